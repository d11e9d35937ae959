//! Scenes that are refused, each with its exact message.
//!
//! `broken/NAME.ron` is the scene and `broken/NAME.txt` the message. With `MARBLES_BLESS=1` the messages are written
//! again, and the run fails so that somebody looks at them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{env, fs};

use marbles_scene::Scene;

fn broken() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("broken")
}

/// The names of the files in `broken` with this extension.
fn names(ending: &str) -> BTreeSet<String> {
    fs::read_dir(broken())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|found| found == ending))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect()
}

/// The message about the scene. Its path is relative to the folder `tests`.
fn message(path: &Path) -> String {
    let error = Scene::load(path).expect_err("a broken scene");
    let folder = format!("{}/", env!("CARGO_MANIFEST_DIR"));
    error.to_string().replace(&folder, "") + "\n"
}

/// The text without ANSI color sequences.
fn without_styles(text: &str) -> String {
    let mut parts = text.split("\u{1b}[");
    let first = parts.next().unwrap().to_owned();
    parts.fold(first, |plain, part| plain + part.split_once('m').unwrap().1)
}

#[test]
fn broken_scenes_are_refused_with_their_messages() {
    let bless = env::var_os("MARBLES_BLESS").is_some();
    let mut wrong = Vec::new();
    let scenes = names("ron");
    for name in &scenes {
        let found = message(&broken().join(format!("{name}.ron")));
        let expected = broken().join(format!("{name}.txt"));
        if bless {
            fs::write(&expected, &found).unwrap();
        } else if fs::read_to_string(&expected).ok().as_ref() != Some(&found) {
            wrong.push(format!("{name}:\n{found}"));
        }
    }
    assert!(!bless, "the messages were written: look at them");
    assert!(wrong.is_empty(), "not as expected:\n\n{}", wrong.join("\n"));
    assert_eq!(scenes, names("txt"), "scenes and messages come in pairs");
    assert!(!scenes.is_empty());
}

#[test]
fn a_message_starts_with_the_place_and_ends_without_a_full_stop() {
    for name in names("ron") {
        let path = broken().join(format!("{name}.ron"));
        let error = Scene::load(&path).expect_err("a broken scene");
        let first = &error.faults()[0];
        let start = format!(
            "{}:{}:{}: {}",
            error.path().display(),
            first.line,
            first.column,
            first.message
        );
        assert!(error.to_string().starts_with(&start), "{name}");
        for fault in error.faults() {
            assert!(fault.message.starts_with("expected "), "{name}");
            assert!(fault.message.contains("found "), "{name}");
            assert!(!fault.message.ends_with('.'), "{name}");
            assert!(!fault.message.contains('\n'), "{name}");
        }
        let styled = error.for_terminal(1000, true);
        assert!(styled.starts_with("\u{1b}["), "{name}");
        assert_eq!(without_styles(&styled), error.to_string(), "{name}");
        let narrow = error.for_terminal(46, false);
        let excerpts = narrow.lines().filter(|line| line.contains(" |"));
        for line in excerpts {
            assert!(line.chars().count() <= 46, "{name}: {line}");
        }
        let is_ordered = |pair: &[marbles_scene::SceneFault]| {
            (pair[0].line, pair[0].column) <= (pair[1].line, pair[1].column)
        };
        assert!(error.faults().windows(2).all(is_ordered), "{name}");
    }
}

#[test]
fn what_is_no_file_is_refused() {
    let missing = broken().join("missing").join("scene.ron");
    assert_eq!(
        message(&missing),
        "broken/missing/scene.ron: no such file\n"
    );
    assert_eq!(
        message(&broken()),
        "broken: expected a scene file, found a folder\n"
    );
}

#[test]
fn a_line_of_ten_megabytes_is_shown_around_the_fault() {
    let many = "(center: (0, 0, 400), radius: 300), ".repeat(150_000);
    let text = format!(
        "(image: (width: 8, height: 8), lens: Fov(50), camera: Free(), spheres: [{many}(center: \
         (0, 0, 0), radius: -3), {many}])"
    );
    assert!(text.len() > 10_000_000);
    let error = Scene::parse(&text, Path::new("a.ron")).unwrap_err();
    let fault = &error.faults()[0];
    assert_eq!(&text[fault.column - 1..][..2], "-3");
    assert_eq!(fault.message, "expected a radius greater than 0, found -3");
    assert!(error.to_string().len() < 1000);
}

#[test]
fn deep_nesting_is_refused() {
    for open in ["(", "[", "{", "(a: ", "Some(", "/*", "\"", "{(", "a("] {
        for before in ["", "(", "(spheres: ", "(camera: Free(position: "] {
            let text = format!("{before}{}", open.repeat(100_000));
            let error = Scene::parse(&text, Path::new("a.ron")).unwrap_err();
            assert_eq!(error.faults().len(), 1, "{before}{open}");
        }
    }
}

#[test]
fn a_scene_cut_anywhere_is_refused() {
    let whole = include_str!("whole.ron");
    assert!(Scene::parse(whole, Path::new("a.ron")).is_ok());
    let end = whole.rfind(')').unwrap();
    for cut in (0..=end).filter(|&cut| whole.is_char_boundary(cut)) {
        let error = Scene::parse(&whole[..cut], Path::new("a.ron")).unwrap_err();
        assert!(!error.faults().is_empty(), "cut at {cut}");
    }
}

#[test]
fn a_scene_with_any_character_replaced_is_read_without_panic() {
    let whole = include_str!("whole.ron");
    for (at, c) in whole.char_indices() {
        for other in [
            "", "(", ")", "\"", "/*", "'", "\u{0}", "ä", "-", "1e999", "_", "#", "\\",
        ] {
            let text = format!("{}{other}{}", &whole[..at], &whole[at + c.len_utf8()..]);
            if let Err(error) = Scene::parse(&text, Path::new("a.ron")) {
                assert!(!error.faults().is_empty(), "{text}");
            }
        }
    }
}
