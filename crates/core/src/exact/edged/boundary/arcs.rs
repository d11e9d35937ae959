//! The visible parts of curves, and the surfaces on either side of them.

use fearless_simd::Simd;

use super::circle::Trace;
use super::events::{INTERVALS, Stretch};
use super::functions::{Function, polynomial, value};
use super::outlines::outlines;
use super::setting::{Arc, Boundary, Curve, Edge, NONE, Setting};
use crate::exact::classify::contents::Contents;
use crate::numeric::lanes::f64x8;
use crate::numeric::pair::both;

/// The surface in front of a curve, or next behind it, at eight places.
#[derive(Clone, Copy)]
pub(super) struct Front<S: Simd> {
    /// In multiples of the ray, whose third component is 1.
    pub(super) nearest: f64x8<S>,
    /// The position of the sphere and one more, or zero.
    pub(super) first: f64x8<S>,
    /// The active sphere that hides all of the places, if one does. What else is in front is not known then.
    pub(super) hider: Option<usize>,
}

impl<S: Simd> Front<S> {
    /// At which of the places an active sphere is first.
    #[inline(always)]
    pub(super) fn is(&self, sphere: usize) -> u64 {
        self.first.simd_eq((sphere + 1) as f64).to_bitmask()
    }

    /// At which of the places it hides a curve.
    #[inline(always)]
    fn hidden(&self, curve: &Curve, places: &Trace<S>) -> u64 {
        if curve.is_side() {
            0
        } else if self.hider.is_some() {
            0xff
        } else {
            self.nearest.simd_lt(places.point.z).to_bitmask()
        }
    }
}

/// Intervals that begin and end at some of the places.
pub(super) fn between(lanes: u64) -> u64 {
    lanes & lanes >> 1 & INTERVALS
}

/// The first of the active spheres on which a curve does not lie, at some places of it.
#[inline(never)]
pub(super) fn front<S: Simd>(
    simd: S,
    contents: &Contents,
    own: [usize; 2],
    places: &Trace<S>,
) -> Front<S> {
    simd.vectorize(
        #[inline(always)]
        || {
            let zero = f64x8::splat(simd, 0.0);
            let mut front = Front {
                nearest: f64x8::splat(simd, f64::INFINITY),
                first: zero,
                hider: None,
            };
            let (x, y) = (places.x, places.y);
            for (position, active) in contents.active.iter().enumerate() {
                if own.contains(&position) {
                    continue;
                }
                let discriminant = polynomial(&active.discriminant, x, y);
                let mut covers = discriminant.simd_ge(0.0);
                if covers.to_bitmask() == 0 {
                    continue;
                }
                let along = x * active.along.x + y * active.along.y + active.along.one;
                let root = discriminant.max(zero).sqrt();
                let t = if active.ball.is_parallel() {
                    let (ball, point) = (&active.ball, &places.point);
                    if ball.outside <= 0.0 {
                        along + root
                    } else if ball.is_apart() {
                        along - root
                    } else {
                        let (u, v) = (point.x, point.y);
                        let power = u * (u - 2.0 * ball.center.x) + v * (v - 2.0 * ball.center.y);
                        (power + ball.power) / (along + root)
                    }
                } else if active.ball.outside > 0.0 {
                    covers &= along.simd_gt(0.0);
                    f64x8::splat(simd, active.ball.outside) / (along + root)
                } else {
                    (along + root) / places.point.length_squared() * places.point.z * places.point.z
                };
                let lanes = covers.to_bitmask();
                let is_nearer = covers & t.simd_lt(front.nearest);
                front.nearest = is_nearer.select(t, front.nearest);
                front.first =
                    is_nearer.select(f64x8::splat(simd, (position + 1) as f64), front.first);
                let is_hidden = lanes == 0xff && t.simd_lt(places.point.z).to_bitmask() == 0xff;
                if is_hidden && own[0] != NONE {
                    front.hider = Some(position);
                    return front;
                }
            }
            front
        },
    )
}

/// The lanes of a trace in which a part of a stretch begins, is halfway, and ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lanes {
    pub(super) start: usize,
    pub(super) middle: usize,
    pub(super) end: usize,
}

impl Lanes {
    /// Those of a stretch at whose eight places nothing changes.
    pub(super) const WHOLE: Self = Self {
        start: 0,
        middle: 3,
        end: 7,
    };
    /// As many steps between breaks as a trace has room for.
    pub(super) const STEPS: usize = 3;

