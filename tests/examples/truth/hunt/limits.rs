//! Limits for the number of pixels over the tolerance, which must not grow.

use std::fmt::Write;
use std::path::Path;

/// Lines about the families with more pixels over the tolerance than a file allows. The file contains lines such as
/// `ordinary,0,0,1,12,40`, with a number for each tolerance of the hunt. With `MARBLES_BLESS=1` it is written again.
///
/// Pictures are the same on all machines, so the same hunt finds the same numbers. A family that is missing in the file
/// has the limit 0.
pub(super) fn exceeded(path: &Path, counts: &[(String, Vec<u64>)]) -> Result<String, String> {
    let at = |error| format!("{}: {error}", path.display());
    if std::env::var_os("MARBLES_BLESS").is_some() {
        let line = |(family, counts): &(String, Vec<u64>)| {
            let counts = counts.iter().map(|count| format!(",{count}"));
            format!("{family}{}\n", counts.collect::<String>())
        };
        let text: String = counts.iter().map(line).collect();
        std::fs::write(path, text).map_err(at)?;
        return Ok(String::new());
    }
    let text = std::fs::read_to_string(path).map_err(at)?;
    let limits_of = |family: &str| {
        let line = text
            .lines()
            .find_map(|line| line.strip_prefix(family)?.strip_prefix(','));
        let limits = line.into_iter().flat_map(|line| line.split(','));
        limits
            .map(|limit| limit.parse().unwrap_or(0))
            .collect::<Vec<u64>>()
    };
    let mut report = String::new();
    for (family, counts) in counts {
        let limits = limits_of(family);
        let limit = |index: usize| limits.get(index).copied().unwrap_or(0);
        if counts
            .iter()
            .enumerate()
            .any(|(index, &count)| count > limit(index))
        {
            // Writing to a string does not fail.
            let _ = writeln!(
                report,
                "{family} gives up {counts:?} pixels, of {limits:?} that {} allows",
                path.display()
            );
        }
    }
    Ok(report)
}
