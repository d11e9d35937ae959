//! Where along curves lights begin and end on either side of them.

use fearless_simd::prelude::*;

use super::arcs::{add, between};
use super::curve::{Piece, Trace};
use super::events::{Function, INTERVALS, Stretch, in_disc};
use super::primitive::ray;
use super::setting::{Arc, Boundary, Curve, Edge, NONE, Setting};
use crate::exact::classify::contents::Reach;
use crate::exact::points::Points;

impl Boundary {
    /// Cuts the arcs where lights begin or end on either side.
    #[inline(always)]
    pub(super) fn light_arcs<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        curve: &Curve,
        piece: &Piece,
    ) {
        self.lit_arcs.clear();
        for index in 0..self.arcs.len() {
            let arc = self.arcs[index];
            let stretch = Stretch {
                curve,
                piece,
                start: arc.start,
                end: arc.end,
            };
            self.breaks.clear();
            for (side, sphere) in [arc.inner, arc.outer].into_iter().enumerate() {
                if sphere != NONE && (side == 0 || sphere != arc.inner) {
                    self.find_light_breaks(simd, setting, &stretch, sphere);
                }
            }
            if [arc.inner, arc.outer]
                .iter()
                .all(|&sphere| is_dark(setting, sphere))
            {
                if !matches!(curve.edge, Edge::Terminator(_) | Edge::Shadow(..)) {
                    add(&mut self.lit_arcs, arc);
                }
                continue;
            }
            self.add_crossings(curve.edge, &stretch);
            self.order_breaks(arc.start, arc.end);
            let steps = self.breaks.len() - 1;
            let mut first = 0;
            while first < steps {
                let count = (steps - first).min(8);
                let middles = self.middles(first, count);
                let places = stretch.trace(simd, setting, middles.simd_into(simd));
                let mut lit = [[0; 8]; 2];
                if arc.inner != NONE {
                    lit[0] = self.lit(simd, setting, arc.inner, curve, &places);
                }
                if arc.outer == arc.inner {
                    lit[1] = lit[0];
                } else if arc.outer != NONE {
                    lit[1] = self.lit(simd, setting, arc.outer, curve, &places);
                }
                let [inner, outer] = lit;
                for (lane, sides) in inner.into_iter().zip(outer).enumerate().take(count) {
                    let mut here = <[u64; 2]>::from(sides);
                    if let Edge::Terminator(light) | Edge::Shadow(light, _) = curve.edge {
                        if here[0] >> light & 1 == 0 {
                            continue;
                        }
                        here[1] = here[0] & !(1 << light);
                    }
                    let arc = Arc {
                        start: self.breaks[first + lane],
                        end: self.breaks[first + lane + 1],
                        lit: here,
                        ..arc
                    };
                    add(&mut self.lit_arcs, arc);
                }
                first += count;
            }
        }
    }

    /// Finds where lights begin or end on an active sphere along a stretch.
    #[inline(never)]
    fn find_light_breaks<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        stretch: &Stretch<'_>,
        sphere: usize,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let lights = setting.scene.lights.len();
                let reach = &setting.contents.reach[sphere * lights..][..lights];
                if is_dark(setting, sphere) {
                    return;
                }
                let curve = stretch.curve;
                let places = stretch.places(simd, setting);
                let active = &setting.contents.active[sphere];
                let points = Points::new(
                    simd,
                    &active.ball,
                    ray(simd, setting.cell, places.x, places.y),
                );
                let place = points.place();
                for (light, reach) in reach.iter().enumerate() {
                    let Reach::Past(casters) = reach else {
                        continue;
                    };
                    let toward = setting.scene.lights[light].toward;
                    let is_own = curve.own[0] == sphere;
                    let mut axis = active.terminators.axis(setting.scene, light);
                    if is_own && curve.edge == Edge::Terminator(light) {
                        axis = None;
                    }
                    let facing = points.normal.dot_one(axis.unwrap_or(toward));
                    let mut closed = 0;
                    if axis.is_some() {
                        closed = between(facing.simd_lt(0.0).to_bitmask());
                    }
                    let height = place.dot_one(toward);
                    for caster in casters.clone() {
                        if is_own && curve.edge == Edge::Shadow(light, caster) {
                            continue;
                        }
                        let inside = in_disc(simd, setting, caster, &place).simd_lt(0.0);
                        let top = setting.contents.occluders[caster].center.dot(toward);
                        closed |= between((inside & height.simd_lt(top)).to_bitmask());
                    }
                    let open = INTERVALS & !closed;
                    if open == 0 {
                        continue;
                    }
                    if axis.is_some() {
                        let function = Function::Lit(sphere, light);
                        stretch.roots(simd, setting, function, facing, open, &mut self.breaks);
                    }
                    for caster in casters.clone() {
                        if is_own && curve.edge == Edge::Shadow(light, caster) {
                            continue;
                        }
                        let values = in_disc(simd, setting, caster, &place);
                        let function = Function::Shaded(sphere, caster);
                        stretch.roots(simd, setting, function, values, open, &mut self.breaks);
                    }
                }
            },
        )
    }

    /// Which lights reach an active sphere where it is seen at some places, but for the event that the
    /// curve is.
    #[inline(never)]
    fn lit<S: Simd>(
        &self,
        simd: S,
        setting: &Setting<'_, '_>,
        sphere: usize,
        curve: &Curve,
        places: &Trace<S>,
    ) -> [u64; 8] {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut masks = [0; 8];
                let contents = setting.contents;
                let lights = setting.scene.lights.len();
                let reach = &contents.reach[sphere * lights..][..lights];
                if is_dark(setting, sphere) {
                    return masks;
                }
                let active = &contents.active[sphere];
                let points = Points::new(
                    simd,
                    &active.ball,
                    ray(simd, setting.cell, places.x, places.y),
                );
                let place = points.place();
                let is_own = curve.own[0] == sphere;
                for (light, reach) in reach.iter().enumerate() {
                    let Reach::Past(casters) = reach else {
                        continue;
                    };
                    let toward = setting.scene.lights[light].toward;
                    let mut axis = active.terminators.axis(setting.scene, light);
                    if is_own && curve.edge == Edge::Terminator(light) {
                        axis = None;
                    }
                    let mut lit = 0xff;
                    if let Some(axis) = axis {
                        lit = points.normal.dot_one(axis).simd_gt(0.0).to_bitmask();
                    }
                    let height = place.dot_one(toward);
                    for caster in casters.clone() {
                        if is_own && curve.edge == Edge::Shadow(light, caster) {
                            continue;
                        }
                        let inside = in_disc(simd, setting, caster, &place).simd_lt(0.0);
                        let top = contents.occluders[caster].center.dot(toward);
                        lit &= !(inside & height.simd_lt(top)).to_bitmask();
                        if lit == 0 {
                            break;
                        }
                    }
                    for (lane, mask) in masks.iter_mut().enumerate() {
                        *mask |= (lit >> lane & 1) << light;
                    }
                }
                masks
            },
        )
    }
}

/// Whether no light reaches an active sphere, or there is none.
fn is_dark(setting: &Setting<'_, '_>, sphere: usize) -> bool {
    let lights = setting.scene.lights.len();
    sphere == NONE
        || setting.contents.reach[sphere * lights..][..lights]
            .iter()
            .all(|reach| matches!(reach, Reach::Nowhere))
}
