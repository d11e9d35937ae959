//! A line across a patch: the places where the visible surface or its light changes, and the light along the line.
//!
//! Formulas and smooth functions only suggest places. What is visible is decided by rays: on both sides of every place,
//! in the middle between places, and at every node of the quadrature.

use glam::DVec3;

use super::ball::Ball;
use super::light::{Signature, Spot};
use super::patch::{Candidate, Patch};
use super::quadrature::{Integral, changes, integrate, zeros};

/// The distance, in pixels, below which places count as one, in addition to rounding noise; it is at least this
/// fraction of the patch's goal.
const CLOSE: f64 = 2e-12;
const CLOSE_SHARE: f64 = 2e-3;
/// Parts shorter than this multiple of it are not counted as a difference between two lines.
const SHORT: f64 = 10.0;
/// The allowed error of the light along a line, in pixels times light, in addition to noise, as a fraction of the
/// patch's goal.
const SHARE: f64 = 2e-3;
/// The largest number of halvings of a part of a line, and of new divisions of a line.
const HALVINGS: u32 = 12;
const RETRIES: u32 = 4;
/// The number of places at which functions along a visible part are evaluated before their zeros are searched for.
const NODES: usize = 16;

/// The directions `origin + s · along`, s from `low` to `high`.
pub(crate) struct Line<'patch> {
    pub(crate) patch: &'patch Patch<'patch>,
    pub(crate) origin: DVec3,
    pub(crate) along: DVec3,
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// Places where quadrature should divide the line, because the light has a peak.
    pub(crate) peaks: Vec<f64>,
}

/// A part of a line on which nothing changes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) start: f64,
    pub(crate) end: f64,
    pub(crate) signature: Signature,
}

