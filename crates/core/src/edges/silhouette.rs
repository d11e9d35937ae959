//! The outlines of spheres.

use super::cell::{Ball, Cell, dot};
use crate::numeric::polynomial::Quadratic;

/// The discriminant Q of the ray through (x, y): a sphere is seen where it is not negative, in
/// front of the eye where the ray's direction d has d · c > 0.
///
/// # Source
/// For |t d − c|² = r² in t, with A = d·d, B = d·c, K = c·c − r²: Q = B² − A K. For an eye far
/// outside, Lagrange's identity makes of it A r² − |d × c|², in which no large terms cancel. Of parallel rays it is
/// the square of the radius less that of the distance from the center.
pub(crate) fn silhouette(cell: &Cell, ball: &Ball) -> Quadratic {
    if cell.is_parallel() {
        let [x, y] = cell.aside(ball.center);
        let radius_sq = Quadratic {
            one: ball.radius * ball.radius,
            ..Quadratic::default()
        };
        radius_sq - x * x - y * y
    } else if ball.is_apart() {
        let across = cell.cross(ball.center);
        cell.ray_sq() * (ball.radius * ball.radius) - dot(&across, &across)
    } else {
        let along = cell.dot(ball.center);
        along * along - cell.ray_sq() * ball.outside
    }
}

#[cfg(test)]
mod tests;
