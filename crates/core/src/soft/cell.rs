//! The average of soft light over a cell: a pixel, or a part of one.
//!
//! A cell inside one sphere takes the light at its corners and in its middle. Any other is cut into horizontal lines, on
//! which what is seen is known exactly. A sun is integrated along these lines (`strips.rs`), and so it is in a cell inside one
//! sphere where edges of its penumbrae are narrow; the light of a sky on each piece of a cell is that of a plane through some
//! points. Cells that claim the most are divided.
//!
//! # Accuracy
//! All claims are estimates. What could fool them are changes of light between points: [`Light::doubt`] finds shadows of
//! suns that are narrower than a cell, small spheres right above it, narrow highlights and fine bumps, and has such cells
//! divided.

use glam::DVec2;

use super::candidate::Candidate;
use super::heights::{add_crossings, heights};
use super::line::{Span, spans};
use super::piece::{Piece, mean_of_fit};
use super::rectangle::{Cell, Contents, Integral, Light};
use super::seam::Seam;
use super::strips::Strips;
use crate::model::camera::Projection;
use crate::model::color::Color;
use crate::numeric::jacobi::JacobiRule;

/// The claim of a cell inside one sphere, in parts of what the light in its middle differs from the mean of its corners, of
/// what the means of its diagonals differ, and of what any corner differs from the middle.
const OF_BEND: f64 = 1.0;
const OF_TWIST: f64 = 0.125;
const OF_SLOPE: f64 = 0.03;

/// The parts of a pixel that are divided together: those that claim at least this part of the largest claim. Not tuned.
const WORST: f64 = 0.25;

/// How often a pixel is halved at most.
const MOST_DIVISIONS: u32 = 30;

/// Lines across a strip of a cell.
const LINES: usize = 8;
const FEW_LINES: usize = 4;

/// Light at a place.
#[derive(Clone, Copy, Debug)]
struct Known {
    sphere: usize,
    at: DVec2,
    light: Option<Color>,
}

/// The places of light that is known.
const KNOWN: usize = 1 << 11;

/// The rules by which lines are summed, and memory.
#[derive(Debug)]
pub(crate) struct Cells {
    /// Nodes from 0 to 1, and their weights.
    rule: [(f64, f64); LINES],
    few: [(f64, f64); FEW_LINES],
    ends: Vec<f64>,
    spans: Vec<Span>,
    strips: Strips,
    seams: Vec<Seam>,
    /// The light at corners and middles, which cells have in common: at each place the last of those that belong there.
    known: Vec<Option<Known>>,
    /// Points of light that were computed, and cells in which some sphere may be seen.
    pub(crate) points: u64,
}

impl Default for Cells {
    fn default() -> Self {
        Self {
            rule: smooth_rule(),
            few: smooth_rule(),
            ends: Vec::new(),
            spans: Vec::new(),
            strips: Strips::default(),
            seams: Vec::new(),
            known: vec![None; KNOWN],
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
        let candidates: Vec<Candidate> = candidates.copied().collect();
        self.points += u64::from(!candidates.is_empty());
        let integral = match &candidates[..] {
            [] => Integral::default(),
            [only] if only.fills(cell.u, cell.v, projection) => {
                match light.contents(only, &cell, 0) {
                    Contents::Dark => Integral::default(),
                    Contents::Edges { .. } => {
                        self.in_strips(light, (&cell, projection), &candidates, limit)
                    }
                    contents => {
                        let smooth = self.filled(light, only, &cell, contents);
                        if smooth.error <= limit || matches!(contents, Contents::Unknown) {
                            smooth
                        } else {
                            self.in_strips(light, (&cell, projection), &candidates, limit)
                        }
                    }
                }
            }
            several => match light.contents(&several[0], &cell, 0) {
                Contents::Unknown => self.mixed(light, several, &cell, projection),
                _ => self.in_strips(light, (&cell, projection), several, limit),
            },
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
        contents: Contents,
    ) -> Integral {
        let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
        let corners = corners.map(|(right, top)| DVec2::new(cell.u[right], cell.v[top]));
        let mut colors = [Color::ZERO; 4];
        let mut is_missed = false;
        for (corner, color) in corners.into_iter().zip(&mut colors) {
            match self.known_at(light, sphere, corner) {
                Some(found) => *color = found,
                None => is_missed = true,
            }
        }
        let middle = self.known_at(light, sphere, cell.middle());
        let center = middle.unwrap_or_default();
        let diagonals = [colors[0] + colors[3], colors[1] + colors[2]].map(|sum| sum * 0.5);
        let mean = (diagonals[0] + diagonals[1]) * 0.5;
        let range = colors.into_iter().map(|color| (color - center).abs());
        let range = range.fold(Color::ZERO, Color::max);
        let error = (mean - center).abs() * OF_BEND
            + (diagonals[0] - diagonals[1]).abs() * OF_TWIST
            + range * OF_SLOPE;
        let mut error = error.max_element();
        let area = cell.area();
        if is_missed || middle.is_none() {
            error = light.brightest();
        }
        let mut doubt = light.doubt(sphere, cell, 1.0);
        if let Contents::Smooth { doubt: of_light } = contents {
            doubt = doubt.max(of_light);
        }
        Integral {
            value: (mean + center * 2.0) * (area / 3.0),
            error: error.max(doubt) * area,
        }
    }

    fn known_at(&mut self, light: &mut dyn Light, sphere: &Candidate, at: DVec2) -> Option<Color> {
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
            seams,
            ..
        } = self;
        Seam::all(candidates, seams);
        let mut heights = heights(
            (candidates, seams),
            (cell.u, cell.v),
            projection,
            (ends, found),
            |_, _, _| {},
        );
        add_crossings(&mut heights, |v| {
            spans((candidates, seams), cell.u, v, projection, ends, found);
            let places = found
                .iter()
                .map(|span| span.seen.map_or(0, |place| place + 1));
            places.fold(0, |pattern: usize, place| {
                pattern.wrapping_mul(31).wrapping_add(place)
            })
        });
        let mut of = |place: usize, act: &mut dyn FnMut(&mut Piece)| {
            let known = pieces.iter().position(|piece| piece.place == place);
            let index = known.unwrap_or_else(|| {
                pieces.push(Piece::new(place));
                pieces.len() - 1
            });
            act(&mut pieces[index]);
        };
        for ends_of_strip in heights.windows(2) {
            let (low, height) = (ends_of_strip[0].v, ends_of_strip[1].v - ends_of_strip[0].v);
            for (node, weight) in &*rule {
                let v = low + height * *node;
                spans((candidates, seams), cell.u, v, projection, ends, found);
                for Span { begin, end, seen } in &*found {
                    if let Some(place) = *seen {
                        let weight = height * *weight;
                        of(place, &mut |piece| piece.add(v, [*begin, *end], weight));
                    }
                }
            }
            for (node, weight) in &*few {
                spans(
                    (candidates, seams),
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
        let mut nodes = piece.nodes();
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
        let doubt = light.doubt(candidate, cell, 1.0);
        Integral {
            value: mean * piece.area,
            error: error.max(doubt) * piece.area
                + (piece.area - piece.rough_area).abs() * brightest,
        }
    }
}