impl Line<'_> {
    fn at(&self, s: f64) -> DVec3 {
        self.origin + self.along * s
    }

    fn close(&self) -> f64 {
        CLOSE.max(CLOSE_SHARE * self.patch.goal) + self.patch.noise
    }

    /// The views along the line, in order.
    pub(crate) fn structure(&self, pieces: &[Piece]) -> Vec<Signature> {
        let short = SHORT * self.close();
        let long = pieces
            .iter()
            .filter(|piece| piece.end - piece.start > short);
        let mut signatures: Vec<_> = long.map(|piece| piece.signature).collect();
        signatures.dedup();
        signatures
    }

    /// The light along the line, and its pieces.
    pub(crate) fn integral(&self) -> (Integral, Vec<Piece>) {
        let mut surprises = Vec::new();
        for attempt in 0.. {
            let pieces = self.pieces(&surprises);
            let known = surprises.len();
            let mut sum = Integral::default();
            for piece in &pieces {
                sum.add(self.piece_integral(piece, &mut surprises));
            }
            if surprises.len() == known {
                return (sum, pieces);
            }
            if attempt == RETRIES {
                // As where light grazes a ball along the edge of a shadow: it flickers.
                sum.error += sum.cautious;
                return (sum, pieces);
            }
        }
        unreachable!("the loop ends by itself")
    }

    /// Records a place inside the piece where something else is visible.
    fn piece_integral(&self, piece: &Piece, surprises: &mut Vec<f64>) -> Integral {
        let mut surprise = None;
        let mut light = |s: f64| {
            let (signature, light) = self.patch.look(self.at(s), true);
            let inside = (s - piece.start).min(piece.end - s);
            if signature != piece.signature && inside > 2.0 * self.close() {
                surprise = Some(s);
            }
            light
        };
        if piece.signature.seen == 0 {
            // Nothing to integrate, but to look whether it is so.
            for step in 1..4 {
                light(piece.start + (piece.end - piece.start) * (0.25 * f64::from(step)));
            }
            surprises.extend(surprise);
            return Integral::default();
        }
        let tolerance = SHARE * self.patch.goal + self.patch.noise;
        let mut sum = Integral::default();
        let mut start = piece.start;
        let inner = |peak: &&f64| **peak > piece.start && **peak < piece.end;
        let ends = self.peaks.iter().filter(inner).chain([&piece.end]);
        for &end in ends {
            sum.add(integrate(start, end, tolerance, HALVINGS, &mut light));
            start = end;
        }
        surprises.extend(surprise);
        sum
    }

    /// The line, divided where the view changes; `extra` are additional places to check.
    pub(crate) fn pieces(&self, extra: &[f64]) -> Vec<Piece> {
        let mut pieces = Vec::new();
        for (start, end, front) in self.runs(extra) {
            let mut seeds = Vec::new();
            if let Some(index) = front {
                let candidate = &self.patch.candidates[index];
                if let Some(inside) = &candidate.inside {
                    self.contour_seeds(inside, &mut seeds);
                }
                if !candidate.ball.has_eye_inside() {
                    self.seeds_on(candidate, start, end, &mut seeds);
                }
            }
            let mut look = |s: f64| self.patch.signature(self.at(s));
            let cuts = cut((start, end), seeds, extra, self.close(), &mut look);
            for pair in cuts.windows(2) {
                let signature = look(0.5 * (pair[0] + pair[1]));
                pieces.push(Piece {
                    start: pair[0],
                    end: pair[1],
                    signature,
                });
            }
        }
        pieces
    }

    /// The parts on which the same sphere is visible.
    fn runs(&self, extra: &[f64]) -> Vec<(f64, f64, Option<usize>)> {
        let mut seeds = Vec::new();
        let candidates = &self.patch.candidates;
        for (index, candidate) in candidates.iter().enumerate() {
            self.contour_seeds(&candidate.ball, &mut seeds);
            for other in &candidates[..index] {
                self.seam_seeds(&candidate.ball, &other.ball, &mut seeds);
            }
        }
        let mut side = |s: f64| {
            let (index, _) = self.patch.front(self.at(s))?;
            let ball = &self.patch.candidates[index].ball;
            Some((index, ball.begins_inside(self.at(s))))
        };
        let cuts = cut((self.low, self.high), seeds, extra, self.close(), &mut side);
        let look = |s: f64| side(s).map(|(index, _)| index);
        let part = |pair: &[f64]| (pair[0], pair[1], look(0.5 * (pair[0] + pair[1])));
        cuts.windows(2).map(part).collect()
    }

    /// The places where the line grazes a ball.
    fn contour_seeds(&self, ball: &Ball, seeds: &mut Vec<f64>) {
        if ball.has_eye_inside() {
            return;
        }
        if ball.forward.is_some() {
            self.circle_seeds(ball, seeds);
            return;
        }
        let (o, u, c) = (self.origin, self.along, ball.center);
        let (k_oo, k_ou, k_uu) = if c.length_squared() > 4.0 * ball.radius * ball.radius {
            let (a, b, r) = (c.cross(o), c.cross(u), ball.radius);
            let form = |d: f64, crossed: f64| r * r * d - crossed;
            (
                form(o.dot(o), a.dot(a)),
                form(o.dot(u), a.dot(b)),
                form(u.dot(u), b.dot(b)),
            )
        } else {
            let form = |a: DVec3, b: DVec3| c.dot(a) * c.dot(b) - ball.power * a.dot(b);
            (form(o, o), form(o, u), form(u, u))
        };
        for mut s in quadratic_roots(k_uu, 2.0 * k_ou, k_oo) {
            // Newton's steps on a more accurate form of the same function.
            for _ in 0..3 {
                let d = self.at(s);
                let slope = 2.0 * (k_uu * s + k_ou) / d.length_squared();
                let step = ball.chord_sq(d) / slope;
                if step.abs() < 1e-3 {
                    s -= step;
                }
            }
            seeds.push(s);
        }
    }

    /// The places where a line of parallel rays grazes a ball, or enters the circle in which the rays begin inside it.
    fn circle_seeds(&self, ball: &Ball, seeds: &mut Vec<f64>) {
        let Some(forward) = ball.forward else { return };
        let to_center = ball.center - self.origin;
        let to_center = to_center - forward * to_center.dot(forward);
        let along_sq = self.along.length_squared();
        let middle = to_center.dot(self.along) / along_sq;
        let aside = (to_center - self.along * middle).length();
        for radius in [Some(ball.radius), ball.cut_radius()].into_iter().flatten() {
            let half = ((radius - aside) * (radius + aside) / along_sq).sqrt();
            if half.is_finite() {
                seeds.extend([middle - half, middle + half]);
            }
        }
    }

    /// The places where the line crosses the circle in which two balls intersect.
    fn seam_seeds(&self, a: &Ball, b: &Ball, seeds: &mut Vec<f64>) {
        let apart = a.center - b.center;
        let distance = apart.length();
        if distance >= a.radius + b.radius || distance <= (a.radius - b.radius).abs() {
            return;
        }
        // The plane p · apart = m; along a ray, p = t d with t = m / q, q = d · apart, which put
        // into the sphere's equation gives |d|² m² − 2 (c · d) m q + K q² = 0.
        let m = 0.5 * (a.power - b.power);
        let (o, u) = (self.origin, self.along);
        let form = |d: DVec3, e: DVec3| {
            let mixed = a.center.dot(d) * apart.dot(e) + a.center.dot(e) * apart.dot(d);
            d.dot(e) * m * m - m * mixed + a.power * apart.dot(d) * apart.dot(e)
        };
        let roots = match a.forward {
            None => quadratic_roots(form(u, u), 2.0 * form(o, u), form(o, o)),
            Some(forward) => {
                // p = o + s u + t f with t = (m − (o + s u) · apart) / q, q = f · apart.
                let q = forward.dot(apart);
                let (rest, slope) = (m - o.dot(apart), -u.dot(apart));
                let (from, depth) = (o - a.center, a.center.dot(forward));
                let outside = from.length_squared() - a.radius * a.radius;
                quadratic_roots(
                    q * q * u.length_squared() + slope * slope,
                    2.0 * (q * q * u.dot(from) - q * depth * slope + rest * slope),
                    q * q * outside - 2.0 * q * depth * rest + rest * rest,
                )
            }
        };
        let lead = |s: f64| a.forced_hit(self.at(s)) - b.forced_hit(self.at(s));
        for mut s in roots {
            // Secant steps on what counts: which is in front.
            let (mut before, mut value) = (s + 1e-7, lead(s));
            let mut value_before = lead(before);
            for _ in 0..4 {
                let step = value * (s - before) / (value - value_before);
                let is_small = step.abs() < 1e-3;
                if !is_small || step == 0.0 {
                    break;
                }
                (before, value_before) = (s, value);
                s -= step;
                value = lead(s);
            }
            seeds.push(s);
        }
    }

    /// The places where terminators, edges of shadows, and borders of noise cells may cross the line, on a ball that is
    /// visible from `start` to `end`.
    fn seeds_on(&self, candidate: &Candidate, start: f64, end: f64, seeds: &mut Vec<f64>) {
        let world = self.patch.stage.world;
        let material = world.material(candidate.sphere);
        // Dense toward the ends, where the contour makes everything run as a square root.
        let place = |u: f64| start + (end - start) * (u * u * (3.0 - 2.0 * u));
        let spot = |u: f64| {
            let direction = self.at(place(u));
            let t = candidate.ball.forced_hit(direction);
            self.patch.spot(candidate, direction, t)
        };
        let nodes = nodes();
        let spots: Vec<Spot> = nodes.iter().map(|&u| spot(u)).collect();
        let mut found = Vec::new();
        let mut search = |value: &dyn Fn(&Spot, f64) -> f64| {
            let values: Vec<f64> = spots
                .iter()
                .zip(&nodes)
                .map(|(spot, &u)| value(spot, u))
                .collect();
            zeros(&nodes, &values, &mut |u| value(&spot(u), u), &mut found);
        };
        let suns = &self.patch.stage.softness.suns;
        for (number, lamp) in self.patch.stage.lamps.iter().enumerate() {
            let casters = &candidate.casters[number];
            search(&|spot, _| spot.normal.dot(lamp.seen_from(spot.point).0));
            if lamp.ahead(candidate.ball.center).is_some() {
                search(&|spot, _| lamp.ahead(spot.point).unwrap_or(1.0));
            }
            if material.highlight.is_some() {
                search(&|spot, u| {
                    let toward = lamp.seen_from(spot.point).0;
                    let half = self.patch.half_way(toward, self.at(place(u)));
                    spot.normal.dot(half)
                });
            }
            if let Some(sun) = &suns[number] {
                let balls = &self.patch.stage.balls;
                for distance in sun.borders(balls, casters) {
                    search(&|spot, _| distance(spot));
                }
                continue;
            }
            let facing = |spot: &Spot| spot.normal.dot(lamp.seen_from(spot.point).0);
            if spots.iter().all(|spot| facing(spot) < -0.3) {
                continue;
            }
            for &caster in casters {
                let caster = &self.patch.stage.balls[caster];
                search(&|spot, _| lamp.shadow(caster, spot.point).0);
            }
        }
        if let Some(rough) = &material.roughness
            && let marbles_core::Grain::Surface(size) = rough.grain
        {
            for axis in 0..3 {
                let coordinate = |spot: &Spot| (spot.point - candidate.ball.center)[axis] / size;
                let ends = spots.iter().map(coordinate);
                let (low, high) = ends.fold((f64::MAX, f64::MIN), |(low, high), value| {
                    (low.min(value), high.max(value))
                });
                // Beyond some number of cells their faces do not pay.
                for face in 0..((high.round() - low.round()) as u32).min(200) {
                    let face = low.round() + 0.5 + f64::from(face);
                    search(&|spot, _| coordinate(spot) - face);
                }
            }
        }
        seeds.extend(found.into_iter().map(place));
    }
}

