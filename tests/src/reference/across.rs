//! The integral over a patch: Gauss–Kronrod across lines, between the lines where their structure changes.

use std::cell::Cell;

use glam::{DVec2, DVec3, DVec4};

use super::light::Signature;
use super::line::{Line, Piece};
use super::patch::{Candidate, Patch};
use super::quadrature::{Integral, changes, integrate};
use super::seeds::{Seeds, touching_circle, touching_lines};

/// The number of lines at first, in addition to those that seeds suggest.
const FIRST_LINES: usize = 24;
/// The accuracy, in pixels, of the lines at which the structure changes: what begins there begins with zero width. If
/// less accuracy is requested, it is this fraction of the patch's goal.
const CLOSE: f64 = 1e-11;
const CLOSE_SHARE: f64 = 1e-2;
/// The allowed error of the integral across lines, in addition to noise, as a fraction of the patch's goal.
const SHARE: f64 = 2e-2;
const HALVINGS: u32 = 10;
const RETRIES: u32 = 4;
/// The largest number of lines in one direction; and the number of changes after which changes are located ten times
/// less precisely: at the ends of shadows, grazing light on distant balls alternates quickly.
const BUDGET: u32 = 6_000;
/// The largest number of lines under soft light.
const SOFT_BUDGET: u32 = 1_500;
const PATIENCE: u32 = 1_000;
/// An obviously large error, for work that was not finished.
const UNDONE: f64 = 1e-3;

/// The direction of lines.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Way {
    Right,
    Up,
}

impl Way {
    fn other(self) -> Self {
        match self {
            Self::Right => Self::Up,
            Self::Up => Self::Right,
        }
    }

    /// Converts coordinates along and across the lines to those of the patch.
    fn parts(self, point: DVec2) -> (f64, f64) {
        match self {
            Self::Right => (point.x, point.y),
            Self::Up => (point.y, point.x),
        }
    }

    fn axes(self, patch: &Patch<'_>) -> (DVec3, DVec3) {
        match self {
            Self::Right => (patch.right, patch.up),
            Self::Up => (patch.up, patch.right),
        }
    }
}

/// The result of an integral over a patch.
pub(crate) struct Found {
    pub(crate) integral: Integral,
    /// Whether the patch shows more than one thing.
    pub(crate) has_edge: bool,
    pub(crate) lines: u32,
}

/// All lines of one direction across a patch.
struct Across<'patch> {
    patch: &'patch Patch<'patch>,
    way: Way,
    peaks: Vec<f64>,
    lines: Cell<u32>,
}

/// The integral of light and coverage over a patch, along lines of one direction.
pub(crate) fn integral(patch: &Patch<'_>, seeds: &Seeds, way: Way) -> Found {
    let mut peaks: Vec<f64> = seeds.peaks.iter().map(|peak| way.parts(*peak).0).collect();
    peaks.sort_by(f64::total_cmp);
    let across = Across {
        patch,
        way,
        peaks,
        lines: Cell::new(0),
    };
    across.integral(seeds)
}

impl<'patch> Across<'patch> {
    fn is_over_budget(&self) -> bool {
        let most = match self.patch.stage.softness.is_any() {
            true => SOFT_BUDGET,
            false => BUDGET,
        };
        self.lines.get() > most
    }

    fn close(&self) -> f64 {
        let impatience = 10_f64.powi((self.lines.get() / PATIENCE) as i32);
        let close = CLOSE.max(CLOSE_SHARE * self.patch.goal);
        (close + 2.0 * self.patch.noise) * impatience
    }

