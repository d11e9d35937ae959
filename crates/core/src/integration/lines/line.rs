//! The integral of light along a line of the retina, split at everything that happens on it.

use glam::DVec3;

use super::arc::{Arc, ScanPlane};
use super::polynomial::quartic_roots;
use super::scene::{Ball, InCamera};
use crate::roughness::PixelKey;
use crate::rounding::UNIT_ROUNDOFF;
use crate::shading::{Surface, shade_inner_side, shade_lit};
use crate::visibility::Visibility;
use crate::{Radiance, Ray, World};

/// What a line needs to know of its scene and pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Context<'scene> {
    pub(super) world: &'scene World,
    pub(super) visibility: &'scene Visibility<'scene>,
    pub(super) camera: &'scene InCamera,
    /// The spheres that may be seen in the pixel.
    pub(super) candidates: &'scene [usize],
    pub(super) pixel: PixelKey,
    /// Whether the background is left out.
    pub(super) alpha: bool,
    /// What the integral of a line of unit length may be off by.
    pub(super) tolerance: f64,
}

/// The integral along a line.
#[derive(Clone, Debug)]
pub(super) struct Line<C> {
    pub(super) value: C,
    /// Length of the line that spheres cover.
    pub(super) covered: f64,
    /// What is seen in which order, and which lights reach it: lines with the same are alike.
    pub(super) signature: u64,
    /// The places where anything changes.
    pub(super) changes: Vec<f64>,
}

/// A piece of a line on which one sphere is seen, or none.
#[derive(Clone, Copy, Debug)]
struct Run {
    start: f64,
    end: f64,
    sphere: Option<usize>,
}

