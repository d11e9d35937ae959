//! Protection against panics of a library on damaged files.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe, catch_unwind};
use std::sync::Once;

thread_local! {
    /// Whether a panic of this thread is expected, and must not be printed.
    static IS_GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Runs `read`, which may panic if a file is damaged. Turns a panic into an error, and prints nothing.
///
/// The decoders of libraries do not check some numbers of a file; `cargo mutate` finds files with invalid ones. After a
/// panic, anything that `read` has changed must not be used.
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
        Err(_) => Err("its data is damaged".to_owned()),
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
        assert_eq!(broken, Err("its data is damaged".to_owned()));
        assert!(!IS_GUARDED.get());
    }
}
