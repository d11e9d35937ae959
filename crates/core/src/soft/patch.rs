//! The light of a sky on a square of a sphere.
//!
//! Light is computed at nodes, which squares have in common. Between 3 × 3 of them it is that of the polynomial of second degree
//! in both directions.
//!
//! # Accuracy
//! The claim is an estimate: by how much the polynomial of the square that this one is a quarter of misses the nodes between
//! its own. With half of their distance the error is at most about as large where light has an edge, and an eighth where it is
//! smooth; the parent's own claim tells which. What lies between the nodes could fool it: small spheres that are so close that
//! they darken no more than that; then the square claims what they may.

use glam::DVec2;

use super::sky::Shares;
use super::square::Square;

/// Nodes along a side.
const SIDE: usize = 3;

/// The claim of a square, in parts of what its parent misses: of that the share that the parent's parent missed, times the
/// first number, but not less than the second. From searches.
const OF_SHRINKING: f64 = 1.5;
const LEAST: f64 = 0.25;

/// The light at the nodes of a square, as shares of that of the sky's halves, row by row.
pub(crate) type Grid = [[Shares; SIDE]; SIDE];

/// The light on a square.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    shares: Grid,
    /// What is claimed near the nodes.
    claims: [[f64; SIDE]; SIDE],
}

/// The weights of three values at 0, ½ and 1.
fn weights(at: f64) -> [f64; 3] {
    let (from_middle, to_end) = (2.0 * at - 1.0, 1.0 - at);
    [-from_middle * to_end, 4.0 * at * to_end, at * from_middle]
}

/// The place of a node, from 0 to 1 along either side.
fn place(row: usize, col: usize) -> DVec2 {
    DVec2::new(col as f64, row as f64) / (SIDE - 1) as f64
}

/// The polynomial through the light at nodes, at a place from 0 to 1 along either side.
fn polynomial(shares: &Grid, at: DVec2) -> Shares {
    let (along, across) = (weights(at.x), weights(at.y));
    let mut sum = Shares::ZERO;
    for (row, across) in shares.iter().zip(across) {
        for (value, along) in row.iter().zip(along) {
            sum += *value * (along * across);
        }
    }
    sum
}

/// What the parent of a square misses at its nodes.
fn missed(square: &Square, shares: &Grid, parent: &Grid) -> [[f64; SIDE]; SIDE] {
    let mut missed = [[0.0; SIDE]; SIDE];
    for row in 0..SIDE {
        for col in 0..SIDE {
            let by_parent = polynomial(parent, square.in_parent(place(row, col)));
            missed[row][col] = (shares[row][col] - by_parent).abs().max_element();
        }
    }
    // The corners are nodes of the parent, and tell nothing.
    for (row, col) in [(0, 0), (0, 2), (2, 0), (2, 2)] {
        missed[row][col] = f64::max(missed[1][col], missed[row][1]);
    }
    missed
}

/// The largest of some numbers.
fn largest(of: &[[f64; SIDE]; SIDE]) -> f64 {
    of.as_flattened().iter().copied().fold(0.0, f64::max)
}

impl Patch {
    /// That of a square, from the light at its nodes, at those of its parent, and of the parent's parent, and from what small
    /// spheres may darken between nodes.
    pub(crate) fn new(
        square: &Square,
        of_small_spheres: f64,
        mut light: impl FnMut(&Square) -> Grid,
    ) -> Self {
        let shares = light(square);
        let mut claims = [[1.0; SIDE]; SIDE];
        if let Some(parent) = square.parent() {
            let of_parent = light(&parent);
            claims = missed(square, &shares, &of_parent);
            if let Some(above) = parent.parent() {
                let before = largest(&missed(&parent, &of_parent, &light(&above)));
                let shrinking = OF_SHRINKING * largest(&claims) / before;
                // Not a number where nothing is missed.
                let part = shrinking.max(LEAST).min(1.0);
                claims = claims.map(|row| row.map(|missed| missed * part));
            }
        }
        for claim in claims.as_flattened_mut() {
            *claim = claim.max(of_small_spheres);
        }
        Self { shares, claims }
    }

    /// The light at a place from 0 to 1 along either side.
    pub(crate) fn at(&self, at: DVec2) -> Shares {
        polynomial(&self.shares, at)
    }

    /// The claim at a place.
    pub(crate) fn claim_at(&self, at: DVec2) -> f64 {
        let at = at * (SIDE - 1) as f64;
        let before = at.floor().min(DVec2::splat((SIDE - 2) as f64));
        let (col, row) = (before.x as usize, before.y as usize);
        let DVec2 { x, y } = at - before;
        let along = |row: usize| {
            let claims = &self.claims[row];
            claims[col] * (1.0 - x) + claims[col + 1] * x
        };
        along(row) * (1.0 - y) + along(row + 1) * y
    }
}
