//! Text files with some numbers per line.

use std::path::Path;

use crate::base::failure::Failure;
use crate::files::save::write_bytes;

/// Numbers separated by spaces, with enough digits to read the same doubles. `+ 0` removes the sign of negative zeros.
pub(super) fn line(numbers: &[f64]) -> String {
    let words = numbers.iter().map(|&number| format!("{}", number + 0.0));
    words.collect::<Vec<_>>().join(" ")
}

/// Writes lines, all of which end with a line feed.
pub(super) fn write_lines(
    path: &Path,
    lines: impl IntoIterator<Item = String>,
) -> Result<(), Failure> {
    let text: String = lines.into_iter().map(|line| line + "\n").collect();
    write_bytes(text.as_bytes(), path)
}
