//! Rectangles of the picture, and what is asked about the light in them.

use glam::DVec2;

use super::candidate::Candidate;
use super::curve::Curve;
use super::edges::Break;
use crate::model::color::Color;

/// A rectangle of the picture, where rays have the directions (u, v, 1); parallel rays begin at (u, v, 0).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    pub(crate) u: [f64; 2],
    pub(crate) v: [f64; 2],
}

/// The light of spheres at places of a picture.
pub(crate) trait Light {
    /// The light of a candidate's sphere; none where the ray misses it.
    fn at(&mut self, candidate: &Candidate, place: DVec2) -> Option<Lit>;

    /// A bound or an estimate of the part of the light of a cell that may change without being noticed between points that
    /// are some part of the cell apart.
    fn doubt(&mut self, candidate: &Candidate, cell: &Cell, spacing: f64) -> f64;

    /// A bound of the light of a surface.
    fn brightest(&self) -> f64;

    /// True if a sphere may be seen in a cell.
    fn may_see(&self, candidate: &Candidate, cell: &Cell) -> bool;

    /// False if the light of a candidate at a place differs from pixel to pixel.
    fn is_shared(&self, candidate: &Candidate) -> bool;

    /// What the light on a candidate is like in a cell. Later calls speak of this cell, and give the same `number`.
    fn contents(&mut self, candidate: &Candidate, cell: &Cell, number: usize) -> Contents;

    /// True if light may go with the square root of the distance from seams.
    fn has_roots_at_seams(&self) -> bool {
        false
    }

    /// Adds the places on a curve, from 0 to 1, at which light is not smooth. Returns false if there is no light on it.
    fn add_breaks(
        &mut self,
        _candidate: &Candidate,
        _curve: &Curve,
        _number: usize,
        _breaks: &mut Vec<Break>,
    ) -> bool {
        true
    }

    /// The integral along a curve between sorted breaks; the limit is for its error in parts of the curve's length.
    fn along(
        &mut self,
        of: (&Candidate, usize),
        curve: &Curve,
        breaks: &[Break],
        limit: f64,
    ) -> Along;
}

/// Light at a place.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lit {
    pub(crate) light: Color,
    /// An estimate of its error.
    pub(crate) error: f64,
}

impl Lit {
    /// Adds another light times a weight.
    pub(super) fn add(&mut self, other: Self, weight: f64) {
        self.light += other.light * weight;
        self.error += other.error * weight;
    }
}

/// Light along a curve.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Along {
    pub(crate) integral: Color,
    /// An estimate of its error.
    pub(crate) error: f64,
}

/// What light is like in a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Contents {
    /// There is none.
    Dark,
    /// It is smooth but for changes of a part of the brightest light.
    Smooth { doubt: f64 },
    /// It changes over widths that are small beside the cell: its breaks are to be looked for. What they may miss is a part of
    /// the brightest light.
    Edges { doubt: f64 },
}

/// The integral over a cell, and an estimate of its error.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Integral {
    pub(crate) value: Color,
    pub(crate) error: f64,
}

impl Cell {
    pub(crate) fn area(&self) -> f64 {
        (self.u[1] - self.u[0]) * (self.v[1] - self.v[0])
    }

    pub(crate) fn middle(&self) -> DVec2 {
        DVec2::new(0.5 * (self.u[0] + self.u[1]), 0.5 * (self.v[0] + self.v[1]))
    }

    pub(crate) fn quarters(&self) -> [Self; 4] {
        let DVec2 { x, y } = self.middle();
        let (left, right) = ([self.u[0], x], [x, self.u[1]]);
        let (low, high) = ([self.v[0], y], [y, self.v[1]]);
        let quarter = |u, v| Self { u, v };
        [
            quarter(left, low),
            quarter(right, low),
            quarter(left, high),
            quarter(right, high),
        ]
    }
}