    fn line(&self, t: f64) -> Line<'patch> {
        self.lines.set(self.lines.get() + 1);
        let (along, across) = self.way.axes(self.patch);
        let (low, _) = self.way.parts(self.patch.low);
        let (high, _) = self.way.parts(self.patch.high);
        Line {
            patch: self.patch,
            origin: self.patch.origin + across * t,
            along,
            low,
            high,
            peaks: self.peaks.clone(),
        }
    }

    fn structure(&self, t: f64) -> Vec<Signature> {
        // Out of budget: as if nothing changed any more.
        if self.is_over_budget() {
            return Vec::new();
        }
        let line = self.line(t);
        line.structure(&line.pieces(&[]))
    }

    fn integral(&self, seeds: &Seeds) -> Found {
        let (_, low) = self.way.parts(self.patch.low);
        let (_, high) = self.way.parts(self.patch.high);
        let within = |t: &f64| *t > low && *t < high;
        let mut places: Vec<f64> = self.border_events().into_iter().filter(within).collect();
        let (along, across) = self.way.axes(self.patch);
        let candidates = self.patch.candidates.iter();
        for ball in candidates.flat_map(Candidate::contours) {
            let lines = touching_lines(ball, self.patch.origin, along, across);
            places.extend(lines.filter(within));
        }
        for candidate in &self.patch.candidates {
            for lamp in &self.patch.stage.lamps {
                if let Some(circle) = lamp.cutoff(&candidate.ball) {
                    let lines = touching_circle(self.patch, circle, along, across);
                    places.extend(lines.into_iter().filter(within));
                }
            }
        }
        places.extend(seeds.points.iter().map(|point| self.way.parts(*point).1));
        places.sort_by(f64::total_cmp);
        places.dedup_by(|a, b| *a - *b < self.close());
        let mut samples = self.first_look(&places, low, high);
        samples.sort_by(|a, b| a.0.total_cmp(&b.0));
        let peaks: Vec<f64> = seeds
            .peaks
            .iter()
            .map(|peak| self.way.parts(*peak).1)
            .collect();
        for attempt in 0.. {
            let cuts = self.cuts(&samples, &places, low, high);
            let mut sum = Integral::default();
            let known = samples.len();
            for pair in cuts.windows(2) {
                sum.add(self.between(pair[0], pair[1], &peaks, &mut samples));
            }
            let over_budget = self.is_over_budget();
            if samples.len() == known || attempt == RETRIES || over_budget {
                if samples.len() != known {
                    sum.error += sum.cautious;
                }
                if over_budget {
                    sum.error += UNDONE * (high - low);
                }
                let has_edge =
                    samples.iter().any(|(_, structure)| structure.len() > 1) || cuts.len() > 2;
                return Found {
                    integral: sum,
                    has_edge,
                    lines: self.lines.get(),
                };
            }
            samples.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        unreachable!("the loop ends by itself")
    }

    /// Lines between all neighbors among the seeds, and evenly spread ones.
    fn first_look(&self, places: &[f64], low: f64, high: f64) -> Vec<(f64, Vec<Signature>)> {
        let ends: Vec<f64> = [low]
            .into_iter()
            .chain(places.iter().copied())
            .chain([high])
            .collect();
        let between = ends.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let step = (high - low) / FIRST_LINES as f64;
        let even = (0..FIRST_LINES).map(|index| low + step * (index as f64 + 0.5));
        let sample = |t: f64| (t, self.structure(t));
        between.chain(even).map(sample).collect()
    }

    fn cuts(
        &self,
        samples: &[(f64, Vec<Signature>)],
        places: &[f64],
        low: f64,
        high: f64,
    ) -> Vec<f64> {
        let mut cuts = vec![low];
        let mut probe = |t: f64| self.structure(t);
        for pair in samples.windows(2) {
            let (from, to) = ((pair[0].0, &pair[0].1), (pair[1].0, &pair[1].1));
            let first = places.partition_point(|place| *place <= from.0);
            let last = places.partition_point(|place| *place < to.0);
            changes(
                from,
                to,
                &places[first..last.max(first)],
                self.close(),
                &mut probe,
                &mut cuts,
            );
        }
        cuts.push(high);
        cuts
    }

    /// The integral between two lines. Records lines whose structure differs from that of the middle.
    fn between(
        &self,
        start: f64,
        end: f64,
        peaks: &[f64],
        samples: &mut Vec<(f64, Vec<Signature>)>,
    ) -> Integral {
        let expected = self.structure(0.5 * (start + end));
        let mut surprise = None;
        let mut unsure: f64 = 0.0;
        let mut light = |t: f64| -> DVec4 {
            if self.is_over_budget() {
                return DVec4::ZERO;
            }
            let line = self.line(t);
            let (integral, pieces): (Integral, Vec<Piece>) = line.integral();
            unsure = unsure.max(integral.error);
            let inside = (t - start).min(end - t);
            if inside > 2.0 * self.close() && surprise.is_none() {
                let structure = line.structure(&pieces);
                if structure != expected {
                    surprise = Some((t, structure));
                }
            }
            integral.value
        };
        let mut sum = Integral::default();
        let mut inner: Vec<f64> = peaks
            .iter()
            .copied()
            .filter(|peak| *peak > start && *peak < end)
            .collect();
        inner.sort_by(f64::total_cmp);
        let tolerance = SHARE * self.patch.goal + 2.0 * self.patch.noise;
        let mut from = start;
        for to in inner.into_iter().chain([end]) {
            sum.add(integrate(from, to, tolerance, HALVINGS, &mut light));
            from = to;
        }
        sum.error += unsure * (end - start);
        if let Some(surprise) = surprise {
            // Both, so that the change between them is sought.
            samples.push(surprise);
            samples.push((0.5 * (start + end), expected));
        }
        sum
    }

    /// The places where edges leave the patch through the two sides that lines connect.
    fn border_events(&self) -> Vec<f64> {
        let crosswise = Across {
            patch: self.patch,
            way: self.way.other(),
            peaks: Vec::new(),
            lines: Cell::new(0),
        };
        let (low, _) = self.way.parts(self.patch.low);
        let (high, _) = self.way.parts(self.patch.high);
        let cuts = |t: f64| {
            let pieces = crosswise.line(t).pieces(&[]);
            pieces.into_iter().map(|piece| piece.start)
        };
        cuts(low).chain(cuts(high)).collect()
    }
}
