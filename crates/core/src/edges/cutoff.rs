//! The plane through a lamp beyond which it sends nothing, where it cuts spheres.

use glam::DVec3;

use super::cell::{Ball, Cell};
use super::seam::plane_cut;
use super::terminator::Plane;
use crate::numeric::polynomial::Quadratic;

/// Vanishes where the ray through (x, y) meets a sphere in the plane of the cutoff of a lamp at this position, on its near
/// side or on its far one.
///
/// # Source
/// That of the plane in which spheres intersect. Near a large sphere, m is computed from the lamp: its distance from the
/// center would be all rounding.
pub(crate) fn cutoff(cell: &Cell, ball: &Ball, plane: &Plane, position: DVec3) -> Quadratic {
    if ball.is_apart() || cell.is_parallel() {
        return plane_cut(cell, ball, plane.axis, plane.offset);
    }
    let m = position.dot(plane.axis);
    let (q, along) = (cell.dot(plane.axis), cell.dot(ball.center));
    cell.ray_sq() * (m * m) - along * q * (2.0 * m) + q * q * ball.outside
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::camera::Projection;

    /// A floor at height −1 below the eye; the plane x + z = 5 meets it in the line y = −1, x = 5 − z.
    #[test]
    fn the_plane_cuts_floors_of_any_radius_in_a_line() {
        for radius in [1e4, 1e7, 1e10] {
            let ball = Ball {
                center: DVec3::new(0.0, -1.0 - radius, 0.0),
                radius,
                power: 1.0 + 2.0 * radius,
                outside: 1.0 + 2.0 * radius,
                projection: Projection::Central,
            };
            let axis = DVec3::new(1.0, 0.0, 1.0).normalize();
            let position = DVec3::new(5.0, 3.0, 0.0);
            let plane = Plane {
                axis,
                offset: (position - ball.center).dot(axis),
            };
            let cell = Cell {
                middle: DVec3::new(0.25, -0.25, 1.0),
                size: [0.1, 0.1],
                projection: Projection::Central,
            };
            let conic = cutoff(&cell, &ball, &plane, position);
            // The ray (u, −v, 1) meets the floor at 1 / v: (u + 1) / v = 5.
            let at = |x: f64, y: f64| {
                (x * conic.xx + y * conic.xy + conic.x) * x
                    + (y * conic.yy + conic.y) * y
                    + conic.one
            };
            for y in [-0.3, 0.0, 0.3] {
                let v = 0.25 - 0.1 * y;
                let x = (5.0 * v - 1.0 - 0.25) / 0.1;
                let slope = (at(x + 1e-3, y) - at(x - 1e-3, y)) / 2e-3;
                let off = (at(x, y) / slope).abs();
                assert!(off < 1e-12 + 1e3 / radius, "{radius:e} {y}: {off:e}");
            }
        }
    }
}
