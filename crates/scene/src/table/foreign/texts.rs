//! Texts of other kinds, told by their contents.

use super::super::fields::{self, Division};
use super::super::number::parse;

/// The usual ending of the name of a text that begins so, where its contents leave no doubt.
pub(super) fn ending(head: &[u8]) -> Option<&'static str> {
    /// The lines that are looked at.
    const LINES: usize = 64;
    let lines = head.split(|&byte| byte == b'\n').take(LINES);
    let lines: Vec<&[u8]> = lines.map(<[u8]>::trim_ascii).collect();
    let line = |number: usize| lines.get(number).copied().unwrap_or_default();
    let first = lines
        .iter()
        .find(|line| !line.is_empty() && !line.starts_with(b"#"))
        .copied()
        .unwrap_or_default();
    if first.starts_with(b"<") {
        return of_markup(&lines);
    }
    if first.starts_with(b"PSF") && lines.iter().any(|line| line.ends_with(b"!NTITLE")) {
        return Some("psf");
    }
    if first.starts_with(b"solid") && lines.iter().any(|line| line.starts_with(b"facet normal")) {
        return Some("stl");
    }
    if is_xsf(&lines) {
        return Some("xsf");
    }
    if first.starts_with(b"{") && lines.iter().any(|line| line.contains(&b'"')) {
        return Some("json");
    }
    // Lines of a table have as many fields each.
    let grid = (2..6).all(|number| matches!(numbers(line(number)), Some(4 | 5)));
    (grid && numbers(line(3)) == Some(4) && numbers(line(6)) == Some(5)).then_some("cube")
}

/// The number of fields of a line that has numbers alone.
fn numbers(line: &[u8]) -> Option<usize> {
    let words = fields::all(line, &Division::Words);
    words
        .iter()
        .all(|word| parse(word, false).is_some())
        .then_some(words.len())
        .filter(|count| *count > 0)
}

fn is_xsf(lines: &[&[u8]]) -> bool {
    const KINDS: [&[u8]; 5] = [b"CRYSTAL", b"SLAB", b"POLYMER", b"MOLECULE", b"ANIMSTEPS"];
    const SECTIONS: [&[u8]; 4] = [b"ATOMS", b"PRIMVEC", b"CONVVEC", b"PRIMCOORD"];
    let said = lines
        .iter()
        .filter(|line| !line.is_empty() && !line.starts_with(b"#"));
    let words = said.map(|line| {
        line.split(u8::is_ascii_whitespace)
            .next()
            .unwrap_or_default()
    });
    let mut words = words.peekable();
    let is_begun = words
        .peek()
        .is_some_and(|word| KINDS.contains(word) || SECTIONS.contains(word));
    is_begun && words.any(|word| SECTIONS.contains(&word))
}

/// The usual ending of the name of an XML or HTML file.
fn of_markup(lines: &[&[u8]]) -> Option<&'static str> {
    let has = |word: &[u8]| {
        lines.iter().any(|line| {
            line.windows(word.len())
                .any(|part| part.eq_ignore_ascii_case(word))
        })
    };
    if has(b"<VTKFile") {
        return Some("vti");
    }
    if has(b"<!doctype html") || has(b"<html") {
        return Some("html");
    }
    if has(b"<molecule") || has(b"<cml") {
        return Some("cml");
    }
    has(b"<?xml").then_some("xml")
}
