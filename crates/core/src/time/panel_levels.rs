//! The lengths of the panels with which pixels begin.
//!
//! Anything that crosses a pixel between two moments is missed. So no moments are farther apart than
//! what is seen near a pixel moves by less than a part of one. The world stands still and the camera
//! moves: what is seen, edges of shadows too, moves as the surfaces do on which it is; but highlights
//! do as mirror images behind them.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec2;
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};

use super::panel::{BLIND, DEEPEST, FASTEST, LONGEST_GAP};
use super::travel::{HALF_MOMENTS, MovingSphere};
use crate::model::exposure::{HALVES, Motion, view_at};
use crate::model::view::View;
use crate::model::world::World;

/// The panels with which a pixel begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstPanels {
    pub(super) level: u32,
    /// The part of the largest difference of light that may be missed between their moments.
    pub(super) missed: f64,
    /// True where that is little enough.
    pub(super) is_fine: bool,
}

/// The first panels of pixels, by cells of the picture.
#[derive(Debug)]
pub(super) struct PanelLevels {
    /// Pixels of a cell's side.
    side: u32,
    columns: u32,
    cells: Vec<FirstPanels>,
}

/// A picture has no more cells than this along a side. Not tuned: every sphere is asked for each cell
/// that it passes, and a cell begins as its fastest sphere asks.
const MOST_CELLS: u32 = 64;

/// The part of the tolerance that may be missed. Not tuned: the rest is left to the rules.
const SHARE: f64 = 0.4;

impl PanelLevels {
    /// For a picture of a world to a tolerance, which is a part of the largest difference of light.
    pub(super) fn new(world: &World, view: &View, motion: &dyn Motion, tolerance: f64) -> Self {
        let side = view.width.max(view.height).div_ceil(MOST_CELLS).max(8);
        let (columns, rows) = (view.width.div_ceil(side), view.height.div_ceil(side));
        let longest = (0..columns * rows).map(|_| AtomicU64::new(0));
        let travels = CellTravels {
            side,
            columns,
            longest: longest.collect(),
        };
        let halves = HALVES.map(|times| times.map(|time| view_at(view, motion, time)));
        let spheres = world.spheres().par_iter().enumerate();
        spheres.for_each(|(index, sphere)| {
            let is_shiny = world.material(index).highlight.is_some();
            for views in &halves {
                travels.add(&MovingSphere {
                    sphere,
                    is_shiny,
                    views,
                });
            }
        });
        if turns_unseen(view, motion) {
            for longest in &travels.longest {
                longest.store(f64::INFINITY.to_bits(), Ordering::Relaxed);
            }
        }
        let lowest = u32::from(!motion.is_smooth());
        let longest = travels.longest.into_iter().map(AtomicU64::into_inner);
        let cells = longest.map(|bits| FirstPanels::new(f64::from_bits(bits), tolerance, lowest));
        Self {
            side,
            columns,
            cells: cells.collect(),
        }
    }

    /// The panels with which a pixel begins.
    pub(super) fn at(&self, col: u32, row: u32) -> FirstPanels {
        let cell = row / self.side * self.columns + col / self.side;
        self.cells[cell as usize]
    }
}

impl FirstPanels {
    /// Panels so short that nothing is missed that matters, where something travels so many pixels in
    /// the whole time.
    fn new(travel: f64, tolerance: f64, lowest: u32) -> Self {
        let mut level = lowest;
        while level < FASTEST && missed(travel, level) > SHARE * tolerance {
            level += 1;
        }
        if missed(travel, level) >= 1.0 {
            // More moments would not tell more.
            level = lowest.max(BLIND);
        }
        let missed = missed(travel, level);
        Self {
            level,
            missed,
            is_fine: missed <= SHARE * tolerance,
        }
    }
}

/// The part of the light on a way of so many pixels that may be missed between the moments of panels of
/// a level.
///
/// A convex thing that comes into a pixel and leaves it again on a way of g has come in by a corner,
/// covers no more than g²/4 of the pixel, and less than a half of that on average: g³/8 in all. With
/// gaps nearly as long as a pixel anything may be missed.
fn missed(travel: f64, level: u32) -> f64 {
    /// The longest gap, in sides of a pixel: the formula holds below it, with room for ways that are not straight. Not
    /// tuned.
    const LONGEST: f64 = 0.9;
    let gap = LONGEST_GAP * travel / f64::from(1_u32 << level);
    if travel == 0.0 {
        0.0
    } else if gap < LONGEST {
        gap * gap * gap / (8.0 * travel)
    } else {
        1.0
    }
}

