//! The division of a cell into boxes, smaller where they claim too much.

use fearless_simd::Simd;

use super::average::{Averages, Setting};
use super::contours::Contours;
use super::eight_boxes::Eight;
use crate::exact::part::Part;
use crate::model::roughness::noise::NoiseCells;

/// Memory to divide cells in.
#[derive(Clone, Debug, Default)]
pub(super) struct Division {
    contours: Contours,
    /// Those of the eight boxes that were done last.
    averages: Averages,
    /// The middles of boxes that are left to do, and their size.
    left: Vec<[f64; 2]>,
    /// Those that are being divided.
    wide: Vec<[f64; 2]>,
    size: [f64; 2],
    /// The boxes of this size that were just done.
    known: Vec<([f64; 2], Part)>,
    /// The points at which light was computed.
    pub(super) samples: u64,
}

/// The middles of the first boxes, four beside each other and two above each other, in an order in which neighbors follow
/// each other, and their sides.
pub(super) const FIRST: [Eight; 2] = [
    [-0.375, -0.375, -0.125, -0.125, 0.125, 0.125, 0.375, 0.375],
    [-0.25, 0.25, 0.25, -0.25, -0.25, 0.25, 0.25, -0.25],
];
pub(super) const FIRST_SIZE: [f64; 2] = [0.25, 0.5];

/// The middles of halves and quarters of a box, in its sides.
pub(super) const HALVES: [[f64; 2]; 2] = [[-0.25, 0.0], [0.25, 0.0]];
const QUARTERS: [[f64; 2]; 4] = [[-0.25, -0.25], [-0.25, 0.25], [0.25, 0.25], [0.25, -0.25]];

/// The share of what is left of the tolerance that the boxes of a size may claim together, if they are more than
/// the tolerance allows.
pub(super) const SHARE: f64 = 0.5;

/// The claims, in multiples of the tolerance that is left, of boxes that are quartered, not halved. Not tuned finely.
const FAR: f64 = 2.5;

impl Division {
    /// The average over a cell, unless more than so many times eight boxes would be needed to claim no more than the
    /// tolerance.
    pub(super) fn integrate<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        tolerance: f64,
        most_eights: usize,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> Option<Part> {
        self.size = FIRST_SIZE;
        let first = &mut self.averages;
        setting.averages(simd, FIRST, self.size, (&mut self.contours, noise), first);
        self.samples += first.samples;
        let whole = first.total(self.size[0] * self.size[1]);
        if whole.error <= tolerance {
            return Some(whole);
        }
        self.known.clear();
        for lane in 0..8 {
            let middle = FIRST.map(|places| places[lane]);
            self.known.push((middle, first.lane(lane)));
        }
        let mut part = Part::NOTHING;
        let mut eights = 1;
        loop {
            let (claims, allowed) = (self.claims(), tolerance - part.error);
            let is_far = claims > FAR * allowed;
            self.divide(&mut part, allowed, claims);
            if self.left.is_empty() {
                return Some(part);
            }
            self.shrink(is_far);
            let of_size = self.left.len().div_ceil(8);
            // Halving them all about halves their claims.
            let (mut claims, mut expected) =
                (claims * if is_far { 0.25 } else { 0.5 }, eights + of_size);
            while claims > allowed && expected <= most_eights {
                claims *= 0.5;
                expected += of_size;
            }
            if expected > most_eights {
                return None;
            }
            eights += of_size;
            self.average(simd, setting, noise);
        }
    }

    /// The sum of the claims of the boxes just done.
    fn claims(&self) -> f64 {
        let sum: f64 = self.known.iter().map(|(_, average)| average.error).sum();
        sum * self.size[0] * self.size[1]
    }

    /// Adds the boxes to `part` that claim little enough, or all if all do, and leaves the halves of the others to do.
    fn divide(&mut self, part: &mut Part, allowed: f64, claims: f64) {
        let area = self.size[0] * self.size[1];
        let limit = if claims <= allowed {
            f64::INFINITY
        } else {
            SHARE * allowed / (self.known.len() as f64 * area)
        };
        self.left.clear();
        for &(middle, average) in &self.known {
            if average.error <= limit {
                part.add(&average, area);
            } else {
                self.left.push(middle);
            }
        }
    }

    /// Puts halves across their longer sides in place of the boxes that are left, or quarters. Parts of a box stay
    /// beside each other: boxes that are averaged together cost least when few spheres meet them.
    fn shrink(&mut self, is_far: bool) {
        let longer = usize::from(self.size[1] > self.size[0]);
        let parts: &[[f64; 2]] = if is_far { &QUARTERS } else { &HALVES };
        let [along, aside] = [self.size[longer], self.size[1 - longer]];
        self.wide.clear();
        std::mem::swap(&mut self.wide, &mut self.left);
        for &middle in &self.wide {
            for &[by_along, by_aside] in parts {
                let mut part = middle;
                part[longer] += by_along * along;
                part[1 - longer] += by_aside * aside;
                self.left.push(part);
            }
        }
        self.size[longer] *= 0.5;
        if is_far {
            self.size[1 - longer] *= 0.5;
        }
    }

    /// Averages the boxes that are left.
    fn average<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        noise: &mut Option<Box<NoiseCells>>,
    ) {
        self.known.clear();
        for group in self.left.chunks(8) {
            let mut middles = [[0.0; 8]; 2];
            for lane in 0..8 {
                let [x, y] = group[lane.min(group.len() - 1)];
                middles[0][lane] = x;
                middles[1][lane] = y;
            }
            let found = &mut self.averages;
            setting.averages(simd, middles, self.size, (&mut self.contours, noise), found);
            self.samples += found.samples;
            for (lane, &middle) in group.iter().enumerate() {
                self.known.push((middle, found.lane(lane)));
            }
        }
    }
}
