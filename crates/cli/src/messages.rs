//! What is said about a file that was written.

use std::time::Duration;

use marbles_core::{Image, Summary};

use crate::numbers::bound;
use crate::output::Encoding;

/// The line of results; `time` is the rendering's alone.
pub(crate) fn result(path: &str, summary: &Summary, time: Duration) -> String {
    format!(
        "{path}: {} pixels, error <= {} (estimate), {} over the tolerance, {:.3} s",
        summary.pixels,
        bound(summary.largest_error),
        summary.over_tolerance,
        time.as_secs_f64()
    )
}

/// That numbers were too large for the file's floats.
pub(crate) fn clipped(path: &str, count: u64, encoding: Encoding) -> String {
    let numbers = if count == 1 { "number" } else { "numbers" };
    match encoding {
        Encoding::Exr(options) if !options.float => format!(
            "{path}: {count} {numbers} above 65504, the largest half, stored as that; \
             --float has room for more"
        ),
        _ => format!("{path}: {count} {numbers} too large for the file, stored as the largest"),
    }
}

/// That pixels did not meet the tolerance, and which one least of all.
pub(crate) fn over_tolerance(path: &str, image: &Image, count: u64) -> String {
    let error = |(col, row)| image.error(col, row);
    let worst = (0..image.height())
        .flat_map(|row| (0..image.width()).map(move |col| (col, row)))
        .filter(|&(col, row)| image.status(col, row).is_over_tolerance())
        .max_by(|&one, &other| error(one).total_cmp(&error(other)));
    let worst = worst.map_or(String::new(), |(col, row)| {
        let error = bound(image.error(col, row));
        format!(", the worst in column {col}, row {row} with an error <= {error}")
    });
    let pixels = if count == 1 { "pixel" } else { "pixels" };
    format!("{path}: {count} {pixels} over the tolerance{worst}")
}
