//! The integral along an arc.

use fearless_simd::Simd;

use super::circle::Trace;
use super::curve::{trace, warped};
use super::hard_arcs::{roots_at_ends, spans_bumps};
use super::inward::sign;
use super::primitive::{Lines, Sender, greatest};
use super::setting::{Arc, Boundary, Curve, Edge, NONE, Path, Region, Setting, Sum};
use crate::exact::edged::rule::{MIDDLE, RULE, doubt, error_estimate};
use crate::exact::scene::InCamera;
use crate::model::color::Color;
use crate::numeric::lanes::f64x8;

/// The factor between the error that the rules are taken to have and their difference.
const CAUTION: f64 = 3.0;

/// The number of times that arcs are halved: towards an end where light goes with a root, or a small power, of the
/// distance, only the last half is.
const DEEPEST: u32 = 12;

/// Arcs that are not worth it, in pieces.
const SHORTEST: f64 = 1e-12;

/// The share of the square of an arc's rise that may be lit between its lines, where none is. Lines are less than
/// 0.22 of the rise apart; what lies between them is about as wide as it is high, and ends in between.
const OF_TIP: f64 = 0.05;

/// The share of the tolerance that this may take on an arc before it is halved: few arcs have any.
const SHARE_OF_TIP: f64 = 0.1;

/// The part of what the rules differ by that they are taken to be off by at least.
///
/// Sums along lines are not analytic everywhere: over bumps their second derivatives jump, and near corners of what
/// is seen they are nearly singular. There Kronrod's rule is off by a tenth of the difference, as a median, seldom
/// by all of it; a power of the difference claims a fiftieth, which one pixel in ten million found out.
const LEAST_OF_DIFFERENCE: f64 = 0.4;

/// The light on both sides of an arc, at the nodes of the rule: summed up from references.
struct Sides<S: Simd> {
    light: [f64x8<S>; 3],
    doubt: f64x8<S>,
    unevenness: f64,
    tip: f64,
    /// 1 if nothing is seen on the inner side, less 1 if nothing is seen on the outer one.
    empty: f64,
}

/// The error that a rule is taken to have, from the difference of two rules and the spread of the function.
#[inline(always)]
fn claim(difference: f64, spread: f64) -> f64 {
    error_estimate(difference, spread).max(LEAST_OF_DIFFERENCE * difference)
}

