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

mod eight;
mod half_plane;
mod lights;
mod outlines;

use fearless_simd::Simd;

use self::eight::Setting;
use self::outlines::{Orders, Outline};
use crate::edges::cell::Cell;
use crate::exact::budget::CellWork;
use crate::exact::classify::active::Terminators;
use crate::exact::classify::contents::Contents;
use crate::exact::part::Part;
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::model::color::Color;

/// Memory to work in.
#[derive(Clone, Debug, Default)]
pub(crate) struct Boxes {
    orders: Orders,
    finishes: Vec<Finish>,
    outlines: Vec<Outline>,
    /// The middles of boxes that are left to do.
    now: Vec<[f64; 2]>,
    /// The boxes that were just done.
    known: Vec<([f64; 2], Part)>,
    pub(crate) work: CellWork,
}

/// The least tolerance for which boxes are worth a try.
const LEAST_TOLERANCE: f64 = 9e-4;

/// The spheres in a cell from which on other ways are cheaper.
const MOST_SPHERES: usize = 24;

/// The boxes along both sides of a cell at first.
const FIRST: [usize; 2] = [4, 2];

/// Times that eight boxes are integrated before the cell is given up.
const MOST_EIGHTS: usize = 40;

/// The share of what is left of the tolerance that the boxes of a size may claim together, if they are more than
/// the tolerance allows.
const SHARE: f64 = 0.5;

impl Boxes {
    /// The average over a cell, if its claim is within the tolerance. The light without a sphere is `background`.
    pub(crate) fn integrate<S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'_>,
        cell: &Cell,
        contents: &Contents,
        (tolerance, background): (f64, Color),
    ) -> Option<Part> {
        if tolerance < LEAST_TOLERANCE || !self.prepare(scene, cell, contents) {
            return None;
        }
        let mut part = Part::NOTHING;
        let mut size = FIRST.map(|count| 1.0 / count as f64);
        self.now.clear();
        for row in 0..FIRST[1] {
            for col in 0..FIRST[0] {
                let middle = |index: usize, size: f64| (index as f64 + 0.5) * size - 0.5;
                self.now.push([middle(col, size[0]), middle(row, size[1])]);
            }
        }
        let mut eights = 0;
        while !self.now.is_empty() {
            eights += self.now.len().div_ceil(8);
            if eights > MOST_EIGHTS {
                return None;
            }
            let setting = Setting {
                scene,
                cell,
                contents,
                background,
                finishes: &self.finishes,
                orders: &self.orders,
            };
            self.known.clear();
            let mut claims = 0.0;
            for group in self.now.chunks(8) {
                let mut middles = [[0.0; 8]; 2];
                for lane in 0..8 {
                    let [x, y] = group[lane.min(group.len() - 1)];
                    middles[0][lane] = x;
                    middles[1][lane] = y;
                }
                let found = setting.averages(simd, middles, size, &mut self.outlines);
                self.work.samples += found.lit;
                for (lane, &middle) in group.iter().enumerate() {
                    let average = found.lane(lane);
                    claims += average.error * size[0] * size[1];
                    self.known.push((middle, average));
                }
            }
            let area = size[0] * size[1];
            let left = tolerance - part.error;
            let limit = if claims <= left {
                f64::INFINITY
            } else {
                SHARE * left / self.now.len() as f64
            };
            self.now.clear();
            let longer = usize::from(size[1] > size[0]);
            for &(middle, average) in &self.known {
                if average.error * area <= limit {
                    part.add(&average, area);
                    continue;
                }
                for side in [-0.25, 0.25] {
                    let mut half = middle;
                    half[longer] += side * size[longer];
                    self.now.push(half);
                }
            }
            size[longer] *= 0.5;
        }
        part.value.is_finite().then_some(part)
    }

    /// Prepares what all boxes share; returns false if the cell is not one for boxes.
    fn prepare(&mut self, scene: &InCamera<'_>, cell: &Cell, contents: &Contents) -> bool {
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
        let _ = cell;
        self.orders.find(active);
        self.finishes.clear();
        let finishes = active
            .iter()
            .map(|active| Finish::new(scene, active.sphere, contents.pixel));
        self.finishes.extend(finishes);
        true
    }
}
