//! The average of soft light over a cell: a pixel, or a part of one.
//!
//! A cell inside one sphere takes the light at its corners and in its middle. Any other is cut into horizontal lines, on
//! which what is seen is known exactly (`strips.rs`), and so is a cell inside one sphere where edges of a sun's penumbrae are
//! narrow. Cells that claim the most are divided.
//!
//! # Accuracy
//! All claims are estimates. What could fool them are changes of light between points: [`Light::doubt`] finds shadows of
//! suns that are narrower than a cell, small spheres right above it, narrow highlights and fine bumps, and has such cells
//! divided.

use glam::DVec2;

use super::behind::remove_hidden;
use super::candidate::Candidate;
use super::rectangle::{Cell, Contents, Integral, Light, Lit};
use super::strips::Strips;
use crate::model::camera::Projection;
use crate::model::color::Color;
use crate::numeric::pair::both;

/// The claim of a cell inside one sphere, in parts of what the light in its middle differs from the mean of its corners, of
/// what the means of its diagonals differ, and of what any corner differs from the middle.
const OF_BEND: f64 = 1.0;
const OF_TWIST: f64 = 0.125;
const OF_SLOPE: f64 = 0.03;

/// The parts of a pixel that are divided together: those that claim at least this part of the largest claim. Not tuned.
const WORST: f64 = 0.25;

/// How often a pixel is halved at most.
const MOST_DIVISIONS: u32 = 30;

/// Light at a place.
#[derive(Clone, Copy, Debug)]
struct Known {
    sphere: usize,
    at: DVec2,
    light: Option<Lit>,
}

/// The places of light that is known.
const KNOWN: usize = 1 << 11;

/// Memory.
#[derive(Debug)]
pub(crate) struct Cells {
    strips: Strips,
    /// The light at corners and middles, which cells have in common: at each place the last of those that belong there.
    known: Vec<Option<Known>>,
    /// Points of light that were computed, and cells in which some sphere may be seen.
    pub(crate) points: u64,
}

impl Default for Cells {
    fn default() -> Self {
        Self {
            strips: Strips::default(),
            known: vec![None; KNOWN],
            points: 0,
        }
    }
}

/// A part of a pixel that may be divided.
struct Part {
    cell: Cell,
    candidates: Vec<Candidate>,
    integral: Integral,
}

impl Cells {
    /// Forgets the light of another tile, or another light.
    pub(crate) fn begin(&mut self) {
        self.known.fill(None);
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
        let limit = tolerance * area;
        let mut parts = vec![self.part(light, (cell, projection), candidates, limit)];
        let mut divided = Vec::new();
        for _ in 0..MOST_DIVISIONS {
            let errors = || parts.iter().map(|part| part.integral.error);
            if errors().sum::<f64>() <= limit || self.points >= last {
                break;
            }
            let least = errors().fold(0.0, f64::max) * WORST;
            for part in parts.drain(..) {
                if part.integral.error < least || self.points >= last {
                    divided.push(part);
                    continue;
                }
                for quarter in part.cell.quarters() {
                    let limit = 0.25 * least;
                    divided.push(self.part(light, (quarter, projection), &part.candidates, limit));
                }
            }
            std::mem::swap(&mut parts, &mut divided);
        }
        let mut average = Integral::default();
        for part in &parts {
            average.value += part.integral.value / area;
            average.error += part.integral.error / area;
        }
        average
    }

