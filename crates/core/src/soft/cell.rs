//! The average of soft light over a cell: a pixel, or a part of one.
//!
//! A cell inside one sphere takes the light at its corners and in its middle. Any other is cut into horizontal lines, on
//! which what is seen is known exactly; the light on each of its pieces is that of a plane through some points. Cells that
//! claim the most are divided.
//!
//! # Accuracy
//! All claims are estimates. What could fool them are changes of light between points: [`Light::doubt`] finds shadows of
//! suns that are narrower than a cell, small spheres right above it, narrow highlights and fine bumps, and has such cells
//! divided.

use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashMap};

use glam::DVec2;

use super::heights::heights;
use super::line::{Candidate, Span, spans};
use super::piece::{BANDS, Piece, mean_of_fit};
use crate::model::camera::Projection;
use crate::model::color::Color;
use crate::numeric::jacobi::JacobiRule;

/// A rectangle of the picture, where rays have the directions (u, v, 1); parallel rays begin at (u, v, 0).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    pub(crate) u: [f64; 2],
    pub(crate) v: [f64; 2],
}

/// The light of spheres at places of a picture.
pub(crate) trait Light {
    /// The light of a candidate's sphere; none where the ray misses it.
    fn at(&mut self, candidate: &Candidate, place: DVec2) -> Option<Color>;

    /// A bound or an estimate of the part of the light of a cell that may change between points without being noticed.
    fn doubt(&mut self, candidate: &Candidate, cell: &Cell) -> f64;

    /// A bound of the light of a surface.
    fn brightest(&self) -> f64;

    /// True if a sphere may be seen in a cell.
    fn may_see(&self, candidate: &Candidate, cell: &Cell) -> bool;
}

/// The integral over a cell, and an estimate of its error.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Integral {
    pub(crate) value: Color,
    pub(crate) error: f64,
}

/// Lines across a strip of a cell.
const LINES: usize = 8;
const FEW_LINES: usize = 4;

/// The rules by which lines are summed, and memory.
#[derive(Debug)]
pub(crate) struct Cells {
    /// Nodes from 0 to 1, and their weights.
    rule: [(f64, f64); LINES],
    few: [(f64, f64); FEW_LINES],
    ends: Vec<f64>,
    spans: Vec<Span>,
    /// The light at corners and middles, of a sphere at a place, which cells have in common.
    known: HashMap<(usize, u64, u64), Option<Color>>,
    /// Points of light that were computed.
    pub(crate) points: u64,
}

impl Default for Cells {
    fn default() -> Self {
        Self {
            rule: smooth_rule(),
            few: smooth_rule(),
            ends: Vec::new(),
            spans: Vec::new(),
            known: HashMap::new(),
            points: 0,
        }
    }
}

/// Gauss's rule for functions from 0 to 1 that may go with the square root of the distance from either end: with
/// x = s² (3 − 2 s) they are smooth in s.
fn smooth_rule<const NODES: usize>() -> [(f64, f64); NODES] {
    let JacobiRule { nodes, weights } = JacobiRule::<NODES>::new(0.0);
    std::array::from_fn(|index| {
        let s = nodes[index];
        (
            s * s * (3.0 - 2.0 * s),
            weights[index] * 6.0 * s * (1.0 - s),
        )
    })
}

/// A part of a pixel that may be divided.
struct Part {
    cell: Cell,
    candidates: Vec<Candidate>,
    integral: Integral,
}

/// The worst is the greatest; of parts that claim as much, the one that lies first in the picture.
impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        let place = |part: &Self| part.cell.middle();
        let (this, that) = (place(self), place(other));
        let errors = self.integral.error.total_cmp(&other.integral.error);
        errors
            .then(this.y.total_cmp(&that.y))
            .then(this.x.total_cmp(&that.x))
    }
}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Part {}

impl Cell {
    fn area(&self) -> f64 {
        (self.u[1] - self.u[0]) * (self.v[1] - self.v[0])
    }

    pub(crate) fn middle(&self) -> DVec2 {
        DVec2::new(0.5 * (self.u[0] + self.u[1]), 0.5 * (self.v[0] + self.v[1]))
    }

    fn quarters(&self) -> [Self; 4] {
        let DVec2 { x, y } = self.middle();
        let (left, right) = ([self.u[0], x], [x, self.u[1]]);
        let (low, high) = ([self.v[0], y], [y, self.v[1]]);
        [(left, low), (right, low), (left, high), (right, high)].map(|(u, v)| Self { u, v })
    }
}

impl Cells {
    /// Forgets the light of another tile, or another light.
    pub(crate) fn begin(&mut self) {
        self.known.clear();
    }

    /// The average over a pixel to a tolerance, if no more than about `most` points are needed.
    pub(crate) fn average(
        &mut self,
        light: &mut dyn Light,
        (cell, projection): (Cell, Projection),
        candidates: &[Candidate],
        (tolerance, most): (f64, u64),
    ) -> Integral {
        let last = self.points + most;
        let area = cell.area();
        let first = self.part(light, cell, projection, candidates);
        let mut error = first.integral.error;
        let mut parts = BinaryHeap::from([first]);
        while error > tolerance * area && self.points < last {
            let Some(Part {
                cell,
                candidates,
                integral,
            }) = parts.pop()
            else {
                break;
            };
            error -= integral.error;
            for quarter in cell.quarters() {
                let part = self.part(light, quarter, projection, &candidates);
                error += part.integral.error;
                parts.push(part);
            }
        }
        let mut average = Integral::default();
        for part in parts.into_sorted_vec() {
            average.value += part.integral.value / area;
            average.error += part.integral.error / area;
        }
        average
    }

