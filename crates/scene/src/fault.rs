//! Faults of a scene file, gathered while it is read.
//!
//! `serde` gives no way to hand something down to the values that it reads, so the text that is
//! being read and the faults found in it wait in a thread-local [`Sink`]. That is what lets a
//! fault be told although the file's syntax breaks further down.

use std::cell::RefCell;
use std::ops::Range;

/// Something that is wrong at a place of the text.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) struct Fault {
    /// The place, in bytes of the text.
    pub(crate) place: Range<usize>,
    /// What was expected, and unless `found_is_open` what was found.
    pub(crate) message: String,
    /// Whether the message still lacks `, found …`, the token at the place.
    pub(crate) found_is_open: bool,
}

impl Fault {
    /// A fault whose message is complete.
    pub(crate) fn new(place: Range<usize>, message: String) -> Self {
        Self {
            place,
            message,
            found_is_open: false,
        }
    }

    /// A fault whose message ends with the token that is found at the place.
    pub(crate) fn at_token(at: usize, expected: String) -> Self {
        Self {
            place: at..at,
            message: expected,
            found_is_open: true,
        }
    }
}

/// Where the text being read lies in memory, and what is wrong with it.
#[derive(Default)]
struct Sink {
    text_address: usize,
    faults: Vec<Fault>,
}

thread_local! {
    static SINK: RefCell<Sink> = RefCell::default();
}

/// Reads `text` by `read`; returns its result and the faults that it reported.
pub(crate) fn collect<T>(text: &str, read: impl FnOnce() -> T) -> (T, Vec<Fault>) {
    let text_address = text.as_ptr() as usize;
    SINK.set(Sink {
        text_address,
        faults: Vec::new(),
    });
    let result = read();
    (result, SINK.take().faults)
}

/// Adds a fault to those of the text being read.
pub(crate) fn report(fault: Fault) {
    SINK.with_borrow_mut(|sink| sink.faults.push(fault));
}

/// A part of the text being read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slice<'t> {
    /// The part.
    pub(crate) text: &'t str,
    /// Where it starts in the whole text, in bytes.
    pub(crate) start: usize,
}

impl<'t> Slice<'t> {
    /// The part `text` of the text being read; it must lie in that text's memory.
    pub(crate) fn of_text_being_read(text: &'t str) -> Self {
        let text_address = SINK.with_borrow(|sink| sink.text_address);
        Self {
            text,
            start: (text.as_ptr() as usize).wrapping_sub(text_address),
        }
    }

    /// The place of this part in the whole text.
    pub(crate) fn place(&self) -> Range<usize> {
        self.start..self.start + self.text.len()
    }

    /// Reports that something else was expected than this part; `None`, for the caller to return.
    pub(crate) fn refuse<T>(&self, expected: &str) -> Option<T> {
        report(Fault::new(
            self.place(),
            format!("expected {expected}, found {}", show(self.text)),
        ));
        None
    }
}

/// A piece of the text as a message shows it: short, and harmless to a terminal.
pub(crate) fn show(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut shown = String::new();
    let mut characters = text.chars();
    for c in characters.by_ref().take(LONGEST) {
        if c.is_control() {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
        }
    }
    if characters.next().is_some() {
        shown.push('…');
    }
    let is_plain = text.starts_with(|c: char| c == '"' || c.is_ascii_digit())
        || text.len() > 1 && text.starts_with(['-', '+', '.'])
        || matches!(text, "NaN" | "inf");
    if is_plain {
        shown
    } else {
        format!("`{shown}`")
    }
}
