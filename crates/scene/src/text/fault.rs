//! Faults of a scene file, gathered while it is read.
//!
//! `serde` gives no way to hand something down to the values that it reads, so the address of the
//! text that is being read and the faults found in it are kept in a thread-local [`Reading`]. That
//! lets a fault be told although the file's syntax breaks further down.

use std::cell::RefCell;
use std::ops::Range;

/// Something that is wrong at a place of the text.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) struct Fault {
    /// The place, in bytes of the text.
    pub(crate) place: Range<usize>,
    /// The expected thing and, unless `found_is_open`, the found one.
    pub(crate) message: String,
    /// The message still lacks `, found …`, the token at the place.
    pub(crate) found_is_open: bool,
}

impl Fault {
    /// A fault whose message is complete.
    pub(crate) fn new(place: Range<usize>, message: impl Into<String>) -> Self {
        Self {
            place,
            message: message.into(),
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

/// The address of the text being read, the faults found in it, and the manner of reading.
#[derive(Default)]
struct Reading {
    text_address: usize,
    faults: Vec<Fault>,
    /// In the strict manner: the innermost structure in which reading failed.
    strict: Option<Option<Names>>,
}

thread_local! {
    static READING: RefCell<Reading> = RefCell::default();
}

/// Reads `text` by `read`; returns its result and the faults that it reported.
pub(crate) fn collect<T>(text: &str, read: impl FnOnce() -> T) -> (T, Vec<Fault>) {
    READING.set(Reading {
        text_address: text.as_ptr() as usize,
        ..Reading::default()
    });
    let result = read();
    (result, READING.take().faults)
}

/// The address of the text being read.
pub(super) fn text_address() -> usize {
    READING.with_borrow(|reading| reading.text_address)
}

/// Adds a fault to those of the text being read.
pub(super) fn report(fault: Fault) {
    READING.with_borrow_mut(|reading| reading.faults.push(fault));
}

/// Takes back the faults of the text being read from this place on.
pub(super) fn forget_from(place: usize) {
    READING.with_borrow_mut(|reading| reading.faults.retain(|fault| fault.place.start < place));
}

/// Reports a fault whose message is complete; `None`, for the caller to return.
pub(crate) fn refuse<T>(place: Range<usize>, message: impl Into<String>) -> Option<T> {
    report(Fault::new(place, message));
    None
}

/// Runs `read` so that structures fail as a whole; returns also the one in which it failed.
pub(super) fn strictly<T>(read: impl FnOnce() -> T) -> (T, Option<Names>) {
    READING.with_borrow_mut(|reading| reading.strict = Some(None));
    let result = read();
    let names = READING.with_borrow_mut(|reading| reading.strict.take());
    (result, names.flatten())
}

/// Returns whether structures are to fail as a whole.
pub(super) fn is_strict() -> bool {
    READING.with_borrow(|reading| reading.strict.is_some())
}

/// Notes that a structure failed while reading strictly; the innermost one is the first.
pub(crate) fn note_failure(names: Names) {
    READING.with_borrow_mut(|reading| {
        if let Some(innermost) = &mut reading.strict {
            innermost.get_or_insert(names);
        }
    });
}

/// The name of a structure or an enumeration in messages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Names {
    /// The noun, as in "a field of this sphere".
    pub(crate) noun: &'static str,
    /// The whole, as in "a sphere `(center: …, radius: …)`".
    pub(crate) form: &'static str,
}

impl Names {
    /// The noun with its article.
    pub(super) fn kind(&self) -> &'static str {
        let end = self.form.find([':', '`']).unwrap_or(self.form.len());
        self.form[..end].trim_end()
    }
}