    /// Those of a step between breaks, in the order of [`Boundary::steps`].
    pub(super) fn of_step(step: usize) -> Self {
        Self {
            start: Self::STEPS + step,
            middle: step,
            end: Self::STEPS + step + 1,
        }
    }
}

impl Boundary {
    /// Finds the parts of a piece that are seen; `whole` is all of it.
    #[inline(always)]
    pub(super) fn find_arcs<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        whole: &Stretch<'_>,
        places: &Trace<S>,
    ) {
        self.arcs.clear();
        self.breaks.clear();
        let curve = whole.curve;
        if !self.find_own_breaks(simd, setting, whole, places) {
            return;
        }
        if self.breaks.is_empty() {
            let own_hidden = own_hidden(simd, setting, curve, places);
            if own_hidden >> Lanes::WHOLE.middle & 1 == 1 {
                return;
            }
            let front = self.find_breaks(simd, setting, whole, places);
            self.add_crossings(curve.edge, whole);
            if self.breaks.is_empty() {
                let hidden = front.hidden(curve, places);
                self.see(setting, whole, Lanes::WHOLE, places, &front, hidden);
                return;
            }
            self.order_breaks(0.0, 1.0);
        } else if matches!(curve.edge, Edge::Shadow(..)) {
            self.find_breaks_by_parts(simd, setting, whole);
        } else {
            self.find_breaks(simd, setting, whole, places);
            self.order_breaks(0.0, 1.0);
        }
        self.see_steps(simd, setting, whole);
    }

    /// Finds the breaks of the edge of a shadow between those that are known: what is in the cell may be a
    /// small part of it.
    #[inline(never)]
    fn find_breaks_by_parts<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        whole: &Stretch<'_>,
    ) {
        self.order_breaks(0.0, 1.0);
        let known = self.breaks.len();
        for first in (0..known - 1).step_by(Lanes::STEPS) {
            let count = (known - 1 - first).min(Lanes::STEPS);
            let places = whole.trace(simd, setting, f64x8::from_array(simd, self.steps(first)));
            let hidden = own_hidden(simd, setting, whole.curve, &places);
            for step in 0..count {
                if hidden >> step & 1 == 0 {
                    let part = Stretch {
                        start: self.breaks[first + step],
                        end: self.breaks[first + step + 1],
                        ..*whole
                    };
                    let places = part.places(simd, setting);
                    self.find_breaks(simd, setting, &part, &places);
                }
            }
        }
        self.breaks.sort_unstable_by(f64::total_cmp);
    }

    /// Adds to the breaks of a piece of a side, or of a part of it, where curves are known to cross it.
    pub(super) fn add_crossings(&mut self, edge: Edge, stretch: &Stretch<'_>) {
        let side = match edge {
            Edge::Left => 0,
            Edge::Right => 1,
            _ => return,
        };
        let [low, high] = both(stretch.piece.ends, |end| end.y);
        for y in &self.crossings[side] {
            let at = (y - low) / (high - low);
            if at > stretch.start && at < stretch.end {
                self.breaks.push(at);
            }
        }
    }

    /// The intervals of a part of a side in which curves are known to cross it: what changes there needs
    /// not be looked for. A change that no known curve makes leaves regions open, which counts as error;
    /// finer parts look for all of them.
    pub(super) fn crossed(&self, setting: &Setting<'_, '_>, stretch: &Stretch<'_>) -> u64 {
        let side = match stretch.curve.edge {
            Edge::Left => 0,
            Edge::Right => 1,
            _ => return 0,
        };
        if setting.goal.parts > 1 {
            return 0;
        }
        let [low, high] = both(stretch.piece.ends, |end| end.y);
        let mut intervals = 0;
        for y in &self.crossings[side] {
            let at = (y - low) / (high - low);
            let share = (at - stretch.start) / (stretch.end - stretch.start);
            if share > 0.0 && share < 1.0 {
                intervals |= 1 << (share * 7.0) as u64;
            }
        }
        intervals & INTERVALS
    }

    /// Brings the breaks in order, between two ends.
    pub(super) fn order_breaks(&mut self, start: f64, end: f64) {
        self.breaks.push(start);
        self.breaks.push(end);
        self.breaks.sort_unstable_by(f64::total_cmp);
    }

    /// Parameters of three steps between breaks, from the break with this number: their middles, then the breaks
    /// at their ends. After the last break it repeats.
    pub(super) fn steps(&self, first: usize) -> [f64; 8] {
        let last = self.breaks.len() - 1;
        let at = |index: usize| self.breaks[(first + index).min(last)];
        let middle = |step: usize| 0.5 * (at(step) + at(step + 1));
        [
            middle(0),
            middle(1),
            middle(2),
            at(0),
            at(1),
            at(2),
            at(3),
            at(3),
        ]
    }

    /// Finds what is seen beside the curve between the breaks.
    #[inline(always)]
    fn see_steps<S: Simd>(&mut self, simd: S, setting: &Setting<'_, '_>, whole: &Stretch<'_>) {
        let steps = self.breaks.len() - 1;
        for first in (0..steps).step_by(Lanes::STEPS) {
            let places = whole.trace(simd, setting, f64x8::from_array(simd, self.steps(first)));
            let front = front(simd, setting.contents, whole.curve.own, &places);
            let hidden = front.hidden(whole.curve, &places)
                | own_hidden(simd, setting, whole.curve, &places);
            for step in 0..(steps - first).min(Lanes::STEPS) {
                let part = Stretch {
                    start: self.breaks[first + step],
                    end: self.breaks[first + step + 1],
                    ..*whole
                };
                self.see(
                    setting,
                    &part,
                    Lanes::of_step(step),
                    &places,
                    &front,
                    hidden,
                );
            }
        }
    }

    /// Adds a part of a piece on which the same is seen, if it is not hidden; notes where it ends on an
    /// upright side of the cell.
    #[inline(always)]
    fn see<S: Simd>(
        &mut self,
        setting: &Setting<'_, '_>,
        part: &Stretch<'_>,
        lanes: Lanes,
        places: &Trace<S>,
        front: &Front<S>,
        hidden: u64,
    ) {
        /// Places that count as on a side.
        const NEAR: f64 = 1e-6;
        if hidden >> lanes.middle & 1 == 1 {
            return;
        }
        let curve = part.curve;
        let first = (front.first[lanes.middle] as usize).wrapping_sub(1);
        let (inner, outer) = match curve.edge {
            Edge::Left | Edge::Right => (first, NONE),
            Edge::Limb => (curve.own[0], first),
            Edge::Seam => (curve.own[0], curve.own[1]),
            Edge::Terminator(_) | Edge::Cutoff(_) | Edge::Shadow(..) | Edge::Outline => {
                (curve.own[0], curve.own[0])
            }
        };
        let outlines = outlines(setting, curve, [inner, outer], (places, lanes.middle));
        let arc = Arc {
            start: part.start,
            end: part.end,
            y: [places.y[lanes.start], places.y[lanes.end]],
            inner,
            outer,
            outlines,
            lit: [0; 2],
        };
        if !curve.is_side() {
            for (lane, y) in [lanes.start, lanes.end].into_iter().zip(arc.y) {
                let x = places.x[lane];
                if (x.abs() - 0.5).abs() < NEAR {
                    self.crossings[usize::from(x > 0.0)].push(y);
                }
            }
        }
        add(&mut self.arcs, arc);
    }
}

