//! The average over a cell by boxes in which edges are lines: the rung for loose tolerances.
//!
//! In each box every silhouette, seam and shadow edge is taken for a straight line, whose share of the box has a
//! closed form, and the light on its sides for that of one point, about the middle of what is seen. Where two edges
//! cross a box their shares are multiplied. The boxes that claim too much are halved.
//!
//! The claim is an estimate, the sum over all boxes of: the share that a second edge in the box may hide or show,
//! times the contrast there; the area between an edge and its line; and the second derivative of the light. What
//! could fool it are silhouettes or shadows far smaller than a box. Their functions bend by more than their values,
//! so that their boxes claim the whole contrast.

mod average;
mod depth;
mod edges;
mod eight_boxes;
mod falloffs;
mod half_plane;
mod lights;
mod orders;
mod outlines;
mod shadows;
mod surroundings;

use fearless_simd::Simd;

use self::average::Setting;
use self::eight_boxes::Eight;
use self::orders::Orders;
use self::outlines::Outline;
use crate::edges::cell::Cell;
use crate::exact::budget::CellWork;
use crate::exact::classify::active::Terminators;
use crate::exact::classify::contents::{Contents, Kind};
use crate::exact::part::Part;
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::model::color::Color;

/// Memory to work in.
#[derive(Clone, Debug, Default)]
pub(crate) struct Boxes {
    orders: Orders,
    finishes: Vec<Finish>,
    has_silhouette: Vec<bool>,
    outlines: Vec<Outline>,
    /// The middles of boxes that are left to do.
    now: Vec<[f64; 2]>,
    /// The boxes that were just done.
    known: Vec<([f64; 2], Part)>,
    pub(crate) work: CellWork,
}

/// How much is asked of a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Goal {
    pub(crate) tolerance: f64,
    /// The light where no sphere is seen, and whether it is asked where that is.
    pub(crate) background: Color,
    pub(crate) has_alpha: bool,
}

/// The least tolerance for which boxes are worth a try.
const LEAST_TOLERANCE: f64 = 9e-4;

/// The spheres in a cell from which on other ways are cheaper.
const MOST_SPHERES: usize = 24;

/// The middles of the first boxes, four beside each other and two above each other, and their sides.
const FIRST: [Eight; 2] = [
    [-0.375, -0.125, 0.125, 0.375, -0.375, -0.125, 0.125, 0.375],
    [-0.25, -0.25, -0.25, -0.25, 0.25, 0.25, 0.25, 0.25],
];
const FIRST_SIZE: [f64; 2] = [0.25, 0.5];

/// The curves in a cell from which on boxes meet no tight tolerance soon. Not tuned finely.
const MOST_CURVES: usize = 6;

/// Times that eight boxes are integrated before the cell is given up: few where others follow its edges in less, more
/// to a loose tolerance, which boxes meet soon. Not tuned finely.
const FEWEST_EIGHTS: usize = 10;
const MOST_EIGHTS: usize = 24;
const LOOSE: f64 = 0.02;

/// The share of what is left of the tolerance that the boxes of a size may claim together, if they are more than
/// the tolerance allows.
const SHARE: f64 = 0.5;

impl Boxes {
    /// The average over a cell, if its claim is within the tolerance.
    pub(crate) fn integrate<S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'_>,
        cell: &Cell,
        contents: &Contents,
        goal: &Goal,
    ) -> Option<Part> {
        let tolerance = goal.tolerance;
        let curves = contents.conics.len() + contents.occluders.len();
        let is_crowd = curves > MOST_CURVES && tolerance < LOOSE;
        if is_crowd || tolerance < LEAST_TOLERANCE || !self.prepare(scene, contents) {
            return None;
        }
        let setting = Setting {
            scene,
            cell,
            contents,
            background: goal.background,
            has_alpha: goal.has_alpha,
            finishes: &self.finishes,
            orders: &self.orders,
            has_silhouette: &self.has_silhouette,
        };
        let mut size = FIRST_SIZE;
        let first = setting.averages(simd, FIRST, size, &mut self.outlines);
        self.work.samples += first.samples;
        let mut part = first.total(size[0] * size[1]);
        if part.error <= tolerance {
            return part.value.is_finite().then_some(part);
        }
        part = Part::NOTHING;
        self.known.clear();
        for lane in 0..8 {
            let middle = FIRST.map(|places| places[lane]);
            self.known.push((middle, first.lane(lane)));
        }
        let most_eights = if tolerance < LOOSE {
            FEWEST_EIGHTS
        } else {
            MOST_EIGHTS
        };
        let mut eights = 1;
        loop {
            let area = size[0] * size[1];
            let claims: f64 = self.known.iter().map(|(_, average)| average.error).sum();
            let left = tolerance - part.error;
            let limit = if claims * area <= left {
                f64::INFINITY
            } else {
                SHARE * left / (self.known.len() as f64 * area)
            };
            let longer = usize::from(size[1] > size[0]);
            self.now.clear();
            for &(middle, average) in &self.known {
                if average.error <= limit {
                    part.add(&average, area);
                    continue;
                }
                for side in [-0.25, 0.25] {
                    let mut half = middle;
                    half[longer] += side * size[longer];
                    self.now.push(half);
                }
            }
            if self.now.is_empty() {
                return part.value.is_finite().then_some(part);
            }
            // Halving them all about halves their claims.
            let of_halving = self.now.len().div_ceil(8);
            let (mut claims, mut expected) = (claims * area, eights);
            while claims > left && expected <= most_eights {
                claims *= 0.5;
                expected += of_halving;
            }
            if expected > most_eights {
                return None;
            }
            eights += of_halving;
            size[longer] *= 0.5;
            self.known.clear();
            for group in self.now.chunks(8) {
                let mut middles = [[0.0; 8]; 2];
                for lane in 0..8 {
                    let [x, y] = group[lane.min(group.len() - 1)];
                    middles[0][lane] = x;
                    middles[1][lane] = y;
                }
                let found = setting.averages(simd, middles, size, &mut self.outlines);
                self.work.samples += found.samples;
                for (lane, &middle) in group.iter().enumerate() {
                    self.known.push((middle, found.lane(lane)));
                }
            }
        }
    }

    /// Prepares what all boxes share; returns false if the cell is not one for boxes.
    fn prepare(&mut self, scene: &InCamera<'_>, contents: &Contents) -> bool {
        let active = &contents.active;
        if active.len() > MOST_SPHERES {
            return false;
        }
        for active in active {
            let along = &active.along;
            let half = 0.5 * (along.x.abs() + along.y.abs());
            let is_ahead = active.ball.outside > 0.0 && along.one > half;
            if !is_ahead || active.terminators != Terminators::Plain {
                return false;
            }
        }
        self.orders.find(active);
        self.has_silhouette.clear();
        self.has_silhouette.resize(active.len(), false);
        for (kind, _) in &contents.conics {
            if let Kind::Silhouette(position) = kind {
                self.has_silhouette[*position] = true;
            }
        }
        self.finishes.clear();
        let finishes = active
            .iter()
            .map(|active| Finish::new(scene, active.sphere, contents.pixel));
        self.finishes.extend(finishes);
        true
    }
}