/// Divides a range where the results of `look` change.
fn cut<S: PartialEq + Clone>(
    (low, high): (f64, f64),
    mut seeds: Vec<f64>,
    extra: &[f64],
    close: f64,
    look: &mut impl FnMut(f64) -> S,
) -> Vec<f64> {
    seeds.retain(|seed| *seed > low && *seed < high);
    seeds.sort_by(f64::total_cmp);
    let ends: Vec<f64> = [low].into_iter().chain(seeds).chain([high]).collect();
    let mut samples: Vec<f64> = ends
        .windows(2)
        .filter(|pair| pair[1] - pair[0] > close)
        .map(|pair| 0.5 * (pair[0] + pair[1]))
        .chain(extra.iter().copied().filter(|s| *s > low && *s < high))
        .collect();
    samples.sort_by(f64::total_cmp);
    let mut cuts = vec![low];
    let results: Vec<S> = samples.iter().map(|&s| look(s)).collect();
    for index in 1..samples.len() {
        let (from, to) = (samples[index - 1], samples[index]);
        if results[index - 1] != results[index] {
            let first = ends.partition_point(|seed| *seed <= from);
            let last = ends.partition_point(|seed| *seed < to);
            let (from, to) = ((from, &results[index - 1]), (to, &results[index]));
            changes(from, to, &ends[first..last], close, look, &mut cuts);
        }
    }
    cuts.push(high);
    cuts
}

/// Numbers from 0 to 1, denser near both ends, where pairs of zeros are more likely.
fn nodes() -> Vec<f64> {
    let step = 1.0 / NODES as f64;
    let near = [0.0, 0.2 * step, 0.5 * step];
    let middle = (1..NODES).map(|index| index as f64 * step);
    let far = near.into_iter().rev().map(|u| 1.0 - u);
    near.into_iter().chain(middle).chain(far).collect()
}

/// Real zeros of a x² + b x + c.
fn quadratic_roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return Vec::new();
    }
    let sum = -0.5 * (b + discriminant.sqrt().copysign(b));
    let roots = [sum / a, c / sum];
    roots.into_iter().filter(|root| root.is_finite()).collect()
}
