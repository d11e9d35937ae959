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

/// Where the text being read lies in memory, what is wrong with it, and how it is read.
#[derive(Default)]
struct Sink {
    text_address: usize,
    faults: Vec<Fault>,
    /// Where reading strictly: the innermost structure in which it failed.
    strict: Option<Option<Names>>,
}

thread_local! {
    static SINK: RefCell<Sink> = RefCell::default();
}

/// Reads `text` by `read`; returns its result and the faults that it reported.
pub(crate) fn collect<T>(text: &str, read: impl FnOnce() -> T) -> (T, Vec<Fault>) {
    SINK.set(Sink {
        text_address: text.as_ptr() as usize,
        ..Sink::default()
    });
    let result = read();
    (result, SINK.take().faults)
}

/// Adds a fault to those of the text being read.
pub(crate) fn report(fault: Fault) {
    SINK.with_borrow_mut(|sink| sink.faults.push(fault));
}

/// Runs `read` so that structures fail as a whole; returns in which one it failed, too.
pub(crate) fn strictly<T>(read: impl FnOnce() -> T) -> (T, Option<Names>) {
    SINK.with_borrow_mut(|sink| sink.strict = Some(None));
    let result = read();
    let names = SINK.with_borrow_mut(|sink| sink.strict.take());
    (result, names.flatten())
}

/// Whether structures are to fail as a whole.
pub(crate) fn is_strict() -> bool {
    SINK.with_borrow(|sink| sink.strict.is_some())
}

/// Notes that a structure failed while reading strictly; the innermost one is the first.
pub(crate) fn note_failure(names: Names) {
    SINK.with_borrow_mut(|sink| {
        if let Some(innermost) = &mut sink.strict {
            innermost.get_or_insert(names);
        }
    });
}

/// What a structure or an enumeration is called in messages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Names {
    /// The noun, as in "a field of this sphere".
    pub(crate) noun: &'static str,
    /// The whole, as in "a sphere `(center: …, radius: …)`".
    pub(crate) form: &'static str,
}

impl Names {
    /// The noun with its article.
    pub(crate) fn kind(&self) -> &'static str {
        let end = self.form.find([':', '`']).unwrap_or(self.form.len());
        self.form[..end].trim_end()
    }
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
        if c.is_control() || turns_text(c) {
            shown.extend(c.escape_unicode());
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

/// Whether a character changes the direction of the text around it.
fn turns_text(c: char) -> bool {
    matches!(c, '\u{200e}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}
