//! The light between nodes.
//!
//! Where a sphere touches another or leaves it, light goes with the square root of the distance: with the cosine c of the angle
//! under which the other one is seen, whose derivative is known. So light is a(x) + Σ b(x) c(x), with such a sum over near
//! spheres, where c is known anywhere, and a and b are polynomials through what they are at nodes.

use glam::{DVec2, DVec3};

use super::light::{NodeLight, Shares, height_and_cosine};
use super::square::{Square, point};
use crate::model::sphere::Sphere;

/// Nodes along a side.
pub(crate) const SIDE: usize = 3;

/// What is known at the nodes of a square, row by row.
pub(crate) type Grid<T> = [[T; SIDE]; SIDE];

/// The light of a square.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    smooth: Grid<Shares>,
    roots: Vec<Root>,
}

/// The light that goes with the cosine of a sphere.
#[derive(Clone, Debug)]
struct Root {
    sphere: u32,
    by_cosine: Grid<Shares>,
    /// The largest cosine at a node.
    largest: f64,
}

/// The weights of three values at 0, ½ and 1.
fn weights(at: f64) -> [f64; SIDE] {
    let (from_middle, to_end) = (2.0 * at - 1.0, 1.0 - at);
    [-from_middle * to_end, 4.0 * at * to_end, at * from_middle]
}

/// The place of a node, from 0 to 1 along either side.
pub(crate) fn place(row: usize, col: usize) -> DVec2 {
    DVec2::new(col as f64, row as f64) / (SIDE - 1) as f64
}

/// The polynomial of second degree in both directions through the light at nodes.
fn polynomial(shares: &Grid<Shares>, along: &[f64; SIDE], across: &[f64; SIDE]) -> Shares {
    let mut sum = Shares::ZERO;
    for (row, across) in shares.iter().zip(across) {
        for (value, along) in row.iter().zip(along) {
            sum += *value * (along * across);
        }
    }
    sum
}

/// The largest second difference along rows and columns.
fn bend(shares: &Grid<Shares>) -> f64 {
    let [low, middle, high] = shares;
    let mut bend = Shares::ZERO;
    for row in shares {
        bend = bend.max((row[0] - row[1] * 2.0 + row[2]).abs());
    }
    for ((before, middle), after) in low.iter().zip(middle).zip(high) {
        bend = bend.max((*before - *middle * 2.0 + *after).abs());
    }
    bend.max_element()
}

impl Model {
    /// That of a square, from the light at its nodes.
    pub(crate) fn new(square: &Square, lights: &Grid<NodeLight>, spheres: &[Sphere]) -> Self {
        /// Higher above a sphere, in parts of the chord from the middle of the square to a corner, light is smooth enough.
        /// Not tuned.
        const HIGHEST: f64 = 4.0;
        let own = &spheres[square.sphere as usize];
        let (_, chord) = square.extent();
        let highest = HIGHEST * chord * own.radius();
        let mut model = Self {
            smooth: [[Shares::ZERO; SIDE]; SIDE],
            roots: Vec::new(),
        };
        for (value, light) in model
            .smooth
            .as_flattened_mut()
            .iter_mut()
            .zip(lights.as_flattened())
        {
            *value = light.shares;
        }
        let mut tried = Vec::new();
        for light in lights.as_flattened() {
            for slope in &light.slopes {
                let Some(sphere) = slope.sphere else { break };
                if f64::from(slope.height) < highest && !tried.contains(&sphere) {
                    tried.push(sphere);
                    model.add(square, lights, spheres, sphere);
                }
            }
        }
        model
    }

    /// Separates the light that goes with the cosine of a sphere, if all nodes know it.
    fn add(&mut self, square: &Square, lights: &Grid<NodeLight>, spheres: &[Sphere], sphere: u32) {
        let (own, other) = (&spheres[square.sphere as usize], &spheres[sphere as usize]);
        let mut root = Root {
            sphere,
            by_cosine: [[Shares::ZERO; SIDE]; SIDE],
            largest: 0.0,
        };
        let mut smooth = self.smooth;
        for row in 0..SIDE {
            for col in 0..SIDE {
                let position = point(own, square.normal(place(row, col)));
                let (height, cosine) = height_and_cosine(other, position);
                let Some(slope) = lights[row][col].slope(sphere, height) else {
                    return;
                };
                root.by_cosine[row][col] = slope;
                root.largest = root.largest.max(cosine);
                smooth[row][col] -= slope * cosine;
            }
        }
        self.smooth = smooth;
        self.roots.push(root);
    }

    /// The light at a place from 0 to 1 along either side, and at this position in the world.
    pub(crate) fn at(&self, at: DVec2, position: DVec3, spheres: &[Sphere]) -> Shares {
        let (along, across) = (weights(at.x), weights(at.y));
        let mut sum = polynomial(&self.smooth, &along, &across);
        for root in &self.roots {
            let (_, cosine) = height_and_cosine(&spheres[root.sphere as usize], position);
            sum += polynomial(&root.by_cosine, &along, &across) * cosine;
        }
        sum
    }

    /// How much light bends on the square, but for cosines: the largest second difference of nodes.
    pub(crate) fn bend(&self) -> f64 {
        let of_roots = self
            .roots
            .iter()
            .map(|root| bend(&root.by_cosine) * root.largest);
        bend(&self.smooth) + of_roots.sum::<f64>()
    }
}
