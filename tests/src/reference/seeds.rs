//! Points of a patch where small details may begin, end, or cross.
//!
//! They only suggest where to put lines at first. Too many do no harm, and the lines in between may still find what
//! they miss.

use glam::{DVec2, DVec3};

use super::ball::Ball;
use super::lamp::Lamp;
use super::patch::{Candidate, Patch};

/// The number of projected points on the edge of a shadow, in addition to its center.
const EDGE_POINTS: u32 = 8;
/// The number of occluders above which pairs of them are not considered.
const MANY: usize = 60;

/// Places to check in a patch.
#[derive(Debug, Default)]
pub(crate) struct Seeds {
    /// Points around which the view may change.
    pub(crate) points: Vec<DVec2>,
    /// The brightest points of highlights and of beams.
    pub(crate) peaks: Vec<DVec2>,
}

impl Seeds {
    pub(crate) fn of(patch: &Patch<'_>) -> Self {
        let mut seeds = Self::default();
        let candidates = &patch.candidates;
        let mut directions = Vec::new();
        for (index, candidate) in candidates.iter().enumerate() {
            directions.push(candidate.ball.center);
            for other in &candidates[..index] {
                for one in candidate.contours() {
                    directions.extend(other.contours().flat_map(|other| match one.forward {
                        None => contour_crossings(one, other),
                        Some(forward) => disc_crossings(one, other, forward),
                    }));
                }
            }
            if !candidate.ball.has_eye_inside() {
                directions.extend(shadow_points(patch, candidate));
                directions.extend(cutoff_points(patch, candidate));
            }
        }
        let inside = |point: &DVec2| point.cmpgt(patch.low).all() && point.cmplt(patch.high).all();
        let project = |direction: DVec3| patch.project(direction).filter(inside);
        seeds.points = directions.into_iter().filter_map(project).collect();
        let peaks = peaks(patch).chain(beams(patch));
        seeds.peaks = peaks.filter_map(project).collect();
        seeds
    }
}

/// The lines `t` = constant that touch the contour of a ball. The plane of the directions
/// `origin + s · along + t · across` has the normal `origin × along + t · across × along`.
pub(crate) fn touching_lines(
    ball: &Ball,
    origin: DVec3,
    along: DVec3,
    across: DVec3,
) -> impl Iterator<Item = f64> {
    if ball.forward.is_some() {
        let across_sq = across.length_squared();
        let middle = (ball.center - origin).dot(across) / across_sq;
        let radii = [Some(ball.radius), ball.cut_radius()].into_iter().flatten();
        let lines = radii.flat_map(|radius| {
            let half = radius / across_sq.sqrt();
            [middle - half, middle + half]
        });
        return lines.collect::<Vec<_>>().into_iter();
    }
    let (n, m) = (origin.cross(along), across.cross(along));
    let form = |a: DVec3, b: DVec3| {
        ball.center.dot(a) * ball.center.dot(b) - ball.radius * ball.radius * a.dot(b)
    };
    let (a, half_b, c) = (form(m, m), form(n, m), form(n, n));
    let root = (half_b * half_b - a * c).max(0.0).sqrt();
    let sum = -(half_b + root.copysign(half_b));
    vec![sum / a, c / sum].into_iter()
}

/// The lines `t` = constant that touch a circle: its middle, its axis and its radius. A plane with the normal N through the
/// eye touches it where |N · m| is the radius times the part of N across the axis.
pub(crate) fn touching_circle(
    patch: &Patch<'_>,
    (middle, axis, radius): (DVec3, DVec3, f64),
    along: DVec3,
    across: DVec3,
) -> Vec<f64> {
    if patch.stage.forward.is_some() {
        let across_sq = across.length_squared();
        let place = (middle - patch.origin).dot(across) / across_sq;
        let half = radius * (across - axis * across.dot(axis)).length() / across_sq;
        return vec![place - half, place + half];
    }
    let (n, m) = (patch.origin.cross(along), across.cross(along));
    let form = |a: DVec3, b: DVec3| {
        middle.dot(a) * middle.dot(b) - radius * radius * (a.dot(b) - a.dot(axis) * b.dot(axis))
    };
    let (a, half_b, c) = (form(m, m), form(n, m), form(n, n));
    let root = (half_b * half_b - a * c).max(0.0).sqrt();
    let sum = -(half_b + root.copysign(half_b));
    vec![sum / a, c / sum]
}

