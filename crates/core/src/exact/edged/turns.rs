//! Terminators of bumps along lines: where light begins or ends on a rough surface.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;
use glam::DVec3;

use super::cut;
use super::piece::Surroundings;
use super::rule::NODES;
use crate::exact::classify::active::Active;
use crate::exact::points::Points;
use crate::exact::surface::Finish;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::vectors::Vectors;

/// Where light on a rough surface begins or ends: its diffuse light or its highlight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn {
    /// Unit vector toward the light.
    pub(crate) toward: DVec3,
    pub(crate) of_spot: bool,
}

impl Turn {
    /// What vanishes there: n·l, or n·(l + v).
    #[inline(always)]
    pub(crate) fn value<S: Simd>(&self, normal: &Vectors<S>, at: &Points<S>) -> f64x8<S> {
        let facing = normal.dot_one(self.toward);
        if self.of_spot {
            facing - normal.dot(&at.ray) / at.ray_sq.sqrt()
        } else {
            facing
        }
    }
}

/// How terminators of bumps are looked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Search {
    /// Parts of an interval at whose ends a rough surface is looked at.
    pub(crate) parts: u32,
    /// Steps to a terminator.
    pub(crate) steps: u32,
}

impl Search {
    /// For a surface whose light jumps, or does not, at terminators.
    pub(crate) fn of(tolerance: f64, jumps: bool) -> Self {
        /// Small enough for a search in earnest.
        const FINE: f64 = 9e-5;
        let (parts, steps) = if tolerance > FINE { (4, 4) } else { (8, 7) };
        if jumps {
            Self {
                parts: 2 * parts,
                steps: steps + 3,
            }
        } else {
            Self { parts, steps }
        }
    }
}

/// What is found at a place of each line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look<S: Simd> {
    pub(crate) x: f64x8<S>,
    /// Of [`Turn::value`].
    pub(crate) value: f64x8<S>,
}

/// How near lines that have no turn come to one, by their looks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    /// The value of the look nearest to zero on each line.
    values: [f64; 8],
    /// Whether others have the other sign, line by line.
    turned: u64,
}

impl Default for Nearest {
    fn default() -> Self {
        Self {
            values: [f64::INFINITY; 8],
            turned: 0,
        }
    }
}

impl Nearest {
    /// Takes in a look at each line.
    pub(crate) fn note(&mut self, values: &[f64; 8]) {
        for (lane, (nearest, &value)) in self.values.iter_mut().zip(values).enumerate() {
            if nearest.is_finite() && (*nearest < 0.0) != (value < 0.0) {
                self.turned |= 1 << lane;
            }
            if value.abs() < nearest.abs() {
                *nearest = value;
            }
        }
    }

    /// By how much the values differ, if none of a rule's lines turns, and one beyond or between them
    /// may.
    pub(crate) fn range_of_turn(&self) -> Option<f64> {
        /// Of the distance of the two outermost lines, what may be between them and the end, and
        /// more.
        const BEYOND: f64 = 0.5;
        let values = &self.values[..NODES];
        let is_even = values
            .iter()
            .all(|value| (*value < 0.0) == (values[0] < 0.0));
        if self.turned & 0x7f != 0 || !is_even || !values[0].is_finite() {
            return None;
        }
        let near = |at: usize| values[at].abs();
        let beyond = |at: usize, next: usize| near(at) + (near(at) - near(next)) * BEYOND;
        let is_near_end = beyond(0, 1).min(beyond(NODES - 1, NODES - 2)) < 0.0;
        let is_near_between = (1..NODES - 1).any(|at| {
            let sides = [near(at - 1), near(at + 1)];
            near(at) <= sides[0].min(sides[1]) && 3.0 * near(at) < sides[0].max(sides[1])
        });
        let lowest = values
            .iter()
            .map(|value| value.abs())
            .fold(f64::INFINITY, f64::min);
        let highest = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
        (is_near_end || is_near_between).then_some(highest - lowest)
    }
}

/// Seeks turns of one kind on eight lines of a sphere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seeker<'a, S: Simd> {
    pub(crate) surroundings: &'a Surroundings<'a>,
    pub(crate) active: &'a Active,
    pub(crate) finish: &'a Finish,
    pub(crate) turn: Turn,
    pub(crate) y: f64x8<S>,
    /// To a turn.
    pub(crate) steps: u32,
}

