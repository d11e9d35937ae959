//! Altered files of all kinds are read or refused. `cargo mutate --seconds 3600` searches longer, and `.ci/run` for a
//! minute.

use marbles_tests::mutations::{Limit, TARGETS, search_all};

#[test]
fn altered_files_are_read_or_refused() {
    const INPUTS: u64 = 300;
    let all = search_all(20261124, Limit::Inputs(INPUTS), None, None);
    assert_eq!(all.len(), TARGETS.len());
    for (target, found) in all {
        assert!(found.faults.is_empty(), "{}: {found:?}", target.name);
        // Neither is all refused, nor all the same as it was.
        let least = INPUTS / 50;
        assert!(found.taken >= least, "{}: {found:?}", target.name);
        let is_all = found.taken == INPUTS && target.name != "rays";
        assert!(!is_all, "{}: {found:?}", target.name);
    }
}
