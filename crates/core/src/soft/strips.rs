//! The average over a cell from lines across it, on which the places are known where light begins to be hidden.

use glam::DVec2;

use super::cell::{Cell, Contents, Integral, Light};
use super::heights::{Height, heights};
use super::line::{Candidate, Span, spans};
use crate::model::camera::Projection;
use crate::model::color::Color;
use crate::numeric::jacobi::JacobiRule;

/// A way from 0 to 1 through an interval, in which functions are smooth that go with the square root of the distance from
/// some of its ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    pub(crate) ends: [f64; 2],
    /// Whether functions go with the square root at the begin, and at the end.
    pub(crate) is_root: [bool; 2],
}

impl Way {
    /// The place in the interval, and by how much it moves where the place on the way does.
    pub(crate) fn at(&self, place: f64) -> (f64, f64) {
        let [begin, end] = self.ends;
        let (share, speed) = match self.is_root {
            [false, false] => (place, 1.0),
            [true, false] => (place * place, 2.0 * place),
            [false, true] => (place * (2.0 - place), 2.0 - 2.0 * place),
            [true, true] => (
                place * place * (3.0 - 2.0 * place),
                6.0 * place * (1.0 - place),
            ),
        };
        (begin + (end - begin) * share, (end - begin) * speed)
    }
}

/// A part of a horizontal or a vertical line of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Curve {
    pub(crate) is_vertical: bool,
    /// The coordinate across it.
    pub(crate) across: f64,
    pub(crate) along: Way,
}

impl Curve {
    /// On a line between two ends at which a candidate is seen.
    fn new(
        is_vertical: bool,
        across: f64,
        ends: [f64; 2],
        candidate: &Candidate,
        projection: Projection,
    ) -> Self {
        /// Less of what a candidate is met by at an end than in the middle means that a contour is near.
        const NEAR: f64 = 0.1;
        let meets = |along: f64| {
            let (u, v) = if is_vertical {
                (across, along)
            } else {
                (along, across)
            };
            candidate.meets(u, v, candidate.radius, projection)
        };
        let limit = NEAR * meets(0.5 * (ends[0] + ends[1]));
        Self {
            is_vertical,
            across,
            along: Way {
                ends,
                is_root: ends.map(|end| meets(end) < limit),
            },
        }
    }

    pub(crate) fn at(&self, place: f64) -> DVec2 {
        let (along, _) = self.along.at(place);
        if self.is_vertical {
            DVec2::new(self.across, along)
        } else {
            DVec2::new(along, self.across)
        }
    }
}

/// A rule for the heights of lines in a strip: nodes from 0 to 1, and their weights.
type Rule = Vec<(f64, f64)>;

/// Rules of lines and memory.
#[derive(Debug)]
pub(crate) struct Strips {
    /// Pairs of rules: a finer one, and a coarser one that it is compared with.
    rules: [[Rule; 2]; 2],
    ends: Vec<f64>,
    spans: Vec<Span>,
    breaks: Vec<f64>,
    contents: Vec<Contents>,
    /// The curves along which light was integrated, in points that cost as much.
    pub(crate) points: u64,
}

impl Default for Strips {
    fn default() -> Self {
        Self {
            rules: [[gauss::<3>(), gauss::<2>()], [gauss::<6>(), gauss::<4>()]],
            ends: Vec::new(),
            spans: Vec::new(),
            breaks: Vec::new(),
            contents: Vec::new(),
            points: 0,
        }
    }
}

fn gauss<const NODES: usize>() -> Rule {
    let JacobiRule { nodes, weights } = JacobiRule::<NODES>::new(0.0);
    nodes.into_iter().zip(weights).collect()
}

/// A curve costs about as much as so many points.
const POINTS_OF_CURVE: u64 = 4;

/// The claim of a rule, in parts of its difference from the coarser one. Not tuned.
const OF_RULES: f64 = 1.0;

