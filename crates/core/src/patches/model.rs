//! The light between nodes.
//!
//! Where a sphere touches another or leaves it, light goes with the square root of the distance: with the cosine c of the angle
//! under which the other one is seen, by which its derivatives are known. So light is a(x) + Σ (b(x) c(x) + d(x) c(x)²), with
//! such a sum over near spheres. The cosines c are known anywhere; b and d are linear between what they are at nodes, along both
//! sides; a goes through what it is at nodes, and has its derivatives there.
//!
//! Source of the surface through values and derivatives at four corners: Coons, "Surfaces for Computer-Aided Design of Space
//! Forms" (1967), with cubic curves along the sides. Polynomials of the third degree are exact.

use glam::{DVec2, DVec3};

use super::light::{FAR, NodeLight, Shares, cosine_by_normal, height_and_cosine};
use super::square::{Square, point};
use crate::model::sphere::Sphere;

/// The corners of a square, from 0 to 1 along either side.
const CORNERS: [DVec2; 4] = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE];

/// The light of a square.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    corners: [Smooth; 4],
    roots: Vec<Root>,
    /// How much expansions by cosines differ between corners.
    pub(crate) doubt: f64,
}

/// The light that does not go with cosines, and its derivatives along both sides.
#[derive(Clone, Copy, Debug, Default)]
struct Smooth {
    value: Shares,
    along: Shares,
    across: Shares,
}

/// The light that goes with the cosine c of a sphere: b c + d c² with b and d at the corners.
#[derive(Clone, Debug)]
struct Root {
    sphere: u32,
    linear: [Shares; 4],
    quadratic: [Shares; 4],
}

/// What the ends 0 and 1 of an interval weigh at a place: their values and their slopes of a cubic polynomial, and their values
/// of a linear one.
#[derive(Clone, Copy, Debug)]
struct Weights {
    values: DVec2,
    slopes: DVec2,
    linear: DVec2,
}

impl Weights {
    fn new(at: f64) -> Self {
        let to_end = 1.0 - at;
        Self {
            values: DVec2::new(
                (1.0 + 2.0 * at) * to_end * to_end,
                (3.0 - 2.0 * at) * at * at,
            ),
            slopes: DVec2::new(at * to_end * to_end, -at * at * to_end),
            linear: DVec2::new(to_end, at),
        }
    }
}

/// The sum of what corners know, by weights along both sides.
fn sum(corners: &[Smooth; 4], along: &Weights, across: &Weights) -> Shares {
    let mut sum = Shares::ZERO;
    for (number, corner) in corners.iter().enumerate() {
        let (col, row) = (number % 2, number / 2);
        let (right, up) = (along.linear[col], across.linear[row]);
        sum += corner.value * (along.values[col] * up + right * (across.values[row] - up))
            + corner.along * (along.slopes[col] * up)
            + corner.across * (right * across.slopes[row]);
    }
    sum
}

/// What is linear along both sides between corners, and its derivatives.
fn between(corners: &[Shares; 4], at: DVec2) -> Smooth {
    let [first, right, up, last] = *corners;
    let (below, above) = (first.lerp(right, at.x), up.lerp(last, at.x));
    Smooth {
        value: below.lerp(above, at.y),
        along: (right - first).lerp(last - up, at.y),
        across: above - below,
    }
}

impl Root {
    /// Its light at a place where the cosine is known, and how that changes with the place while the cosine stays what it is.
    fn at(&self, at: DVec2, cosine: f64) -> Smooth {
        let (linear, quadratic) = (between(&self.linear, at), between(&self.quadratic, at));
        let of = |linear: Shares, quadratic: Shares| (linear + quadratic * cosine) * cosine;
        Smooth {
            value: of(linear.value, quadratic.value),
            along: of(linear.along, quadratic.along),
            across: of(linear.across, quadratic.across),
        }
    }
}

