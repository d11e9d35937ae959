//! The integral over lines that are alike.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::contents::{Active, Contents, Reach};
use super::cut::{
    self, Cuts, MOST_CHANGES, NOTHING, Signature, branch_of_conic, is_lit, sphere_of,
};
use super::rule::{CAUTION, NODES, Roots, Rule, error_estimate};
use super::scene::{InCamera, MOST_LIGHTS};
use super::surface::{Finish, Points};
use super::turns::{Look, Nearest, Search, Seeker, Turn, Turns};
use crate::edges::{Arcs, Cell};
use crate::roughness::NoiseCells;
use crate::{Color, Radiance, World};

/// An integral over a part of a cell whose area is 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) value: Color,
    pub(super) covered: f64,
    pub(super) error: f64,
    /// What of the error comes from along the lines.
    pub(super) along: f64,
    /// What of the error comes from rounding.
    pub(super) rounding: f64,
}

impl Part {
    pub(super) const NOTHING: Self = Self {
        value: Color::ZERO,
        covered: 0.0,
        error: 0.0,
        along: 0.0,
        rounding: 0.0,
    };

    pub(super) fn add(&mut self, other: &Self, share: f64) {
        self.value += other.value * share;
        self.covered += other.covered * share;
        self.error += other.error * share;
        self.along += other.along * share;
        self.rounding += other.rounding * share;
    }
}

/// Lines that were held to be alike are not, or may not be at `at`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unlike {
    pub(super) at: Option<f64>,
}

/// Lines from `start` to `end` with one signature.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece<'a> {
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) roots: Roots,
    pub(super) signature: &'a Signature,
    /// Parts into which every interval of a line is divided.
    pub(super) division: u32,
    /// How far from the start and from the end lines need not have the signature.
    pub(super) loose: [f64; 2],
    /// What is narrower along lines may be anything.
    pub(super) gap: f64,
    /// Whether to look for lines between that are not alike.
    pub(super) is_suspicious: bool,
}

/// What pieces of a cell have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surroundings<'a> {
    pub(super) scene: &'a InCamera<'a>,
    pub(super) cell: &'a Cell,
    pub(super) contents: &'a Contents,
    /// Light where no sphere is seen.
    pub(super) background: Color,
    pub(super) tolerance: f64,
}

