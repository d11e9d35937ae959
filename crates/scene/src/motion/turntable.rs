//! The turntable: an orbit around its target in a loop, or lights that turn so.

use crate::file::Animation;

/// A turn in degrees.
const TURN: f64 = 360.0;

/// A turn of the camera around its target, or of the lights, in frames 1 to `frames`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turntable {
    /// Frames of a loop, at least 1.
    pub(super) frames: i32,
    /// Turns in a loop.
    pub(super) turns: f64,
}

impl Turntable {
    /// The turntable of an animation; `None` where it is none, or a fault was reported.
    pub(super) fn new(animation: &Animation) -> Option<Self> {
        let Animation::Turntable { frames, turns, .. } = animation else {
            return None;
        };
        Some(Self {
            frames: frames.get()?.0,
            turns: turns.get()?.0,
        })
    }

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
mod tests;
