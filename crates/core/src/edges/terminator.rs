//! The terminators of spheres, where the light grazes.

use glam::DVec3;

use super::cell::{Ball, Cell};
use super::seam::plane_cut;
use crate::numeric::polynomial::Quadratic;

/// Vanishes where the ray through (x, y) meets a sphere in the great circle n·l = 0 across a light
/// in the unit direction `toward`, on its near side or on its far one.
pub(crate) fn terminator(cell: &Cell, ball: &Ball, toward: DVec3) -> Quadratic {
    plane_cut(cell, ball, toward, 0.0)
}

#[cfg(test)]
mod tests;
