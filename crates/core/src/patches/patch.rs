//! The light of a sky on a square of a sphere.
//!
//! Light is computed at nodes, which squares have in common. Between 3 × 3 of them it is that of a [`Model`].
//!
//! # Accuracy
//! The claim is an estimate: by how much the model misses the light at the middles of the square's quarters, which are nodes of
//! these quarters. Two things could fool it. The model may be right there by chance: so the claim is at least a part of the
//! largest difference of the square, and of how much the light bends. Spheres may be so small and close that they darken only
//! what lies between nodes: then the square claims what they may.

use glam::{DVec2, DVec3};

use super::light::{NodeLight, Shares};
use super::model::{Grid, Model};
use super::square::{Node, Square, point};
use crate::model::sphere::Sphere;

/// The claim in a quarter, in parts of what the model misses in its middle, of the most that it misses, and of how much the
/// light bends. Not tuned: of 375,000 pixels of hunted scenes with contacts and skies at 1e-2 to 1e-4, one was off by more than
/// it claimed, by 1.09 of that.
const OF_MISSED: f64 = 1.0;
const OF_LARGEST: f64 = 0.5;
const OF_BEND: f64 = 0.03;

/// The light on a square.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    model: Model,
    /// What is claimed in the middles of its quarters, row by row.
    claims: [[f64; 2]; 2],
}

impl Patch {
    /// That of a square, from the light at its nodes and at those in the middles of its quarters, and from what small spheres
    /// may darken between nodes.
    pub(crate) fn new(
        square: &Square,
        of_small_spheres: f64,
        spheres: &[Sphere],
        light: &mut dyn FnMut(&Node) -> NodeLight,
    ) -> Self {
        let own = &spheres[square.sphere as usize];
        let mut lights = Grid::<NodeLight>::default();
        for (row, lights) in lights.iter_mut().enumerate() {
            for (col, value) in lights.iter_mut().enumerate() {
                *value = light(&square.node(row, col));
            }
        }
        let model = Model::new(square, &lights, spheres);
        let mut claims = [[0.0; 2]; 2];
        let mut largest: f64 = 0.0;
        for (row, claims) in claims.iter_mut().enumerate() {
            for (col, claim) in claims.iter_mut().enumerate() {
                let node = square.quarter(row, col).node(1, 1);
                let at = DVec2::new(col as f64, row as f64) * 0.5 + 0.25;
                let by_model = model.at(at, point(own, node.normal()), spheres);
                let missed = (light(&node).shares - by_model).abs().max_element();
                largest = largest.max(missed);
                *claim = OF_MISSED * missed;
            }
        }
        let least = (OF_LARGEST * largest).max(OF_BEND * model.bend());
        for claim in claims.as_flattened_mut() {
            *claim = claim.max(least).max(of_small_spheres);
        }
        Self { model, claims }
    }

    /// The light at a place from 0 to 1 along either side, and at this position in the world.
    pub(crate) fn at(&self, at: DVec2, position: DVec3, spheres: &[Sphere]) -> Shares {
        self.model.at(at, position, spheres)
    }

    /// The claim at a place.
    pub(crate) fn claim_at(&self, at: DVec2) -> f64 {
        let DVec2 { x, y } = (at * 2.0 - 0.5).clamp(DVec2::ZERO, DVec2::ONE);
        let [low, high] = self
            .claims
            .map(|claims| claims[0] * (1.0 - x) + claims[1] * x);
        low * (1.0 - y) + high * y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patches::light::{Slope, height_and_cosine};

    /// A sphere, and another one that cuts it.
    fn spheres() -> [Sphere; 2] {
        let sphere = |x, radius| Sphere::new(DVec3::new(x, 0.3 * x, 0.0), radius).unwrap();
        [sphere(0.0, 1.0), sphere(1.4, 0.8)]
    }

    /// The patch of light that is a function of the normal, and of the cosine of the other sphere by another function.
    fn patch(
        square: &Square,
        of: &dyn Fn(DVec3) -> f64,
        by_cosine: &dyn Fn(DVec3) -> f64,
    ) -> Patch {
        let spheres = spheres();
        let mut nodes = |node: &Node| {
            let normal = node.normal();
            let (height, cosine) = height_and_cosine(&spheres[1], normal);
            let slope = by_cosine(normal);
            let mut light = NodeLight {
                shares: Shares::new(of(normal) + slope * cosine, 0.0),
                ..NodeLight::default()
            };
            light.add(Slope {
                sphere: Some(1),
                height: height as f32,
                by_cosine: Shares::new(slope, 0.0),
            });
            light
        };
        Patch::new(square, 0.0, &spheres, &mut nodes)
    }

    fn at(patch: &Patch, at: DVec2, normal: DVec3) -> f64 {
        patch.at(at, normal, &spheres()).x
    }

    #[test]
    fn functions_of_second_degree_are_exact_beside_another_sphere_too() {
        let of = |normal: DVec3| {
            let (x, y) = (normal.y / normal.x, normal.z / normal.x);
            0.4 + x - 0.5 * y + 0.3 * x * y - 0.2 * x * x + 0.1 * x * x * y * y
        };
        let by_cosine = |normal: DVec3| 0.2 - 0.3 * normal.y / normal.x;
        let mut outside = 0;
        for number in 0..400 {
            let angle = f64::from(number);
            let turned = DVec2::new(libm::cos(angle), libm::sin(angle)) * (0.3 + 0.001 * angle);
            let normal = DVec3::new(1.0, turned.x, turned.y).normalize();
            let square = Square::around(0, normal, 2 + number % 3);
            let (height, cosine) = height_and_cosine(&spheres()[1], normal);
            if height > 0.1 {
                continue;
            }
            let light = of(normal) + by_cosine(normal) * cosine;
            let patch = patch(&square, &of, &by_cosine);
            let error = at(&patch, square.locate(normal), normal) - light;
            assert!(error.abs() < 1e-14, "{number}: {error:e}");
            outside += i32::from(height > 0.0);
        }
        assert!(outside > 20, "{outside}");
    }

    #[test]
    fn the_mean_of_claims_is_larger_than_the_error_of_the_mean() {
        const SIDE: usize = 40;
        for number in 0..200 {
            let angle = 0.37 * f64::from(number);
            let edge = DVec3::new(
                libm::cos(angle),
                libm::sin(angle),
                0.3 * libm::sin(7.0 * angle),
            );
            // Light that goes with a square root of which nothing is known.
            let of = |normal: DVec3| 0.3 + 0.5 * normal.dot(edge).max(0.0).sqrt();
            let square = Square::around(0, DVec3::new(0.1, 0.2, 0.9), 2 + number % 4);
            let patch = patch(&square, &of, &|_| 0.0);
            let (mut error, mut claim) = (0.0, 0.0);
            for index in 0..SIDE * SIDE {
                let place = DVec2::new((index % SIDE) as f64, (index / SIDE) as f64);
                let place = (place + 0.5) / SIDE as f64;
                let normal = square.normal(place);
                error += at(&patch, place, normal) - of(normal);
                claim += patch.claim_at(place);
            }
            assert!(error.abs() <= claim + 1e-12, "{number}: {error} {claim}");
        }
    }
}
