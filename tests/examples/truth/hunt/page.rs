//! The page that shows what a hunt found.

use std::path::Path;

use super::Options;

/// The part of the page that hunts write.
const HEAD: &str = "<!-- measured: hunt -->\n";
const END: &str = "<!-- end -->\n";

/// Writes a table into a page, in place of the last one.
pub(super) fn write(path: &Path, options: &Options, table: &str) -> Result<(), String> {
    let at = |error| format!("{}: {error}", path.display());
    let text = std::fs::read_to_string(path).map_err(at)?;
    let parts = text.split_once(HEAD);
    let parts = parts.and_then(|(before, rest)| Some((before, rest.split_once(END)?.1)));
    let (before, after) = parts.ok_or_else(|| format!("{} has no part for it", path.display()))?;
    let command = format!(
        "`cargo truth hunt --scenes {} --seed {}`",
        options.scenes, options.seed
    );
    let text = format!("{before}{HEAD}{command}\n\n{table}{END}{after}");
    std::fs::write(path, text).map_err(at)
}
