//! The average over a cell from lines across it, on which the places are known where light begins to be hidden.

use super::across::{RULE, doubt_of_rule};
use super::candidate::Candidate;
use super::curve::{Curve, Way};
use super::edges::Break;
use super::heights::{Height, heights};
use super::line::{Span, spans};
use super::rectangle::{Cell, Contents, Integral, Light};
use super::seam::Seam;
use crate::model::camera::Projection;
use crate::model::color::Color;
use crate::numeric::pair::both;

/// The light along a line.
#[derive(Clone, Copy, Debug, Default)]
struct Line {
    sum: Color,
    error: f64,
    pattern: Pattern,
    /// How much of the line each candidate fills with light: of some, the sum.
    filled: [f64; FILLED],
}

/// So many candidates, whose numbers follow each other, are told apart.
const FILLED: usize = 8;

/// What is seen along a line, and what begins and ends on it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Pattern {
    breaks: usize,
    /// A number for their order.
    order: u64,
}

impl Pattern {
    fn add(&mut self, of: usize) {
        self.order =
            (self.order ^ of as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (self.order >> 29);
    }

    /// Adds sorted breaks. Those in the same place, as of spheres that coincide, have no order.
    fn add_breaks(&mut self, breaks: &[Break]) {
        /// The distance below which rounding may exchange breaks.
        const SAME: f64 = 1e-9;
        self.breaks += breaks.len();
        for same in breaks.chunk_by(|one, next| next.place - one.place < SAME) {
            self.add(same.len());
            self.add(same.iter().map(|one| (one.of + 1) * (one.of + 1)).sum());
        }
    }
}

/// A part of a cell between two heights.
#[derive(Clone, Copy, Debug)]
struct Strip {
    between: Way,
    value: Color,
    error: f64,
    /// Two heights between which something begins or ends, and how much the light of lines there differs.
    change: Option<Change>,
}

#[derive(Clone, Copy, Debug)]
struct Change {
    heights: [f64; 2],
    /// The patterns of the lower and the upper line.
    patterns: [Pattern; 2],
    difference: f64,
}

/// Memory.
#[derive(Debug, Default)]
pub(crate) struct Strips {
    ends: Vec<f64>,
    spans: Vec<Span>,
    breaks: Vec<Break>,
    contents: Vec<Contents>,
    seams: Vec<Seam>,
    strips: Vec<Strip>,
    /// The curves along which light was integrated, in points that cost as much.
    pub(crate) points: u64,
}

/// How often a strip of a cell is divided before the cell itself is.
const MOST_DIVISIONS: usize = 16;

/// Halvings that find the height at which something begins or ends.
const HALVINGS: u32 = 20;

/// How far points of lines are apart, in parts of the cell.
const SPACING: f64 = 0.25;

/// The light of a curve costs about as much as so many points, and what begins and ends on it.
const POINTS_OF_CURVE: u64 = 3;
const POINTS_OF_PATTERN: u64 = 1;

/// The part of a cell's error that the errors along its lines may have. Not tuned.
const OF_LINES: f64 = 0.25;

/// The claim of what begins or ends between two lines, in parts of their difference, and of the brightest light on what one
/// of them sees more of than the other. Not tuned.
const OF_CHANGE: f64 = 0.75;
const OF_BRIGHTEST: f64 = 0.25;

/// What lines are drawn across.
#[derive(Clone, Copy)]
struct Scene<'a> {
    cell: &'a Cell,
    projection: Projection,
    candidates: &'a [Candidate],
    /// The error of light along a line that is allowed, in parts of its length.
    limit: f64,
    brightest: f64,
}

