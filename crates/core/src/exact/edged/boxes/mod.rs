//! The average over a cell by boxes in which edges are lines: the rung for loose tolerances.
//!
//! In each box every silhouette, seam and shadow edge is taken for the straight line that leaves the area which its
//! curve leaves, to the second degree. What is inside of two such lines has a closed form; the shares of more are
//! multiplied. The light on their sides is that of one point, in the middle of what is seen, with its second derivative;
//! rough surfaces take five points. The boxes that claim too much are divided.
//!
//! The claim is an estimate, the sum over all boxes of: what a third edge in the box may hide or show, times the
//! contrast there; a share of the area between an edge and its line, more of it where two things of different color lie
//! behind the edge, each on a part of its way; and what second derivatives do not know of the light. Tips of curves that
//! barely enter a box may be off by a little more than that: pixels claim at least what such tips were seen to do.
//! Silhouettes or shadows far smaller than a box could fool it; but their functions bend by more than their values, so
//! that their boxes claim the whole contrast. So could bumps between the points; but boxes that are not small beside
//! bumps claim all light that there may be.
//!
//! An outline is what is seen of its sphere and not of a smaller one, whose contour is one more line.

pub(crate) mod areas;
mod average;
mod bent;
mod contours;
mod depth;
mod division;
mod eight_boxes;
mod falloffs;
pub(crate) mod half_plane;
mod half_vectors;
mod lights;
mod normals;
mod orders;
mod outlines;
mod projected;
mod region;
mod shadows;
mod sum;
mod surroundings;
mod wedge;

use fearless_simd::Simd;

use self::areas::Shares;
use self::average::Setting;
use self::division::Division;
use self::orders::Orders;
use crate::edges::cell::Cell;
use crate::exact::budget::CellWork;
use crate::exact::classify::contents::{Contents, Kind};
use crate::exact::part::Part;
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::model::color::Color;
use crate::model::roughness::noise::NoiseCells;

/// Memory to work in.
#[derive(Clone, Debug, Default)]
pub(crate) struct Boxes {
    orders: Orders,
    finishes: Vec<Finish>,
    has_silhouette: Vec<bool>,
    division: Division,
    pub(crate) work: CellWork,
}

/// The accuracy asked of a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Goal {
    pub(crate) tolerance: f64,
    /// The light where no sphere is seen, and whether it is asked where that is.
    pub(crate) background: Color,
    pub(crate) has_alpha: bool,
}

/// The least tolerance for which boxes are worth a try.
const LEAST_TOLERANCE: f64 = 2.2e-4;

/// The spheres in a cell from which on other ways are cheaper.
const MOST_SPHERES: usize = 24;

/// The tolerance below which boxes seldom meet it before a cell's edges would, and those below which they do not where
/// curves are more than few, or many.
const TIGHT: f64 = 1.2e-3;
const LOOSE: f64 = 2e-2;
const LOOSEST: f64 = 5e-2;

/// The curves in a cell from which on boxes meet the tolerance too late, below [`LOOSE`], and below [`LOOSEST`]. Not tuned
/// finely: a million spheres under a sun with shadows, on 600 × 600 pixels, took 8.3 s to 1e-2 and 6.2 s to 3e-2 without such
/// a limit, and 5.5 s and 4.9 s with 12 curves. Without shadows, they took 5.1 s to 2e-3 with 12, and 3.2 s with 6.
const FEW_CURVES: usize = 6;
const MANY_CURVES: usize = 12;

/// Times that eight boxes are integrated before the cell is given up, below [`TIGHT`], below [`LOOSE`], and above: few where
/// others follow its edges in less. Not tuned finely: the turntable takes 4 % more instructions to 3e-3 with 10 than with 20,
/// a cloud of a thousand with shadows 9 % more to 2e-3 with 40 than with 20, and the snowman 4 % more to 3e-2 with 20 than
/// with 40.
const FEW_EIGHTS: usize = 10;
const SOME_EIGHTS: usize = 20;
const MANY_EIGHTS: usize = 40;

impl Boxes {
    /// The average over a cell, if its claim is within the tolerance.
    pub(crate) fn integrate<S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'_>,
        cell: &Cell,
        contents: &Contents,
        goal: &Goal,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> Option<Part> {
        let tolerance = goal.tolerance;
        // Outlines cost little beside the silhouettes that they follow.
        let is_outline = |(kind, _): &&(Kind, _)| matches!(kind, Kind::Outline(_));
        let outlines = contents.conics.iter().filter(is_outline).count();
        let curves = contents.conics.len() - outlines + contents.occluders.len();
        let is_crowd =
            curves > FEW_CURVES && tolerance < LOOSE || curves > MANY_CURVES && tolerance < LOOSEST;
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
        let most_eights = if tolerance < TIGHT {
            FEW_EIGHTS
        } else if tolerance < LOOSE {
            SOME_EIGHTS
        } else {
            MANY_EIGHTS
        };
        let part = self
            .division
            .integrate(simd, &setting, tolerance, most_eights, noise);
        self.work.samples += std::mem::take(&mut self.division.samples);
        part.filter(|part| part.value.is_finite())
    }

    /// Measures the shares of a cell in which its active spheres are seen, to an error that all of them together may
    /// have; returns whether that succeeded.
    pub(crate) fn shares<S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'_>,
        cell: &Cell,
        contents: &Contents,
        (tolerance, shares): (f64, &mut Shares),
    ) -> bool {
        if !self.prepare(scene, contents) {
            return false;
        }
        let setting = Setting {
            scene,
            cell,
            contents,
            background: Color::ZERO,
            has_alpha: false,
            finishes: &self.finishes,
            orders: &self.orders,
            has_silhouette: &self.has_silhouette,
        };
        shares.measure(simd, &setting, tolerance)
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
            let is_ahead = active.ball.is_parallel() || along.one > half;
            let is_ahead = active.ball.outside > 0.0 && is_ahead;
            if !is_ahead {
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

#[cfg(test)]
mod by_points;
