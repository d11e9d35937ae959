//! "Did you mean": the known name that is closest to an unknown one.

/// The end of a message: ", did you mean CANDIDATE?", or nothing where none is close to `name`.
pub(crate) fn did_you_mean<'c>(
    name: &str,
    candidates: impl IntoIterator<Item = &'c str>,
    show: impl Fn(&str) -> String,
) -> String {
    let close = closest(name, candidates);
    close.map_or_else(String::new, |close| {
        format!(", did you mean {}?", show(close))
    })
}

/// The candidate that a misspelled `name` probably stands for.
pub(crate) fn closest<'c>(
    name: &str,
    candidates: impl IntoIterator<Item = &'c str>,
) -> Option<&'c str> {
    // Longer names would cost quadratic time and are no slip of a finger.
    const LONGEST: usize = 64;
    if name.len() > LONGEST {
        return None;
    }
    let lower = name.to_lowercase();
    candidates
        .into_iter()
        .filter(|candidate| candidate.len() <= LONGEST)
        .map(|candidate| (edits(&lower, &candidate.to_lowercase()), candidate))
        .filter(|&(edits, candidate)| {
            edits <= allowed_edits(name.chars().count().min(candidate.chars().count()))
        })
        .min_by_key(|&(edits, _)| edits)
        .map(|(_, candidate)| candidate)
}

/// The list "`a`, `b` or `c`".
pub(crate) fn either<'c>(names: impl IntoIterator<Item = &'c str>) -> String {
    let quoted: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    list(&quoted)
}

/// The list "a, b or c".
pub(crate) fn list(items: &[String]) -> String {
    match items {
        [] => String::from("nothing"),
        [one] => one.clone(),
        [most @ .., last] => format!("{} or {last}", most.join(", ")),
    }
}

/// Insertions, removals, replacements and swaps of neighbors that lead from `a` to `b`.
fn edits(a: &str, b: &str) -> usize {
    strsim::osa_distance(a, b)
}

/// One slip in three letters, and one in the shortest names.
fn allowed_edits(letters: usize) -> usize {
    match letters {
        0 | 1 => 0,
        2..=5 => 1,
        _ => letters / 3,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_recognized() {
        let fields = ["center", "radius", "material"];
        assert_eq!(closest("centre", fields), Some("center"));
        assert_eq!(closest("raduis", fields), Some("radius"));
        assert_eq!(closest("Material", fields), Some("material"));
        assert_eq!(closest("color", fields), None);
        assert_eq!(closest("", fields), None);
        assert_eq!(closest(&"radius".repeat(1000), fields), None);
    }

    #[test]
    fn lists_read_well() {
        assert_eq!(either(["a"]), "`a`");
        assert_eq!(either(["a", "b"]), "`a` or `b`");
        assert_eq!(either(["a", "b", "c"]), "`a`, `b` or `c`");
    }
}
