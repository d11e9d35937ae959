//! Altered scenes and tables: read or refused. `cargo mutate --seconds 3600` looks longer.

use marbles_tests::mutations::{TARGETS, search};

#[test]
fn altered_files_are_read_or_refused() {
    const INPUTS: u64 = 1500;
    for target in &TARGETS {
        let found = search(target, 20261124, |inputs| inputs < INPUTS);
        assert!(found.faults.is_empty(), "{}: {found:?}", target.name);
        // Neither is all refused, nor all the same as it was.
        assert!(
            (INPUTS / 50..INPUTS).contains(&found.taken),
            "{}: {found:?}",
            target.name
        );
    }
}
