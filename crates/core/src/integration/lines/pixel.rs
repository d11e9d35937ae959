//! The integral over a pixel, by lines in one direction and then in the other.

use std::num::NonZeroU32;

use glam::{DVec2, DVec3};

use super::across::{Part, between};
use super::arc::ScanPlane;
use super::line::{Context, Line, distance};
use super::scene::InCamera;
use super::trust::trusted;
use crate::Tile;
use crate::integration::{Integrator, Pixel, Status, Supersampling};
use crate::roughness::PixelKey;
use crate::visibility::Seen;
use crate::{Radiance, View, World};

/// Averages to a tolerance.
#[derive(Clone, Debug)]
pub(crate) struct Lines<'scene> {
    world: &'scene World,
    view: &'scene View,
    seen: &'scene Seen<'scene>,
    camera: InCamera,
    /// For every sphere whether lines can be trusted with it.
    trusted: Vec<bool>,
    /// For pixels that lines cannot be trusted with.
    fallback: Supersampling<'scene>,
    tolerance: f64,
    alpha: bool,
}

/// The square of a pixel on the retina.
#[derive(Clone, Copy, Debug)]
struct Square {
    low: DVec2,
    high: DVec2,
}

impl Square {
    fn area(&self) -> f64 {
        let sides = self.high - self.low;
        sides.x * sides.y
    }

    fn quarters(&self) -> [Self; 4] {
        let middle = 0.5 * (self.low + self.high);
        let (low, high) = (self.low, self.high);
        [
            Self { low, high: middle },
            Self {
                low: DVec2::new(middle.x, low.y),
                high: DVec2::new(high.x, middle.y),
            },
            Self {
                low: DVec2::new(low.x, middle.y),
                high: DVec2::new(middle.x, high.y),
            },
            Self { low: middle, high },
        ]
    }
}

/// Which way lines run.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Direction {
    Level,
    Upright,
}

/// Lines that a sweep over a square may cost.
const MOST_LINES: u32 = 1000;

/// Samples on a side of a pixel that lines cannot integrate.
const FALLBACK_SAMPLES: NonZeroU32 = NonZeroU32::new(8).unwrap();

/// How often a square is quartered.
const DEEPEST: u32 = 4;

impl<'scene> Lines<'scene> {
    pub(crate) fn new(
        world: &'scene World,
        view: &'scene View,
        seen: &'scene Seen<'scene>,
        tolerance: f64,
        alpha: bool,
    ) -> Self {
        let camera = InCamera::new(world, view);
        Self {
            world,
            view,
            seen,
            trusted: trusted(&camera, view, tolerance),
            camera,
            fallback: Supersampling::new(world, view, seen, FALLBACK_SAMPLES, alpha),
            tolerance,
            alpha,
        }
    }

    fn square(&self, col: u32, row: u32) -> Square {
        let center = self.view.cell_center(u64::from(col), u64::from(row), 1);
        let half = DVec2::splat(0.5 * self.view.pixel_size());
        Square {
            low: center - half,
            high: center + half,
        }
    }
}

impl<C: Radiance> Integrator<C> for Lines<'_> {
    fn integrate(&self, tile: Tile, pixels: &mut Vec<Pixel<C>>) {
        let candidates = self.seen.indices(tile);
        for (col, row) in tile.pixels() {
            let square = self.square(col, row);
            let near = self.near(&candidates, &square);
            let context = Context {
                world: self.world,
                visibility: self.seen.visibility,
                camera: &self.camera,
                candidates: &near,
                pixel: PixelKey {
                    col,
                    row,
                    frame: self.view.frame,
                },
                alpha: self.alpha,
                tolerance: 0.02 * self.tolerance,
            };
            pixels.push(self.pixel(&context, &square));
        }
    }
}

