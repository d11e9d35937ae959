//! The page with the results of a hunt.

use std::path::Path;

use super::Options;

/// The line after a part of the page.
const END: &str = "<!-- end -->\n";

/// Replaces tables of a page: each list of tolerances has its own part of the page.
pub(super) fn write(path: &Path, options: &Options, tables: &str) -> Result<(), String> {
    let at = |error| format!("{}: {error}", path.display());
    let text = std::fs::read_to_string(path).map_err(at)?;
    let mut part = "hunt".to_owned();
    let mut command = format!(
        "cargo truth hunt --scenes {} --seed {}",
        options.scenes, options.seed
    );
    if let Some(tolerances) = options.unusual_tolerances() {
        part += &format!(" {tolerances}");
        command += &format!(" --tolerances {tolerances}");
    }
    if !options.family.is_empty() {
        command += &format!(" --family '{}'", options.family);
    }
    let head = format!("<!-- measured: {part} -->\n");
    let parts = text.split_once(&head);
    let parts = parts.and_then(|(before, rest)| Some((before, rest.split_once(END)?.1)));
    let (before, after) =
        parts.ok_or_else(|| format!("{} has no part \"{part}\"", path.display()))?;
    let text = format!("{before}{head}`{command}`\n\n{tables}{END}{after}");
    std::fs::write(path, text).map_err(at)
}
