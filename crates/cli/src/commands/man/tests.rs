use std::fs;

use super::*;
use crate::tests::{run_here, temporary};

#[test]
fn every_command_has_a_page() {
    for command in Arguments::command().get_subcommands() {
        let name = command.get_name();
        let (code, page, err) = run_here(&["man", name]);
        assert_eq!((code, &*err), (0, ""), "{name}");
        let page = page.replace("\\-", "-");
        assert!(page.contains(&format!(".TH marbles-{name} 1")), "{page}");
        for argument in command.get_arguments().filter_map(|a| a.get_long()) {
            let option = format!("--{argument}");
            assert!(page.contains(&option), "{name} {option}");
        }
    }
    let (_, page, _) = run_here(&["man", "farm-slurm"]);
    assert!(page.replace("\\-", "-").contains("--chunk"), "{page}");
    let (_, page, _) = run_here(&["man", "render"]);
    let example = ".SH EXAMPLES\n.nf\n  marbles new ball.ron\n      write a scene";
    assert!(page.contains(example), "{page}");
    assert!(
        page.contains(".SH \"EXIT CODES\"\n.nf\n  0    everything"),
        "{page}"
    );
    let (code, page, _) = run_here(&["man"]);
    assert_eq!(code, 0);
    assert!(
        page.replace("\\-", "-").contains("marbles-render(1)"),
        "{page}"
    );
}

#[test]
fn pages_name_no_page_that_is_not_there() {
    let mut seen = 0;
    for page in pages() {
        let name = page.man.get_filename();
        let command = name.strip_suffix(".1").unwrap();
        let command = command.strip_prefix("marbles").unwrap();
        let command = command.strip_prefix('-');
        let (_, text, _) = run_here(&[&["man"], command.as_slice()].concat());
        let text = text.replace("\\-", "-");
        let start = format!(".TH {} 1 ", name.trim_end_matches(".1"));
        assert!(text.contains(&start), "{name}");
        for other in text.lines().filter_map(|line| line.strip_suffix("(1)")) {
            let other = other.strip_prefix("marbles-").unwrap();
            assert_eq!(run_here(&["man", other]).0, 0, "{name} names {other}");
            seen += 1;
        }
    }
    assert_eq!(seen + 1, pages().len());
}

#[test]
fn unknown_commands_have_none() {
    let (code, out, err) = run_here(&["man", "paint"]);
    assert_eq!((code, &*out), (2, ""));
    assert!(err.contains("found `paint`"), "{err}");
}

#[test]
fn a_folder_takes_all_pages() {
    let folder = temporary("man");
    let (code, out, err) = run_here(&["man", "-o", folder.to_str().unwrap()]);
    assert_eq!((code, &*err), (0, ""));
    let pages = fs::read_dir(&folder).unwrap().count();
    fs::remove_dir_all(&folder).unwrap();
    assert_eq!(pages, super::pages().len());
    assert_eq!(out.lines().count(), pages);
}
