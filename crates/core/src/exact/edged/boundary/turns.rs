//! Places on chords where bumps turn from a light.

use fearless_simd::Simd;
use glam::DVec3;

use super::chord::Chord;
use super::primitive::{Lines, Noise, Sender};
use crate::exact::points::Points;
use crate::light::near_light::NearLight;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// The function that vanishes where light begins or ends: n·l, or, for a highlight, n·(l + v).
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// Unit vector toward the light.
    pub(super) toward: DVec3,
    /// The place of a point light.
    pub(super) near: Option<NearLight>,
    pub(super) of_spot: bool,
}

impl Turn {
    #[inline(always)]
    pub(super) fn value<S: Simd>(&self, normal: &Vectors<S>, at: &Points<S>) -> f64x8<S> {
        let facing = match &self.near {
            None => normal.dot_one(self.toward),
            Some(near) => normal.dot(&near.at_distances(&at.place()).0),
        };
        if self.of_spot {
            facing - normal.dot(&at.ray) / at.ray_sq.sqrt()
        } else {
            facing
        }
    }
}

/// Places on a chord, by its parameter, and the value there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look<S: Simd> {
    pub(super) sigma: f64x8<S>,
    pub(super) value: f64x8<S>,
}

/// Seeks turns of one kind on eight chords.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seeker<'a, 'scene, S: Simd> {
    pub(super) sender: &'a Sender<'a, 'scene>,
    pub(super) chord: &'a Chord<S>,
    pub(super) lines: &'a Lines<S>,
    pub(super) turn: Turn,
    /// To a turn.
    pub(super) steps: u32,
}

impl<S: Simd> Seeker<'_, '_, S> {
    /// Notes the turns between two looks on some of the chords.
    #[inline(always)]
    pub(super) fn note(
        &self,
        simd: S,
        which: u64,
        low: &Look<S>,
        high: &Look<S>,
        stops: &mut Stops,
        noise: &mut Noise,
    ) {
        if which == 0 {
            return;
        }
        let root = self.root(simd, *low, *high, noise);
        for lane in 0..8 {
            if which >> lane & 1 == 1 {
                stops.note(lane, root[lane]);
            }
        }
        stops.samples += 8 * u64::from(self.steps);
    }

    /// Notes the two turns where the value dips below zero between three looks, or rises above it; the
    /// samples that it took.
    #[inline(always)]
    pub(super) fn note_dip(
        &self,
        simd: S,
        looks: &[Look<S>; 3],
        stops: &mut Stops,
        noise: &mut Noise,
    ) {
        /// Dips come nearer to zero than the looks by this.
        const NEARER: f64 = 0.5;
        let [before, here, after] = looks;
        let sign = here.value.simd_lt(0.0);
        let (first, middle) = (before.value.abs(), here.value.abs());
        let last = after.value.abs();
        let bend = (first - middle) + (last - middle);
        let rise = (last - first) * 0.5;
        // In steps from the middle.
        let way = rise * -1.0 / bend;
        let lowest = middle + rise * way * 0.5;
        let is_same = !(sign ^ before.value.simd_lt(0.0)) & !(sign ^ after.value.simd_lt(0.0));
        let may_dip = is_same
            & bend.simd_gt(0.0)
            & way.abs().simd_lt(1.0)
            & lowest.simd_lt(first.min(middle).min(last) * NEARER);
        let may_dip = may_dip.to_bitmask();
        if may_dip == 0 {
            return;
        }
        let sigma = here.sigma + (here.sigma - before.sigma) * way;
        let value = self.value(simd, sigma, noise);
        let dips = (value * here.value).simd_lt(0.0).to_bitmask() & may_dip;
        let bottom = Look { sigma, value };
        stops.samples += 8;
        self.note(simd, dips, before, &bottom, stops, noise);
        self.note(simd, dips, &bottom, after, stops, noise);
    }

    #[inline(always)]
    fn value(&self, simd: S, sigma: f64x8<S>, noise: &mut Noise) -> f64x8<S> {
        let (points, normal) = self
            .sender
            .normal_at(simd, self.chord, self.lines, sigma, noise);
        self.turn.value(&normal, &points)
    }

    /// The place between two others where light begins or ends: by the rule of false position, with the value
    /// of an end halved that stays once more (Illinois).
    #[inline(never)]
    fn root(&self, simd: S, mut low: Look<S>, mut high: Look<S>, noise: &mut Noise) -> f64x8<S> {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut sigma = low.sigma;
                let one = f64x8::splat(simd, 1.0);
                let (mut high_factor, mut low_factor) = (one, one);
                let never = one.simd_lt(0.0);
                let (mut was_low, mut was_high) = (never, never);
                for _ in 0..self.steps {
                    let (at_low, at_high) = (low.value * low_factor, high.value * high_factor);
                    let share = at_low / (at_low - at_high);
                    sigma = low.sigma + (high.sigma - low.sigma) * share;
                    let value = self.value(simd, sigma, noise);
                    let is_low = !(value.simd_gt(0.0) ^ low.value.simd_gt(0.0));
                    low.sigma = is_low.select(sigma, low.sigma);
                    low.value = is_low.select(value, low.value);
                    high.sigma = is_low.select(high.sigma, sigma);
                    high.value = is_low.select(high.value, value);
                    high_factor = (is_low & was_low).select(high_factor * 0.5, one);
                    low_factor = (!is_low & was_high).select(low_factor * 0.5, one);
                    (was_low, was_high) = (is_low, !is_low);
                }
                sigma
            },
        )
    }
}

/// Places at which eight chords are divided, in order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stops {
    places: [[f64; 8]; MOST_STOPS],
    pub(super) counts: [usize; 8],
    /// Points that were looked at to find them.
    pub(super) samples: u64,
}

/// The places on a chord that are told apart; more make the rules worse, which they notice.
const MOST_STOPS: usize = 48;

impl Default for Stops {
    fn default() -> Self {
        Self {
            places: [[1.0; 8]; MOST_STOPS],
            counts: [0; 8],
            samples: 0,
        }
    }
}

impl Stops {
    /// Adds a place on a chord.
    pub(super) fn note(&mut self, lane: usize, place: f64) {
        if self.counts[lane] == MOST_STOPS || place.is_nan() {
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

    /// The largest number of places on a chord.
    pub(super) fn most(&self) -> usize {
        self.counts.iter().copied().max().unwrap_or(0)
    }

    /// The places with this number, or the ends of the chords.
    pub(super) fn at(&self, index: usize) -> [f64; 8] {
        self.places.get(index).copied().unwrap_or([1.0; 8])
    }
}
