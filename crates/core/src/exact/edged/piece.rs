//! The integral over lines that are alike.

use crate::exact::part::Part;
use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::across::{Across, Likeness, across};
use super::cut::{Cuts, MOST_CHANGES, NOTHING, Signature, branch_of_conic};
use super::interval::Interval;
use super::rule::{NODES, Roots, Rule};
use crate::edges::cell::Cell;
use crate::edges::shadow::Arcs;
use crate::exact::classify::contents::{Contents, Reach};
use crate::exact::scene::InCamera;
use crate::model::color::Color;
use crate::model::roughness::noise::NoiseCells;

/// Lines that were held to be alike are not, or may not be at `at`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unlike {
    pub(crate) at: Option<f64>,
}

/// Lines from `start` to `end` with one signature.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece<'a> {
    pub(crate) start: f64,
    pub(crate) end: f64,
    pub(crate) roots: Roots,
    pub(crate) signature: &'a Signature,
    /// Parts into which every interval of a line is divided.
    pub(crate) division: u32,
    /// How far from the start and from the end lines need not have the signature.
    pub(crate) loose: [f64; 2],
    /// What is narrower along lines may be anything.
    pub(crate) gap: f64,
    /// Whether to look for lines between that are not alike.
    pub(crate) is_suspicious: bool,
}

/// What pieces of a cell have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surroundings<'a> {
    pub(crate) scene: &'a InCamera<'a>,
    pub(crate) cell: &'a Cell,
    pub(crate) contents: &'a Contents,
    /// Light where no sphere is seen.
    pub(crate) background: Color,
    pub(crate) tolerance: f64,
}

impl Surroundings<'_> {
    /// The integral over the lines of a piece; the number of samples that it took is added to
    /// `samples`.
    #[inline(always)]
    pub(crate) fn integrate<S: Simd>(
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
                for channel in 0..self.scene.channels {
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
                    self.add(simd, &interval, y, &mut sum, &mut along, noise, samples);
                across_lines.likeness = across_lines.likeness.min(of_interval.likeness);
                across_lines.least_error += of_interval.least_error;
            }
            start = end;
        }
        Ok(self.sum_up(rule, &sum, covered, along, across_lines))
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
        let found = cuts.look(simd, scene, cell, contents, &lines, piece.gap);
        found.map_err(|_| Unlike { at: None })?;
        let mut stops = [[0.5; 8]; MOST_CHANGES + 1];
        let mut unlike = 0_u64;
        for (lane, found) in cuts.signatures().iter().enumerate() {
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
    fn sum_up<S: Simd>(
        &self,
        rule: &Rule,
        sum: &[f64x8<S>; 3],
        covered: f64x8<S>,
        along: f64x8<S>,
        across_lines: Across,
    ) -> Part {
        let mut part = Part::NOTHING;
        let mut error: f64 = 0.0;
        for (channel, sum) in sum.iter().enumerate().take(self.scene.channels) {
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
                let places = arcs.crossings(simd, self.cell, &contents.occluders[caster], scratch);
                places[which / 2][which % 2]
            },
        )
    }
}