    fn part(
        &mut self,
        light: &mut dyn Light,
        cell: Cell,
        projection: Projection,
        candidates: &[Candidate],
    ) -> Part {
        let candidates = candidates
            .iter()
            .filter(|candidate| light.may_see(candidate, &cell));
        let candidates: Vec<Candidate> = candidates.copied().collect();
        let integral = match &candidates[..] {
            [] => Integral::default(),
            [only] if only.fills(cell.u, cell.v, projection) => self.filled(light, only, &cell),
            several => self.mixed(light, several, &cell, projection),
        };
        Part {
            cell,
            candidates,
            integral,
        }
    }

    /// The integral over a cell inside one sphere.
    ///
    /// With the mean T of the light at the corners and C in the middle it is (T + 2 C)/3 of the area. Of a function that is
    /// convex, or concave, the average lies between C and T.
    fn filled(&mut self, light: &mut dyn Light, sphere: &Candidate, cell: &Cell) -> Integral {
        let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
        let corners = corners.map(|(right, top)| DVec2::new(cell.u[right], cell.v[top]));
        let mut sum = Color::ZERO;
        let mut is_missed = false;
        for corner in corners {
            match self.known_at(light, sphere, corner) {
                Some(color) => sum += color,
                None => is_missed = true,
            }
        }
        let middle = self.known_at(light, sphere, cell.middle());
        let (mean, center) = (sum * 0.25, middle.unwrap_or_default());
        let area = cell.area();
        let mut error = (mean - center).abs().max_element() * (2.0 / 3.0);
        if is_missed || middle.is_none() {
            error = light.brightest();
        }
        Integral {
            value: (mean + center * 2.0) * (area / 3.0),
            error: error.max(light.doubt(sphere, cell)) * area,
        }
    }

    fn known_at(&mut self, light: &mut dyn Light, sphere: &Candidate, at: DVec2) -> Option<Color> {
        let key = (sphere.sphere, at.x.to_bits(), at.y.to_bits());
        if let Some(&known) = self.known.get(&key) {
            return known;
        }
        self.points += 1;
        let found = light.at(sphere, at);
        self.known.insert(key, found);
        found
    }

    /// The integral over any cell.
    fn mixed(
        &mut self,
        light: &mut dyn Light,
        candidates: &[Candidate],
        cell: &Cell,
        projection: Projection,
    ) -> Integral {
        let mut pieces: Vec<Piece> = Vec::new();
        let Self {
            rule,
            few,
            ends,
            spans: found,
            ..
        } = self;
        let heights = heights(candidates, (cell.u, cell.v), projection, (ends, found));
        let mut of = |place: usize, act: &mut dyn FnMut(&mut Piece)| {
            let known = pieces.iter().position(|piece| piece.place == place);
            let index = known.unwrap_or_else(|| {
                pieces.push(Piece::new(place));
                pieces.len() - 1
            });
            act(&mut pieces[index]);
        };
        for ends_of_strip in heights.windows(2) {
            let (low, height) = (ends_of_strip[0], ends_of_strip[1] - ends_of_strip[0]);
            for (node, weight) in &*rule {
                let v = low + height * *node;
                spans(candidates, cell.u, v, projection, ends, found);
                let band = (v - cell.v[0]) / (cell.v[1] - cell.v[0]) * BANDS as f64;
                let band = (band as usize).min(BANDS - 1);
                for Span { begin, end, seen } in &*found {
                    if let Some(place) = *seen {
                        let weight = height * *weight;
                        of(place, &mut |piece| {
                            piece.add(band, v, [*begin, *end], weight)
                        });
                    }
                }
            }
            for (node, weight) in &*few {
                spans(
                    candidates,
                    cell.u,
                    low + height * *node,
                    projection,
                    ends,
                    found,
                );
                for Span { begin, end, seen } in &*found {
                    if let Some(place) = *seen {
                        let area = (end - begin) * height * *weight;
                        of(place, &mut |piece| piece.rough_area += area);
                    }
                }
            }
        }
        let mut sum = Integral::default();
        for piece in &pieces {
            let of_piece = self.piece(light, &candidates[piece.place], piece, cell);
            sum.value += of_piece.value;
            sum.error += of_piece.error;
        }
        sum
    }

    fn piece(
        &mut self,
        light: &mut dyn Light,
        candidate: &Candidate,
        piece: &Piece,
        cell: &Cell,
    ) -> Integral {
        let mut nodes = piece.nodes(cell.u[1] - cell.u[0]);
        if nodes.is_empty() {
            // Only the few lines have met it.
            let error = piece.rough_area * light.brightest();
            return Integral {
                value: Color::ZERO,
                error,
            };
        }
        let mut colors = Vec::with_capacity(nodes.len());
        nodes.retain(|&node| {
            self.points += 1;
            let color = light.at(candidate, node);
            colors.extend(color);
            color.is_some()
        });
        if nodes.is_empty() {
            let error = piece.area * light.brightest();
            return Integral {
                value: Color::ZERO,
                error,
            };
        }
        let (mean, error) = mean_of_fit(piece.moment / piece.area, &nodes, &colors);
        let brightest = mean.abs().max_element().max(error);
        let doubt = light.doubt(candidate, cell);
        Integral {
            value: mean * piece.area,
            error: error.max(doubt) * piece.area
                + (piece.area - piece.rough_area).abs() * brightest,
        }
    }
}