/// The points where the cutoffs of lights on a candidate cross its contour, its terminators and each other.
fn cutoff_points(patch: &Patch<'_>, candidate: &Candidate) -> Vec<DVec3> {
    let ball = &candidate.ball;
    let lamps = &patch.stage.lamps;
    let mut planes = vec![match ball.forward {
        None => (ball.center, ball.power),
        Some(forward) => (forward, forward.dot(ball.center)),
    }];
    for lamp in lamps {
        let (axis, offset) = match *lamp {
            Lamp::Far(toward) => (toward, 0.0),
            Lamp::Near { position, .. } => (position - ball.center, ball.radius * ball.radius),
        };
        planes.push((axis, ball.center.dot(axis) + offset));
    }
    let mut points = Vec::new();
    for (index, lamp) in lamps.iter().enumerate() {
        let Some((middle, axis, _)) = lamp.cutoff(ball) else {
            continue;
        };
        let plane = (axis, middle.dot(axis));
        for other in &planes {
            points.extend(on_both(ball, plane, *other));
        }
        let others = lamps[..index].iter().filter_map(|lamp| lamp.cutoff(ball));
        for (middle, axis, _) in others {
            points.extend(on_both(ball, plane, (axis, middle.dot(axis))));
        }
    }
    points
}

/// The points of a ball that are on two planes p · a = m.
fn on_both(ball: &Ball, (a, m): (DVec3, f64), (b, n): (DVec3, f64)) -> Vec<DVec3> {
    let line = a.cross(b);
    let size_sq = line.length_squared();
    let (m, n) = (m - ball.center.dot(a), n - ball.center.dot(b));
    let foot = (b.cross(line) * m + line.cross(a) * n) / size_sq;
    let rest = ball.radius * ball.radius - foot.length_squared();
    if rest.is_nan() || rest < 0.0 {
        return Vec::new();
    }
    let step = line * (rest / size_sq).sqrt();
    vec![ball.center + foot + step, ball.center + foot - step]
}

/// The two directions in which the contours of two balls cross: the unit vectors d with d · c = √K for both.
fn contour_crossings(a: &Ball, b: &Ball) -> Vec<DVec3> {
    let normal = a.center.cross(b.center);
    if a.has_eye_inside() || b.has_eye_inside() || normal == DVec3::ZERO {
        return Vec::new();
    }
    let (m, n) = (a.power.sqrt(), b.power.sqrt());
    let foot = (b.center.cross(normal) * m + normal.cross(a.center) * n) / normal.length_squared();
    let rest = 1.0 - foot.length_squared();
    if rest < 0.0 {
        return Vec::new();
    }
    let step = normal * (rest.sqrt() / normal.length());
    vec![foot + step, foot - step]
}

/// Directions toward centers and edges of shadows on a candidate, and toward the points where these edges cross each
/// other and the terminators.
fn shadow_points(patch: &Patch<'_>, candidate: &Candidate) -> Vec<DVec3> {
    let ball = &candidate.ball;
    let mut points = Vec::new();
    let stage = patch.stage;
    let lamps = &stage.lamps;
    for (index, (lamp, casters)) in lamps.iter().zip(&candidate.casters).enumerate() {
        let toward = match *lamp {
            Lamp::Far(toward) => toward,
            Lamp::Near { position, .. } => {
                points.extend(near_shadow_points(patch, candidate, position, casters));
                continue;
            }
        };
        let (x, y) = toward.any_orthonormal_pair();
        // The point of the lit side that has this place in the plane of the light.
        let land = |place: DVec3| {
            let from_center = place - ball.center;
            let flat = from_center - toward * from_center.dot(toward);
            let height_sq = ball.radius * ball.radius - flat.length_squared();
            (height_sq >= 0.0).then(|| ball.center + flat + toward * height_sq.sqrt())
        };
        for &caster in casters {
            let caster = &stage.balls[caster];
            points.extend(land(caster.center));
            for step in 0..EDGE_POINTS {
                let angle = std::f64::consts::TAU * f64::from(step) / f64::from(EDGE_POINTS);
                let edge = x * angle.cos() + y * angle.sin();
                points.extend(land(caster.center + edge * caster.radius));
            }
        }
        if casters.len() <= MANY {
            let discs = casters.iter().map(|&caster| &stage.balls[caster]);
            let discs: Vec<&Ball> = discs.chain([ball]).collect();
            for (number, a) in discs.iter().enumerate() {
                for b in &discs[..number] {
                    points.extend(disc_crossings(a, b, toward).into_iter().filter_map(land));
                }
            }
        }
        let meets = |other: &Lamp| match other {
            Lamp::Far(other) => Some(toward.cross(*other).normalize_or_zero()),
            Lamp::Near { .. } => None,
        };
        for other in lamps[..index].iter().filter_map(meets) {
            points.push(ball.center + other * ball.radius);
            points.push(ball.center - other * ball.radius);
        }
    }
    points
}

