//! The files that a name with a place for a number stands for, and those that it nearly does.

use std::cmp::Ordering;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::CloudError;
use crate::table::COMPRESSED_ENDINGS;
use crate::text::{list, quoted};

/// The files of a name with a place for a number, in the order of their numbers.
#[derive(Debug, Default)]
pub(super) struct Numbered {
    pub(super) files: Vec<(i64, PathBuf)>,
    /// The names of files that are nearly of this form.
    left_out: Vec<String>,
    /// The names of files whose numbers are too large.
    too_large: Vec<String>,
}

/// The files that are told by name; of more, their number is.
const MOST_NAMES: usize = 4;

/// The files whose names have a number where `name` has its mark; `None` where it has no mark.
///
/// A number has as many digits as the mark, or more where it needs them. Where no number begins with a zero, those with
/// fewer digits count as well: programs that do not fill up numbers write `dump0`, `dump500`, `dump1000`.
pub(super) fn files(folder: &Path, name: &str) -> io::Result<Option<Numbered>> {
    let path = folder.join(name);
    let file_name = path.file_name().and_then(|name| name.to_str());
    let Some(mark) = file_name.and_then(Mark::of) else {
        return Ok(None);
    };
    if path.exists() {
        return Ok(None);
    }
    let parent = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let mut numbered = Numbered::default();
    let (mut short, mut is_filled_up) = (Vec::new(), false);
    for entry in fs::read_dir(parent)? {
        let name = entry?.file_name();
        let shown = name.to_string_lossy().into_owned();
        let Some(digits) = name.to_str().and_then(|name| mark.digits(name)) else {
            if mark.is_near(&shown) {
                numbered.left_out.push(shown);
            }
            continue;
        };
        let has_zero = digits.len() > 1 && digits.starts_with('0');
        let Ok(number) = digits.parse() else {
            numbered.too_large.push(shown);
            continue;
        };
        match digits.len().cmp(&mark.width) {
            Ordering::Less if !has_zero => short.push((number, parent.join(&name))),
            Ordering::Greater if !has_zero => numbered.files.push((number, parent.join(&name))),
            Ordering::Equal => {
                is_filled_up |= has_zero;
                numbered.files.push((number, parent.join(&name)));
            }
            _ => numbered.left_out.push(shown),
        }
    }
    match is_filled_up {
        true => {
            let names = short.iter().filter_map(|(_, path)| path.file_name());
            numbered
                .left_out
                .extend(names.map(|name| name.to_string_lossy().into_owned()));
        }
        false => numbered.files.extend(short),
    }
    numbered.files.sort_unstable();
    numbered.left_out.sort_unstable();
    numbered.too_large.sort_unstable();
    Ok(Some(numbered))
}

impl Numbered {
    /// The error of no steps, which tells those that are nearly some.
    pub(super) fn explain(&self, error: CloudError) -> CloudError {
        match error {
            CloudError::Scene(mut fault) if !self.left_out.is_empty() => {
                let names = listed(&self.left_out);
                fault
                    .message
                    .push_str(&format!(" ({}: {names})", similar(self.left_out.len())));
                CloudError::Scene(fault)
            }
            error => error,
        }
    }

    /// Warnings of files left out of the steps of `name`, which have these numbers.
    pub(super) fn warnings(&self, name: &str, numbers: &[i64]) -> Vec<String> {
        let mut warnings = Vec::new();
        if !self.left_out.is_empty() {
            warnings.push(format!(
                "{name}: {}, not shown: {}",
                similar(self.left_out.len()),
                listed(&self.left_out)
            ));
        }
        if !self.too_large.is_empty() {
            warnings.push(format!(
                "{name}: {} with numbers of more than 64 bits, not shown: {}",
                counted(self.too_large.len()),
                listed(&self.too_large)
            ));
        }
        warnings.extend(gaps(numbers).map(|gaps| format!("{name}: {gaps}")));
        warnings
    }
}

fn counted(count: usize) -> String {
    match count {
        1 => String::from("1 file"),
        count => format!("{count} files"),
    }
}

fn similar(count: usize) -> String {
    match count {
        1 => String::from("1 file with a similar name"),
        count => format!("{count} files with similar names"),
    }
}

