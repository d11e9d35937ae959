//! Judges scenes whose bumps are too fine for lines, and scenes with random normals for each pixel.

use glam::DVec4;
use marbles_core::Grain;
use marbles_scene::Scene;

use super::draft::MOMENTS;
use super::picture::Picture;
use super::pixels::claims_something;
use super::subject::Subject;
use super::{Broken, Found};
use marbles_tests::numbers::Numbers;

/// The size of bumps, in pixels, below which they are fine.
const FINE: f64 = 0.5;

/// One of this many pixels is judged.
const STRIDE: usize = 21;

/// The integrator determines the ratio of true and claimed error, to a tenth, if the claim is this many times its own
/// error.
const TELLING: f64 = 10.0;

/// Strata on a side of a pixel: at first, and for suspect pixels.
const STRATA: [u32; 2] = [64, 400];

/// The number of parts of the time, with two random moments each, if the shutter is open; and the assumed largest error
/// of the mean, in standard deviations.
const PARTS: i32 = 32;
const DEVIATIONS: f64 = 6.0;

/// The largest error of the mean over time with random normals for each pixel.
const FINE_OVER_TIME: f64 = 1e-5;

/// Returns whether a scene has surfaces for which finer pictures are of no use.
pub(super) fn is_fine(subject: &Subject) -> bool {
    grains(subject.plain()).any(|grain| match grain {
        Grain::Surface(size) => size < FINE * subject.pixel,
        Grain::Pixel => true,
    })
}

/// The grains of a scene's bumps.
pub(super) fn grains(scene: &Scene) -> impl Iterator<Item = Grain> {
    let materials = scene.world().materials().iter();
    materials.filter_map(|material| Some(material.roughness.as_ref()?.grain))
}

/// The true value of a pixel from this many strata on a side, and its error.
fn truth(subject: &Subject, (col, row): (u32, u32), strata: u32) -> Option<(DVec4, f64)> {
    let is_by_pixel = grains(subject.plain()).any(|grain| grain == Grain::Pixel);
    if is_by_pixel {
        return subject.truth(FINE_OVER_TIME, |judge, _| judge.pixel(col, row));
    }
    let Some(moments) = subject.moments() else {
        return subject.truth(0.0, |judge, _| judge.by_strata(col, row, strata, 0));
    };
    // As of strata: how far two samples of a part are apart tells how far their mean is off.
    let mut numbers = Numbers(u64::from(col) << 32 | u64::from(row));
    let length = MOMENTS / PARTS;
    let strata = (strata / 4).max(16);
    let (mut sum, mut squares) = (DVec4::ZERO, DVec4::ZERO);
    for part in 0..PARTS {
        let mut sample = || {
            let within = numbers.below(length as usize) as i32;
            let frame = 2 * MOMENTS - MOMENTS / 2 + part * length + within;
            let seed = numbers.bits();
            let judged = subject.at(moments, frame, |judge, _| {
                judge.by_strata(col, row, strata, seed)
            });
            judged.map(|(value, _)| value)
        };
        let (one, other) = (sample()?, sample()?);
        sum += one + other;
        squares += (one - other) * (one - other);
    }
    let count = f64::from(2 * PARTS);
    let off = DEVIATIONS * squares.max_element().sqrt() / count;
    Some((sum / count, off))
}

/// The broken pixels among a part of a scene's pixels, and the ratios of true and claimed errors.
pub(super) fn judge(subject: &Subject, tolerances: &[f64]) -> Found {
    let mut found = Found::new(tolerances);
    let is_by_pixel = grains(subject.plain()).any(|grain| grain == Grain::Pixel);
    let pictures: Vec<_> = tolerances
        .iter()
        .map(|&tolerance| subject.picture(tolerance))
        .collect();
    for (index, picture) in pictures.iter().enumerate() {
        let Some(picture) = picture else { continue };
        let over = picture
            .places()
            .filter(|&(col, row)| picture.is_over(col, row));
        found.given_up[index] += over.count() as u64;
        found.rendered += picture.places().count() as u64;
    }
    let places = pictures.iter().flatten().next().map(Picture::places);
    for (col, row) in places.into_iter().flatten().step_by(STRIDE) {
        let Some(mut known) = truth(subject, (col, row), STRATA[0]) else {
            continue;
        };
        let mut is_fine = is_by_pixel;
        for (index, (picture, &tolerance)) in pictures.iter().zip(tolerances).enumerate() {
            let Some(picture) = picture else { continue };
            found.pixels += 1;
            let claimed = picture.claimed(col, row);
            let is_confessed = picture.is_over(col, row);
            let allowed = if is_confessed { claimed } else { tolerance };
            let value = picture.value(col, row);
            let error_of = |known: DVec4| (value - known).abs().max_element();
            if error_of(known.0) > 0.5 * allowed && !is_fine {
                known = truth(subject, (col, row), STRATA[1]).unwrap_or(known);
                is_fine = true;
            }
            let error = error_of(known.0);
            if claims_something(claimed, tolerance) && claimed >= TELLING * known.1 {
                found.honesty[index].count(error / claimed, STRIDE as u32);
            }
            if error > allowed + known.1 {
                found.broken.push(Broken {
                    col,
                    row,
                    tolerance,
                    error,
                    claimed,
                    is_confessed,
                });
            } else if known.1 > allowed {
                found.unjudged += 1;
            }
        }
    }
    found
}