impl Context<'_> {
    /// The integral over the line's places from `start` to `end`.
    pub(super) fn line<C: Radiance>(&self, plane: &ScanPlane, start: f64, end: f64) -> Line<C> {
        let mut line = Line {
            value: C::ZERO,
            covered: 0.0,
            signature: 0,
            changes: Vec::new(),
        };
        for (index, run) in self.runs(plane, start, end).into_iter().enumerate() {
            if index > 0 {
                line.changes.push(run.start);
            }
            let length = run.end - run.start;
            match run.sphere {
                None => {
                    line.note(0);
                    if !self.alpha {
                        line.value += C::from_color(self.world.background) * length;
                    }
                }
                Some(sphere) => {
                    line.note(1 + sphere as u64);
                    line.covered += length;
                    if self.camera.balls[sphere].outside <= 0.0 {
                        line.value += shade_inner_side::<C>(self.world, sphere) * length;
                    } else {
                        self.add_arc(&mut line, plane, sphere, run);
                    }
                }
            }
        }
        line
    }

    /// Who is seen where.
    fn runs(&self, plane: &ScanPlane, start: f64, end: f64) -> Vec<Run> {
        let balls = &self.camera.balls;
        let mut breaks = vec![start, end];
        let mut note = |place: f64| {
            if place > start && place < end {
                breaks.push(place);
            }
        };
        let mut active: Vec<usize> = Vec::new();
        for &index in self.candidates {
            let ball = &balls[index];
            let roots = if ball.outside > 0.0 {
                plane.silhouette(ball)
            } else {
                [f64::NAN; 2]
            };
            roots.into_iter().for_each(&mut note);
            let crosses = roots.iter().any(|root| *root >= start && *root <= end);
            if crosses || plane.distance(ball, 0.5 * (start + end)).is_some() {
                active.push(index);
            }
        }
        for (position, &first) in active.iter().enumerate() {
            for &second in &active[position + 1..] {
                plane
                    .seam(&balls[first], &balls[second])
                    .into_iter()
                    .for_each(&mut note);
            }
        }
        breaks.sort_by(f64::total_cmp);
        let mut runs: Vec<Run> = Vec::new();
        for pair in breaks.windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let sphere = nearest(plane, balls, &active, middle);
            match runs.last_mut() {
                Some(run) if run.sphere == sphere => run.end = pair[1],
                _ => runs.push(Run {
                    start: pair[0],
                    end: pair[1],
                    sphere,
                }),
            }
        }
        runs
    }

    /// Adds what is seen of a sphere from outside.
    fn add_arc<C: Radiance>(&self, line: &mut Line<C>, plane: &ScanPlane, sphere: usize, run: Run) {
        let ball = &self.camera.balls[sphere];
        let arc = Arc::new(plane, ball);
        let (first, last) = (arc.parameter(ball, run.start), arc.parameter(ball, run.end));
        let (low, high) = if first < last {
            (first, last)
        } else {
            (last, first)
        };
        let mut breaks = vec![low, high];
        let casters: Vec<Vec<usize>> = (0..self.camera.lights.len())
            .map(|light| self.add_breaks(&mut breaks, &arc, sphere, light, low, high))
            .collect();
        breaks.sort_by(f64::total_cmp);
        // Pieces that differ in nothing but a break that meant nothing are one.
        let mut pieces: Vec<(f64, f64, u64)> = Vec::new();
        for pair in breaks.windows(2) {
            if pair[1] - pair[0] <= 4.0 * f64::EPSILON * pair[0].abs().max(pair[1].abs()) {
                continue;
            }
            let lit = self.lit_at(&arc, sphere, 0.5 * (pair[0] + pair[1]), &casters);
            match pieces.last_mut() {
                Some(piece) if piece.2 == lit => piece.1 = pair[1],
                _ => pieces.push((pair[0], pair[1], lit)),
            }
        }
        let sign = if first < last { 1.0 } else { -1.0 };
        let count = pieces.len();
        for step in 0..count {
            // In the order of the line, whichever way τ goes.
            let (start, end, lit) = pieces[if sign > 0.0 { step } else { count - 1 - step }];
            line.note(lit | 1 << 63);
            if step > 0 {
                line.changes
                    .push(arc.place(if sign > 0.0 { start } else { end }));
            }
            let light = |tau: f64| -> C {
                let at = arc.at(tau);
                self.light_from::<C>(sphere, at.point, lit) * (at.slope * sign)
            };
            let tolerance = self.tolerance * (run.end - run.start);
            line.value += self.integrate(sphere, &light, start, end, tolerance);
        }
    }

    /// Notes where a light's terminator and shadow edges cross the arc, and who may cast shadows.
    fn add_breaks(
        &self,
        breaks: &mut Vec<f64>,
        arc: &Arc,
        sphere: usize,
        light: usize,
        low: f64,
        high: f64,
    ) -> Vec<usize> {
        let toward = self.camera.lights[light];
        let ball = &self.camera.balls[sphere];
        let mut note = |tau: f64| {
            if tau > low && tau < high {
                breaks.push(tau);
            }
        };
        arc.terminator(ball, toward).into_iter().for_each(&mut note);
        let mut casters = Vec::new();
        if !self.world.shadows {
            return casters;
        }
        let points = [low, 0.5 * (low + high), high].map(|tau| arc.at(tau).point);
        let ends = points.map(|point| self.in_world(point));
        // The arc bulges out of the polygon of these points by less.
        let bulge = ball.radius * (high - low) * (high - low);
        self.visibility.casters(light, &ends, bulge, &mut casters);
        let mut roots = Vec::new();
        casters.retain(|&caster| {
            if caster == sphere {
                return false;
            }
            // What lies behind all of the arc, as the light sees it, cannot hide it.
            let caster = &self.camera.balls[caster];
            let reach = caster.radius + bulge;
            if points
                .iter()
                .all(|point| (caster.center - point).dot(toward) < -reach)
            {
                return false;
            }
            let bernstein = arc.shadow(caster, toward, low, high);
            if bernstein.iter().all(|&value| value > 0.0) {
                return false;
            }
            roots.clear();
            quartic_roots(bernstein, &mut roots);
            roots.iter().for_each(|s| note(low + (high - low) * s));
            true
        });
        casters
    }

    /// The lights that reach a point of an arc, one bit each (beyond 62 lights they share one).
    fn lit_at(&self, arc: &Arc, sphere: usize, tau: f64, casters: &[Vec<usize>]) -> u64 {
        let point = arc.at(tau).point;
        let ball = &self.camera.balls[sphere];
        let normal = point - ball.center;
        let rough = self.world.material(sphere).roughness.is_some();
        let mut lit = 0;
        for (light, &toward) in self.camera.lights.iter().enumerate() {
            // The perturbed normal of a rough surface may face what the sphere does not.
            if !rough && normal.dot(toward) <= 0.0 {
                continue;
            }
            let to_light = Ray {
                origin: self.in_world(point),
                direction: self.world.lights[light].toward(),
            };
            let reach = to_light.origin.abs().max_element() + point.abs().max_element();
            let error = 16.0 * UNIT_ROUNDOFF * reach;
            let spheres = self.world.spheres();
            if !casters[light]
                .iter()
                .any(|&caster| spheres[caster].is_met(&to_light, error))
            {
                lit |= 1 << light.min(62);
            }
        }
        lit
    }

    fn in_world(&self, point: DVec3) -> DVec3 {
        self.camera.viewpoint + self.camera.world_from_camera * point
    }

    fn light_from<C: Radiance>(&self, sphere: usize, point: DVec3, lit: u64) -> C {
        let ball: &Ball = &self.camera.balls[sphere];
        let to_world = self.camera.world_from_camera;
        let surface = Surface {
            sphere,
            normal: to_world * ((point - ball.center) / ball.radius),
            to_viewer: to_world * -point,
            pixel: self.pixel,
        };
        shade_lit(self.world, &surface, |light| lit >> light.min(62) & 1 == 1)
    }

    /// The integral of a smooth function.
    fn integrate<C: Radiance>(
        &self,
        sphere: usize,
        light: &impl Fn(f64) -> C,
        start: f64,
        end: f64,
        tolerance: f64,
    ) -> C {
        let exponent = self.world.material(sphere).exponent;
        if exponent.fract() == 0.0 {
            return gauss(light, start, end, tolerance, 0);
        }
        // A terminator at an end leaves a power there that is not whole: squares tame it.
        let length = end - start;
        let eased = |s: f64| {
            light(start + length * (s * s * (3.0 - 2.0 * s))) * (6.0 * s * (1.0 - s) * length)
        };
        gauss(&eased, 0.0, 1.0, tolerance, 0)
    }
}

