//! Spheres that have the same light all over a pixel.

use glam::DVec2;

use crate::model::color::Color;
use crate::soft::candidate::Candidate;
use crate::soft::curve::Curve;
use crate::soft::edges::Break;
use crate::soft::rectangle::{Along, Cell, Contents, Light, Lit};
use crate::soft::rule::whole_integral;

/// The mean light of the spheres of a pixel, by their numbers. What is not known of the others is anything up to the brightest
/// light.
#[derive(Debug)]
pub(super) struct Means<'a> {
    pub(super) known: &'a [(usize, Lit)],
    pub(super) brightest: f64,
}

impl Means<'_> {
    fn of(&self, candidate: &Candidate) -> Lit {
        let known = self.known.iter().find(|one| one.0 == candidate.number);
        match known {
            Some(&(_, lit)) => lit,
            None => Lit {
                light: Color::splat(0.5 * self.brightest),
                error: 0.5 * self.brightest,
            },
        }
    }
}

impl Light for Means<'_> {
    fn at(&mut self, candidate: &Candidate, _place: DVec2) -> Option<Lit> {
        Some(self.of(candidate))
    }

    fn doubt(&mut self, _candidate: &Candidate, _cell: &Cell, _spacing: f64) -> f64 {
        0.0
    }

    fn brightest(&self) -> f64 {
        self.brightest
    }

    fn may_see(&self, _candidate: &Candidate, _cell: &Cell) -> bool {
        true
    }

    fn is_shared(&self, _candidate: &Candidate) -> bool {
        false
    }

    fn contents(&mut self, _candidate: &Candidate, _cell: &Cell, _number: usize) -> Contents {
        Contents::Smooth { doubt: 0.0 }
    }

    fn along(
        &mut self,
        (candidate, _): (&Candidate, usize),
        curve: &Curve,
        _breaks: &[Break],
        limit: f64,
    ) -> Along {
        whole_integral(self, candidate, curve, limit)
    }
}