    /// The integral over a part of a pixel; rules that cost more are tried while its error is above a limit.
    fn part(
        &mut self,
        light: &mut dyn Light,
        (cell, projection): (Cell, Projection),
        candidates: &[Candidate],
        limit: f64,
    ) -> Part {
        let candidates = candidates
            .iter()
            .filter(|candidate| light.may_see(candidate, &cell));
        let mut candidates: Vec<Candidate> = candidates.copied().collect();
        remove_hidden(&mut candidates, &cell, projection);
        self.points += u64::from(!candidates.is_empty());
        let integral = match &candidates[..] {
            [] => Integral::default(),
            [only] if only.fills(cell.u, cell.v, projection) => {
                match light.contents(only, &cell, 0) {
                    Contents::Dark => Integral::default(),
                    Contents::Edges { .. } => {
                        self.in_strips(light, (&cell, projection), &candidates, limit)
                    }
                    Contents::Smooth { doubt } => {
                        let smooth = self.filled(light, only, &cell, doubt);
                        if smooth.error <= limit {
                            smooth
                        } else {
                            self.in_strips(light, (&cell, projection), &candidates, limit)
                        }
                    }
                }
            }
            several => self.in_strips(light, (&cell, projection), several, limit),
        };
        Part {
            cell,
            candidates,
            integral,
        }
    }

    fn in_strips(
        &mut self,
        light: &mut dyn Light,
        of: (&Cell, Projection),
        candidates: &[Candidate],
        limit: f64,
    ) -> Integral {
        let before = self.strips.points;
        let integral = self.strips.integral(light, of, candidates, limit);
        self.points += self.strips.points - before;
        integral
    }

    /// The integral over a cell inside one sphere.
    ///
    /// With the mean T of the light at the corners and C in the middle it is (T + 2 C)/3 of the area. Of a function that is
    /// convex, or concave, the average lies between C and T.
    ///
    /// The claim is as much as that allows, and parts of other differences, which bends along several lines leave. Their
    /// factors are from searches: with none of them 1 pixel in 1000 was off by more than it claimed.
    fn filled(
        &mut self,
        light: &mut dyn Light,
        sphere: &Candidate,
        cell: &Cell,
        doubt: f64,
    ) -> Integral {
        let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
        let corners = corners.map(|(right, top)| DVec2::new(cell.u[right], cell.v[top]));
        let mut claim: f64 = 0.0;
        let mut light_at = |at: DVec2| match self.known_at(light, sphere, at) {
            Some(Lit { light, error }) => {
                claim = claim.max(error);
                light
            }
            None => {
                claim = f64::INFINITY;
                Color::ZERO
            }
        };
        let colors = corners.map(&mut light_at);
        let center = light_at(cell.middle());
        let diagonals = both([colors[0] + colors[3], colors[1] + colors[2]], |sum| {
            sum * 0.5
        });
        let mean = (diagonals[0] + diagonals[1]) * 0.5;
        let range = colors.into_iter().map(|color| (color - center).abs());
        let range = range.fold(Color::ZERO, Color::max);
        let error = (mean - center).abs() * OF_BEND
            + (diagonals[0] - diagonals[1]).abs() * OF_TWIST
            + range * OF_SLOPE;
        let error = (error.max_element() + claim).min(light.brightest());
        let doubt = doubt.max(light.doubt(sphere, cell, 1.0));
        let area = cell.area();
        Integral {
            value: (mean + center * 2.0) * (area / 3.0),
            error: error.max(doubt) * area,
        }
    }

    fn known_at(&mut self, light: &mut dyn Light, sphere: &Candidate, at: DVec2) -> Option<Lit> {
        if !light.is_shared(sphere) {
            self.points += 1;
            return light.at(sphere, at);
        }
        let hash = (sphere.sphere as u64)
            .wrapping_add(at.x.to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15))
            .wrapping_add(at.y.to_bits().rotate_left(32))
            .wrapping_mul(0xff51_afd7_ed55_8ccd);
        let place = (hash >> 32) as usize % KNOWN;
        if let Some(known) = &self.known[place]
            && known.sphere == sphere.sphere
            && known.at == at
        {
            return known.light;
        }
        self.points += 1;
        let light = light.at(sphere, at);
        self.known[place] = Some(Known {
            sphere: sphere.sphere,
            at,
            light,
        });
        light
    }
}