impl Strips {
    /// The integral over a cell, to a limit if few divisions allow it.
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
                doubt = doubt.max(light.doubt(candidate, cell, SPACING));
            }
            if let Contents::Edges { doubt: of_edges } = contents {
                doubt = doubt.max(of_edges);
            }
            self.contents.push(contents);
        }
        if self
            .contents
            .iter()
            .all(|one| matches!(one, Contents::Dark))
        {
            return Integral::default();
        }
        let scene = Scene {
            cell,
            projection,
            candidates,
            limit: OF_LINES * limit / cell.area(),
            brightest: light.brightest(),
        };
        Seam::all(candidates, &mut self.seams);
        let heights = self.heights(light, scene);
        let mut strips = std::mem::take(&mut self.strips);
        strips.clear();
        let is_root = |height: &Height| {
            height.is_turn || (light.has_roots_at_seams() && !cell.v.contains(&height.v))
        };
        let ways = heights.windows(2).map(|ends| Way {
            ends: [ends[0].v, ends[1].v],
            is_root: [is_root(&ends[0]), is_root(&ends[1])],
        });
        let ways: Vec<Way> = ways.collect();
        for between in ways {
            strips.push(self.strip(light, scene, between));
        }
        for _ in 0..MOST_DIVISIONS {
            if strips.iter().map(|strip| strip.error).sum::<f64>() <= limit {
                break;
            }
            let worst = strips.iter().enumerate();
            let worst = worst.max_by(|(_, one), (_, other)| one.error.total_cmp(&other.error));
            let Some((worst, strip)) = worst else { break };
            let [lower, upper] = self.division(light, scene, strip);
            strips[worst] = self.strip(light, scene, lower);
            strips.push(self.strip(light, scene, upper));
        }
        let mut integral = Integral::default();
        for strip in &strips {
            integral.value += strip.value;
            integral.error += strip.error;
        }
        self.strips = strips;
        integral.error = integral.error.max(doubt * cell.area());
        integral
    }

    /// The heights between which integrals over lines are smooth.
    fn heights(&mut self, light: &mut dyn Light, scene: Scene<'_>) -> Vec<Height> {
        let Scene {
            cell,
            projection,
            candidates,
            ..
        } = scene;
        let Self {
            ends,
            spans: found,
            breaks,
            contents,
            seams,
            ..
        } = self;
        let visit = |side: f64, span: &Span, all: &mut Vec<Height>| {
            if let Some(number) = span.seen
                && matches!(contents[number], Contents::Edges { .. })
            {
                let candidate = &candidates[number];
                let curve = Curve::new(true, side, [span.begin, span.end], candidate, projection);
                breaks.clear();
                light.add_breaks(candidate, &curve, number, breaks);
                let heights = breaks.iter().map(|one| curve.along.at(one.place).0);
                all.extend(heights.map(Height::crossing));
            }
        };
        heights(
            (candidates, seams),
            (cell.u, cell.v),
            projection,
            (ends, found),
            visit,
        )
    }

    /// Where to divide a strip: where something begins or ends, or in the middle.
    fn division(&mut self, light: &mut dyn Light, scene: Scene<'_>, strip: &Strip) -> [Way; 2] {
        let Way {
            ends: [low, high],
            is_root,
        } = strip.between;
        let (middle, is_begin, is_end) = match &strip.change {
            Some(change) => {
                let [mut below, mut above] = change.heights;
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (below + above);
                    if self.pattern(light, scene, middle) == change.patterns[0] {
                        below = middle;
                    } else {
                        above = middle;
                    }
                }
                let [before, after] = both(change.patterns, |pattern| pattern.breaks);
                let is_root = light.has_roots_at_seams();
                (
                    0.5 * (below + above),
                    is_root || after < before,
                    is_root || after > before,
                )
            }
            None => (0.5 * (low + high), false, false),
        };
        [
            Way {
                ends: [low, middle],
                is_root: [is_root[0], is_begin],
            },
            Way {
                ends: [middle, high],
                is_root: [is_end, is_root[1]],
            },
        ]
    }

    /// The light of a strip. Lines at its ends are looked at, too, for what begins or ends between them and others.
    fn strip(&mut self, light: &mut dyn Light, scene: Scene<'_>, between: Way) -> Strip {
        let mut strip = Strip {
            between,
            value: Color::ZERO,
            error: 0.0,
            change: None,
        };
        /// The part of a strip by which lines at its ends are inside of it.
        const INSIDE: f64 = 1e-5;
        let [low, high] = between.ends;
        let inside = INSIDE * (high - low);
        let mut first: Option<(Line, f64)> = None;
        let mut before: Option<(Line, f64)> = None;
        let mut values = [Color::ZERO; RULE.len()];
        for (node, across) in RULE.iter().zip(&mut values) {
            let (v, speed) = between.at(node.place);
            let line = self.line(light, scene, v);
            *across = line.sum * speed;
            strip.value += *across * node.weight;
            strip.error += line.error * (node.weight * speed);
            let below = before.or_else(|| self.unlike(light, scene, low + inside, &line));
            strip.compare(below, Some((line, v)), scene.brightest);
            before = Some((line, v));
            first = first.or(before);
        }
        if let Some((last, _)) = before {
            let above = self.unlike(light, scene, high - inside, &last);
            strip.compare(before, above, scene.brightest);
        }
        if strip.change.is_some() {
            // Light that begins right before the first line, or the last one, may grow beyond it.
            for (end, nearest) in [(low + inside, first), (high - inside, before)] {
                if let Some((nearest, v)) = nearest {
                    let difference = self.line(light, scene, end).sum - nearest.sum;
                    strip.error += difference.abs().max_element() * (end - v).abs();
                }
            }
        }
        strip.error += doubt_of_rule(&values).max_element();
        strip
    }

    /// The line at a height unless its pattern is that of another.
    fn unlike(
        &mut self,
        light: &mut dyn Light,
        scene: Scene<'_>,
        v: f64,
        other: &Line,
    ) -> Option<(Line, f64)> {
        let is_like = self.pattern(light, scene, v) == other.pattern;
        (!is_like).then(|| (self.line(light, scene, v), v))
    }

    fn line(&mut self, light: &mut dyn Light, scene: Scene<'_>, v: f64) -> Line {
        self.walk(light, scene, v, true)
    }

    fn pattern(&mut self, light: &mut dyn Light, scene: Scene<'_>, v: f64) -> Pattern {
        self.walk(light, scene, v, false).pattern
    }

    /// What is seen along a line; its light, too, if that is wanted.
    fn walk(&mut self, light: &mut dyn Light, scene: Scene<'_>, v: f64, wants_light: bool) -> Line {
        let Scene {
            cell,
            projection,
            candidates,
            ..
        } = scene;
        let Self {
            ends,
            spans: found,
            breaks,
            contents,
            seams,
            points,
            ..
        } = self;
        spans((candidates, seams), cell.u, v, projection, ends, found);
        let mut line = Line::default();
        for Span {
            begin,
            end,
            met,
            seen,
        } in found
        {
            // Where nothing is lit, too: the ends of lit spans bend where what lies beside them changes.
            line.pattern.add(met.map_or(0, |number| number + 1));
            let lit = seen.filter(|&number| !matches!(contents[number], Contents::Dark));
            let Some(number) = lit else {
                line.pattern.add(0);
                continue;
            };
            line.filled[number % FILLED] += *end - *begin;
            let candidate = &candidates[number];
            let mut curve = Curve::new(false, v, [*begin, *end], candidate, projection);
            if light.has_roots_at_seams() {
                curve.along.is_root[0] |= *begin > cell.u[0];
                curve.along.is_root[1] |= *end < cell.u[1];
            }
            breaks.clear();
            *points += POINTS_OF_PATTERN;
            if !light.add_breaks(candidate, &curve, number, breaks) {
                line.pattern.add(0);
                continue;
            }
            sort(breaks);
            line.pattern.add_breaks(breaks);
            if wants_light {
                *points += POINTS_OF_CURVE;
                let along = light.along((candidate, number), &curve, breaks, scene.limit);
                line.sum += along.integral;
                line.error += along.error;
            }
        }
        line
    }
}

