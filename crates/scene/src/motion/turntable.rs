//! The turntable: an orbit around its target in a loop.

/// A turn in degrees.
const TURN: f64 = 360.0;

/// A turn of the camera around its target, in frames 1 to `frames`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turntable {
    /// Frames of a loop, at least 1.
    pub(super) frames: i32,
    /// Turns in a loop.
    pub(super) turns: f64,
}

impl Turntable {
    /// The angle that is added to the azimuth in frame `frame`.
    ///
    /// For whole turns frame `frame + frames` is the same as `frame` to the bit: the fraction of
    /// the turn is a quotient of whole numbers, and whole turns are dropped before the division.
    pub(super) fn azimuth_degrees(&self, frame: i32) -> f64 {
        let frames = f64::from(self.frames);
        let part_of_turn = if self.loops() {
            // Less than 2^31 each, so that the product is a whole number of 64 bits.
            let turns = libm::fmod(self.turns, frames) as i64;
            let since_first = i64::from(self.looped(frame)) - 1;
            (turns * since_first).rem_euclid(i64::from(self.frames)) as f64
        } else {
            libm::fmod(self.turns * (f64::from(frame) - 1.0), frames)
        };
        TURN * part_of_turn / frames
    }

    /// The angle that is added to the azimuth so many frames after frame `frame`, fewer than 1.
    ///
    /// For whole turns it is the same in frame `frame + frames`, to the bit.
    pub(super) fn azimuth_degrees_at(&self, frame: i32, later: f64) -> f64 {
        let turns = libm::fmod(self.turns * later / f64::from(self.frames), 1.0);
        self.azimuth_degrees(frame) + TURN * turns
    }

    /// The number of the frame by which noise is drawn: from 1 to `frames` where the last frame
    /// leads back to the first.
    pub(super) fn looped(&self, frame: i32) -> i32 {
        if self.loops() {
            let since_first = (i64::from(frame) - 1).rem_euclid(i64::from(self.frames));
            since_first as i32 + 1
        } else {
            frame
        }
    }

    /// Returns whether the frame after the last is the first.
    fn loops(&self) -> bool {
        libm::fmod(self.turns, 1.0) == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_turns_loop_to_the_bit() {
        for turns in [1.0, -1.0, 3.0, 0.0, 7.0, 1e300, -123_456_789.0] {
            for frames in [1, 2, 7, 120, i32::MAX] {
                let turntable = Turntable { frames, turns };
                for frame in [1, 2, 5, 100, -3, 0] {
                    let other = i64::from(frame) + i64::from(frames);
                    let Ok(other) = i32::try_from(other) else {
                        continue;
                    };
                    assert_eq!(
                        turntable.azimuth_degrees(frame).to_bits(),
                        turntable.azimuth_degrees(other).to_bits()
                    );
                    for later in [-0.5, -0.123, 0.0, 0.3, 0.5] {
                        assert_eq!(
                            turntable.azimuth_degrees_at(frame, later).to_bits(),
                            turntable.azimuth_degrees_at(other, later).to_bits()
                        );
                    }
                    assert_eq!(turntable.looped(frame), turntable.looped(other));
                }
            }
        }
    }

    #[test]
    fn a_turn_is_divided_evenly() {
        let turntable = Turntable {
            frames: 8,
            turns: 1.0,
        };
        let azimuths: Vec<f64> = (1..=8).map(|f| turntable.azimuth_degrees(f)).collect();
        assert_eq!(
            azimuths,
            [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0]
        );
        let back = Turntable {
            frames: 8,
            turns: -1.0,
        };
        assert_eq!(back.azimuth_degrees(2), 315.0);
        assert_eq!(turntable.azimuth_degrees_at(2, 0.5), 67.5);
        assert_eq!(turntable.azimuth_degrees_at(1, -0.25), -11.25);
        assert_eq!(back.azimuth_degrees_at(2, 0.5), 292.5);
        assert_eq!(back.looped(9), 1);
    }

    #[test]
    fn part_of_a_turn_does_not_loop() {
        let turntable = Turntable {
            frames: 4,
            turns: 0.5,
        };
        assert_eq!(turntable.azimuth_degrees(3), 90.0);
        assert_eq!(turntable.azimuth_degrees(5), 180.0);
        assert_eq!(turntable.looped(5), 5);
        for frame in [i32::MIN, i32::MAX] {
            assert!(turntable.azimuth_degrees(frame).is_finite());
        }
    }
}
