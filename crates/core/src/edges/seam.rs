//! The circles in which spheres intersect.

use glam::DVec3;

use super::cell::{Ball, Cell, dot};
use crate::numeric::polynomial::{Linear, Quadratic};

/// The plane in which two spheres intersect: p · w = (K₁ − K₂) / 2, w = c₁ − c₂.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeamPlane {
    /// The smaller of the spheres.
    pub(crate) small: Ball,
    /// The unit vector toward it from the other one.
    pub(crate) normal: DVec3,
    /// The plane's distance from its center along that.
    pub(crate) offset: f64,
    /// The length that rounding moves the plane by, in units of the roundoff.
    pub(crate) scale: f64,
}

impl SeamPlane {
    /// The plane of the seam of two spheres that intersect: from the radii, or from K, whichever rounds less.
    pub(crate) fn new(one: &Ball, other: &Ball) -> Self {
        let (small, large) = if one.radius <= other.radius {
            (one, other)
        } else {
            (other, one)
        };
        let between = small.center - large.center;
        let length = between.length();
        let radii_cost = large.radius.max(length) * length.max(1e-300);
        let power_cost = small.power.abs() + large.power.abs() + small.center.length() * length;
        let (twice, cost) = if radii_cost <= power_cost {
            let radii = (large.radius - length) * (large.radius + length);
            (radii - small.radius * small.radius, radii_cost)
        } else {
            let twice = small.power - large.power - 2.0 * small.center.dot(between);
            (twice, power_cost)
        };
        Self {
            small: *small,
            normal: between / length,
            offset: 0.5 * twice / length,
            scale: cost / length,
        }
    }

    /// The square of the circle's radius; not positive where there is none.
    pub(crate) fn radius_sq(&self) -> f64 {
        (self.small.radius - self.offset) * (self.small.radius + self.offset)
    }

    /// Vanishes where the ray through (x, y) meets both spheres in one point, on their near sides or on others.
    pub(crate) fn seen(&self, cell: &Cell) -> Quadratic {
        plane_cut(cell, &self.small, self.normal, self.offset)
    }
}

/// Vanishes where the ray through (x, y) meets a sphere in the plane (p − c) · w = `offset`, w
/// a unit vector.
///
/// # Source
/// With q = d·w and m = c·w + μ, μ the offset, the point t d = (m / q) d of the plane lies on the
/// sphere where A m² − 2 B m q + K q² = 0. For an eye far outside the terms nearly cancel, unless
/// the plane passes it near by: then the conic is almost a double line, and real only in this form.
/// Elsewhere, with ĉ = c / |c|, w∥ = ĉ·w and Lagrange's identities, they become
///
/// > w∥² |d × c|² + ((c × d) · (ĉ × w))² − r² q² + A μ² + 2 μ (d × c) · (d × w).
pub(super) fn plane_cut(cell: &Cell, ball: &Ball, w: DVec3, offset: f64) -> Quadratic {
    let (center, radius_sq) = (ball.center, ball.radius * ball.radius);
    if cell.is_parallel() {
        return parallel_plane_cut(cell, ball, w, offset);
    }
    let q = cell.dot(w);
    let ray_sq = cell.ray_sq();
    let m = center.dot(w) + offset;
    if !ball.is_apart() || m.abs() <= 2.0 * ball.radius {
        let along = cell.dot(center);
        return ray_sq * (m * m) - along * q * (2.0 * m) + q * q * ball.outside;
    }
    let across = cell.cross(center);
    let toward_center = center.normalize();
    let share = toward_center.dot(w);
    // (c × d) · (ĉ × w) = −(d × c) · (ĉ × w), of which only the square counts.
    let turned = {
        let side = toward_center.cross(w);
        let part = |pick: fn(&Linear) -> f64| {
            pick(&across[0]) * side.x + pick(&across[1]) * side.y + pick(&across[2]) * side.z
        };
        Linear {
            one: part(|linear| linear.one),
            x: part(|linear| linear.x),
            y: part(|linear| linear.y),
        }
    };
    let central = dot(&across, &across) * (share * share) + turned * turned - q * q * radius_sq;
    if offset == 0.0 {
        return central;
    }
    let mixed = dot(&across, &cell.cross(w));
    central + ray_sq * (offset * offset) + mixed * (2.0 * offset)
}

/// The same for parallel rays.
///
/// # Source
/// With a and b the ways from the center to a ray, across it, the ray meets the plane (μ − w_x a − w_y b) / w_z ahead of
/// the center, on the sphere where that is the root of r² − a² − b².
fn parallel_plane_cut(cell: &Cell, ball: &Ball, w: DVec3, offset: f64) -> Quadratic {
    let [a, b] = cell.aside(ball.center);
    let along = |linear: &Linear, factor: f64| Linear {
        one: linear.one * factor,
        x: linear.x * factor,
        y: linear.y * factor,
    };
    let (x, y) = (along(&a, w.x), along(&b, w.y));
    let rest = Linear {
        one: x.one + y.one - offset,
        x: x.x + y.x,
        y: x.y + y.y,
    };
    let radius_sq = Quadratic {
        one: ball.radius * ball.radius,
        ..Quadratic::default()
    };
    rest * rest - (radius_sq - a * a - b * b) * (w.z * w.z)
}

#[cfg(test)]
mod tests;