fn listed(names: &[String]) -> String {
    let shown: Vec<String> = names
        .iter()
        .take(MOST_NAMES)
        .map(|name| quoted(name))
        .collect();
    match names.len() - shown.len() {
        0 => list(&shown).replace(" or ", " and "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

/// The gaps between numbers most of which are equally far apart.
fn gaps(numbers: &[i64]) -> Option<String> {
    let steps = numbers.windows(2).map(|pair| pair[0].abs_diff(pair[1]));
    let mut sorted: Vec<u64> = steps.collect();
    sorted.sort_unstable();
    let mut usual = (0, 0);
    for same in sorted.chunk_by(|a, b| a == b) {
        if same.len() > usual.0 {
            usual = (same.len(), same[0]);
        }
    }
    let (count, step) = usual;
    if sorted.len() < 2 || 2 * count < sorted.len() {
        return None;
    }
    let mut gaps = numbers
        .windows(2)
        .filter(|pair| pair[0].abs_diff(pair[1]) > step);
    let first = gaps.next()?;
    let (low, high) = (first[0], first[1]);
    let others = match gaps.count() {
        0 => String::new(),
        1 => String::from(", and in another place"),
        count => format!(", and in {count} other places"),
    };
    Some(format!(
        "files are missing between the numbers {low} and {high}{others} (most numbers are {step} apart): the \
         steps on both sides are shown one after the other"
    ))
}

/// The place for a number in a name.
#[derive(Debug, Eq, PartialEq)]
struct Mark<'name> {
    before: &'name str,
    /// The least number of digits.
    width: usize,
    after: &'name str,
}

impl<'name> Mark<'name> {
    /// The place of `####` or `%04d`.
    fn of(name: &'name str) -> Option<Self> {
        if let Some((before, rest)) = name.split_once('%') {
            let (width, after) = rest.split_once('d')?;
            let width = match width {
                "" => 1,
                width => width.parse().ok()?,
            };
            return Some(Self {
                before,
                width,
                after,
            });
        }
        let start = name.find('#')?;
        let marks = name[start..].bytes().take_while(|&byte| byte == b'#');
        let width = marks.count();
        Some(Self {
            before: &name[..start],
            width,
            after: &name[start + width..],
        })
    }

    /// The digits in the place of the mark.
    fn digits<'file>(&self, name: &'file str) -> Option<&'file str> {
        let digits = name.strip_prefix(self.before)?.strip_suffix(self.after)?;
        let is_number = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
        is_number.then_some(digits)
    }

    /// Says whether a name that is not of this form nearly is: with a number that is negative or no whole one, with
    /// letters of another case, with more behind the number, or compressed.
    fn is_near(&self, name: &str) -> bool {
        let name = name.to_lowercase();
        let plain = |name: &str| {
            let (plain, ending) = name.rsplit_once('.')?;
            COMPRESSED_ENDINGS
                .contains(&ending)
                .then(|| plain.to_owned())
        };
        let after = self.after.to_lowercase();
        let after = plain(&after).unwrap_or(after);
        let name = plain(&name).unwrap_or(name);
        let Some(rest) = name.strip_prefix(&*self.before.to_lowercase()) else {
            return false;
        };
        let number = rest
            .strip_suffix(&*after)
            .map(|rest| rest.trim_start_matches(['-', '+']));
        number.is_some_and(|number| number.starts_with(|first: char| first.is_ascii_digit()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_stand_for_numbers() {
        let mark = |name| Mark::of(name).map(|mark| (mark.before, mark.width, mark.after));
        assert_eq!(mark("run.####.csv"), Some(("run.", 4, ".csv")));
        assert_eq!(mark("run%03d.xyz.gz"), Some(("run", 3, ".xyz.gz")));
        assert_eq!(mark("run%d.xyz"), Some(("run", 1, ".xyz")));
        assert_eq!(mark("run.csv"), None);
        assert_eq!(mark("100%.csv"), None);
    }

    #[test]
    fn names_of_another_form_are_near() {
        let mark = Mark::of("run.####.csv").unwrap();
        for (name, is_near) in [
            ("run.-0001.csv", true),
            ("run.0.5.csv", true),
            ("Run.0001.CSV", true),
            ("run.0001.csv.gz", true),
            ("run.0001.copy.csv", true),
            ("run.0001.xyz", false),
            ("run.csv", false),
            ("run.all.csv", false),
            ("rerun.0001.csv", false),
        ] {
            assert_eq!(mark.is_near(name), is_near, "{name}");
        }
    }

    #[test]
    fn gaps_are_those_of_numbers_that_go_by_equal_steps() {
        let gap = |numbers: &[i64]| {
            let gaps = gaps(numbers)?;
            gaps.strip_prefix("files are missing between the numbers ")
                .map(|gaps| gaps.split(" (").next().unwrap_or_default().to_owned())
        };
        assert_eq!(
            gap(&[0, 500, 1000, 12500]).as_deref(),
            Some("1000 and 12500")
        );
        assert_eq!(gap(&[1, 2, 4]).as_deref(), Some("2 and 4"));
        let several = [1, 2, 3, 5, 6, 7, 9, 10, 13];
        assert_eq!(
            gap(&several).as_deref(),
            Some("3 and 5, and in 2 other places")
        );
        for none in [&[][..], &[7], &[1, 9], &[1, 2, 3], &[0, 13, 29, 41, 100]] {
            assert_eq!(gap(none), None, "{none:?}");
        }
    }
}
