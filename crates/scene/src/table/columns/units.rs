//! Units that stand behind the names of columns, and are not all the same.

use super::names::{marked, unit};

/// The doubt about radii of elements, which are in ångströms, beside positions in this column.
pub(super) fn of_elements(x: Option<&str>) -> Option<String> {
    const ANGSTROMS: [&str; 5] = ["a", "ang", "angstrom", "angstroms", "angström"];
    let (name, unit) = with_unit(x?)?;
    (!ANGSTROMS.contains(&&*unit)).then(|| {
        let name = marked(name);
        format!(
            "the radii of elements are in ångströms, but the column {name} is not: `columns: (radius_scale: …)` multiplies \
             them"
        )
    })
}

/// The doubt about lengths in columns of these names that have different units.
pub(super) fn unequal<'a>(names: impl Iterator<Item = &'a str>) -> Option<String> {
    let mut units = names.filter_map(with_unit);
    let (name, first) = units.next()?;
    let (other, _) = units.find(|(_, unit)| *unit != first)?;
    let (name, other) = (marked(name), marked(other));
    Some(format!(
        "the columns {name} and {other} have different units, but are read as if they had the same one (`columns: \
         (radius_scale: …)` multiplies radii)"
    ))
}

/// The name of a column and its unit, as most programs write it.
fn with_unit(name: &str) -> Option<(&str, String)> {
    let unit = unit(name)?.to_lowercase();
    Some((name, unit.replace(['µ', 'μ'], "u").replace('å', "a")))
}