/// Returns whether a camera turns so fast that the moments at which travel is measured may see it come back: by
/// more than a radian from one to the next.
///
/// How fast it turns is measured between moments that are close together. A camera that is fast only between those
/// would fool it; poses between two frames go with polynomials, which are not.
fn turns_unseen(view: &View, motion: &dyn Motion) -> bool {
    /// Far more than rounding, of the whole time.
    const CLOSE: f64 = 1.0 / (1_u64 << 24) as f64;
    const MOST_TURN: f64 = 1.0;
    HALVES.iter().any(|times| {
        times.windows(2).any(|step| {
            let middle = 0.5 * (step[0] + step[1]);
            let axes = [middle, middle + CLOSE]
                .map(|time| view_at(view, motion, time).camera.world_from_camera);
            let apart = axes[1] - axes[0];
            let turn = apart.x_axis.length().max(apart.y_axis.length());
            let turn = turn.max(apart.z_axis.length());
            let turn = turn / CLOSE * (step[1] - step[0]);
            // What is not a number may be any turn.
            turn.is_nan() || turn > MOST_TURN
        })
    })
}

/// The longest travel in each cell, while spheres are added.
struct CellTravels {
    side: u32,
    columns: u32,
    /// In the whole time, in pixels: bits of numbers that are not negative, which are ordered as these
    /// are.
    longest: Vec<AtomicU64>,
}

impl CellTravels {
    /// Adds the travel of a sphere in half of the time.
    fn add(&self, moving: &MovingSphere<'_>) {
        if moving.is_outside() {
            return;
        }
        let mut around: Option<(DVec2, DVec2)> = None;
        let mut before: Option<(DVec2, DVec2)> = None;
        let mut step: f64 = 0.0;
        for view in moving.views {
            let Some((low, high)) = moving.silhouette_box(view) else {
                // It may come from anywhere.
                let size = DVec2::new(f64::from(view.width), f64::from(view.height));
                for moment in 0..HALF_MOMENTS {
                    self.add_within((DVec2::ZERO, size), moving, moment);
                }
                return;
            };
            if let Some(before) = before {
                step = step.max((low - before.0).length());
                step = step.max((high - before.1).length());
            }
            before = Some((low, high));
            let all = around.unwrap_or((low, high));
            around = Some((all.0.min(low), all.1.max(high)));
        }
        if let Some((low, high)) = around {
            // Between moments the way is not straight.
            let margin = 1.0 + 0.25 * step;
            self.add_within((low - margin, high + margin), moving, HALF_MOMENTS / 2);
        }
    }

    /// Adds the travel of a sphere in cells that it passes, as they see it at one of the moments.
    fn add_within(&self, (low, high): (DVec2, DVec2), moving: &MovingSphere<'_>, moment: usize) {
        let view = &moving.views[moment];
        let side = f64::from(self.side);
        let rows = self.longest.len() as u32 / self.columns;
        // Casts saturate.
        let first = (low / side).floor();
        let last = (high / side).floor();
        if last.x < 0.0 || last.y < 0.0 {
            return;
        }
        for row in first.y as u32..=(last.y as u32).min(rows - 1) {
            for column in first.x as u32..=(last.x as u32).min(self.columns - 1) {
                let middle = (DVec2::new(f64::from(column), f64::from(row)) + 0.5) * side;
                let Some(travel) = moving.travel(view, middle, side) else {
                    continue;
                };
                let travel = if travel.is_finite() {
                    2.0 * travel
                } else {
                    f64::INFINITY
                };
                let cell = row * self.columns + column;
                self.longest[cell as usize].fetch_max(travel.to_bits(), Ordering::Relaxed);
            }
        }
    }
}

const _: () = assert!(FASTEST < DEEPEST && DEEPEST < 32);

#[cfg(test)]
mod tests;
