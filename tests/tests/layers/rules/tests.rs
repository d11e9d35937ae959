//! Small crates, and the faults in their imports.

use super::super::order::layers;
use super::super::tree::Tree;
use super::faults;

/// The faults in a crate of these files with this list.
fn wrong(list: &str, files: &[(&str, &str)]) -> Vec<String> {
    let document = format!("```layers\nx: {list}\n```");
    let own = |&(name, text): &(&str, &str)| (name.to_owned(), text.to_owned());
    let tree = Tree::new(&files.iter().map(own).collect()).unwrap();
    faults(&tree, &layers(&document).unwrap()["x"])
}

#[test]
fn downward_imports_are_allowed() {
    let files = [
        (
            "lib.rs",
            "mod a; mod b; pub use b::B; fn run() -> B { a::one() }",
        ),
        (
            "a.rs",
            "pub(crate) fn one() -> u32 { 1 }\npub(crate) struct A;",
        ),
        (
            "b.rs",
            "use crate::a::{self, A};\npub struct B(A); fn two() { a::one(); }",
        ),
    ];
    assert_eq!(wrong("a ← b", &files), [""; 0]);
}

#[test]
fn upward_imports_are_found() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\nmod c;\npub fn run() {}"),
        ("a.rs", "\nuse crate::b::B;\nfn f() { crate::c::g() }"),
        ("b.rs", "pub struct B;"),
        ("c.rs", "use crate::run; pub fn g() {}"),
    ];
    assert_eq!(
        wrong("a ← b, c", &files),
        [
            "a.rs:2: `crate::b::B`, which is in b.rs: `a` may not use `b`, which is not below it",
            "a.rs:3: `crate::c::g`, which is in c.rs: `a` may not use `c`, which is not below it",
            "c.rs:1: `crate::run`, which is in lib.rs: nothing uses lib.rs",
        ]
    );
    let files = [
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "pub struct A;"),
        ("b.rs", "use super::a::A;"),
    ];
    assert_eq!(wrong("a, b", &files).len(), 1, "neighbors");
    assert_eq!(wrong("a ← b", &files).len(), 0);
}

#[test]
fn the_list_names_every_layer() {
    let files = [("lib.rs", "mod a;"), ("a.rs", "")];
    assert_eq!(
        wrong("b", &files),
        [
            "`a` is not in the list of ARCHITECTURE.md",
            "`b` of ARCHITECTURE.md does not exist"
        ]
    );
}

#[test]
fn a_child_that_uses_what_uses_it_is_a_circle() {
    let with = |parent: &str| {
        let child = "use super::Size;\npub(super) fn measure() -> Size { Size }";
        let files = [
            ("lib.rs", "mod a;"),
            ("a/mod.rs", parent),
            ("a/child.rs", child),
            ("a/size.rs", "pub(crate) struct Size;"),
        ];
        wrong("a", &files)
    };
    let own = "mod child;\npub(crate) struct Size;\nfn f() { child::measure(); }";
    assert_eq!(
        with(own),
        ["2 files import each other in a circle:\n  \
          a/mod.rs:3: `child::measure`, which is in a/child.rs\n  \
          a/child.rs:1: `super::Size`, which is in a/mod.rs"]
    );
    let handed_on =
        "mod child; mod size;\npub(crate) use size::Size;\nfn f() { child::measure(); }";
    assert_eq!(with(handed_on), [""; 0]);
}

#[test]
fn circles_through_re_exports_are_found() {
    let files = [
        ("lib.rs", "mod a;"),
        (
            "a.rs",
            "mod one;\nmod two;\npub(crate) use one::{One, Other as Else};\npub(crate) use two::Two;",
        ),
        (
            "a/one.rs",
            "use super::Two; pub struct One; pub struct Other;",
        ),
        ("a/two.rs", "use crate::a::Else; pub struct Two;"),
    ];
    assert_eq!(
        wrong("a", &files),
        ["2 files import each other in a circle:\n  \
          a/one.rs:1: `super::Two`, which is in a/two.rs\n  \
          a/two.rs:1: `crate::a::Else`, which is in a/one.rs"]
    );
}

#[test]
fn a_re_export_that_the_file_uses_is_an_import() {
    let one = ("a/one.rs", "use super::Own;\npub(crate) struct One;");
    let with = |code: &str| {
        let parent = format!("mod one;\npub(crate) use one::One;\npub(crate) struct Own;\n{code}");
        wrong("a", &[("lib.rs", "mod a;"), ("a.rs", &parent), one]).len()
    };
    assert_eq!(with(""), 0);
    assert_eq!(with("fn f() -> One {}"), 1);
}

#[test]
fn tests_may_use_everything() {
    let test = "#[cfg(test)]\nuse crate::b::B;\n#[cfg(test)] mod tests { use crate::b::B; }\n";
    let files = [
        ("lib.rs", "mod a; mod b; #[cfg(test)] mod helpers;"),
        (
            "a.rs",
            &format!("{test}#[cfg(test)]\nmod more;\nfn f<A, B>() {{}}"),
        ),
        (
            "b.rs",
            "pub struct B { #[cfg(test)] a: crate::c::C, d: u32 }",
        ),
    ];
    assert_eq!(wrong("a ← b", &files), [""; 0]);
}

#[test]
fn modules_inside_a_file_and_globs_are_followed() {
    let files = [
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "mod inner { fn f() { super::super::b::g() } }"),
        ("b.rs", "pub fn g() {}"),
    ];
    assert_eq!(wrong("a ← b", &files).len(), 1);
    let files = [
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "use super::b::*;"),
        ("b.rs", "pub fn g() {}"),
    ];
    assert_eq!(wrong("a ← b", &files).len(), 1);
}

#[test]
fn what_a_macro_makes_belongs_to_the_file_of_the_macro() {
    let files = [
        ("lib.rs", "mod a; mod b; mod c;"),
        ("a.rs", "use crate::c::Made;"),
        ("b.rs", "use crate::c::Kind::One;"),
        ("c.rs", "make! { Made } pub enum Kind { One }"),
    ];
    assert_eq!(wrong("a ← b ← c", &files).len(), 2);
}
