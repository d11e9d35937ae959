//! Pixels of a row that one sphere fills.

use fearless_simd::Simd;

use super::filled::{Filled, FilledRow};
use super::mean_normals::MeanNormals;
use super::plain::Plain;
use super::reached::{Extents, Reached};
use crate::exact::classify::occluder_cache::OccluderCache;
use crate::exact::classify::row::Coverage;
use crate::exact::context::Context;
use crate::exact::part::Part;
use crate::exact::surface::Finish;
use crate::model::color::Color;
use crate::model::material::Grain;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::bits::set_bits;
use crate::numeric::rounding::UNIT_ROUNDOFF;
use crate::picture::pixel::{Evidence, Pixel, Status};

/// The outcome for the pixels of a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FilledPixels {
    /// The pixels, bit by bit, that have edges or other light that is too hard for rules: they were left
    /// alone.
    pub(crate) hard: u64,
    /// All samples.
    pub(crate) samples: u64,
    /// Those of each pixel that do not depend on the pixels beside it: of bumps in parts, or in strata.
    pub(crate) of_bumps: [u64; 8],
}

/// Writes the pixels of a row that are not too hard; `extents` tell where they see the sphere's outer side, if they do.
#[inline(always)]
pub(crate) fn fill<S: Simd>(
    simd: S,
    context: &Context<'_>,
    (row, extents): (&FilledRow<'_>, Option<&Extents<'_, S>>),
    cache: &mut OccluderCache,
    (noise, normals): (&mut Option<Box<NoiseCells>>, &mut Vec<MeanNormals>),
    pixels: &mut [Pixel],
) -> FilledPixels {
    let scene = &context.scene;
    let Coverage { sphere, .. } = row.coverage;
    let material = scene.world.material(*sphere);
    let mut reached = Reached::nothing(simd);
    let mut finish = Finish::new(scene, *sphere, context.key(row.start, 0));
    if let Some(extents) = extents
        && !scene.is_enclosed
    {
        simd.vectorize(
            #[inline(always)]
            || reached = Reached::new(simd, context, (row, extents), &finish, cache),
        );
    }
    let mut filled = FilledPixels {
        hard: reached.hard,
        samples: 0,
        of_bumps: [0; 8],
    };
    let analytic = extents.and_then(|extents| extents.analytic.as_ref());
    let plain = Plain::new(context, row, analytic, &finish);
    if let Some(plain) = &plain
        && reached.turning != 0
    {
        filled.hard |= reached.turning & !plain.fill_turning(simd, reached.turning, pixels);
    }
    let easy = row.which & !reached.hard & !reached.turning;
    let lit = reached.lit.iter().fold(0, |any, lit| any | lit) & easy;

    // Pixels without light.
    let ambient = scene.world.albedo(*sphere) * scene.ambient;
    for lane in set_bits(easy & !lit) {
        pixels[lane] = Pixel {
            evidence: Evidence::Bound,
            ..met(ambient, ambient.max_element() * UNIT_ROUNDOFF)
        };
    }

    // The noise of each pixel is its own: one after the other.
    let roughness = material.roughness.as_ref();
    let is_own = roughness.is_some_and(|roughness| matches!(roughness.grain, Grain::Pixel));
    let mut rest = lit;
    if let Some(plain) = &plain
        && lit != 0
    {
        let (done, samples) = plain.fill_lit(simd, lit, normals, pixels);
        rest &= !done;
        filled.samples += samples;
    }
    while rest != 0 {
        let group = if is_own {
            rest & rest.wrapping_neg()
        } else {
            rest
        };
        rest &= !group;
        if is_own {
            finish = Finish::new(
                scene,
                *sphere,
                context.key(row.start, group.trailing_zeros()),
            );
        }
        let lit = (&reached, &finish);
        let of_group = fill_lit(simd, context, row, lit, group, noise, pixels);
        filled.hard |= of_group.hard;
        filled.samples += of_group.samples;
        for lane in set_bits(group) {
            filled.of_bumps[lane] = of_group.of_bumps[lane];
        }
    }
    filled
}

/// Writes pixels that lights reach, unless they are too hard.
#[inline(always)]
fn fill_lit<S: Simd>(
    simd: S,
    context: &Context<'_>,
    row: &FilledRow<'_>,
    (reached, finish): (&Reached<S>, &Finish),
    which: u64,
    noise: &mut Option<Box<NoiseCells>>,
    pixels: &mut [Pixel],
) -> FilledPixels {
    let (middle, sides) = context.rays(simd, row.start);
    let mut lit = reached.lit;
    for lit in &mut lit {
        *lit &= which;
    }
    let filled = Filled {
        scene: &context.scene,
        ball: &row.coverage.ball,
        finish,
        middle,
        size: sides.both(),
        lit: &lit,
        turn: reached.turn,
        view_turn: reached.view_turn,
        nearness: reached.nearness,
        which,
        tolerance: context.tolerance,
        allowance: context.allowance,
        is_proved: context.is_proved,
    };
    let averages = filled.averages(simd, noise);
    let mut samples = averages.samples as u64 * u64::from(which.count_ones());
    let mut of_bumps = [0; 8];
    let mut hard = 0;
    let is_met = |error: f64| error <= context.tolerance;
    for lane in set_bits(which) {
        let (mut value, mut error) = (averages.values[lane], averages.errors[lane]);
        let mut is_last = false;
        if !is_met(error)
            && let Some(found) = filled.of_bumps(simd, lane, noise)
        {
            samples += found.samples;
            of_bumps[lane] = found.samples;
            (value, error, is_last) = (found.value, found.error, found.is_random);
        }
        if is_met(error) || is_last {
            let bound = averages.bounds[lane];
            let is_proved = is_met(bound);
            let known = Part {
                value,
                covered: 1.0,
                error: if is_proved { bound } else { error },
                rounding: 0.0,
            };
            pixels[lane] = context.pixel_of(&known);
            if is_proved {
                pixels[lane].evidence = Evidence::Bound;
            }
        } else {
            hard |= 1 << lane;
        }
    }
    FilledPixels {
        hard,
        samples,
        of_bumps,
    }
}

/// A pixel that meets its tolerance.
fn met(value: Color, error: f64) -> Pixel {
    Pixel {
        value,
        alpha: 1.0,
        error,
        evidence: Evidence::Estimate,
        status: Status::Met,
    }
}
