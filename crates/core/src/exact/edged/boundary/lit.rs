//! The places along curves where lights begin and end on either side of them.

use fearless_simd::Simd;

use super::arcs::{Lanes, add, between};
use super::circle::Trace;
use super::cutoff_beside::CutoffBeside;
use super::events::{INTERVALS, Stretch};
use super::functions::{Function, ahead, facing, in_disc, is_beyond};
use super::primitive::ray;
use super::setting::{Arc, Boundary, Curve, Edge, NONE, Setting};
use crate::edges::terminator::Plane;
use crate::exact::classify::coincidence::is_contour;
use crate::exact::classify::reach::Reach;
use crate::exact::points::Points;
use crate::numeric::lanes::f64x8;

impl Boundary {
    /// Cuts the arcs of a piece where lights begin or end on either side; `whole` is all of it.
    #[inline(always)]
    pub(super) fn light_arcs<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        whole: &Stretch<'_>,
        places: &Trace<S>,
    ) {
        self.lit_arcs.clear();
        let curve = whole.curve;
        for index in 0..self.arcs.len() {
            let arc = self.arcs[index];
            let is_dark = [(arc.inner, 0), (arc.outer, 1)]
                .map(|(sphere, side)| arc.outlines[side] || is_dark(setting, sphere));
            if is_dark == [true; 2] {
                if curve.edge.light().is_none() {
                    add(&mut self.lit_arcs, arc);
                }
                continue;
            }
            let stretch = Stretch {
                start: arc.start,
                end: arc.end,
                ..*whole
            };
            let of_arc;
            let places = if arc.start == whole.start && arc.end == whole.end {
                places
            } else {
                of_arc = stretch.places(simd, setting);
                &of_arc
            };
            self.breaks.clear();
            let mut lit = [0; 2];
            if !is_dark[0] {
                lit[0] = self.find_light_breaks(simd, setting, &stretch, arc.inner, places);
            }
            if arc.has_one_surface() {
                lit[1] = lit[0];
            } else if !is_dark[1] {
                lit[1] = self.find_light_breaks(simd, setting, &stretch, arc.outer, places);
            }
            self.add_crossings(curve.edge, &stretch);
            if self.breaks.is_empty() {
                self.add_lit(curve, Arc { lit, ..arc });
            } else {
                self.light_steps(simd, setting, whole, &arc);
            }
        }
    }

    /// Adds the parts of an arc between the breaks.
    #[inline(never)]
    fn light_steps<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        whole: &Stretch<'_>,
        arc: &Arc,
    ) {
        self.order_breaks(arc.start, arc.end);
        let curve = whole.curve;
        let steps = self.breaks.len() - 1;
        for first in (0..steps).step_by(Lanes::STEPS) {
            let places = whole.trace(simd, setting, f64x8::from_array(simd, self.steps(first)));
            let mut lit = [[0; 8]; 2];
            if !arc.outlines[0] {
                lit[0] = self.lit(simd, setting, arc.inner, curve, &places);
            }
            if arc.has_one_surface() {
                lit[1] = lit[0];
            } else if !arc.outlines[1] {
                lit[1] = self.lit(simd, setting, arc.outer, curve, &places);
            }
            for step in 0..(steps - first).min(Lanes::STEPS) {
                let lanes = Lanes::of_step(step);
                let part = Arc {
                    start: self.breaks[first + step],
                    end: self.breaks[first + step + 1],
                    y: [places.y[lanes.start], places.y[lanes.end]],
                    lit: [lit[0][lanes.middle], lit[1][lanes.middle]],
                    ..*arc
                };
                self.add_lit(curve, part);
            }
        }
    }

    /// Adds a part of an arc that these lights reach, but for the event that the curve is.
    fn add_lit(&mut self, curve: &Curve, mut arc: Arc) {
        if let Some(light) = curve.edge.light() {
            if arc.lit[0] >> light & 1 == 0 {
                return;
            }
            arc.lit[1] = arc.lit[0] & !(1 << light);
        }
        add(&mut self.lit_arcs, arc);
    }

    /// Finds where lights begin or end on an active sphere along a stretch; returns those that reach its
    /// middle, if there are none.
    #[inline(never)]
    fn find_light_breaks<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        stretch: &Stretch<'_>,
        sphere: usize,
        places: &Trace<S>,
    ) -> u64 {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut lights_there = 0;
                if is_dark(setting, sphere) {
                    return lights_there;
                }
                let lights = setting.scene.lights.len();
                let reach = &setting.contents.reach[sphere * lights..][..lights];
                let curve = stretch.curve;
                let crossed = self.crossed(setting, stretch);
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
                    let is_own = curve.own[0] == sphere;
                    let plane = terminator_beside(setting, curve, sphere, light);
                    let mut dark = 0;
                    let facing = match plane {
                        Some(plane) => Some(facing(&plane, &active.ball, &points.normal)),
                        None => None,
                    };
                    if let Some(facing) = facing {
                        dark = facing.simd_le(0.0).to_bitmask();
                    }
                    let mut closed = between(dark);
                    let cutoff = CutoffBeside::of(setting, curve, sphere, light);
                    let ahead = match &cutoff {
                        CutoffBeside::Plane(plane) => {
                            Some(ahead(plane, setting, (sphere, light), &points))
                        }
                        CutoffBeside::Ahead | CutoffBeside::Beyond => None,
                    };
                    let beyond = match ahead {
                        Some(ahead) => ahead.simd_le(0.0).to_bitmask(),
                        None if matches!(cutoff, CutoffBeside::Beyond) => 0xff,
                        None => 0,
                    };
                    closed |= between(beyond);
                    dark |= beyond;
                    for caster in casters.clone() {
                        if is_own && curve.edge == Edge::Shadow(light, caster) {
                            continue;
                        }
                        let inside = in_disc(simd, setting, caster, &place).simd_lt(0.0);
                        let is_beyond = is_beyond(simd, setting, (light, caster), &place);
                        let shaded = (inside & is_beyond).to_bitmask();
                        closed |= between(shaded);
                        dark |= shaded;
                    }
                    lights_there |= (!dark >> Lanes::WHOLE.middle & 1) << light;
                    let open = INTERVALS & !closed & !crossed;
                    if open == 0 {
                        continue;
                    }
                    if let Some(facing) = facing {
                        let function = Function::Lit(sphere, light);
                        stretch.roots(simd, setting, function, facing, open, &mut self.breaks);
                    }
                    if let Some(ahead) = ahead {
                        let function = Function::Ahead(sphere, light);
                        stretch.roots(simd, setting, function, ahead, open, &mut self.breaks);
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
                lights_there
            },
        )
    }

    /// The lights that reach an active sphere at some visible places, but for the event that the
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
                if is_dark(setting, sphere) {
                    return masks;
                }
                let contents = setting.contents;
                let lights = setting.scene.lights.len();
                let reach = &contents.reach[sphere * lights..][..lights];
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
                    let plane = terminator_beside(setting, curve, sphere, light);
                    let mut lit = 0xff;
                    if let Some(plane) = plane {
                        let facing = facing(&plane, &active.ball, &points.normal);
                        lit = facing.simd_gt(0.0).to_bitmask();
                    }
                    match CutoffBeside::of(setting, curve, sphere, light) {
                        CutoffBeside::Plane(plane) => {
                            let ahead = ahead(&plane, setting, (sphere, light), &points);
                            lit &= ahead.simd_gt(0.0).to_bitmask();
                        }
                        CutoffBeside::Ahead => {}
                        CutoffBeside::Beyond => continue,
                    }
                    for caster in casters.clone() {
                        if is_own && curve.edge == Edge::Shadow(light, caster) {
                            continue;
                        }
                        let inside = in_disc(simd, setting, caster, &place).simd_lt(0.0);
                        let is_beyond = is_beyond(simd, setting, (light, caster), &place);
                        lit &= !(inside & is_beyond).to_bitmask();
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

/// The plane of the terminator of a light on an active sphere; none on the terminator itself, and none on a contour
/// that is one: there a light that reaches the sphere reaches all that is seen of it.
fn terminator_beside(
    setting: &Setting<'_, '_>,
    curve: &Curve,
    sphere: usize,
    light: usize,
) -> Option<Plane> {
    let active = &setting.contents.active[sphere];
    let plane = active
        .terminators
        .plane(setting.scene, &active.ball, light)?;
    let is_here = match curve.edge {
        Edge::Terminator(of_light) => of_light == light,
        Edge::Limb => setting.cell.is_parallel() && is_contour(&plane),
        _ => false,
    };
    (curve.own[0] != sphere || !is_here).then_some(plane)
}

/// Whether no light reaches an active sphere, or there is none.
fn is_dark(setting: &Setting<'_, '_>, sphere: usize) -> bool {
    let lights = setting.scene.lights.len();
    sphere == NONE
        || setting.contents.reach[sphere * lights..][..lights]
            .iter()
            .all(|reach| matches!(reach, Reach::Nowhere))
}
