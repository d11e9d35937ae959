//! The column of a table that a figure colors, where the table has neither elements nor colors.

use super::reader::Reader;
use crate::table::{Coloring, ColumnRef, Paint, Value, has_axis};

/// The colors of a figure.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Colors {
    /// The fields of the cloud, as the scene file writes them.
    pub(super) fields: Vec<String>,
    /// The comment about them.
    pub(super) comment: String,
}

/// The most different values of a column of categories: as many as there are colors.
const MOST_CATEGORIES: usize = 12;
/// The columns that are looked at: each is read on its own.
const MOST_COLUMNS: usize = 24;
/// If the numbers from the 1st to the 99th percentile cover less than this share of all, a few extreme ones would take
/// all colors.
const LEAST_SHARE: f64 = 0.6;
/// Names of columns that number rows, or say where and when they are, rather than what they are like.
const PASSED_OVER: [&str; 40] = [
    "id",
    "ids",
    "index",
    "idx",
    "serial",
    "number",
    "no",
    "no.",
    "nr",
    "row",
    "particle",
    "particle_id",
    "particleid",
    "atom_id",
    "atomid",
    "globalids",
    "pointids",
    "ix",
    "iy",
    "iz",
    "radius",
    "radii",
    "r",
    "diameter",
    "diameters",
    "d",
    "time",
    "frame",
    "step",
    "timestep",
    "t",
    "nx",
    "ny",
    "nz",
    "a",
    "alpha",
    "opacity",
    "proc",
    "procp1",
    "mol",
];

/// The first column of the table that is worth coloring.
pub(super) fn choose(reader: &Reader<'_>) -> Option<Colors> {
    let names = reader.names;
    let is_position = |index: usize| {
        let alone = std::sync::Arc::new(vec![names[index].clone()]);
        (0..3).any(|axis| has_axis(&alone, axis)) || reader.used.contains(&(index + 1))
    };
    let candidates = (0..names.len()).filter(|&index| {
        let name = names[index].to_ascii_lowercase();
        let same = names
            .iter()
            .filter(|other| other.eq_ignore_ascii_case(&name));
        !PASSED_OVER.contains(&&*name) && !is_position(index) && same.count() == 1
    });
    candidates
        .take(MOST_COLUMNS)
        .find_map(|index| vector(reader, index).unwrap_or_else(|| column(reader, index)))
}

/// The length of the vector that begins with this column; `None` if none does, `Some(None)` if all lengths are equal.
fn vector(reader: &Reader<'_>, index: usize) -> Option<Option<Colors>> {
    const ENDINGS: [[&str; 3]; 4] = [
        ["x", "y", "z"],
        ["_1", "_2", "_3"],
        [":0", ":1", ":2"],
        ["_0", "_1", "_2"],
    ];
    let first = &reader.names[index];
    let parts = ENDINGS.iter().find_map(|ending| {
        let stem = first
            .strip_suffix(ending[0])
            .filter(|stem| !stem.is_empty())?;
        let parts = ending.map(|ending| format!("{stem}{ending}"));
        let mut others = parts.iter();
        others
            .all(|part| reader.names.contains(part))
            .then_some(parts)
    })?;
    let columns = parts.clone().map(ColumnRef::Name);
    let Some(Paint::Values(values)) = reader.paint(Value::Length(columns), Coloring::Value) else {
        return None;
    };
    let [x, y, z] = parts;
    let value = format!("Length({x:?}, {y:?}, {z:?})");
    Some(of_numbers(values, value, "the length of a vector"))
}

fn column(reader: &Reader<'_>, index: usize) -> Option<Colors> {
    let name = &reader.names[index];
    let is_numbered = name.parse::<u32>().is_ok();
    let value = match is_numbered {
        true => name.clone(),
        false => format!("{name:?}"),
    };
    let of = |coloring| reader.paint(Value::Column(ColumnRef::Number(index + 1)), coloring);
    match of(Coloring::Value) {
        Some(Paint::Values(values)) => of_numbers(values, value, "a column of numbers"),
        _ => match of(Coloring::Category)? {
            Paint::Categories(categories)
                if (2..=MOST_CATEGORIES).contains(&categories.names.len()) =>
            {
                Some(categories_of(value))
            }
            _ => None,
        },
    }
}

fn categories_of(value: String) -> Colors {
    Colors {
        fields: vec![format!("value: {value}"), "color: Category".to_owned()],
        comment: "each value has a color of its own; `palette: {\"1\": \"#d02840\"}` chooses it"
            .to_owned(),
    }
}

/// The colors of numbers; `None` if they are all the same, or number the rows.
fn of_numbers(mut values: Vec<f64>, value: String, kind: &str) -> Option<Colors> {
    let count = values.len();
    values.retain(|value| !value.is_nan());
    let is_missing = values.len() < count;
    values.sort_unstable_by(f64::total_cmp);
    let (low, high) = (*values.first()?, *values.last()?);
    if low >= high {
        return None;
    }
    let last = values.len() - 1;
    let at = |percent: usize| values[(last as f64 * percent as f64 / 100.0) as usize];
    let is_extreme = at(99) - at(1) < LEAST_SHARE * (high - low) && at(1) < at(99);
    let are_whole = values.iter().all(|value| value.fract() == 0.0);
    let mut different = values;
    different.dedup();
    if are_whole && different.len() <= MOST_CATEGORIES && !is_missing {
        return Some(categories_of(value));
    }
    if are_whole && different.len() == count && high - low < 2.0 * count as f64 {
        return None;
    }
    let mut fields = vec![format!("value: {value}"), "colormap: Viridis".to_owned()];
    if is_extreme {
        fields.push("range: Percentile(1, 99)".to_owned());
    }
    if is_missing {
        fields.push("missing: \"#a0a0a0\"".to_owned());
    }
    Some(Colors {
        fields,
        comment: format!("{kind}; `marbles render --legend FILE.svg` draws the scale"),
    })
}
