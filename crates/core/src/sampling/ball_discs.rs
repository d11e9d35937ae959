//! The discs that may darken the balls of a tile, in worlds too large to keep those of their spheres.

use super::tile_balls::TileBall;
use crate::search::discs::Disc;
use crate::search::light_grid::Found;
use crate::search::visibility::Visibility;

/// The discs before the balls of a tile, for each light, once somebody asked for them.
pub(super) struct BallDiscs {
    /// The number of lights.
    lights: usize,
    /// For each ball and light.
    known: Vec<Before>,
    discs: Vec<Disc>,
    /// Memory to work in.
    found: Found,
}

/// The discs that may keep a light from a ball, as a range of all discs.
#[derive(Clone, Copy, Debug)]
enum Before {
    Unasked,
    Discs(u32, u32),
    /// Too many, or not known well.
    Unknown,
}

impl BallDiscs {
    /// Nothing is known yet.
    pub(super) fn new(lights: usize) -> Self {
        Self {
            lights,
            known: Vec::new(),
            discs: Vec::new(),
            found: Found::default(),
        }
    }

    /// The discs before a ball, if they are known.
    #[inline(always)]
    pub(super) fn of(&self, light: usize, ball: &TileBall) -> Option<&[Disc]> {
        match self.known.get(self.place(light, ball)) {
            Some(&Before::Discs(first, end)) => Some(&self.discs[first as usize..end as usize]),
            _ => None,
        }
    }

    /// Finds the discs before a ball, unless it was asked about before; returns whether they are known.
    pub(super) fn find(
        &mut self,
        visibility: &Visibility<'_>,
        light: usize,
        ball: &TileBall,
    ) -> bool {
        let Some(grid) = visibility.light(light).grid() else {
            return false;
        };
        let place = self.place(light, ball);
        if place >= self.known.len() {
            self.known.resize(place + 1, Before::Unasked);
        }
        if let Before::Unasked = self.known[place] {
            let first = self.discs.len();
            let (spheres, index) = (visibility.spheres(), ball.index());
            let is_found = grid.discs_before(spheres, index, &mut self.found, &mut self.discs);
            self.known[place] = if is_found {
                Before::Discs(first as u32, self.discs.len() as u32)
            } else {
                self.discs.truncate(first);
                Before::Unknown
            };
        }
        matches!(self.known[place], Before::Discs(..))
    }

    /// The place of what is known.
    fn place(&self, light: usize, ball: &TileBall) -> usize {
        ball.place as usize * self.lights + light
    }
}
