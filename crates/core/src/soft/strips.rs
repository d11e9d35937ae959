//! The average over a cell from lines across it, on which the places are known where light begins to be hidden.

use super::candidate::Candidate;
use super::curve::{Curve, Way};
use super::heights::{Height, heights};
use super::line::{Span, spans};
use super::rectangle::{Cell, Contents, Integral, Light};
use super::seam::Seam;
use crate::model::camera::Projection;
use crate::model::color::Color;

/// A line of a strip: its place from 0 to 1, and its weight in a rule and in a coarser one.
#[derive(Clone, Copy, Debug)]
struct RuleNode {
    place: f64,
    fine: f64,
    coarse: f64,
}

const fn node(place: f64, fine: f64, coarse: f64) -> RuleNode {
    RuleNode {
        place,
        fine,
        coarse,
    }
}

/// Kronrod's rule with 5 nodes, which contains Gauss's with 2.
const RULE: [RuleNode; 5] = [
    node(0.037_089_950_113_724_27, 0.098_989_898_989_898_99, 0.0),
    node(0.211_324_865_405_187_1, 0.245_454_545_454_545_45, 0.5),
    node(0.5, 0.311_111_111_111_111_1, 0.0),
    node(0.788_675_134_594_812_9, 0.245_454_545_454_545_45, 0.5),
    node(0.962_910_049_886_275_7, 0.098_989_898_989_898_99, 0.0),
];

/// The light along a line.
#[derive(Clone, Copy, Debug, Default)]
struct Line {
    sum: Color,
    error: f64,
    breaks: usize,
    /// A number for the order of what is seen, and of what begins and ends.
    pattern: usize,
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
    /// The pattern of the lower line.
    pattern: usize,
    /// True if more is seen above.
    is_more: bool,
    difference: f64,
}

/// Memory.
#[derive(Debug, Default)]
pub(crate) struct Strips {
    ends: Vec<f64>,
    spans: Vec<Span>,
    breaks: Vec<f64>,
    contents: Vec<Contents>,
    seams: Vec<Seam>,
    strips: Vec<Strip>,
    /// The curves along which light was integrated, in points that cost as much.
    pub(crate) points: u64,
}

/// How often a strip of a cell is divided before the cell itself is.
const MOST_DIVISIONS: usize = 16;

/// Halvings that find the height at which something begins or ends.
const HALVINGS: u32 = 8;

/// How far points of lines are apart, in parts of the cell.
const SPACING: f64 = 0.25;

/// The claim of a rule, in parts of its difference from the coarser one. Not tuned.
const OF_RULES: f64 = 1.0;

/// The part of a cell's error that the errors along its lines may have. Not tuned.
const OF_LINES: f64 = 0.25;

/// The claim of what begins or ends between two lines, in parts of their difference. Not tuned.
const OF_CHANGE: f64 = 0.75;

