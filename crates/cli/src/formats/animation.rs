//! The writing of files with all pictures of a sequence.

use crate::files::save::Fault;

/// A file that is being written.
pub(super) trait Animation {
    /// Adds rows of the picture, from the top.
    fn add_samples(&mut self, samples: &[u8]) -> Result<(), Fault>;

    /// Ends the picture when all of its rows have been added.
    fn end_frame(&mut self) -> Result<(), Fault>;

    /// Ends the file.
    fn finish(self: Box<Self>) -> Result<(), Fault>;
}

/// The time for which the picture with this index is shown, at least `shortest`. `units` is the number of units of time per
/// second. Each picture begins at the right time, to half a unit.
pub(super) fn duration(index: u32, rate: f64, units: f64, shortest: u32) -> u32 {
    let start = |index: f64| (index * units / rate).round();
    let exact = start(f64::from(index) + 1.0) - start(f64::from(index));
    // The cast saturates.
    (exact as u32).max(shortest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_add_up_to_the_time_of_the_sequence() {
        const HUNDREDTHS: f64 = 100.0;
        let all = |rate, frames| -> Vec<u32> {
            let of = |index| duration(index, rate, HUNDREDTHS, 2);
            (0..frames).map(of).collect()
        };
        assert_eq!(all(30.0, 6), [3, 4, 3, 3, 4, 3]);
        assert_eq!(all(25.0, 3), [4, 4, 4]);
        assert_eq!(all(24.0, 48).iter().sum::<u32>(), 200);
        // What no player shows.
        assert_eq!(all(60.0, 3), [2, 2, 2]);
        assert_eq!(duration(0, 1e-300, HUNDREDTHS, 2), u32::MAX);
        assert_eq!(duration(0, 29.97, 1000.0, 11), 33);
    }
}