impl Model {
    /// That of a square, from the light at its corners.
    pub(crate) fn new(square: &Square, lights: &[NodeLight; 4], spheres: &[Sphere]) -> Self {
        /// Higher above a sphere, in parts of the chord from the middle of the square to a corner, light is smooth enough.
        /// Not tuned.
        const HIGHEST: f64 = 4.0;
        let own = &spheres[square.sphere as usize];
        let (_, chord) = square.extent();
        let highest = HIGHEST * chord * own.radius();
        let mut model = Self {
            corners: [Smooth::default(); 4],
            roots: Vec::new(),
            doubt: 0.0,
        };
        let mut tried = Vec::new();
        for light in lights {
            for slope in &light.slopes {
                let Some(sphere) = slope.sphere else { break };
                if f64::from(slope.height) < highest && !tried.contains(&sphere) {
                    tried.push(sphere);
                    model.add(square, lights, spheres, sphere);
                }
            }
        }
        for (number, light) in lights.iter().enumerate() {
            model.corners[number] = model.smooth(square, CORNERS[number], light, spheres);
        }
        model
    }

    /// Separates the light that goes with the cosine of a sphere, if all corners know it.
    fn add(&mut self, square: &Square, lights: &[NodeLight; 4], spheres: &[Sphere], sphere: u32) {
        let own = &spheres[square.sphere as usize];
        let mut root = Root {
            sphere,
            linear: [Shares::ZERO; 4],
            quadratic: [Shares::ZERO; 4],
        };
        let mut cosines = [0.0; 4];
        let mut slopes = [FAR; 4];
        for (number, light) in lights.iter().enumerate() {
            let position = point(own, square.normal(CORNERS[number]));
            let (height, cosine) = height_and_cosine(&spheres[sphere as usize], position);
            let Some(slope) = light.slope(sphere, height) else {
                return;
            };
            root.linear[number] = slope.by_cosine - slope.twice_by_cosine * cosine;
            root.quadratic[number] = slope.twice_by_cosine * 0.5;
            (cosines[number], slopes[number]) = (cosine, slope);
        }
        self.roots.push(root);
        // What one corner expects of the light at another, and what that one knows.
        let mut doubt: f64 = 0.0;
        for (cosine, slope) in cosines.iter().zip(&slopes) {
            for (other, at_other) in cosines.iter().zip(&slopes) {
                let step = other - cosine;
                let expected = slope.by_cosine + slope.twice_by_cosine * step;
                let missed = (at_other.by_cosine - expected) * step;
                doubt = doubt.max(missed.abs().max_element());
            }
        }
        self.doubt += doubt;
    }

    /// What the node at a corner knows of the light that does not go with cosines.
    fn smooth(&self, square: &Square, at: DVec2, light: &NodeLight, spheres: &[Sphere]) -> Smooth {
        let own = &spheres[square.sphere as usize];
        let position = point(own, square.normal(at));
        let tangents = square.tangents(at);
        let mut smooth = Smooth {
            value: light.shares,
            ..Smooth::default()
        };
        let mut turn = |by_normal: &dyn Fn(DVec3) -> Shares| {
            smooth.along += by_normal(tangents[0]);
            smooth.across += by_normal(tangents[1]);
        };
        turn(&|along| Shares::new(light.by_normal[0].dot(along), light.by_normal[1].dot(along)));
        for slope in &light.slopes {
            let Some(sphere) = slope.sphere else { break };
            let other = &spheres[sphere as usize];
            let has_root = self.roots.iter().any(|root| root.sphere == sphere);
            if !has_root {
                let cosine = cosine_by_normal(own.radius(), other, position);
                turn(&|along| slope.by_cosine * cosine.dot(along));
            }
        }
        for root in &self.roots {
            let (_, cosine) = height_and_cosine(&spheres[root.sphere as usize], position);
            let light = root.at(at, cosine);
            smooth.value -= light.value;
            smooth.along -= light.along;
            smooth.across -= light.across;
        }
        smooth
    }

    /// The light at a place from 0 to 1 along either side, and at this position in the world.
    pub(crate) fn at(&self, at: DVec2, position: DVec3, spheres: &[Sphere]) -> Shares {
        let mut light = sum(&self.corners, &Weights::new(at.x), &Weights::new(at.y));
        for root in &self.roots {
            let (_, cosine) = height_and_cosine(&spheres[root.sphere as usize], position);
            light += root.at(at, cosine).value;
        }
        light
    }
}