/// What lines are drawn across.
#[derive(Clone, Copy)]
struct Scene<'a> {
    cell: &'a Cell,
    projection: Projection,
    candidates: &'a [Candidate],
    /// The error of light along a line that is allowed, in parts of its length.
    limit: f64,
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
        };
        Seam::all(candidates, &mut self.seams);
        let heights = self.heights(light, scene);
        let mut strips = std::mem::take(&mut self.strips);
        strips.clear();
        let last = heights.len() - 2;
        for (index, ends) in heights.windows(2).enumerate() {
            let between = Way {
                ends: [ends[0].v, ends[1].v],
                is_root: [ends[0].is_turn, ends[1].is_turn],
            };
            let looks_at = [
                index == 0 || ends[0].is_penumbra,
                index == last || ends[1].is_penumbra,
            ];
            strips.push(self.strip(light, scene, between, looks_at));
        }
        for _ in 0..MOST_DIVISIONS {
            if strips.iter().map(|strip| strip.error).sum::<f64>() <= limit {
                break;
            }
            let worst = strips.iter().enumerate();
            let worst = worst.max_by(|(_, one), (_, other)| one.error.total_cmp(&other.error));
            let Some((worst, strip)) = worst else { break };
            let [lower, upper] = self.division(light, scene, strip);
            strips[worst] = self.strip(light, scene, lower, [false; 2]);
            strips.push(self.strip(light, scene, upper, [false; 2]));
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
                let heights = breaks.iter().map(|&place| curve.along.at(place).0);
                all.extend(heights.map(Height::of_penumbra));
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
                    if self.line(light, scene, middle).pattern == change.pattern {
                        below = middle;
                    } else {
                        above = middle;
                    }
                }
                (0.5 * (below + above), !change.is_more, change.is_more)
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

    /// The light of a strip; whether to look at its lower and its upper end, too, for what begins or ends.
    fn strip(
        &mut self,
        light: &mut dyn Light,
        scene: Scene<'_>,
        between: Way,
        looks_at: [bool; 2],
    ) -> Strip {
        let mut strip = Strip {
            between,
            value: Color::ZERO,
            error: 0.0,
            change: None,
        };
        /// The part of a strip by which lines at its ends are inside of it.
        const INSIDE: f64 = 1e-3;
        let inside = INSIDE * (between.ends[1] - between.ends[0]);
        let mut before: Option<(Line, f64)> = looks_at[0].then(|| {
            let low = between.ends[0] + inside;
            (self.line(light, scene, low), low)
        });
        let mut rough = Color::ZERO;
        for node in &RULE {
            let (v, speed) = between.at(node.place);
            let line = self.line(light, scene, v);
            strip.value += line.sum * (node.fine * speed);
            rough += line.sum * (node.coarse * speed);
            strip.error += line.error * (node.fine * speed);
            strip.compare(before, (line, v));
            before = Some((line, v));
        }
        if looks_at[1] {
            let high = between.ends[1] - inside;
            let line = self.line(light, scene, high);
            strip.compare(before, (line, high));
        }
        strip.error += (strip.value - rough).abs().max_element() * OF_RULES;
        strip
    }

    fn line(&mut self, light: &mut dyn Light, scene: Scene<'_>, v: f64) -> Line {
        let Scene {
            cell,
            projection,
            candidates,
            ..
        } = scene;
        let Self {
            ends,
            spans: found,
            contents,
            seams,
            ..
        } = self;
        spans((candidates, seams), cell.u, v, projection, ends, found);
        let mut line = Line::default();
        for Span { begin, end, seen } in found {
            let Some(number) = *seen else { continue };
            if matches!(contents[number], Contents::Dark) {
                continue;
            }
            let candidate = &candidates[number];
            let mut curve = Curve::new(false, v, [*begin, *end], candidate, projection);
            if light.has_roots_at_seams() {
                curve.along.is_root[0] |= *begin > cell.u[0];
                curve.along.is_root[1] |= *end < cell.u[1];
            }
            let along = light.along(candidate, &curve, number, scene.limit);
            self.points += along.points;
            line.sum += along.integral;
            line.error += along.error;
            line.breaks += along.breaks;
            let of_span = (number + 1).wrapping_mul(31).wrapping_add(along.breaks);
            line.pattern = line.pattern.wrapping_mul(961).wrapping_add(of_span);
        }
        line
    }
}

impl Strip {
    /// Notices what begins or ends between two lines.
    fn compare(&mut self, before: Option<(Line, f64)>, (line, v): (Line, f64)) {
        let Some((before, below)) = before else {
            return;
        };
        if before.pattern == line.pattern {
            return;
        }
        let difference = (line.sum - before.sum).abs().max_element() * (v - below);
        self.error += difference * OF_CHANGE;
        if self
            .change
            .is_none_or(|change| change.difference < difference)
        {
            self.change = Some(Change {
                heights: [below, v],
                pattern: before.pattern,
                is_more: line.breaks > before.breaks,
                difference,
            });
        }
    }
}
