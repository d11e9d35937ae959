//! The styles of atoms in data files of LAMMPS, and their columns.
//!
//! # Source
//! The documentation of LAMMPS, `read_data` and `atom_style`.

use super::number::parse;

/// A style of atoms.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    pub(super) name: &'static str,
    pub(super) columns: &'static [&'static str],
}

const fn style(name: &'static str, columns: &'static [&'static str]) -> Style {
    Style { name, columns }
}

/// The styles of atoms. The first that fits is guessed.
const STYLES: [Style; 9] = [
    style("full", &["id", "mol", "type", "q", "x", "y", "z"]),
    style("molecular", &["id", "mol", "type", "x", "y", "z"]),
    style("atomic", &["id", "type", "x", "y", "z"]),
    style("charge", &["id", "type", "q", "x", "y", "z"]),
    style(
        "sphere",
        &["id", "type", "diameter", "density", "x", "y", "z"],
    ),
    style("bond", &["id", "mol", "type", "x", "y", "z"]),
    style("angle", &["id", "mol", "type", "x", "y", "z"]),
    style(
        "ellipsoid",
        &["id", "type", "ellipsoid", "density", "x", "y", "z"],
    ),
    style(
        "dipole",
        &["id", "type", "q", "x", "y", "z", "mux", "muy", "muz"],
    ),
];
/// The names of other styles.
const OTHERS: [&str; 21] = [
    "amoeba",
    "body",
    "bpm/sphere",
    "dielectric",
    "dpd",
    "edpd",
    "electron",
    "hybrid",
    "line",
    "mdpd",
    "oxdna",
    "peri",
    "rheo",
    "rheo/thermal",
    "smd",
    "sph",
    "spin",
    "tdpd",
    "template",
    "tri",
    "wavepacket",
];
/// The columns that count how often an atom left the box, which may follow.
pub(super) const IMAGES: [&str; 3] = ["ix", "iy", "iz"];

/// A row, as its words.
pub(super) type Words = Vec<Vec<u8>>;

impl Style {
    /// What is guessed of no rows.
    pub(super) const USUAL: Self = STYLES[0];

    /// Says whether a word is the name of a style.
    pub(super) fn is_name(word: &[u8]) -> bool {
        let mut known = STYLES.iter().map(|style| style.name).chain(OTHERS);
        known.any(|known| known.as_bytes() == word)
    }

    /// The style of this name, if its columns are known.
    pub(super) fn of(name: &[u8]) -> Option<Self> {
        let mut styles = STYLES.into_iter();
        styles.find(|style| style.name.as_bytes() == name)
    }

    /// The names of the styles whose columns are known.
    pub(super) fn names() -> [&'static str; STYLES.len()] {
        STYLES.map(|style| style.name)
    }

    /// The first style that all these rows may have.
    pub(super) fn guessed(rows: &[Words], is_type: &dyn Fn(&[u8]) -> bool) -> Option<Self> {
        let mut styles = STYLES.into_iter();
        styles.find(|style| rows.iter().all(|row| style.fits(row, is_type)))
    }

    fn fits(&self, row: &Words, is_type: &dyn Fn(&[u8]) -> bool) -> bool {
        let may_be = |(word, column): (&Vec<u8>, &&str)| match *column {
            "id" | "mol" => is_whole(word),
            "type" => is_type(word),
            _ => parse(word, false).is_some(),
        };
        (row.len() == self.columns.len() || self.has_images(row))
            && row.iter().zip(self.columns).all(may_be)
    }

    /// Says whether the counts of how often its atom left the box stand behind the columns of a row.
    pub(super) fn has_images(&self, row: &Words) -> bool {
        let behind = row.get(self.columns.len()..).unwrap_or_default();
        behind.len() == IMAGES.len() && behind.iter().all(|word| is_whole(word))
    }
}

fn is_whole(word: &[u8]) -> bool {
    let digits = word.strip_prefix(b"-").unwrap_or(word);
    !digits.is_empty() && digits.iter().all(u8::is_ascii_digit)
}
