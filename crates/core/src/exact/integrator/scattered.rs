//! Pixels that are over their tolerance, by as many random samples as it takes.

use super::Exact;
use super::range::OF_SPHERE;
use crate::exact::crowd::CrowdWork;
use crate::model::color::Color;
use crate::model::light::Light;
use crate::model::roughness::PixelKey;
use crate::numeric::bernstein::{error_of_mean, least_error};
use crate::picture::pixel::{Evidence, Pixel, Status};
use crate::sampling::Pairs;

/// Strata on a side of a pixel at the first look, and at most.
const FIRST: u32 = 32;
const MOST: u32 = 512;

/// The tests that the most strata of a pixel may take, tens of milliseconds: enough for them over three spheres under a
/// lamp, or under some suns. The looks before them take a third of it; the first look is always taken.
const MOST_TESTS: u64 = 1 << 25;

/// The tests that a light takes, whose ray may meet anything.
const OF_SUN: u64 = 4;
const OF_LAMP: u64 = 32;

/// The number of samples in so many strata on a side.
fn samples(side: u32) -> u64 {
    2 * u64::from(side) * u64::from(side)
}

/// The conditions under which samples are scattered over the pixels of a tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scattering {
    /// The largest possible difference of light, in any channel.
    range: f64,
    /// The units of a sample.
    of_sample: u64,
    /// The most strata on a side.
    most: u32,
}

/// The most strata on a side that samples of so many tests allow.
fn most_strata(tests: u64) -> u32 {
    let mut most = MOST;
    while most > FIRST && samples(most) * tests > MOST_TESTS {
        most /= 2;
    }
    most
}

/// The error that may be expected of the most strata, from that of so many on a side.
///
/// An estimate, which only decides how much is tried: the variance in strata of the side s is between that of edges,
/// which falls with s, and that of smooth light, which falls with s².
fn expected(error: f64, side: u32, of: Scattering) -> f64 {
    const POWER: f64 = -0.9;
    let [now, most] = [side, of.most].map(|side| samples(side) as f64);
    let of_range = |count| least_error(of.range, count);
    of_range(most) + (error - of_range(now)) * libm::pow(most / now, POWER)
}

impl Exact<'_> {
    /// Tells how samples are scattered over pixels of a tile that may see some spheres, if they may meet the tolerance.
    pub(super) fn scattering(
        &self,
        candidates: &[usize],
        [least, most]: [Color; 2],
        most_occluders: usize,
    ) -> Option<Scattering> {
        let range = (most - least).max_element();
        let range = if self.alpha {
            range.max(self.unit)
        } else {
            range
        };
        // At one moment of many a look must do.
        let is_of_moment = self
            .groups
            .iter()
            .any(|group| group.allowance.is_of_moment());
        let of_light = |light: &Light| {
            let ray = match light {
                Light::Directional(_) => OF_SUN,
                Light::Point(_) => OF_LAMP,
            };
            ray + most_occluders as u64
        };
        let lights = self.index.visibility.lights();
        let of_spheres = OF_SPHERE * candidates.len() as u64;
        let most = most_strata(of_spheres + lights.iter().map(of_light).sum::<u64>());
        let may_meet = least_error(range, samples(most) as f64) < self.tolerance;
        let is_affordable = !is_of_moment && !self.are_costly(candidates);
        (may_meet && is_affordable).then_some(Scattering {
            range,
            of_sample: of_spheres + most_occluders as u64,
            most,
        })
    }

    /// A pixel by random samples in more and more strata, until they meet the tolerance; none if they do not. Counts the
    /// samples.
    ///
    /// # Accuracy
    /// An estimate that holds with a probability: see [`error_of_mean`]. There are five looks at most, each of which may
    /// claim too little. Samples see exactly, and nothing that they may overlook is brighter or darker than what the tile
    /// may show.
    pub(super) fn scattered(
        &self,
        key: PixelKey,
        of: Scattering,
        crowds: &mut CrowdWork,
        count: &mut u64,
    ) -> Option<Pixel> {
        let mut side = FIRST;
        while crowds.affords(samples(side) * of.of_sample) {
            let pairs = self.samples.scattered(key, side);
            *count += samples(side);
            let error = self.error_of_pairs(&pairs, of.range);
            if error <= self.tolerance {
                return Some(Pixel {
                    value: pairs.value,
                    alpha: pairs.alpha,
                    error,
                    evidence: Evidence::Estimate,
                    status: Status::Met,
                });
            }
            if side >= of.most || expected(error, side, of) > self.tolerance {
                return None;
            }
            side *= 2;
        }
        None
    }

    /// The error of the means of pairs of samples.
    fn error_of_pairs(&self, pairs: &Pairs, range: f64) -> f64 {
        let count = pairs.count as f64;
        let of_light = error_of_mean(pairs.squares.max_element(), range, count);
        if self.alpha {
            of_light.max(self.unit * error_of_mean(pairs.squares_of_alpha, 1.0, count))
        } else {
            of_light
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strata_cost_no_more_than_a_pixel_may() {
        for tests in 1..2000 {
            let most = most_strata(tests);
            assert!(samples(most) * tests <= MOST_TESTS || most == FIRST);
            let is_enough = most == MOST || samples(2 * most) * tests > MOST_TESTS;
            assert!(is_enough && most.is_multiple_of(2), "{tests}: {most}");
        }
        // Three spheres under a lamp, and under four suns, each with three occluders.
        assert_eq!(most_strata(3 * OF_SPHERE + OF_LAMP + 3), MOST);
        assert_eq!(most_strata(3 * OF_SPHERE + 4 * (OF_SUN + 3)), MOST);
        // Three spheres under twenty lamps.
        assert!(most_strata(3 * OF_SPHERE + 20 * OF_LAMP) < MOST);
    }
}
