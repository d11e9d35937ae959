//! The arcs of a circle that no cap covers.
//!
//! Each cap covers one arc. Where such an arc ends and no other one covers the place, an exposed arc begins; it leads to the
//! nearest place at which a covered arc begins. So nothing is sorted.

use std::f64::consts::{PI, TAU};

use fearless_simd::Simd;
use glam::DVec2;

use super::cap::{Crossing, Frame};
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{LANES, f64x8};
use crate::numeric::pair::both;

/// Arcs of one circle: those that are covered, and those that are not.
#[derive(Debug, Default)]
pub(crate) struct Arcs {
    /// Eight covered arcs each.
    groups: Vec<Covered>,
    count: usize,
    exposed: Vec<Exposed>,
}

/// Covered arcs, as [`Crossing`] says; those that are missing are no numbers.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Covered {
    /// Vectors toward their middles, in the frame of the circle.
    pub(super) x: [f64; LANES],
    pub(super) y: [f64; LANES],
    pub(super) t: [f64; LANES],
    pub(super) root: [f64; LANES],
    /// Where they begin and end, as [`order`] tells.
    pub(super) begin: [f64; LANES],
    pub(super) end: [f64; LANES],
    /// The numbers of their caps.
    pub(super) cap: [u32; LANES],
}

/// No arcs.
pub(super) const NONE: Covered = Covered {
    x: [0.0; LANES],
    y: [0.0; LANES],
    t: [0.0; LANES],
    root: [0.0; LANES],
    begin: [f64::NAN; LANES],
    end: [f64::NAN; LANES],
    cap: [0; LANES],
};

/// An arc that is not covered, in the order in which a point runs along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exposed {
    /// Where it begins, and how long it is, as [`order`] tells.
    from: f64,
    length: f64,
    pub(crate) ends: [End; 2],
}

/// An end of an arc.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End {
    /// A unit vector toward it in the circle's frame.
    pub(crate) at: DVec2,
    /// The number of the cap whose circle crosses there.
    pub(crate) cap: usize,
}

/// What [`order`] grows by in a turn.
const TURN: f64 = 4.0;

/// Numbers that grow with the angles of vectors, from 0 to [`TURN`].
#[inline(always)]
fn order<S: Simd>(x: f64x8<S>, y: f64x8<S>) -> f64x8<S> {
    let ratio = x / (x.abs() + y.abs());
    y.simd_ge(0.0).select(ratio * -1.0 + 1.0, ratio + 3.0)
}

impl Exposed {
    /// Its angle.
    pub(crate) fn angle(&self) -> f64 {
        let [begin, end] = both(self.ends, |end| end.at);
        let angle = libm::atan2(begin.perp_dot(end), begin.dot(end));
        // Ends that are almost the same are those of an arc that is almost nothing, or almost a turn.
        let about = self.length * (TAU / TURN);
        if angle < about - PI {
            angle + TAU
        } else {
            angle
        }
    }
}

impl Arcs {
    pub(crate) fn clear(&mut self) {
        self.groups.clear();
        self.count = 0;
        self.exposed.clear();
    }

    /// Adds a covered arc.
    fn push(&mut self, [x, y, t, root]: [f64; 4], cap: usize) {
        let lane = self.count % LANES;
        if lane == 0 {
            self.groups.push(NONE);
        }
        if let Some(last) = self.groups.last_mut() {
            (last.x[lane], last.y[lane]) = (x, y);
            (last.t[lane], last.root[lane]) = (t, root);
            last.cap[lane] = cap as u32;
        }
        self.count += 1;
    }

    /// Covers what the cap with some number covers.
    pub(crate) fn cover(&mut self, crossing: &Crossing, frame: &Frame, cap: usize) {
        let DVec2 { x, y } = crossing.toward(frame);
        self.push([x, y, crossing.t, crossing.root], cap);
    }

    /// Covers what the cap with some number does not cover.
    pub(crate) fn cover_rest(&mut self, crossing: &Crossing, frame: &Frame, cap: usize) {
        let DVec2 { x, y } = crossing.toward(frame);
        self.push([x, y, crossing.t, -crossing.root], cap);
    }

    /// Covers what some of eight caps with these numbers cover: the bits of a mask.
    pub(super) fn cover_lanes(&mut self, mask: u64, of: &Covered, numbers: &[u32]) {
        for lane in set_bits(mask) {
            let arc = [of.x[lane], of.y[lane], of.t[lane], of.root[lane]];
            self.push(arc, numbers[lane] as usize);
        }
    }

    /// Finds the arcs that are not covered; false if there are none.
    #[inline(always)]
    pub(super) fn expose<S: Simd>(&mut self, simd: S) -> bool {
        for group in &mut self.groups {
            let x = f64x8::from_array(simd, group.x);
            let y = f64x8::from_array(simd, group.y);
            let t = f64x8::from_array(simd, group.t);
            let root = f64x8::from_array(simd, group.root);
            let begin = order(x * t + y * root, y * t - x * root);
            let end = order(x * t - y * root, y * t + x * root);
            // Nothing, or the whole circle.
            let same = begin.simd_eq(end);
            if (same & (t * root).simd_lt(0.0)).any_true() {
                return false;
            }
            let none = f64x8::splat(simd, f64::NAN);
            group.begin = same.select(none, begin).into();
            group.end = same.select(none, end).into();
        }
        let mut is_whole = true;
        for number in 0..self.count {
            let end = self.groups[number / LANES].end[number % LANES];
            if end.is_nan() {
                continue;
            }
            is_whole = false;
            if !self.is_covered(simd, end) {
                self.add(number, end);
            }
        }
        is_whole || !self.exposed.is_empty()
    }

    /// True if an arc covers more than its end there.
    #[inline(always)]
    fn is_covered<S: Simd>(&self, simd: S, at: f64) -> bool {
        let at = f64x8::splat(simd, at);
        for group in &self.groups {
            let begin = f64x8::from_array(simd, group.begin);
            let end = f64x8::from_array(simd, group.end);
            let (after, before) = (begin.simd_le(at), at.simd_lt(end));
            let turns = end.simd_lt(begin);
            if (after & before | turns & (after | before)).any_true() {
                return true;
            }
        }
        false
    }

    /// Adds the exposed arc that begins where a covered one ends.
    fn add(&mut self, number: usize, from: f64) {
        if self.exposed.iter().any(|arc| arc.from == from) {
            return;
        }
        let (mut next, mut least) = (number, f64::INFINITY);
        for other in 0..self.count {
            let way = self.groups[other / LANES].begin[other % LANES] - from;
            let way = if way <= 0.0 { way + TURN } else { way };
            if way < least {
                (next, least) = (other, way);
            }
        }
        let end = |number: usize, sign: f64| {
            let (group, lane) = (&self.groups[number / LANES], number % LANES);
            let toward = DVec2::new(group.x[lane], group.y[lane]);
            let aside = toward.perp() * (group.root[lane] * sign);
            End {
                at: (toward * group.t[lane] + aside).normalize(),
                cap: group.cap[lane] as usize,
            }
        };
        let ends = [end(number, 1.0), end(next, -1.0)];
        self.exposed.push(Exposed {
            from,
            length: least,
            ends,
        });
    }

    /// The arcs that are not covered; none if the whole circle is not covered.
    pub(crate) fn exposed(&self) -> &[Exposed] {
        &self.exposed
    }
}
