//! The terminators of spheres, where the light grazes.

use glam::DVec3;

use super::cell::{Ball, Cell};
use super::seam::plane_cut;
use crate::numeric::polynomial::Quadratic;

/// The plane of a terminator: (p − c) · `axis` = `offset`, with a unit vector toward the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plane {
    pub(crate) axis: DVec3,
    /// 0 for a light that is infinitely far; of a light at distance D, r² / D.
    pub(crate) offset: f64,
}

impl Plane {
    /// That of a point light at a vector from a sphere's center; none where the light is not outside.
    pub(crate) fn of_near_light(from_center: DVec3, radius: f64) -> Option<Self> {
        let distance = from_center.length();
        (distance > radius).then(|| Self {
            axis: from_center / distance,
            offset: radius * (radius / distance),
        })
    }
}

/// Vanishes where the ray through (x, y) meets a sphere in the circle n·l = 0 in this plane, on its near side or on
/// its far one.
pub(crate) fn terminator(cell: &Cell, ball: &Ball, plane: &Plane) -> Quadratic {
    plane_cut(cell, ball, plane.axis, plane.offset)
}

#[cfg(test)]
mod tests;
