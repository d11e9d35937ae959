//! Files that were altered, and a library that panics on some of them.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe, catch_unwind};
use std::sync::Once;

thread_local! {
    /// True while what this thread does may panic without a word.
    static IS_GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Does what may panic where a file is broken: then it is an error, and nothing is printed.
///
/// Decoders of libraries take some numbers of a file for granted; `cargo mutate` finds files with others.
/// What `read` has changed by then is not to be used any more.
pub(super) fn guarded<T, E: ToString>(read: impl FnOnce() -> Result<T, E>) -> Result<T, String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let others = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            if !IS_GUARDED.get() {
                others(panic);
            }
        }));
    });
    IS_GUARDED.set(true);
    let read = catch_unwind(AssertUnwindSafe(read));
    IS_GUARDED.set(false);
    match read {
        Ok(read) => read.map_err(|error| error.to_string()),
        Err(_) => Err("its data is broken".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panics_become_errors() {
        assert_eq!(guarded(|| Ok::<_, String>(7)), Ok(7));
        assert_eq!(guarded(|| Err::<(), _>("a word")), Err("a word".to_owned()));
        let broken = guarded(|| -> Result<(), String> { panic!("not printed") });
        assert_eq!(broken, Err("its data is broken".to_owned()));
        assert!(!IS_GUARDED.get());
    }
}
