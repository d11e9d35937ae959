//! Scenes of other families whose spheres have outlines.

use super::draft::Draft;
use super::parallel::{parallel_lenses, planes_that_cut};
use super::point_lights::near_lights;
use super::scenes::{
    DISTANCE, crowds, exponents, far_away, floors, grazing_shadows, highlights, ordinary, seams,
    shutters, slivers, surface_bumps, touching, wide_lenses,
};
use marbles_tests::numbers::Numbers;

/// Spheres with a line along their outlines. Its width is in units of the scene, so that finer pictures show the same.
pub(super) fn outlined(numbers: &mut Numbers) -> Draft {
    let mut draft = match numbers.below(15) {
        0 => ordinary(numbers),
        1 => touching(numbers),
        2 => grazing_shadows(numbers),
        3 => exponents(numbers),
        4 => highlights(numbers),
        5 => slivers(numbers),
        6 => seams(numbers),
        7 => floors(numbers),
        8 => wide_lenses(numbers),
        9 => far_away(numbers),
        10 => near_lights(numbers),
        11 => parallel_lenses(numbers),
        12 => planes_that_cut(numbers),
        13 => shutters(numbers),
        _ => match numbers.below(2) {
            0 => crowds(numbers),
            _ => surface_bumps(numbers, [0.0, 1.5]),
        },
    };
    // From a hundredth of a pixel to ten: a pixel is about 100 / DISTANCE units wide.
    let width = libm::pow(10.0, numbers.between(-2.0, 1.0)) * 100.0 / DISTANCE;
    let color = numbers.either(&["0", "0.5", "(1, 0.2, 0.1)", "2"]);
    draft.material += &format!(", outline: (width: Units({width}), color: {color})");
    draft
}
