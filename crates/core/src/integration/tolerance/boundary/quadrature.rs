//! The integral along an arc.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;
use glam::DVec3;

use super::super::contents::Contents;
use super::super::rule::{Roots, Rule, error_estimate};
use super::super::scene::InCamera;
use super::curve::{Piece, Shape, Trace, trace};
use super::primitive::{Lines, lit_up_to};
use super::{Arc, Boundary, Curve, Edge, NONE, Setting, Sum};
use crate::Radiance;

impl Boundary {
    /// Adds what an arc contributes.
    #[expect(
        clippy::too_many_arguments,
        reason = "all of it is at hand where it is called"
    )]
    #[inline(never)]
    pub(super) fn add_arc<S: Simd, C: Radiance>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        curve: &Curve,
        piece: &Piece,
        arc: &Arc,
        depth: u32,
        sum: &mut Sum<S>,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let Setting {
                    scene, cell, goal, ..
                } = *setting;
                if arc.end - arc.start < 1e-12 {
                    return;
                }
                let rule = Rule::of(Roots::default());
                let nodes: f64x8<S> = rule.nodes.simd_into(simd);
                let length = arc.end - arc.start;
                let places = trace(simd, cell, &curve.shape, piece, nodes * length + arc.start);
                let sign = sign(scene, setting.contents, curve, &places);
                let dy = places.dy * (length * sign);
                let fine: f64x8<S> = rule.fine.simd_into(simd);
                let coarse: f64x8<S> = rule.coarse.simd_into(simd);
                let zero = f64x8::splat(simd, 0.0);
                let (kept, kept_empty) = (sum.value, sum.empty);
                let mut light = [zero; 3];
                let mut doubt = zero;
                let mut is_empty = [0.0; 2];
                for (side, sphere) in [arc.inner, arc.outer].into_iter().enumerate() {
                    let factor = if side == 0 { 1.0 } else { -1.0 };
                    if sphere == NONE {
                        if side == 1 && matches!(curve.edge, Edge::Left | Edge::Right) {
                            continue;
                        }
                        is_empty[side] = factor;
                        for channel in 0..C::CHANNELS {
                            light[channel] += places.x * (factor * goal.background[channel]);
                        }
                        continue;
                    }
                    let active = &setting.contents.active[sphere];
                    let albedo = scene.world.albedo(active.sphere);
                    for channel in 0..C::CHANNELS {
                        light[channel] += places.x * (factor * (albedo * scene.ambient)[channel]);
                    }
                    // What both sides have need not be computed.
                    let mut lights = arc.lit[side];
                    if arc.inner == arc.outer {
                        lights &= !arc.lit[1 - side];
                    }
                    if lights != 0 {
                        let lines = Lines {
                            cell,
                            x: places.x,
                            y: places.y,
                        };
                        let summed = lit_up_to::<S, C>(
                            simd,
                            scene,
                            active,
                            &setting.finishes[sphere],
                            lights,
                            self.references[sphere],
                            &lines,
                            0.01 * goal.tolerance,
                        );
                        self.samples += summed.samples;
                        doubt += summed.doubt;
                        for channel in 0..C::CHANNELS {
                            light[channel] += summed.light[channel] * factor;
                        }
                    }
                }
                let empty = is_empty[0] + is_empty[1];
                let all = dy * fine;
                if empty != 0.0 {
                    sum.empty += places.x * all * empty;
                }
                let ends: [f64; 8] = [
                    arc.start, arc.end, arc.end, arc.end, arc.end, arc.end, arc.end, arc.end,
                ];
                let ends = trace(simd, cell, &curve.shape, piece, ends.simd_into(simd));
                let rise = (ends.y[1] - ends.y[0]) * sign;
                let slip = (total(all) - rise).abs();
                let of_sums = total(doubt * all.abs());
                let mut error = 0.0_f64;
                for channel in 0..C::CHANNELS {
                    let part = light[channel] * dy;
                    let (one, other) = (part * fine, part * coarse);
                    sum.value[channel] += one;
                    let difference = total(one - other).abs();
                    let spread = total(one.abs());
                    let highest = greatest(light[channel].abs());
                    error = error.max(error_estimate(difference, spread) + slip * highest);
                }
                if error > 0.02 * goal.tolerance && depth < 5 {
                    for (channel, kept) in kept.into_iter().enumerate() {
                        sum.value[channel] = kept;
                    }
                    sum.empty = kept_empty;
                    let middle = 0.5 * (arc.start + arc.end);
                    let halves = [(arc.start, middle), (middle, arc.end)];
                    for (start, end) in halves {
                        let half = Arc { start, end, ..*arc };
                        self.add_arc::<S, C>(simd, setting, curve, piece, &half, depth + 1, sum);
                    }
                    return;
                }
                sum.error += error + of_sums;
                self.note(arc.inner, arc.lit[0], rise);
                if !matches!(curve.edge, Edge::Left | Edge::Right) {
                    self.note(arc.outer, arc.lit[1], -rise);
                }
            },
        );
    }

    fn note(&mut self, sphere: usize, lit: u64, rise: f64) {
        let known = self
            .regions
            .iter_mut()
            .find(|region| region.0 == sphere && region.1 == lit);
        match known {
            Some(region) => region.2 += rise,
            None => self.regions.push((sphere, lit, rise)),
        }
    }
}

/// The sum of the lanes.
#[inline(always)]
pub(super) fn total<S: Simd>(lanes: f64x8<S>) -> f64 {
    let v: [f64; 8] = lanes.into();
    ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]))
}

fn greatest<S: Simd>(lanes: f64x8<S>) -> f64 {
    let v: [f64; 8] = lanes.into();
    v.into_iter().fold(0.0, f64::max)
}

/// 1 where the inner side lies to the left of a curve, -1 to its right.
#[inline(always)]
fn sign<S: Simd>(
    scene: &InCamera<'_>,
    contents: &Contents,
    curve: &Curve,
    places: &Trace<S>,
) -> f64 {
    /// A node in the middle.
    const MIDDLE: usize = 3;
    let point = DVec3::new(
        places.point.x[MIDDLE],
        places.point.y[MIDDLE],
        places.point.z[MIDDLE],
    );
    let inward = match (curve.edge, &curve.shape) {
        (Edge::Left, _) => return -1.0,
        (Edge::Right, _) => return 1.0,
        (Edge::Limb, _) => contents.active[curve.own[0]].ball.center,
        (Edge::Seam, Shape::Circle(circle)) => {
            let [one, other] = curve.own.map(|own| contents.active[own].ball.center);
            let axis = one - other;
            let along = axis.cross(point - circle.middle);
            let across = (point - one).cross(along);
            across * across.dot(axis).signum()
        }
        (Edge::Terminator(light), _) => scene.lights[light].toward,
        (
            Edge::Shadow(..),
            Shape::Shadow {
                circle,
                center,
                toward,
                ..
            },
        ) => {
            let from_center = point - *center;
            let height = from_center.dot(*toward);
            let aside = from_center - *toward * height;
            let away = aside - circle.middle;
            away - *toward * (aside.dot(away) / height)
        }
        _ => return 0.0,
    };
    let x = inward.x * point.z - point.x * inward.z;
    let y = inward.y * point.z - point.y * inward.z;
    (places.dx[MIDDLE] * y - places.dy[MIDDLE] * x).signum()
}
