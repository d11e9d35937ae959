//! Cells, balls and rays for the tests of edges, each computed the plain way.

use glam::DVec3;

use super::cell::{Ball, Cell};
use crate::numeric::polynomial::{Linear, Quadratic};
use crate::search::tests::Random;

/// From `low` to `high`, every magnitude alike.
pub(crate) fn magnitude(random: &mut Random, low: f64, high: f64) -> f64 {
    low * (high / low).powf(random.number())
}

/// A coordinate of a cell.
pub(crate) fn coordinate(random: &mut Random) -> f64 {
    random.number() - 0.5
}

pub(crate) fn direction(random: &mut Random) -> DVec3 {
    loop {
        let point = random.point();
        if (0.01..1.0).contains(&point.length_squared()) {
            return point.normalize();
        }
    }
}

pub(crate) fn ball(center: DVec3, radius: f64) -> Ball {
    Ball {
        center,
        radius,
        outside: center.length_squared() - radius * radius,
        power: center.length_squared() - radius * radius,
        projection: crate::model::camera::Projection::Central,
    }
}

/// A ball in front of the eye, which is outside of it.
pub(crate) fn ball_in_front(random: &mut Random) -> Ball {
    let distance = magnitude(random, 0.1, 1e3);
    let center = (random.point() + DVec3::Z * 2.0) * distance;
    ball(
        center,
        center.length() * magnitude(random, 1e-3, 1.0).min(0.95),
    )
}

/// A cell that sees a ball nearly in its middle, `widths` of its radius wide.
pub(crate) fn cell_at(random: &mut Random, ball: &Ball, widths: f64) -> Cell {
    let angle = ball.radius / ball.center.z;
    let mut middle = ball.center / ball.center.z;
    middle.x += 0.3 * angle * coordinate(random);
    middle.y += 0.3 * angle * coordinate(random);
    let size = [0, 1].map(|_| widths * angle * (0.7 + 0.6 * random.number()));
    Cell {
        middle,
        size,
        projection: crate::model::camera::Projection::Central,
    }
}

/// A cell anywhere, of any size.
pub(crate) fn any_cell(random: &mut Random) -> Cell {
    let away = magnitude(random, 0.01, 10.0);
    Cell {
        middle: (random.point() * away).with_z(1.0),
        size: [0, 1].map(|_| magnitude(random, 1e-5, 2.0)),
        projection: crate::model::camera::Projection::Central,
    }
}

/// The ray through (x, y): its third component is 1.
pub(crate) fn ray(cell: &Cell, x: f64, y: f64) -> DVec3 {
    cell.middle + DVec3::new(x * cell.size[0], y * cell.size[1], 0.0)
}

/// The coordinates at which a point of the camera's frame is seen.
pub(crate) fn place(cell: &Cell, point: DVec3) -> (f64, f64) {
    let at = |axis: usize| (point[axis] / point.z - cell.middle[axis]) / cell.size[axis];
    (at(0), at(1))
}

/// The first point in which a ray meets a ball that the eye is outside of.
pub(crate) fn first_hit(ray: DVec3, ball: &Ball) -> Option<DVec3> {
    let ray = ray.normalize();
    let along = ray.dot(ball.center);
    let foot = ray * along - ball.center;
    let half_chord_sq = ball.radius * ball.radius - foot.length_squared();
    (half_chord_sq >= 0.0 && along > 0.0).then(|| ball.center + foot - ray * half_chord_sq.sqrt())
}

pub(crate) fn at(linear: &Linear, x: f64, y: f64) -> f64 {
    linear.one + linear.x * x + linear.y * y
}

/// The value of a polynomial, and the sum of the magnitudes that it consists of.
pub(crate) fn value(q: &Quadratic, x: f64, y: f64) -> (f64, f64) {
    let terms = [
        q.one,
        q.x * x,
        q.y * y,
        q.xx * x * x,
        q.xy * x * y,
        q.yy * y * y,
    ];
    (
        terms.iter().sum(),
        terms.iter().map(|term| term.abs()).sum(),
    )
}

/// The derivative of the polynomial along x.
pub(crate) fn slope(q: &Quadratic, x: f64, y: f64) -> f64 {
    q.x + 2.0 * q.xx * x + q.xy * y
}

/// Places x of the crossings with eight lines: rising, falling.
pub(crate) fn crossings(q: &Quadratic, y: [f64; 8]) -> [[f64; 8]; 2] {
    [0, 1].map(|which| y.map(|y| q.crossings(y)[which]))
}

/// The zeros of a polynomial in a cell, on eight lines of it.
pub(crate) fn zeros(random: &mut Random, q: &Quadratic) -> Vec<(f64, f64)> {
    let y = [0.0; 8].map(|_| coordinate(random));
    let mut zeros = Vec::new();
    for places in crossings(q, y) {
        zeros.extend(places.into_iter().zip(y).filter(|(x, _)| x.abs() <= 0.5));
    }
    zeros
}
