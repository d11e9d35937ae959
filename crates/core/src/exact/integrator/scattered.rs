//! Pixels that are over their tolerance, by as many random samples as it takes.

use super::Exact;
use super::range::OF_SPHERE;
use crate::exact::crowd::{CrowdWork, FEWEST};
use crate::model::color::Color;
use crate::model::light::Light;
use crate::model::roughness::PixelKey;
use crate::numeric::bernstein::{error_of_mean, least_error};
use crate::numeric::pair::both;
use crate::picture::pixel::{Evidence, Pixel, Status};
use crate::sampling::Pairs;

/// Strata on a side of a pixel at the first look.
const FIRST: u32 = 32;

/// What a pixel may cost.
#[derive(Clone, Copy, Debug)]
struct Limits {
    /// The most strata on a side.
    strata: u32,
    /// The tests that these may take. The looks before them take a third of it; the first look is always taken.
    tests: u64,
}

/// Tens of milliseconds: enough tests for the most strata over three spheres under a lamp, or under some suns.
const ORDINARY: Limits = Limits {
    strata: 512,
    tests: 1 << 25,
};

/// Where bumps may be seen. With bumps finer than pixels, edges are so many that nothing but samples meets 1e-4: with 512
/// strata on a side a pixel in ten fails, with these none, with 2048 none in the same time (`cargo truth hunt --family
/// "bumps finer than pixels" --scenes 8 --seed 5`; 2048 in its first scene alone).
const BUMPY: Limits = Limits {
    strata: 1024,
    tests: 1 << 27,
};

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
    /// Whether they count as work on a crowd.
    is_crowd: bool,
}

impl Limits {
    /// The most strata on a side that samples of so many tests allow.
    fn most_strata(self, tests: u64) -> u32 {
        let mut most = self.strata;
        while most > FIRST && samples(most) * tests > self.tests {
            most /= 2;
        }
        most
    }
}

/// The error that may be expected of the most strata, from that of so many on a side.
///
/// An estimate, which only decides how much is tried: the variance in strata of the side s is between that of edges,
/// which falls with s, and that of smooth light, which falls with s².
fn expected(error: f64, side: u32, of: Scattering) -> f64 {
    const POWER: f64 = -0.9;
    let [now, most] = both([side, of.most], |side| samples(side) as f64);
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
        let world = self.groups[0].scene.world;
        let mut materials = candidates.iter().map(|&sphere| world.material(sphere));
        let is_bumpy = materials.any(|material| material.roughness.is_some());
        let is_crowd = candidates.len() > FEWEST || most_occluders > FEWEST;
        let limits = if is_bumpy && !is_crowd {
            BUMPY
        } else {
            ORDINARY
        };
        let most = limits.most_strata(of_spheres + lights.iter().map(of_light).sum::<u64>());
        let may_meet = least_error(range, samples(most) as f64) < self.tolerance;
        let is_affordable = !is_of_moment && !self.are_costly(candidates);
        (may_meet && is_affordable).then_some(Scattering {
            range,
            of_sample: of_spheres + most_occluders as u64,
            most,
            is_crowd: is_crowd || !is_bumpy,
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
        while !of.is_crowd || crowds.affords(samples(side) * of.of_sample) {
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
        for limits in [ORDINARY, BUMPY] {
            for tests in 1..2000 {
                let most = limits.most_strata(tests);
                assert!(samples(most) * tests <= limits.tests || most == FIRST);
                let is_enough = most == limits.strata || samples(2 * most) * tests > limits.tests;
                assert!(is_enough && most.is_multiple_of(2), "{tests}: {most}");
            }
        }
        // Three spheres under a lamp, and under four suns, each with three occluders.
        let most = ORDINARY.strata;
        assert_eq!(ORDINARY.most_strata(3 * OF_SPHERE + OF_LAMP + 3), most);
        assert_eq!(ORDINARY.most_strata(3 * OF_SPHERE + 4 * (OF_SUN + 3)), most);
        // Three spheres under twenty lamps.
        assert!(ORDINARY.most_strata(3 * OF_SPHERE + 20 * OF_LAMP) < most);
    }
}