impl Surroundings<'_> {
    /// The integral over the lines of a piece; the number of samples that it took is added to
    /// `samples`.
    #[inline(always)]
    pub(super) fn integrate<S: Simd, C: Radiance>(
        &self,
        simd: S,
        piece: &Piece<'_>,
        cuts: &mut Cuts,
        scratch: &mut Vec<f64>,
        noise: &mut Option<Box<NoiseCells>>,
        samples: &mut u64,
    ) -> Result<Part, Unlike> {
        let background = self.background;
        let rule = Rule::of(piece.roots);
        let nodes: f64x8<S> = rule.nodes.simd_into(simd);
        let y = nodes * (piece.end - piece.start) + piece.start;
        let stops = self.stops(simd, piece, y, cuts, scratch)?;
        let signature = piece.signature;
        let zero = f64x8::splat(simd, 0.0);
        let mut sum = [zero; 3];
        let mut covered = zero;
        let mut along = zero;
        let mut across_lines = Across::SMOOTH;
        let mut start = f64x8::splat(simd, -0.5);
        for (index, stops) in stops.iter().enumerate().take(signature.changes + 1) {
            let end: f64x8<S> = (*stops).simd_into(simd);
            // What is not there has no width.
            let end = (end - start).simd_ge(0.0).select(end, start);
            let width = end - start;
            let view = signature.views[index];
            if view == NOTHING {
                for channel in 0..C::CHANNELS {
                    sum[channel] += width * background[channel];
                }
            } else {
                covered += width;
                let interval = Interval {
                    start,
                    width,
                    view,
                    before: (index > 0).then(|| signature.branches[index - 1]),
                    after: (index < signature.changes).then(|| signature.branches[index]),
                    division: piece.division,
                };
                let of_interval =
                    self.add::<S, C>(simd, &interval, y, &mut sum, &mut along, noise, samples);
                across_lines.likeness = across_lines.likeness.min(of_interval.likeness);
                across_lines.least_error += of_interval.least_error;
            }
            start = end;
        }
        Ok(self.sum_up::<S, C>(rule, &sum, covered, along, across_lines))
    }

    /// Where the lines of a piece change, and where they end: as the signature says, which all of
    /// them have but for those near the ends of the piece.
    #[inline(always)]
    fn stops<S: Simd>(
        &self,
        simd: S,
        piece: &Piece<'_>,
        y: f64x8<S>,
        cuts: &mut Cuts,
        scratch: &mut Vec<f64>,
    ) -> Result<[[f64; 8]; MOST_CHANGES + 1], Unlike> {
        let &Self {
            scene,
            cell,
            contents,
            ..
        } = self;
        let signature = piece.signature;
        let lines: [f64; 8] = y.into();
        let found = cuts.signatures(simd, scene, cell, contents, &lines, piece.gap);
        let found = found.map_err(|_| Unlike { at: None })?;
        let mut stops = [[0.5; 8]; MOST_CHANGES + 1];
        let mut unlike = 0_u64;
        for (lane, found) in found.iter().enumerate() {
            if found == signature {
                for (change, stops) in stops.iter_mut().enumerate().take(signature.changes) {
                    stops[lane] = cuts.place(lane, change);
                }
            } else {
                unlike |= 1 << lane;
            }
        }
        if unlike == 0 {
            let approach = piece
                .is_suspicious
                .then(|| cuts.approach(signature.changes, &lines, NODES));
            return match approach.flatten() {
                Some(at) => Err(Unlike { at: Some(at) }),
                None => Ok(stops),
            };
        }
        let is_strict = (y.simd_gt(piece.start + piece.loose[0])
            & y.simd_lt(piece.end - piece.loose[1]))
        .to_bitmask();
        if unlike & is_strict != 0 {
            return Err(Unlike { at: None });
        }
        for (change, stops) in stops.iter_mut().enumerate().take(signature.changes) {
            let places = self.place(simd, signature.branches[change], y, scratch);
            for (lane, stop) in stops.iter_mut().enumerate() {
                if unlike >> lane & 1 == 1 {
                    *stop = places[lane];
                }
            }
        }
        Ok(stops)
    }

    /// The integral across the lines, from what is along them.
    #[inline(always)]
    fn sum_up<S: Simd, C: Radiance>(
        &self,
        rule: &Rule,
        sum: &[f64x8<S>; 3],
        covered: f64x8<S>,
        along: f64x8<S>,
        across_lines: Across,
    ) -> Part {
        let mut part = Part::NOTHING;
        let mut error: f64 = 0.0;
        for (channel, sum) in sum.iter().enumerate().take(C::CHANNELS) {
            let (value, estimate) = across(rule, sum, across_lines.likeness);
            part.value[channel] = value;
            error = error.max(estimate);
        }
        error = error.max(across_lines.least_error);
        let (value, estimate) = across(rule, &covered, Likeness::Smooth);
        part.covered = value;
        error = error.max(estimate);
        for index in 0..NODES {
            part.along += rule.fine[index] * along[index];
        }
        part.error = error + part.along;
        part
    }

    /// Adds the light of an interval of the lines.
    #[expect(
        clippy::too_many_arguments,
        reason = "all of it is at hand where it is called"
    )]
    #[inline(always)]
    fn add<S: Simd, C: Radiance>(
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
            for channel in 0..C::CHANNELS {
                sum[channel] += interval.width * constant[channel];
            }
            return Across::SMOOTH;
        }
        let exponent = material.exponent;
        let root_at = |branch: Option<u16>| {
            branch.is_some_and(|branch| cut::has_root_at(contents, branch, position, exponent))
        };
        let Some(pixel) = contents.pixel else {
            return Across::SMOOTH;
        };
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
            return self.add_rough::<S, C>(
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
            self.add_stretch::<S, C>(
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
    fn add_rough<S: Simd, C: Radiance>(
        &self,
        simd: S,
        interval: &Interval<S>,
        active: &Active,
        finish: &Finish<'_>,
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
                let kinds = if finish.has_blunt_spot() { 2 } else { 1 };
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
                        self.add_stretch::<S, C>(
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
    fn add_stretch<S: Simd, C: Radiance>(
        &self,
        simd: S,
        active: &Active,
        finish: &Finish<'_>,
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
                    let light = finish.radiance::<S, C>(simd, scene, points, normal, lit, None);
                    for channel in 0..C::CHANNELS {
                        fine[channel] += light[channel] * rule.fine[node];
                        coarse[channel] += light[channel] * rule.coarse[node];
                    }
                    let mut gauge = light[0];
                    for channel in &light[1..C::CHANNELS] {
                        gauge += *channel;
                    }
                    lowest = lowest.min(gauge);
                    highest = highest.max(gauge);
                }
                let spread = highest - lowest;
                let mut largest = zero;
                for channel in 0..C::CHANNELS {
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

    /// Where a branch crosses lines; NaN where it does not.
    #[inline(never)]
    fn place<S: Simd>(
        &self,
        simd: S,
        branch: u16,
        y: f64x8<S>,
        scratch: &mut Vec<f64>,
    ) -> f64x8<S> {
        simd.vectorize(
            #[inline(always)]
            || {
                let contents = self.contents;
                let branch = usize::from(branch);
                let conics = contents.conics.len();
                if branch < 2 * conics {
                    let crossings = contents.conics[branch / 2].1.crossings(y);
                    return if branch_of_conic(branch / 2, true) == branch as u16 {
                        crossings.falling
                    } else {
                        crossings.rising
                    };
                }
                let (caster, which) = ((branch - 2 * conics) / 4, (branch - 2 * conics) % 4);
                let lights = self.scene.lights.len();
                let of = contents.reach.iter().position(
                    |reach| matches!(reach, Reach::Past(casters) if casters.contains(&caster)),
                );
                let Some(of) = of else {
                    return f64x8::splat(simd, f64::NAN);
                };
                let ball = &contents.active[of / lights].ball;
                let arcs = Arcs::new(simd, self.cell, ball, y);
                let places = arcs.crossings(simd, self.cell, &contents.casters[caster], scratch);
                places[which / 2][which % 2]
            },
        )
    }
}

/// What is known of lines of a piece beside each other.
#[derive(Clone, Copy, Debug)]
struct Across {
    likeness: Likeness,
    /// What may be missed beside and between them.
    least_error: f64,
}

impl Across {
    const SMOOTH: Self = Self {
        likeness: Likeness::Smooth,
        least_error: 0.0,
    };
}

/// How lines of a piece go over into each other, the worst first.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
enum Likeness {
    /// On some of them light jumps in other bumps than on others.
    Jumpy,
    /// Some of them have other terminators of bumps than others.
    Uneven,
    /// The noise has no third derivative where its cells meet.
    Rough,
    Smooth,
}

/// The integral over lines with these integrals, and an estimate of its error.
#[inline(always)]
fn across<S: Simd>(rule: &Rule, of: &f64x8<S>, likeness: Likeness) -> (f64, f64) {
    let (mut fine, mut coarse) = (0.0, 0.0);
    for index in 0..NODES {
        fine += rule.fine[index] * of[index];
        coarse += rule.coarse[index] * of[index];
    }
    let mut spread = 0.0;
    for index in 0..NODES {
        spread += rule.fine[index] * (of[index] - fine).abs();
    }
    let difference = (fine - coarse).abs();
    // A jump between two lines may cost half of their weight.
    let error = match likeness {
        Likeness::Smooth => error_estimate(difference, spread),
        Likeness::Rough => difference,
        Likeness::Uneven => difference.max(0.02 * spread),
        Likeness::Jumpy => difference.max(0.2 * spread),
    };
    (fine, error)
}

/// A part of eight lines on which one sphere is seen.
#[derive(Clone, Copy, Debug)]
struct Interval<S: Simd> {
    start: f64x8<S>,
    width: f64x8<S>,
    view: u64,
    /// The branches at its ends, where these are not the sides of the cell.
    before: Option<u16>,
    after: Option<u16>,
    division: u32,
}