/// Sorts few breaks by their places, and those of one place by what they are of.
fn sort(breaks: &mut [Break]) {
    let is_before = |one: &Break, other: &Break| {
        let in_place = one.place.total_cmp(&other.place);
        in_place.then(one.of.cmp(&other.of)).is_lt()
    };
    for end in 1..breaks.len() {
        let mut at = end;
        while at > 0 && is_before(&breaks[at], &breaks[at - 1]) {
            breaks.swap(at, at - 1);
            at -= 1;
        }
    }
}

impl Strip {
    /// Notices what begins or ends between two lines.
    ///
    /// Light that is weak on both lines may be strong between them, where one sees what the other does not.
    fn compare(&mut self, before: Option<(Line, f64)>, after: Option<(Line, f64)>, brightest: f64) {
        let (Some((before, below)), Some((after, above))) = (before, after) else {
            return;
        };
        if before.pattern == after.pattern {
            return;
        }
        let mut filled = 0.0;
        for (before, after) in before.filled.iter().zip(after.filled) {
            filled += (after - before).abs();
        }
        let of_light = (after.sum - before.sum).abs().max_element() * OF_CHANGE;
        let difference = of_light.max(filled * brightest * OF_BRIGHTEST) * (above - below);
        self.error += difference;
        if self
            .change
            .is_none_or(|change| change.difference < difference)
        {
            self.change = Some(Change {
                heights: [below, above],
                patterns: [before.pattern, after.pattern],
                difference,
            });
        }
    }
}
