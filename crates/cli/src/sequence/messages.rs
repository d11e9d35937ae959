//! Messages about written files.

use std::path::Path;
use std::time::Duration;

use marbles_core::Summary;

use super::frames;
use super::outcome::Outcome;
use super::results::WorstPixel;
use crate::base::numbers::{bound, counted};
use crate::base::shown::Shown;
use crate::formats::encoding::Encoding;

/// The line of results. `time` is the rendering time, and `clipped` the number of pixels that are too bright for a PNG.
pub(super) fn result(path: &str, summary: &Summary, clipped: u64, time: Duration) -> String {
    let clipped = match clipped {
        0 => String::new(),
        _ => format!(", {clipped} clipped"),
    };
    format!(
        "{path}: {}, {} over{clipped}, {:.3} s",
        claim(summary),
        summary.over_tolerance,
        time.as_secs_f64()
    )
}

/// The line of results for all files together, in the form of the line for one file; `None` if no file was written.
/// `noun` is the word for one of them.
pub(crate) fn total(outcome: &Outcome, noun: &str) -> Option<String> {
    let files = counted(outcome.written, noun);
    let summary = outcome.total.as_ref()?;
    Some(result(&files, summary, outcome.clipped, outcome.time))
}

/// The line of results for a file that existed already.
pub(super) fn skipped(path: &Path) -> String {
    format!(
        "{}: skipped, complete and made from this scene",
        path.shown()
    )
}

/// The number of written files, with the word `noun`, and the failed frames, in the notation of `--frames`.
pub(crate) fn counts(outcome: &Outcome, noun: &str) -> String {
    let Outcome {
        pictures,
        written,
        skipped,
        failed,
        ..
    } = outcome;
    let mut counts = format!("{written} of {pictures} {noun}s written");
    if *skipped > 0 {
        counts.push_str(&format!(", {skipped} skipped"));
    }
    if !failed.is_empty() {
        counts.push_str(&format!(", failed: {}", frames::listed(failed)));
    }
    counts
}

/// The size of the errors, and the evidence for it: `error <= 8.3e-04 (97 % bounds)`, or `error unknown` for single
/// samples.
pub(crate) fn claim(summary: &Summary) -> String {
    if summary.largest_error == f64::INFINITY {
        return "error unknown".to_owned();
    }
    format!(
        "error <= {} ({})",
        bound(summary.largest_error),
        evidence(summary)
    )
}

/// The evidence for errors: `bound`, `estimate`, or the share of bounds, rounded down.
fn evidence(summary: &Summary) -> String {
    match bound_percent(summary) {
        100 => "bound".to_owned(),
        0 if summary.bounds == 0 => "estimate".to_owned(),
        0 => "under 1 % bounds".to_owned(),
        percent => format!("{percent} % bounds"),
    }
}

/// The share of pixels whose errors are bounds, in whole percents, rounded down.
pub(crate) fn bound_percent(summary: &Summary) -> u128 {
    u128::from(summary.bounds) * 100 / u128::from(summary.pixels.max(1))
}

/// The warning about numbers that were too large for the file's number type.
pub(super) fn clipped(path: &str, count: u64, encoding: Encoding) -> String {
    let numbers = counted(count, "number");
    match encoding {
        Encoding::Exr(options) if !options.float => format!(
            "{path}: {numbers} above 65504, the largest half-precision number, stored as this number; use --float \
             for larger ones"
        ),
        _ => format!("{path}: {numbers} too large for the file, stored as the largest"),
    }
}

/// The warning about pixels over the tolerance, with the worst of them.
pub(super) fn over_tolerance(path: &str, count: u64, worst: Option<WorstPixel>) -> String {
    let worst = worst.map_or(String::new(), |WorstPixel { col, row, error }| {
        let error = bound(error);
        format!(", the worst in column {col}, row {row} with an error <= {error}")
    });
    let pixels = counted(count, "pixel");
    format!("{path}: {pixels} over the tolerance{worst}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_say_what_stands_behind_the_error() {
        let summary = |bounds| Summary {
            pixels: 600,
            largest_error: 8.21e-4,
            bounds,
            over_tolerance: 2,
        };
        let time = Duration::from_millis(12);
        assert_eq!(
            result("a.png", &summary(600), 0, time),
            "a.png: error <= 8.3e-04 (bound), 2 over, 0.012 s"
        );
        assert_eq!(
            result("a.png", &summary(600), 1, time),
            "a.png: error <= 8.3e-04 (bound), 2 over, 1 clipped, 0.012 s"
        );
        let minutes = Duration::from_millis(123_456);
        let line = result("frames/turntable.0001.png", &summary(380), 0, minutes);
        assert!(line.len() <= 80, "{line}");
        let outcome = Outcome {
            written: 7,
            total: Some(summary(0)),
            clipped: 37,
            time,
            ..Outcome::default()
        };
        assert_eq!(
            total(&outcome, "frame").unwrap(),
            "7 frames: error <= 8.3e-04 (estimate), 2 over, 37 clipped, 0.012 s"
        );
        assert_eq!(total(&Outcome::default(), "frame"), None);
        for (bounds, share) in [(599, "99 %"), (360, "60 %"), (6, "1 %"), (5, "under 1 %")] {
            let expected = format!("error <= 8.3e-04 ({share} bounds)");
            assert_eq!(claim(&summary(bounds)), expected);
        }
        let unknown = Summary {
            largest_error: f64::INFINITY,
            ..summary(0)
        };
        assert_eq!(claim(&unknown), "error unknown");
    }
}
