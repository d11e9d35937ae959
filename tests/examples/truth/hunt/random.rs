//! Judges scenes whose bumps are too fine for lines, and those whose pixels have bumps of their own.

use glam::DVec4;
use marbles_core::{Grain, View};
use marbles_scene::Scene;
use marbles_tests::reference::{Reference, Truth};

use super::draft::SIDE;
use super::pixels::claims_something;
use super::subject::render;
use super::{Broken, Found};

/// Bumps, in units of a scene, which in the families of bumps are about pixels, that are fine.
const FINE: f64 = 0.5;

/// One of so many pixels is judged.
const STRIDE: u32 = 21;

/// The truth tells how far a pixel is off, as a part of what it claims, if the claim is so many times what the
/// truth may be off by: to a tenth.
const TELLING: f64 = 10.0;

/// Strata on a side of a pixel: at first, and for those that seem off.
const STRATA: [u32; 2] = [64, 400];

/// Returns whether a scene has surfaces whose pixels finer pictures tell nothing of.
pub(super) fn is_fine(scene: &Scene) -> bool {
    grains(scene).any(|grain| match grain {
        Grain::Surface(size) => size < FINE,
        Grain::Pixel => true,
    })
}

/// The grains of a scene's bumps.
pub(super) fn grains(scene: &Scene) -> impl Iterator<Item = Grain> {
    let materials = scene.world().materials().iter();
    materials.filter_map(|material| Some(material.roughness.as_ref()?.grain))
}

/// The pixels, of a part of a scene's, that fall short, and how far they are off.
pub(super) fn judge(scene: &Scene, view: &View, tolerances: &[f64]) -> Found {
    let mut found = Found::new(tolerances);
    let reference = Reference::new(scene.world(), view);
    let is_by_pixel = grains(scene).any(|grain| grain == Grain::Pixel);
    let truth = |col: u32, row: u32, strata: u32| {
        if is_by_pixel {
            reference.pixel(col, row)
        } else {
            reference.by_strata(col, row, strata)
        }
    };
    let background = scene.world().background;
    let error_of = |truth: &Truth, value: DVec4| {
        let exact = truth.value.truncate() + background * (1.0 - truth.value.w);
        (value.truncate() - exact).abs().max_element()
    };
    let images: Vec<_> = tolerances
        .iter()
        .map(|&tolerance| render(scene, view, tolerance))
        .collect();
    for place in (0..SIDE * SIDE).step_by(STRIDE as usize) {
        let (col, row) = (place % SIDE, place / SIDE);
        let mut known = truth(col, row, STRATA[0]);
        let mut is_fine = is_by_pixel;
        for (index, (image, &tolerance)) in images.iter().zip(tolerances).enumerate() {
            let Some(image) = image else { continue };
            found.pixels += 1;
            let claimed = image.error(col, row);
            let is_confessed = image.status(col, row).is_over_tolerance();
            let allowed = if is_confessed { claimed } else { tolerance };
            let value = DVec4::from_array(image.rgba(col, row));
            if error_of(&known, value) > 0.5 * allowed && !is_fine {
                known = truth(col, row, STRATA[1]);
                is_fine = true;
            }
            let error = error_of(&known, value);
            if claims_something(claimed, tolerance) && claimed >= TELLING * known.error {
                found.honesty[index].count(error / claimed, STRIDE);
            }
            if error > allowed + known.error + 1e-13 {
                found.broken.push(Broken {
                    col,
                    row,
                    tolerance,
                    error,
                    claimed,
                    is_confessed,
                });
            } else if known.error > allowed {
                found.unjudged += 1;
            }
        }
    }
    found
}
