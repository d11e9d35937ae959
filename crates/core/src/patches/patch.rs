//! The light of a sky on a square of a sphere.
//!
//! Light is computed at nodes, which squares have in common. On each quarter of a square it is that of a [`Model`] from the
//! light at its corners.
//!
//! # Accuracy
//! The claim is an estimate: the largest difference, at many places, of the quarters' models from one by the light at the
//! square's own corners. Three things could fool it. All models may agree by chance: the claim is the largest difference of the
//! whole square, where few places are right by chance. Beside a sphere that cuts this one, light may not go with the cosine as
//! nodes say: the claim is at least a part of what one node's expansion misses at another. Spheres may be so small and close
//! that they darken only what lies between nodes: then the square claims what they may.

use glam::{DVec2, DVec3};

use super::light::{NodeLight, Shares};
use super::model::Model;
use super::square::{Node, Square, point};
use crate::model::sphere::Sphere;

/// What is claimed of what expansions by cosines miss. Of the 286,705 pixels of a picture of 1,000 spheres that cut each other,
/// 3 beside each other were off by more than they claimed at 1e-2, by up to 1.5 of that; with 0.07, and 0.7 of differences, 13.
const OF_EXPANSIONS: f64 = 0.1;

/// Places along a side of a quarter at which models are compared, its corners among them.
const PLACES: usize = 4;

/// The light on a square.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    /// Those of its quarters, row by row.
    models: [Model; 4],
    pub(crate) claim: f64,
}

impl Patch {
    /// That of a square, from the light at its nodes, and from what small spheres may darken between nodes.
    pub(crate) fn new(
        square: &Square,
        of_small_spheres: f64,
        spheres: &[Sphere],
        light: &mut dyn FnMut(&Node) -> NodeLight,
    ) -> Self {
        let mut lights = [[NodeLight::default(); 3]; 3];
        for (row, lights) in lights.iter_mut().enumerate() {
            for (col, known) in lights.iter_mut().enumerate() {
                *known = light(&square.node(row, col));
            }
        }
        let corners = |[row, col]: [usize; 2], apart: usize| {
            let [low, high] = [&lights[row], &lights[row + apart]];
            [low[col], low[col + apart], high[col], high[col + apart]]
        };
        let whole = Model::new(square, &corners([0, 0], 2), spheres);
        let own = &spheres[square.sphere as usize];
        let mut claim = of_small_spheres;
        let models = std::array::from_fn(|number| {
            let (row, col) = (number / 2, number % 2);
            let quarter = square.quarter(row, col);
            let model = Model::new(&quarter, &corners([row, col], 1), spheres);
            for place in 0..PLACES * PLACES {
                let place = DVec2::new((place % PLACES) as f64, (place / PLACES) as f64);
                let place = place / (PLACES - 1) as f64;
                let position = point(own, quarter.normal(place));
                let in_square = (place + DVec2::new(col as f64, row as f64)) * 0.5;
                let by_quarter = model.at(place, position, spheres);
                let apart = by_quarter - whole.at(in_square, position, spheres);
                claim = claim.max(apart.abs().max_element());
            }
            claim = claim.max(OF_EXPANSIONS * model.doubt);
            model
        });
        Self { models, claim }
    }

    /// The light at a place from 0 to 1 along either side, and at this position in the world.
    pub(crate) fn at(&self, at: DVec2, position: DVec3, spheres: &[Sphere]) -> Shares {
        let (number, place) = quarter_of(at);
        self.models[number].at(place, position, spheres)
    }
}

/// The quarter of a square in which a place is, and the place from 0 to 1 along either side of the quarter.
fn quarter_of(at: DVec2) -> (usize, DVec2) {
    let (col, row) = (usize::from(at.x >= 0.5), usize::from(at.y >= 0.5));
    (2 * row + col, at * 2.0 - DVec2::new(col as f64, row as f64))
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

    /// A function of the place on the face across x, and its derivatives along both sides.
    type OfFace = dyn Fn(DVec2) -> (f64, DVec2);

    fn on_face(normal: DVec3) -> DVec2 {
        DVec2::new(normal.y, normal.z) / normal.x
    }

    /// The derivative by the normal.
    fn by_normal(normal: DVec3, slope: DVec2) -> DVec3 {
        let at = on_face(normal);
        DVec3::new(-at.dot(slope), slope.x, slope.y) / normal.x
    }

    /// The patch of light that is the first function, and the second one times the cosine of the other sphere.
    fn patch(square: &Square, of: &OfFace, by_cosine: &OfFace) -> Patch {
        let spheres = spheres();
        let mut nodes = |node: &Node| {
            let normal = node.normal();
            let (height, cosine) = height_and_cosine(&spheres[1], normal);
            let (value, change) = of(on_face(normal));
            let (slope, change_of_slope) = by_cosine(on_face(normal));
            let mut light = NodeLight {
                shares: Shares::new(value + slope * cosine, 0.0),
                ..NodeLight::default()
            };
            light.by_normal[0] = by_normal(normal, change + change_of_slope * cosine);
            let slope = Slope {
                sphere: Some(1),
                height: height as f32,
                by_cosine: Shares::new(slope, 0.0),
                twice_by_cosine: Shares::ZERO,
            };
            light.add(slope, [DVec3::ZERO; 2], (normal, 1.0), &spheres);
            light
        };
        Patch::new(square, 0.0, &spheres, &mut nodes)
    }

    fn at(patch: &Patch, at: DVec2, normal: DVec3) -> f64 {
        patch.at(at, normal, &spheres()).x
    }

    #[test]
    fn functions_of_third_degree_are_exact_beside_another_sphere_too() {
        let of = |DVec2 { x, y }: DVec2| {
            let value = 0.4 + x - 0.5 * y + 0.3 * x * y - 0.2 * x * x + 0.1 * x * x * y;
            let along = 1.0 + 0.3 * y - 0.4 * x + 0.2 * x * y;
            (value, DVec2::new(along, -0.5 + 0.3 * x + 0.1 * x * x))
        };
        let by_cosine = |at: DVec2| {
            let value = 0.2 - 0.3 * at.x + 0.1 * at.x * at.y;
            (value, DVec2::new(-0.3 + 0.1 * at.y, 0.1 * at.x))
        };
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
            let light = of(turned).0 + by_cosine(turned).0 * cosine;
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
            let across = DVec2::new(libm::cos(angle), libm::sin(angle));
            let from = 0.3 * libm::sin(7.0 * angle);
            // Light that goes with a square root of which nothing is known.
            let of = move |at: DVec2| {
                let root = (at.dot(across) - from).max(0.0).sqrt();
                let slope = if root > 0.0 { 0.25 / root } else { 0.0 };
                (0.3 + 0.5 * root, across * slope)
            };
            let square = Square::around(0, DVec3::new(0.9, 0.1, 0.2), 2 + number % 4);
            let patch = patch(&square, &of, &|_| (0.0, DVec2::ZERO));
            let (mut error, mut claim) = (0.0, 0.0);
            for index in 0..SIDE * SIDE {
                let place = DVec2::new((index % SIDE) as f64, (index / SIDE) as f64);
                let place = (place + 0.5) / SIDE as f64;
                let normal = square.normal(place);
                claim += patch.claim;
                error += at(&patch, place, normal) - of(on_face(normal)).0;
            }
            assert!(error.abs() <= claim + 1e-12, "{number}: {error} {claim}");
        }
    }
}