/// Points on the edges of the shadows that a point light casts on a candidate, the centers of the shadows, and the
/// points where the edges cross each other and the terminator.
fn near_shadow_points(
    patch: &Patch<'_>,
    candidate: &Candidate,
    position: DVec3,
    casters: &[usize],
) -> Vec<DVec3> {
    let seen = |ball: &Ball| Ball::new(ball.center, ball.radius, position, None);
    let own = seen(&candidate.ball);
    // The point of the lit side in a direction from the light.
    let land = |way: DVec3| own.hit(way).map(|t| position + way * t);
    let mut points = Vec::new();
    let discs = casters
        .iter()
        .map(|&caster| seen(&patch.stage.balls[caster]));
    let discs: Vec<Ball> = discs.filter(|disc| !disc.has_eye_inside()).collect();
    for disc in &discs {
        points.extend(land(disc.center));
        let (x, y) = disc.center.normalize().any_orthonormal_pair();
        let share = disc.power / disc.center.length_squared();
        let radius = disc.radius * share.sqrt();
        for step in 0..EDGE_POINTS {
            let angle = std::f64::consts::TAU * f64::from(step) / f64::from(EDGE_POINTS);
            let edge = x * angle.cos() + y * angle.sin();
            points.extend(land(disc.center * share + edge * radius));
        }
    }
    if discs.len() <= MANY {
        let all: Vec<&Ball> = discs.iter().chain([&own]).collect();
        for (number, a) in all.iter().enumerate() {
            for b in &all[..number] {
                let crossings = contour_crossings(a, b);
                points.extend(crossings.into_iter().filter_map(land));
            }
        }
    }
    points
}

/// The points where the contours of two balls cross, as seen from a light.
fn disc_crossings(a: &Ball, b: &Ball, toward: DVec3) -> Vec<DVec3> {
    let way = b.center - a.center;
    let way = way - toward * way.dot(toward);
    let distance_sq = way.length_squared();
    let along = 0.5 + 0.5 * (a.radius - b.radius) * (a.radius + b.radius) / distance_sq;
    let aside_sq = a.radius * a.radius / distance_sq - along * along;
    // Also where they are concentric, and nothing is a number.
    if aside_sq.is_nan() || aside_sq < 0.0 {
        return Vec::new();
    }
    let aside = toward.cross(way) * aside_sq.sqrt();
    let middle = a.center + way * along;
    vec![middle + aside, middle - aside]
}

/// Directions toward the brightest points of the highlights.
fn peaks(patch: &Patch<'_>) -> impl Iterator<Item = DVec3> {
    let world = patch.stage.world;
    let shiny = |candidate: &&Candidate| {
        let material = world.material(candidate.sphere);
        material.highlight.is_some() && !candidate.ball.has_eye_inside()
    };
    let candidates = patch.candidates.iter().filter(shiny);
    candidates.flat_map(move |candidate| {
        let ball = &candidate.ball;
        patch.stage.lamps.iter().map(move |lamp| {
            let mut point = ball.center;
            // Each step brings it nearer by about radius / distance.
            for _ in 0..40 {
                let toward = lamp.seen_from(point).0;
                point = ball.center + patch.half_way(toward, point) * ball.radius;
            }
            point
        })
    })
}

/// The points that lamps face.
fn beams(patch: &Patch<'_>) -> impl Iterator<Item = DVec3> {
    patch.candidates.iter().flat_map(move |candidate| {
        patch.stage.lamps.iter().filter_map(move |lamp| {
            let Lamp::Near {
                position,
                facing: Some((direction, _)),
                ..
            } = *lamp
            else {
                return None;
            };
            let Ball { center, radius, .. } = candidate.ball;
            let seen = Ball::new(center, radius, position, None);
            seen.hit(direction).map(|t| position + direction * t)
        })
    })
}
