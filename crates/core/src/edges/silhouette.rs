//! The contours of spheres.

use glam::DVec3;

use super::cell::{Ball, Cell, dot};
use crate::numeric::polynomial::Quadratic;

/// The discriminant Q of the ray through (x, y): a sphere is seen where it is not negative, in
/// front of the eye where the ray's direction d has d · c > 0.
///
/// # Source
/// For |t d − c|² = r² in t, with A = d·d, B = d·c, K = c·c − r²: Q = B² − A K. For an eye far
/// outside, Lagrange's identity makes of it A r² − |d × c|², in which no large terms cancel. Of parallel rays it is
/// the square of the radius less that of the distance from the center, or c_z² less K of where they begin.
pub(crate) fn silhouette(cell: &Cell, ball: &Ball) -> Quadratic {
    if cell.is_parallel() {
        if ball.is_apart() {
            let [x, y] = cell.aside(ball.center);
            constant(ball.radius * ball.radius) - x * x - y * y
        } else {
            // c_z² − K', with K' = K + u² + v² − 2 (u c_x + v c_y) where a ray begins.
            let (c, [u, v]) = (ball.center, cell.aside(DVec3::ZERO));
            let [by_u, by_v] = cell.aside(2.0 * c);
            constant(c.z * c.z - ball.power) - u * by_u - v * by_v
        }
    } else if ball.is_apart() {
        let across = cell.cross(ball.center);
        cell.ray_sq() * (ball.radius * ball.radius) - dot(&across, &across)
    } else {
        let along = cell.dot(ball.center);
        along * along - cell.ray_sq() * ball.outside
    }
}

fn constant(one: f64) -> Quadratic {
    Quadratic {
        one,
        ..Quadratic::default()
    }
}

#[cfg(test)]
mod tests;
