//! The spheres that may hide light from a square of a sphere.

use super::bodies::Bodies;
use super::gather::{Neighborhood, gather};
use super::point::Occluders;
use super::square::{Square, point};
use crate::model::sphere::Sphere;

/// Spheres that may hide light from a square.
#[derive(Clone, Debug, Default)]
pub(crate) struct List {
    pub(crate) bodies: Bodies,
    found: Vec<u32>,
}

impl List {
    /// Makes it that of a square.
    pub(crate) fn fill(&mut self, square: &Square, occluders: &Occluders<'_>) {
        let own = square.sphere as usize;
        let of = neighborhood(square, &occluders.spheres[own]);
        gather(occluders, own, &of, &mut self.found);
        self.bodies.clear();
        for &index in &self.found {
            self.bodies.push(&occluders.spheres[index as usize]);
        }
    }

    /// The share of the light that small ones may darken between the nodes of a square, which is a part of the list's.
    pub(crate) fn missed(&self, square: &Square, occluders: &Occluders<'_>) -> f64 {
        let of = neighborhood(square, &occluders.spheres[square.sphere as usize]);
        let found = self.found.iter();
        let missed = found.map(|&index| missed(&of, &occluders.spheres[index as usize]));
        missed.fold(0.0, f64::max)
    }
}

/// The part of the world that a square is.
fn neighborhood(square: &Square, sphere: &Sphere) -> Neighborhood {
    let (normal, chord) = square.extent();
    Neighborhood {
        middle: point(sphere, normal),
        around: chord * sphere.radius(),
        normal,
        // The angle of a chord, and a little more.
        turn: chord * (1.0 + 0.1 * chord * chord),
    }
}

/// What a small sphere near a square may darken between its nodes.
fn missed(of: &Neighborhood, sphere: &Sphere) -> f64 {
    /// The distance between nodes, in parts of that of corners from the middle, and a little more.
    const SPACING: f64 = 0.75;
    let spacing = SPACING * of.around;
    let to_center = sphere.center() - of.middle;
    let radius = sphere.radius();
    if radius >= spacing || to_center.length() > of.around + radius + spacing {
        return 0.0;
    }
    // The height of the center above the surface.
    let curvature = of.turn / of.around;
    let height = to_center.dot(of.normal) + 0.5 * curvature * to_center.length_squared();
    let height = height.abs().max(radius);
    if height < spacing {
        (radius / height) * (radius / height)
    } else {
        0.0
    }
}