impl Strips {
    /// The integral over a cell, to a limit if one of the rules allows it.
    pub(crate) fn integral(
        &mut self,
        light: &mut dyn Light,
        (cell, projection): (&Cell, Projection),
        candidates: &[Candidate],
        limit: f64,
    ) -> Integral {
        self.contents.clear();
        let mut doubt = 0.0_f64;
        for (number, candidate) in candidates.iter().enumerate() {
            let contents = light.contents(candidate, cell, number);
            if !matches!(contents, Contents::Dark) {
                doubt = doubt.max(light.doubt(candidate, cell));
            }
            self.contents.push(contents);
        }
        let doubt = doubt * cell.area();
        if self
            .contents
            .iter()
            .all(|one| matches!(one, Contents::Dark))
        {
            return Integral::default();
        }
        let heights = self.heights(light, (cell, projection), candidates);
        let mut best = Integral::default();
        for number in 0..self.rules.len() {
            best = self.by_rules(light, (cell, projection), candidates, (&heights, number));
            if best.error <= limit {
                break;
            }
        }
        best.error = best.error.max(doubt);
        best
    }

    /// The heights between which integrals over lines are smooth.
    fn heights(
        &mut self,
        light: &mut dyn Light,
        (cell, projection): (&Cell, Projection),
        candidates: &[Candidate],
    ) -> Vec<Height> {
        let Self {
            ends,
            spans: found,
            breaks,
            contents,
            ..
        } = self;
        let visit = |side: f64, span: &Span, all: &mut Vec<Height>| {
            if let Some(number) = span.seen
                && matches!(contents[number], Contents::Edges)
            {
                let candidate = &candidates[number];
                let curve = Curve::new(true, side, [span.begin, span.end], candidate, projection);
                breaks.clear();
                light.add_breaks(candidate, &curve, number, breaks);
                let heights = breaks.iter().map(|&place| curve.along.at(place).0);
                all.extend(heights.map(Height::crossing));
            }
        };
        heights(
            candidates,
            (cell.u, cell.v),
            projection,
            (ends, found),
            visit,
        )
    }

    fn by_rules(
        &mut self,
        light: &mut dyn Light,
        (cell, projection): (&Cell, Projection),
        candidates: &[Candidate],
        (heights, number): (&[Height], usize),
    ) -> Integral {
        let mut sums = [Color::ZERO; 2];
        let mut error = 0.0;
        for strip in heights.windows(2) {
            let way = Way {
                ends: [strip[0].v, strip[1].v],
                is_root: [strip[0].is_turn, strip[1].is_turn],
            };
            for (of, sum) in sums.iter_mut().enumerate() {
                for index in 0..self.rules[number][of].len() {
                    let (node, weight) = self.rules[number][of][index];
                    let (v, speed) = way.at(node);
                    let (value, of_line) = self.line(light, (cell, projection), candidates, v);
                    *sum += value * (weight * speed);
                    if of == 0 {
                        error += of_line * (weight * speed);
                    }
                }
            }
        }
        Integral {
            value: sums[0],
            error: (sums[0] - sums[1]).abs().max_element() * OF_RULES + error,
        }
    }

    fn line(
        &mut self,
        light: &mut dyn Light,
        (cell, projection): (&Cell, Projection),
        candidates: &[Candidate],
        v: f64,
    ) -> (Color, f64) {
        let Self {
            ends,
            spans: found,
            contents,
            ..
        } = self;
        spans(candidates, cell.u, v, projection, ends, found);
        let (mut sum, mut error) = (Color::ZERO, 0.0);
        for Span { begin, end, seen } in found {
            let Some(number) = *seen else { continue };
            if matches!(contents[number], Contents::Dark) {
                continue;
            }
            let candidate = &candidates[number];
            let curve = Curve::new(false, v, [*begin, *end], candidate, projection);
            self.points += POINTS_OF_CURVE;
            let (value, of_curve) = light.along(candidate, &curve, number);
            sum += value;
            error += of_curve;
        }
        (sum, error)
    }
}
