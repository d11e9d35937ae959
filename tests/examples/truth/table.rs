//! Measures the promise in all its scenes.

use std::fmt::Write;
use std::time::Instant;

use marbles_tests::promise::{measure, pixels};

/// Prints what the test asserts, for the scenes whose names contain `part`.
pub(crate) fn table(part: &str, whole: bool) -> String {
    let mut text = String::from(
        "scene              tolerance  broken   3x  unmet  beyond claim  worst met  true/claimed  seconds\n",
    );
    for scene in pixels::scenes() {
        let name = pixels::name(&scene);
        for tolerance in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
            if !name.contains(part) {
                continue;
            }
            let start = Instant::now();
            // Grain drawn for pixels makes sense in whole pictures only.
            let score = measure::score(&scene, tolerance, whole || name == "candy");
            // Writing to a string does not fail.
            let _ = writeln!(
                text,
                "{name:<18} {tolerance:>9.0e} {:>7} {:>4} {:>6} {:>13} {:>10.1e} {:>13.1e} {:>8.2}",
                score.broken,
                score.badly_broken,
                score.unmet,
                score.beyond_claim,
                score.worst,
                score.honesty,
                start.elapsed().as_secs_f64()
            );
        }
    }
    text
}