impl<C> Line<C> {
    fn note(&mut self, what: u64) {
        self.signature = (self.signature ^ what)
            .wrapping_mul(0x9e37_79b9_7f4a_7c15)
            .rotate_left(23);
    }
}

fn nearest(plane: &ScanPlane, balls: &[Ball], active: &[usize], place: f64) -> Option<usize> {
    let mut nearest: Option<(f64, usize)> = None;
    for &index in active {
        if let Some(distance) = plane.distance(&balls[index], place) {
            let is_nearer = nearest.is_none_or(|(other_distance, other)| {
                distance < other_distance || distance == other_distance && index < other
            });
            if is_nearer {
                nearest = Some((distance, index));
            }
        }
    }
    nearest.map(|(_, index)| index)
}

/// Gauss's rules with 2 and 4 points: where they agree within ten tolerances the better one holds.
fn gauss<C: Radiance>(
    light: &impl Fn(f64) -> C,
    start: f64,
    end: f64,
    tolerance: f64,
    depth: u32,
) -> C {
    const DEEPEST: u32 = 14;
    let (middle, half) = (0.5 * (start + end), 0.5 * (end - start));
    let pair = |place: f64| light(middle - half * place) + light(middle + half * place);
    let coarse = pair(0.577_350_269_189_625_8) * half;
    let fine = (pair(0.339_981_043_584_856_3) * 0.652_145_154_862_546_1
        + pair(0.861_136_311_594_052_6) * 0.347_854_845_137_453_9)
        * half;
    let difference = distance(fine, coarse);
    if difference <= 10.0 * tolerance || depth == DEEPEST {
        return fine;
    }
    gauss(light, start, middle, 0.5 * tolerance, depth + 1)
        + gauss(light, middle, end, 0.5 * tolerance, depth + 1)
}

/// The largest difference in any channel.
pub(super) fn distance<C: Radiance>(a: C, b: C) -> f64 {
    let differences = a
        .channels()
        .iter()
        .zip(b.channels())
        .map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max)
}
