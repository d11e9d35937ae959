//! Which parts of curves are seen, and what lies on either side of them.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::curve::{Piece, Trace};
use super::events::{Function, INTERVALS, Stretch, polynomial, value};
use super::setting::{Arc, Boundary, Curve, Edge, NONE, Setting};
use crate::exact::classify::contents::Contents;

/// What is in front, or next behind a curve, at eight places.
#[derive(Clone, Copy)]
pub(super) struct Front<S: Simd> {
    /// In multiples of the ray.
    pub(super) nearest: f64x8<S>,
    /// The position of the sphere and one more, or zero.
    pub(super) first: f64x8<S>,
    /// Whether one sphere hides all of the places.
    pub(super) is_hidden: bool,
}

impl<S: Simd> Front<S> {
    /// At which of the places an active sphere is first.
    #[inline(always)]
    pub(super) fn is(&self, sphere: usize) -> u64 {
        self.first.simd_eq((sphere + 1) as f64).to_bitmask()
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
                is_hidden: false,
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
                let t = if active.ball.outside > 0.0 {
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
                    front.is_hidden = true;
                    return front;
                }
            }
            front
        },
    )
}

impl Boundary {
    /// Finds the parts of a piece that are seen.
    #[inline(always)]
    pub(super) fn find_arcs<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        curve: &Curve,
        piece: &Piece,
    ) {
        self.arcs.clear();
        self.breaks.clear();
        let stretch = Stretch {
            curve,
            piece,
            start: 0.0,
            end: 1.0,
        };
        let places = stretch.places(simd, setting);
        if !self.find_own_breaks(simd, setting, &stretch, &places) {
            return;
        }
        if matches!(curve.edge, Edge::Shadow(..)) {
            // What is in the cell may be a small part of the piece.
            self.order_breaks(0.0, 1.0);
            let known = self.breaks.len();
            let mut first = 0;
            while first + 1 < known {
                let count = (known - 1 - first).min(8);
                let middles = self.middles(first, count);
                let middles = stretch.trace(simd, setting, middles.simd_into(simd));
                let hidden = own_hidden(simd, setting, curve, &middles);
                for lane in 0..count {
                    if hidden >> lane & 1 == 0 {
                        let part = Stretch {
                            start: self.breaks[first + lane],
                            end: self.breaks[first + lane + 1],
                            ..stretch
                        };
                        let places = part.places(simd, setting);
                        self.find_breaks(simd, setting, &part, &places);
                    }
                }
                first += count;
            }
            self.breaks.sort_unstable_by(f64::total_cmp);
        } else {
            self.find_breaks(simd, setting, &stretch, &places);
            self.add_crossings(curve.edge, &stretch);
            self.order_breaks(0.0, 1.0);
        }
        self.see_arcs(simd, setting, &stretch);
        self.note_crossings(simd, setting, &stretch);
    }

    /// Notes where what is seen of a piece ends on an upright side of the cell.
    #[inline(always)]
    fn note_crossings<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        stretch: &Stretch<'_>,
    ) {
        /// Places that count as on a side.
        const NEAR: f64 = 1e-6;
        if matches!(stretch.curve.edge, Edge::Left | Edge::Right) {
            return;
        }
        for chunk in self.arcs.chunks(4) {
            let mut ends = [0.0; 8];
            for (ends, arc) in ends.chunks_mut(2).zip(chunk) {
                ends.copy_from_slice(&[arc.start, arc.end]);
            }
            let places = stretch.trace(simd, setting, ends.simd_into(simd));
            for lane in 0..2 * chunk.len() {
                let side = usize::from(places.x[lane] > 0.0);
                if (places.x[lane].abs() - 0.5).abs() < NEAR {
                    self.crossings[side].push(places.y[lane]);
                }
            }
        }
    }

    /// Adds to the breaks of a piece of a side, or of a part of it, where curves are known to cross it.
    pub(super) fn add_crossings(&mut self, edge: Edge, stretch: &Stretch<'_>) {
        let side = match edge {
            Edge::Left => 0,
            Edge::Right => 1,
            _ => return,
        };
        let [low, high] = stretch.piece.ends.map(|end| end.y);
        for y in &self.crossings[side] {
            let at = (y - low) / (high - low);
            if at > stretch.start && at < stretch.end {
                self.breaks.push(at);
            }
        }
    }

    /// Brings the breaks in order, between two ends.
    pub(super) fn order_breaks(&mut self, start: f64, end: f64) {
        self.breaks.push(start);
        self.breaks.push(end);
        self.breaks.sort_unstable_by(f64::total_cmp);
    }

    /// The middles between eight of the breaks and the next ones.
    pub(super) fn middles(&self, first: usize, count: usize) -> [f64; 8] {
        let mut middles = [0.0; 8];
        for (lane, middle) in middles.iter_mut().enumerate() {
            let at = first + lane.min(count - 1);
            *middle = 0.5 * (self.breaks[at] + self.breaks[at + 1]);
        }
        middles
    }

    /// Finds what is seen beside the curve between the breaks.
    #[inline(always)]
    fn see_arcs<S: Simd>(&mut self, simd: S, setting: &Setting<'_, '_>, stretch: &Stretch<'_>) {
        let (contents, curve) = (setting.contents, stretch.curve);
        let steps = self.breaks.len() - 1;
        let mut first = 0;
        while first < steps {
            let count = (steps - first).min(8);
            let middles = self.middles(first, count);
            let places = stretch.trace(simd, setting, middles.simd_into(simd));
            let front = front(simd, contents, curve.own, &places);
            let mut hidden = front.nearest.simd_lt(places.point.z).to_bitmask();
            if matches!(curve.edge, Edge::Left | Edge::Right) {
                hidden = 0;
            } else if front.is_hidden {
                hidden = 0xff;
            }
            hidden |= own_hidden(simd, setting, curve, &places);
            let firsts: [f64; 8] = front.first.into();
            for (lane, first_here) in firsts.into_iter().enumerate().take(count) {
                if hidden >> lane & 1 == 1 {
                    continue;
                }
                let seen = (first_here as usize).wrapping_sub(1);
                let (inner, outer) = match curve.edge {
                    Edge::Left | Edge::Right => (seen, NONE),
                    Edge::Limb => (curve.own[0], seen),
                    Edge::Seam => (curve.own[0], curve.own[1]),
                    Edge::Terminator(_) | Edge::Shadow(..) => (curve.own[0], curve.own[0]),
                };
                let arc = Arc {
                    start: self.breaks[first + lane],
                    end: self.breaks[first + lane + 1],
                    inner,
                    outer,
                    lit: [0; 2],
                };
                add(&mut self.arcs, arc);
            }
            first += count;
        }
    }
}

/// Where a curve lies on the far side of its own spheres, out of the cell, or above its caster.
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
            if matches!(curve.edge, Edge::Left | Edge::Right | Edge::Limb) {
                return hidden;
            }
            for own in curve.own {
                if own != NONE {
                    let facing = value(simd, setting, Function::Facing(own), places);
                    hidden |= facing.simd_le(0.0).to_bitmask();
                }
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
                && last.lit == arc.lit =>
        {
            last.end = arc.end;
        }
        _ => arcs.push(arc),
    }
}
