//! Files of text with some numbers a line.

use std::path::Path;

use crate::base::failure::Failure;
use crate::files::save::write_bytes;

/// Numbers with spaces between them, and as many digits as it takes to read the same doubles; `+ 0` makes no negative
/// zeros.
pub(super) fn line(numbers: &[f64]) -> String {
    let words = numbers.iter().map(|&number| format!("{}", number + 0.0));
    words.collect::<Vec<_>>().join(" ")
}

/// Writes lines, the last of which ends as the others do.
pub(super) fn write_lines(
    path: &Path,
    lines: impl IntoIterator<Item = String>,
) -> Result<(), Failure> {
    let text: String = lines.into_iter().map(|line| line + "\n").collect();
    write_bytes(text.as_bytes(), path)
}
