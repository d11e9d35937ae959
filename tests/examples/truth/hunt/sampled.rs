//! The same picture by samples, which share no code with integrals except for the scene. It finds errors that the finer
//! picture shares.

use std::num::NonZeroU32;

use glam::DVec4;

use super::picture::Picture;
use super::subject::Subject;

/// Samples along each side of a pixel.
const SAMPLES: NonZeroU32 = NonZeroU32::new(4).unwrap();

/// The allowed distance, in addition to the tolerance, of a pixel from all samples in and near it, in units of light
/// and relative to the samples. Samples miss thin spheres and small highlights. It is larger if the integrator takes
/// long.
const MISSED: f64 = 0.01;
const MISSED_OF_SLOW: f64 = 0.1;
const OF_RANGE: f64 = 0.1;

/// A picture of means over samples.
pub(super) struct Sampled {
    picture: Picture,
    missed: f64,
}

impl Sampled {
    pub(super) fn of(subject: &Subject) -> Option<Self> {
        let missed = if subject.is_slow() {
            MISSED_OF_SLOW
        } else {
            MISSED
        };
        let picture = subject.sampled_picture(SAMPLES)?;
        Some(Self { picture, missed })
    }

    /// Returns whether the distance of a pixel from all samples near it is larger than its tolerance.
    pub(super) fn contradicts(&self, (col, row): (u32, u32), value: DVec4, allowed: f64) -> bool {
        let (mut least, mut most) = (DVec4::INFINITY, DVec4::NEG_INFINITY);
        for row in row.saturating_sub(1)..=(row + 1).min(self.picture.rows() - 1) {
            for col in col.saturating_sub(1)..=(col + 1).min(self.picture.columns() - 1) {
                let near = self.picture.value(col, row);
                least = least.min(near);
                most = most.max(near);
            }
        }
        let beyond = (value - most).max(least - value).max_element();
        beyond > allowed + self.missed + OF_RANGE * (most - least).max_element()
    }
}
