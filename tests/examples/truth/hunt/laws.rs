//! Renders every scene in other units of length and of light. The pictures must be the same to the last bit.

use std::io::{self, Write as _};

use marbles_core::Method;
use rayon::prelude::*;

use super::draft::Draft;
use super::families::Family;
use super::options::Options;
use super::subject::Subject;

/// The powers of two by which lengths and light are multiplied.
const UNITS: [(i32, i32); 5] = [(-12, 0), (-33, 0), (17, 0), (0, -40), (0, 34)];

/// Claims below this may have fewer digits in another unit of light: the least number that has all of them, times 2⁴⁰.
const ALL_DIGITS: f64 = (1_u64 << 40) as f64 * f64::MIN_POSITIVE;

/// Prints each scene with a picture that differs in another unit.
pub(super) fn search(
    family: &Family,
    scenes: u64,
    options: &Options,
) -> Result<Vec<String>, String> {
    let differs = |index| {
        let draft = super::draft(family, scenes, options, index);
        let difference = difference(&draft, &options.tolerances)
            .map_err(|error| format!("{} {index}: {error}", family.name))?;
        let line = difference.map(|it| format!("{} {index}: {it} {}\n", family.name, draft.kind));
        if let Some(line) = &line {
            // A long search tells what it finds; nothing is left to do when even this fails.
            let _ = write!(io::stderr(), "{line}");
            if options.only.is_some() {
                let _ = write!(io::stderr(), "{}", draft.text());
            }
        }
        Ok(line)
    };
    let all: Result<Vec<_>, String> = super::indices(scenes, options)
        .into_par_iter()
        .map(differs)
        .collect();
    Ok(all?.into_iter().flatten().collect())
}

/// The first picture that differs, and the place of the difference.
fn difference(draft: &Draft, tolerances: &[f64]) -> Result<Option<String>, String> {
    let subject = Subject::of(draft)?;
    for (length, light) in UNITS {
        let mut other = draft.clone();
        other.length *= libm::scalbn(1.0, length);
        other.light *= libm::scalbn(1.0, light);
        let other = Subject::of(&other)?;
        let tolerances = tolerances.iter().map(|&it| Method::Tolerance(it));
        let samples = Method::Samples(2.try_into().map_err(|_| "no samples")?);
        for method in tolerances.chain([samples]) {
            let pictures = (subject.shown(method), other.shown(method));
            let (Some(one), Some(other)) = pictures else {
                continue;
            };
            let is_other = |&(col, row): &(u32, u32)| {
                let claims = [&one, &other].map(|it| it.claimed(col, row));
                one.value(col, row) != other.value(col, row)
                    || claims[0] != claims[1] && claims.into_iter().any(|it| it > ALL_DIGITS)
            };
            let place = one.places().find(is_other);
            let units = format!("{method:?}, lengths * 2^{length}, light * 2^{light}");
            if let Some((col, row)) = place {
                let [one, other] =
                    [&one, &other].map(|it| (it.value(col, row), it.claimed(col, row)));
                return Ok(Some(format!(
                    "{units}: column {col}, row {row}: {one:?}, {other:?}"
                )));
            }
            if one.work() != other.work() {
                return Ok(Some(format!("{units}: other work")));
            }
        }
    }
    Ok(None)
}
