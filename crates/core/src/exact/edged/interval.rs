//! The light of one sphere along lines.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::across::{Across, Likeness};
use super::cut;
use super::cut::{is_lit, sphere_of};
use super::piece::Surroundings;
use super::rule::{CAUTION, NODES, Roots, Rule};
use super::turns::{Look, Nearest, Search, Seeker, Turn, Turns};
use crate::exact::classify::active::Active;
use crate::exact::points::Points;
use crate::exact::scene::MOST_LIGHTS;
use crate::exact::surface::Finish;
use crate::model::roughness::noise::NoiseCells;
use crate::model::world::World;

/// A part of eight lines on which one sphere is seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Interval<S: Simd> {
    pub(crate) start: f64x8<S>,
    pub(crate) width: f64x8<S>,
    pub(crate) view: u64,
    /// The branches at its ends, where these are not the sides of the cell.
    pub(crate) before: Option<u16>,
    pub(crate) after: Option<u16>,
    pub(crate) division: u32,
}

impl Surroundings<'_> {
    /// Adds the light of an interval of the lines.
    #[expect(
        clippy::too_many_arguments,
        reason = "all of it is at hand where it is called"
    )]
    #[inline(always)]
    pub(crate) fn add<S: Simd>(
        &self,
        simd: S,
        interval: &Interval<S>,
        y: f64x8<S>,
        sum: &mut [f64x8<S>; 3],
        error: &mut f64x8<S>,
        noise: &mut Option<Box<NoiseCells>>,
        samples: &mut u64,
    ) -> Across {
        let &Self {
            scene, contents, ..
        } = self;
        let world: &World = scene.world;
        let Some(position) = sphere_of(interval.view) else {
            return Across::SMOOTH;
        };
        let active = &contents.active[position];
        let material = world.material(active.sphere);
        if interval.view >> 32 == 0 {
            let constant = world.albedo(active.sphere) * scene.ambient;
            for channel in 0..scene.channels {
                sum[channel] += interval.width * constant[channel];
            }
            return Across::SMOOTH;
        }
        let exponent = material.exponent;
        let root_at = |branch: Option<u16>| {
            branch.is_some_and(|branch| cut::has_root_at(contents, branch, position, exponent))
        };
        let pixel = contents.pixel;
        let finish = Finish::new(scene, active.sphere, pixel);
        let mut lit = [0; MOST_LIGHTS];
        for (light, lit) in lit.iter_mut().enumerate() {
            *lit = if is_lit(interval.view, light) {
                0xff
            } else {
                0
            };
        }
        if finish.is_rough() {
            let is_eased =
                !finish.has_whole_exponent() || root_at(interval.before) || root_at(interval.after);
            return self.add_rough(
                simd, interval, active, &finish, &lit, is_eased, y, sum, error, noise, samples,
            );
        }
        let step = 1.0 / f64::from(interval.division);
        let width = interval.width * step;
        for part in 0..interval.division {
            let rule = Rule::of(Roots {
                at_start: part == 0 && root_at(interval.before),
                at_end: part + 1 == interval.division && root_at(interval.after),
            });
            let start = interval.start + width * f64::from(part);
            *samples += 8 * NODES as u64;
            self.add_stretch(
                simd, active, &finish, &lit, rule, start, width, y, sum, error, noise,
            );
        }
        Across::SMOOTH
    }

    /// Adds the light of an interval on a rough surface, which has terminators inside its bumps: they
    /// are found between points, line by line. At eased ends of stretches, light may go with a root of
    /// the distance.
    #[expect(
        clippy::too_many_arguments,
        reason = "all of it is at hand where it is called"
    )]
    #[inline(never)]
    fn add_rough<S: Simd>(
        &self,
        simd: S,
        interval: &Interval<S>,
        active: &Active,
        finish: &Finish,
        lit: &[u64; MOST_LIGHTS],
        is_eased: bool,
        y: f64x8<S>,
        sum: &mut [f64x8<S>; 3],
        error: &mut f64x8<S>,
        noise: &mut Option<Box<NoiseCells>>,
        samples: &mut u64,
    ) -> Across {
        simd.vectorize(
            #[inline(always)]
            || {
                let end = interval.start + interval.width;
                let mut turns = Turns::default();
                let middle = cut::ray(simd, self.cell, y * 0.0, y * 0.0);
                let negligible = 0.01 * self.tolerance;
                let jumps = finish.jumps(simd, self.scene, &middle, self.cell.size, negligible);
                let jumps = jumps.to_bitmask() != 0;
                let Search { parts, steps } = Search::of(self.tolerance, jumps);
                let points = parts * interval.division;
                *samples += 8 * u64::from(points + 1);
                let nothing = Look {
                    x: interval.start,
                    value: f64x8::splat(simd, f64::NAN),
                };
                let mut looks = [[[nothing; 2]; MOST_LIGHTS]; 2];
                let mut nearest = [Nearest::default(); MOST_LIGHTS];
                let kinds = if finish.has_blunt_highlight() { 2 } else { 1 };
                for index in 0..=points {
                    let s = f64::from(index) / f64::from(points);
                    let share = if is_eased { s * s * (3.0 - 2.0 * s) } else { s };
                    let x = interval.start + interval.width * share;
                    let at = Points::new(simd, &active.ball, cut::ray(simd, self.cell, x, y));
                    let normal = finish.normal(simd, self.scene, &at, noise);
                    for (light, in_camera) in self.scene.lights.iter().enumerate() {
                        if lit[light] == 0 {
                            continue;
                        }
                        for (kind, looks) in looks.iter_mut().enumerate().take(kinds) {
                            let turn = Turn {
                                toward: in_camera.toward,
                                of_spot: kind == 1,
                            };
                            let seeker = Seeker {
                                surroundings: self,
                                active,
                                finish,
                                turn,
                                y,
                                steps,
                            };
                            let value = turn.value(&normal, &at);
                            let here = Look { x, value };
                            if kind == 0 {
                                nearest[light].note(&value.into());
                            }
                            let [before, last] = looks[light];
                            *samples += seeker.note(simd, &last, &here, &mut turns, noise);
                            if index >= 2 {
                                let is_end = [index == 2, index == points];
                                *samples += seeker.note_dip(
                                    simd, &before, &last, &here, is_end, &mut turns, noise,
                                );
                            }
                            looks[light] = [last, here];
                        }
                    }
                }
                let rule = Rule::of(Roots {
                    at_start: is_eased,
                    at_end: is_eased,
                });
                let mut start = interval.start;
                let ends: [f64; 8] = end.into();
                for index in 0..=turns.most() {
                    let stop: f64x8<S> = turns.stops(index, &ends).simd_into(simd);
                    let division = interval.division;
                    let width = (stop - start) * (1.0 / f64::from(division));
                    for part in 0..division {
                        *samples += 8 * NODES as u64;
                        let start = start + width * f64::from(part);
                        self.add_stretch(
                            simd, active, finish, lit, rule, start, width, y, sum, error, noise,
                        );
                    }
                    start = stop;
                }
                let is_even = turns.counts[..NODES]
                    .iter()
                    .all(|&count| count == turns.counts[0]);
                let likeness = match (is_even, jumps) {
                    (true, _) => Likeness::Rough,
                    (false, false) => Likeness::Uneven,
                    (false, true) => Likeness::Jumpy,
                };
                let mut least_error: f64 = 0.0;
                for (nearest, in_camera) in nearest.iter().zip(&self.scene.lights) {
                    if let Some(range) = nearest.range_of_turn() {
                        let light = finish.cost_of_any_turn(simd, in_camera, range, jumps);
                        least_error += light * interval.width[0].max(interval.width[NODES - 1]);
                    }
                }
                Across {
                    likeness,
                    least_error,
                }
            },
        )
    }

    /// Adds the light of stretches of the lines on which it is smooth.
    #[expect(
        clippy::too_many_arguments,
        reason = "all of it is at hand where it is called"
    )]
    #[inline(never)]
    fn add_stretch<S: Simd>(
        &self,
        simd: S,
        active: &Active,
        finish: &Finish,
        lit: &[u64; MOST_LIGHTS],
        rule: &Rule,
        start: f64x8<S>,
        width: f64x8<S>,
        y: f64x8<S>,
        sum: &mut [f64x8<S>; 3],
        error: &mut f64x8<S>,
        noise: &mut Option<Box<NoiseCells>>,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let (scene, cell) = (self.scene, self.cell);
                let one = f64x8::splat(simd, 1.0);
                let zero = f64x8::splat(simd, 0.0);
                let mut fine = [zero; 3];
                let mut coarse = [zero; 3];
                let mut lowest = one * f64::INFINITY;
                let mut highest = one * f64::NEG_INFINITY;
                let mut points = [Points::nowhere(simd); NODES];
                for (points, &node) in points.iter_mut().zip(&rule.nodes) {
                    let x = start + width * node;
                    *points = Points::new(simd, &active.ball, cut::ray(simd, cell, x, y));
                }
                let normals = finish.normals(simd, scene, &points, noise);
                for node in 0..NODES {
                    let (points, normal) = (&points[node], &normals[node]);
                    let light = finish.radiance(simd, scene, points, normal, lit, None);
                    for channel in 0..scene.channels {
                        fine[channel] += light[channel] * rule.fine[node];
                        coarse[channel] += light[channel] * rule.coarse[node];
                    }
                    let mut gauge = light[0];
                    for channel in &light[1..scene.channels] {
                        gauge += *channel;
                    }
                    lowest = lowest.min(gauge);
                    highest = highest.max(gauge);
                }
                let spread = highest - lowest;
                let mut largest = zero;
                for channel in 0..scene.channels {
                    let difference = (fine[channel] - coarse[channel]).abs();
                    let estimate = if active.is_smooth {
                        let ratio = (difference * CAUTION / (spread + f64::MIN_POSITIVE)).min(one);
                        (spread * ratio * ratio.sqrt()).min(difference)
                    } else {
                        // The noise has no third derivative where its cells meet.
                        difference
                    };
                    largest = largest.max(estimate);
                    sum[channel] += fine[channel] * width;
                }
                *error += largest * width;
            },
        )
    }
}