/// The places where a curve lies on the far side of its own spheres, out of the cell, or above its caster.
#[inline(never)]
fn own_hidden<S: Simd>(
    simd: S,
    setting: &Setting<'_, '_>,
    curve: &Curve,
    places: &Trace<S>,
) -> u64 {
    simd.vectorize(
        #[inline(always)]
        || {
            let mut hidden = 0;
            if curve.is_side() || matches!(curve.edge, Edge::Limb | Edge::Outline) {
                return hidden;
            }
            for own in curve.own {
                if own != NONE {
                    let facing = value(simd, setting, Function::Facing(own), places);
                    hidden |= facing.simd_le(0.0).to_bitmask();
                }
            }
            if curve.is_within_outline() && setting.contents.has_outlines() {
                let within = value(simd, setting, Function::Outline(curve.own[0]), places);
                hidden |= within.simd_lt(0.0).to_bitmask();
            }
            if let Edge::Shadow(light, caster) = curve.edge {
                let above = value(simd, setting, Function::Above(light, caster), places);
                hidden |= above.simd_ge(0.0).to_bitmask();
                let far = places.x.abs().max(places.y.abs());
                hidden |= far.simd_gt(0.5).to_bitmask() | places.point.z.simd_le(0.0).to_bitmask();
            }
            hidden
        },
    )
}

/// Adds an arc, to the last one where that goes on.
pub(super) fn add(arcs: &mut Vec<Arc>, arc: Arc) {
    match arcs.last_mut() {
        Some(last)
            if last.end == arc.start
                && last.inner == arc.inner
                && last.outer == arc.outer
                && last.outlines == arc.outlines
                && last.lit == arc.lit =>
        {
            last.end = arc.end;
            last.y[1] = arc.y[1];
        }
        _ => arcs.push(arc),
    }
}