impl Lines<'_> {
    /// The spheres whose outline may reach into the square.
    fn near(&self, candidates: &[usize], square: &Square) -> Vec<usize> {
        let distance = self.camera.distance;
        let outside = |center: DVec2, radius: f64, edge: f64| {
            // The signed distance from the plane through the viewpoint and the edge.
            let length = libm::hypot(edge, distance);
            center.x * (distance / length) - center.y * (edge / length) - radius
        };
        let is_near = |&index: &usize| {
            let ball = &self.camera.balls[index];
            let DVec3 { x, y, z } = ball.center;
            let radius = ball.radius * (1.0 + 1e-9) + 1e-12 * ball.center.abs().max_element();
            let (across, upward) = (DVec2::new(x, z), DVec2::new(y, z));
            let beyond = outside(across, radius, square.high.x) > 0.0
                || outside(across * DVec2::new(-1.0, 1.0), radius, -square.low.x) > 0.0
                || outside(upward, radius, square.high.y) > 0.0
                || outside(upward * DVec2::new(-1.0, 1.0), radius, -square.low.y) > 0.0;
            !beyond
        };
        candidates.iter().copied().filter(is_near).collect()
    }

    fn pixel<C: Radiance>(&self, context: &Context<'_>, square: &Square) -> Pixel<C> {
        if context.candidates.is_empty() {
            let value = if self.alpha {
                C::ZERO
            } else {
                C::from_color(self.world.background)
            };
            return Pixel {
                value,
                alpha: 0.0,
                error: 0.0,
                status: Status::Met,
            };
        }
        if !context.candidates.iter().all(|&index| self.trusted[index]) {
            return self.fallback.pixel_of_last_resort(context.pixel);
        }
        let part = self.part::<C>(context, square, 0);
        let area = square.area();
        // The lines themselves are good to their own tolerance.
        let error = part.error / area + context.tolerance;
        if !error.is_finite() {
            return self.fallback.pixel_of_last_resort(context.pixel);
        }
        let status = if error <= self.tolerance {
            Status::Met
        } else {
            Status::OutOfBudget
        };
        let (value, alpha) = (part.value * (1.0 / area), part.covered / area);
        Pixel {
            value,
            alpha,
            error,
            status,
        }
    }

    /// The integral over a square: by level lines and by upright ones, which have to agree. Where
    /// they do not, something lies between the lines of one, and the quarters find it.
    fn part<C: Radiance>(&self, context: &Context<'_>, square: &Square, depth: u32) -> Part<C> {
        let tolerance = 0.9 * self.tolerance * square.area();
        let effort = 0.3 * tolerance;
        let level = self.sweep::<C>(context, square, Direction::Level, effort);
        if level.changes == 0 && level.error <= tolerance {
            return level;
        }
        let upright = self.sweep::<C>(context, square, Direction::Upright, effort);
        let apart =
            distance(level.value, upright.value).max((level.covered - upright.covered).abs());
        let better = if level.error <= upright.error {
            level
        } else {
            upright
        };
        let part = Part {
            error: apart.max(better.error),
            ..better
        };
        if part.error <= tolerance || depth == DEEPEST || !part.error.is_finite() {
            return part;
        }
        let mut sum = Part::NOTHING;
        for quarter in square.quarters() {
            sum.add(self.part(context, &quarter, depth + 1));
        }
        sum
    }

    /// The integral over the square by lines in one direction.
    fn sweep<C: Radiance>(
        &self,
        context: &Context<'_>,
        square: &Square,
        direction: Direction,
        tolerance: f64,
    ) -> Part<C> {
        let (low, high) = (square.low, square.high);
        let (start, end) = match direction {
            Direction::Level => (low.x, high.x),
            Direction::Upright => (low.y, high.y),
        };
        let (first, last) = match direction {
            Direction::Level => (low.y, high.y),
            Direction::Upright => (low.x, high.x),
        };
        let line =
            |place: f64| -> Line<C> { context.line(&self.plane(direction, place), start, end) };
        // What crosses the two other sides of the square, and the extremes of outlines.
        let other = match direction {
            Direction::Level => Direction::Upright,
            Direction::Upright => Direction::Level,
        };
        let mut breaks = vec![first, last];
        for side in [start, end] {
            let crossing: Line<C> = context.line(&self.plane(other, side), first, last);
            breaks.extend(crossing.changes);
        }
        for &index in context.candidates {
            let extremes = self.extremes(index, direction);
            breaks.extend(
                extremes
                    .into_iter()
                    .filter(|place| *place > first && *place < last),
            );
        }
        breaks.sort_by(f64::total_cmp);
        let mut sum = Part {
            changes: breaks.len() - 2,
            ..Part::NOTHING
        };
        let smallest = 1e-9 * (last - first);
        let mut lines = MOST_LINES;
        for pair in breaks.windows(2) {
            if pair[1] - pair[0] > smallest {
                let share = tolerance * (pair[1] - pair[0]) / (last - first);
                sum.add(between(&line, pair[0], pair[1], share, &mut lines));
            }
        }
        sum
    }

    fn plane(&self, direction: Direction, place: f64) -> ScanPlane {
        let distance = self.camera.distance;
        let (along, base) = match direction {
            Direction::Level => (DVec3::X, DVec3::new(0.0, place, distance)),
            Direction::Upright => (DVec3::Y, DVec3::new(place, 0.0, distance)),
        };
        ScanPlane {
            along,
            base,
            base_sq: base.length_squared(),
        }
    }

    /// The places of the lines that touch a sphere's outline.
    fn extremes(&self, index: usize, direction: Direction) -> [f64; 2] {
        let ball = &self.camera.balls[index];
        let DVec3 { x, y, z } = ball.center;
        let (along, across) = match direction {
            Direction::Level => (x, y),
            Direction::Upright => (y, x),
        };
        let rest = along * along - ball.outside;
        let distance = self.camera.distance;
        super::polynomial::quadratic_roots(
            rest + across * across,
            distance * across * z,
            distance * distance * (rest + z * z),
        )
    }
}
