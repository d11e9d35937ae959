//! Tests of `completions.rs`.

use clap::ValueEnum;
use clap_complete::Shell;

use crate::tests::run_here;

#[test]
fn every_shell_learns_every_command_and_option() {
    let mut scripts = Vec::new();
    for shell in Shell::value_variants() {
        let (code, script, err) = run_here(&["completions", &shell.to_string()]);
        assert_eq!((code, &*err), (0, ""));
        // Each in its own language.
        assert!(!scripts.contains(&script), "{shell}");
        scripts.push(script.clone());
        // Fish leaves the dashes out.
        for word in ["marbles", "render", "compare", "error-channel", "tolerance"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
}

#[test]
fn unknown_shells_are_refused() {
    let (code, out, err) = run_here(&["completions", "tcsh"]);
    assert_eq!((code, &*out), (2, ""));
    assert!(err.contains("tcsh") && err.contains("fish"), "{err}");
}