impl<S: Simd> Seeker<'_, S> {
    /// Notes turns where the value changes its sign between two looks; the samples that it took.
    #[inline(always)]
    pub(crate) fn note(
        &self,
        simd: S,
        low: &Look<S>,
        high: &Look<S>,
        turns: &mut Turns,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> u64 {
        let turned = (low.value * high.value).simd_lt(0.0).to_bitmask();
        self.note_in(simd, turned, low, high, turns, noise)
    }

    /// Notes the two turns where the value dips below zero between looks, or rises above it; the
    /// samples that it took. `is_end` tells whether the first and the last of the looks are those of
    /// the whole interval.
    #[expect(
        clippy::too_many_arguments,
        reason = "all of it is at hand where it is called"
    )]
    #[inline(always)]
    pub(crate) fn note_dip(
        &self,
        simd: S,
        before: &Look<S>,
        here: &Look<S>,
        after: &Look<S>,
        is_end: [bool; 2],
        turns: &mut Turns,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> u64 {
        /// Dips come nearer to zero than the looks by this.
        const NEARER: f64 = 0.5;
        let sign = here.value.simd_lt(0.0);
        let (first, middle) = (before.value.abs(), here.value.abs());
        let last = after.value.abs();
        let (left, right) = (here.x - before.x, after.x - here.x);
        let (falls, rises) = ((middle - first) / left, (last - middle) / right);
        let curvature = (rises - falls) / (left + right);
        let slope = (falls * right + rises * left) / (left + right);
        let x = here.x - slope * 0.5 / curvature;
        let lowest = middle - slope * slope * 0.25 / curvature;
        let from = if is_end[0] {
            before.x
        } else {
            here.x - left * 0.5
        };
        let to = if is_end[1] {
            after.x
        } else {
            here.x + right * 0.5
        };
        let is_same = !(sign ^ before.value.simd_lt(0.0)) & !(sign ^ after.value.simd_lt(0.0));
        let may_dip = is_same
            & curvature.simd_gt(0.0)
            & x.simd_gt(from)
            & x.simd_lt(to)
            & lowest.simd_lt(first.min(middle).min(last) * NEARER);
        let may_dip = may_dip.to_bitmask();
        if may_dip == 0 {
            return 0;
        }
        let value = self.value(simd, x, noise);
        let dips = (value * here.value).simd_lt(0.0).to_bitmask() & may_dip;
        let bottom = Look { x, value };
        8 + self.note_in(simd, dips, before, &bottom, turns, noise)
            + self.note_in(simd, dips, &bottom, after, turns, noise)
    }

    #[inline(always)]
    fn note_in(
        &self,
        simd: S,
        which: u64,
        low: &Look<S>,
        high: &Look<S>,
        turns: &mut Turns,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> u64 {
        if which == 0 {
            return 0;
        }
        let root = self.root(simd, *low, *high, noise);
        for lane in 0..8 {
            if which >> lane & 1 == 1 {
                turns.note(lane, root[lane]);
            }
        }
        8 * u64::from(self.steps)
    }

    #[inline(always)]
    fn value(&self, simd: S, x: f64x8<S>, noise: &mut Option<Box<NoiseCells>>) -> f64x8<S> {
        let Surroundings { scene, cell, .. } = *self.surroundings;
        let at = Points::new(simd, &self.active.ball, cut::ray(simd, cell, x, self.y));
        let normal = self.finish.normal(simd, scene, &at, noise);
        self.turn.value(&normal, &at)
    }

    /// Where between two places light begins or ends: by the rule of false position, with the value
    /// of an end halved that stays once more (Illinois).
    #[inline(never)]
    fn root(
        &self,
        simd: S,
        mut low: Look<S>,
        mut high: Look<S>,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> f64x8<S> {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut x = low.x;
                let one = f64x8::splat(simd, 1.0);
                let (mut high_factor, mut low_factor) = (one, one);
                let never = one.simd_lt(0.0);
                let (mut was_low, mut was_high) = (never, never);
                for _ in 0..self.steps {
                    let (at_low, at_high) = (low.value * low_factor, high.value * high_factor);
                    let share = at_low / (at_low - at_high);
                    x = low.x + (high.x - low.x) * share;
                    let value = self.value(simd, x, noise);
                    let is_low = !(value.simd_gt(0.0) ^ low.value.simd_gt(0.0));
                    low.x = is_low.select(x, low.x);
                    low.value = is_low.select(value, low.value);
                    high.x = is_low.select(high.x, x);
                    high.value = is_low.select(high.value, value);
                    high_factor = (is_low & was_low).select(high_factor * 0.5, one);
                    low_factor = (!is_low & was_high).select(low_factor * 0.5, one);
                    (was_low, was_high) = (is_low, !is_low);
                }
                x
            },
        )
    }
}

/// Places on eight lines, at most so many each, in order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turns {
    places: [[f64; 8]; MOST_TURNS],
    pub(crate) counts: [usize; 8],
}

/// Terminators in an interval that are told apart; more make the rules worse, which they notice.
const MOST_TURNS: usize = 16;

impl Default for Turns {
    fn default() -> Self {
        Self {
            places: [[f64::INFINITY; 8]; MOST_TURNS],
            counts: [0; 8],
        }
    }
}

impl Turns {
    /// Adds a place on a line.
    fn note(&mut self, lane: usize, place: f64) {
        if self.counts[lane] == MOST_TURNS {
            return;
        }
        let mut at = self.counts[lane];
        while at > 0 && self.places[at - 1][lane] > place {
            self.places[at][lane] = self.places[at - 1][lane];
            at -= 1;
        }
        self.places[at][lane] = place;
        self.counts[lane] += 1;
    }

    /// The largest number of places on a line.
    pub(crate) fn most(&self) -> usize {
        self.counts.iter().copied().max().unwrap_or(0)
    }

    /// The places with this number, or the ends of the lines.
    pub(crate) fn stops(&self, index: usize, ends: &[f64; 8]) -> [f64; 8] {
        let mut stops = *ends;
        if index < MOST_TURNS {
            for (stop, place) in stops.iter_mut().zip(&self.places[index]) {
                *stop = stop.min(*place);
            }
        }
        stops
    }
}