impl Boundary {
    /// Adds what an arc contributes.
    #[inline(never)]
    pub(super) fn add_arc<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        path: &Path<'_>,
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
                let length = arc.end - arc.start;
                if length < SHORTEST {
                    return;
                }
                let Path { curve, piece } = *path;
                let nodes: f64x8<S> = f64x8::from_array(simd, RULE.nodes);
                let is_singular = setting.is_singular(arc);
                let mut roots = [is_singular; 2];
                let (mut shares, mut slope) = warped(roots, nodes);
                let at = shares * length + arc.start;
                let mut places = trace(simd, cell, &curve.shape, piece, at);
                if !is_singular {
                    roots = roots_at_ends(setting, curve, arc, &places);
                    if roots.contains(&true) {
                        (shares, slope) = warped(roots, nodes);
                        let at = shares * length + arc.start;
                        places = trace(simd, cell, &curve.shape, piece, at);
                    }
                }
                let middle = (arc.start + length * shares[MIDDLE], places.y[MIDDLE]);
                if depth < DEEPEST && setting.has_bumps && spans_bumps(simd, setting, arc, &places)
                {
                    self.add_halves(simd, setting, path, (arc, middle), depth, sum);
                    return;
                }
                let sign = sign((scene, cell), setting.contents, curve, &places);
                let rise = (arc.y[1] - arc.y[0]) * sign;
                if !sends_light(setting, curve, arc) {
                    self.note_sides(curve, arc, rise);
                    return;
                }
                let dy = places.dy * slope * (length * sign);
                let fine: f64x8<S> = f64x8::from_array(simd, RULE.fine);
                let coarse: f64x8<S> = f64x8::from_array(simd, RULE.coarse);
                let odd: f64x8<S> = f64x8::from_array(simd, RULE.odd);
                let sides = self.sides(simd, setting, curve, arc, &places);
                let all = dy * fine;
                let slip = (total(all) - rise).abs();
                let mut error = 0.0_f64;
                let kept = *sum;
                if sides.empty != 0.0 {
                    let (one, other) = (places.x * all, places.x * dy * coarse);
                    sum.empty += one * sides.empty;
                    let spread = total((places.x * dy - total(one)).abs() * fine);
                    let of_odd = total(places.x * dy * odd);
                    let difference = doubt(total(one - other), of_odd);
                    error = goal.of_coverage * (claim(difference, spread) + slip);
                }
                let mut square = 0.0;
                for (channel, light) in sides.light.into_iter().enumerate().take(scene.channels) {
                    let part = light * dy;
                    let (one, other) = (part * fine, part * coarse);
                    sum.value[channel] += one;
                    let apart = total(one - other).abs();
                    let difference = doubt(apart, total(part * odd));
                    let mean = total(one);
                    let spread = total((part - mean).abs() * fine);
                    let highest = greatest(light.abs());
                    let mut estimate = claim(difference, spread);
                    if is_singular {
                        // Of a power at an end both rules are off by a fixed ratio.
                        estimate = apart;
                    }
                    if sides.unevenness > 0.0 {
                        estimate = difference.max(sides.unevenness * spread);
                    }
                    estimate += slip * highest;
                    error = error.max(estimate);
                    square += estimate * estimate;
                }
                if scene.is_of_normals {
                    // In any direction.
                    error = error.max(square.sqrt());
                }
                let tip = OF_TIP * sides.tip * rise * rise;
                let is_over = self.work.units() > goal.units;
                let is_coarse =
                    error > setting.share * goal.tolerance || tip > SHARE_OF_TIP * goal.tolerance;
                if is_coarse && depth < DEEPEST && !is_over {
                    *sum = kept;
                    self.add_halves(simd, setting, path, (arc, middle), depth, sum);
                    return;
                }
                let of_sums = total(sides.doubt * all.abs());
                sum.error += CAUTION * (error + of_sums) + tip;
                self.note_sides(curve, arc, rise);
            },
        );
    }

    /// Adds what both halves of an arc contribute, which meet at this parameter and y.
    fn add_halves<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        path: &Path<'_>,
        (arc, middle): (&Arc, (f64, f64)),
        depth: u32,
        sum: &mut Sum<S>,
    ) {
        let ends = [(arc.start, arc.y[0]), middle, (arc.end, arc.y[1])];
        for half in ends.windows(2) {
            let half = Arc {
                start: half[0].0,
                end: half[1].0,
                y: [half[0].1, half[1].1],
                ..*arc
            };
            self.add_arc(simd, setting, path, &half, depth + 1, sum);
        }
    }

    /// The light on either side of an arc.
    #[inline(always)]
    fn sides<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        curve: &Curve,
        arc: &Arc,
        places: &Trace<S>,
    ) -> Sides<S> {
        let Setting {
            scene, cell, goal, ..
        } = *setting;
        let zero = f64x8::splat(simd, 0.0);
        let mut sides = Sides {
            light: [zero; 3],
            doubt: zero,
            unevenness: 0.0,
            tip: 0.0,
            empty: 0.0,
        };
        for (side, sphere) in [arc.inner, arc.outer].into_iter().enumerate() {
            let factor = if side == 0 { 1.0 } else { -1.0 };
            if sphere == NONE {
                if side == 1 && matches!(curve.edge, Edge::Left | Edge::Right) {
                    continue;
                }
                sides.empty += factor;
                for (channel, light) in sides.light.iter_mut().enumerate().take(scene.channels) {
                    *light += places.x * (factor * goal.background[channel]);
                }
                continue;
            }
            let active = &setting.contents.active[sphere];
            let unlit = unlit(scene, active.sphere, arc.outlines[side]) * factor;
            for (channel, light) in sides.light.iter_mut().enumerate().take(scene.channels) {
                *light += places.x * unlit[channel];
            }
            // What both sides have need not be computed.
            let mut lights = arc.lit[side];
            if arc.has_one_surface() {
                lights &= !arc.lit[1 - side];
            }
            if lights == 0 {
                continue;
            }
            let surface = &setting.surfaces[sphere];
            let sender = Sender {
                scene,
                cell,
                active,
                finish: &surface.finish,
                reference: &surface.reference,
                terminators: surface.terminators,
                cutoffs: surface.cutoffs,
                rules: &surface.rules,
                tolerance: goal.tolerance,
            };
            let lines = Lines {
                x: places.x,
                y: places.y,
                lights,
                diffuse: lights,
            };
            let summed = sender.lit_up_to(simd, &lines, &mut self.noise);
            self.work.samples += summed.samples;
            self.lines += if summed.samples > 0 { 8 } else { 0 };
            sides.doubt += summed.doubt;
            sides.unevenness = sides.unevenness.max(summed.unevenness);
            sides.tip += summed.tip;
            for (channel, light) in sides.light.iter_mut().enumerate().take(scene.channels) {
                *light += summed.light[channel] * factor;
            }
        }
        sides
    }

    /// Notes how far an arc rises for what lies on either side.
    fn note_sides(&mut self, curve: &Curve, arc: &Arc, rise: f64) {
        self.note((arc.inner, arc.outlines[0], arc.lit[0]), rise);
        if !matches!(curve.edge, Edge::Left | Edge::Right) {
            self.note((arc.outer, arc.outlines[1], arc.lit[1]), -rise);
        }
    }

    fn note(&mut self, region: Region, rise: f64) {
        let known = self.regions.iter_mut().find(|known| known.0 == region);
        match known {
            Some(known) => known.1 += rise,
            None => self.regions.push((region, rise)),
        }
    }
}

/// The light of a sphere, or of its outline, that no light has a part in.
fn unlit(scene: &InCamera<'_>, sphere: usize, is_outline: bool) -> Color {
    if is_outline {
        scene.outline_color(sphere)
    } else {
        scene.world.albedo(sphere) * scene.ambient
    }
}

/// Whether anything but darkness lies on either side of an arc.
fn sends_light(setting: &Setting<'_, '_>, curve: &Curve, arc: &Arc) -> bool {
    let scene = setting.scene;
    let sides = [(arc.inner, arc.lit[0]), (arc.outer, arc.lit[1])];
    let is_side = matches!(curve.edge, Edge::Left | Edge::Right);
    sides
        .iter()
        .enumerate()
        .any(|(index, &(sphere, lit))| match sphere {
            NONE => index == 0 || !is_side,
            _ if arc.outlines[index] => true,
            _ => lit != 0 || scene.ambient.max_element() > 0.0,
        })
}

/// The sum of the lanes.
#[inline(always)]
pub(super) fn total<S: Simd>(lanes: f64x8<S>) -> f64 {
    let v: [f64; 8] = lanes.into();
    ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]))
}
