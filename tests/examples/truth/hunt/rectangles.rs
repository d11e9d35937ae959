//! Scenes of other families whose pixels are not square.

use super::draft::Draft;
use super::extremes::{brightness, huge_floors, near_eyes};
use super::outlines::outlined;
use super::point_lights::{grazing_cones, lights_between_spheres, lights_inside, near_lights};
use super::scenes::{
    aligned_grids, coincident, crowds, exponents, far_away, floors, grazing_shadows, highlights,
    long_lenses, many_lights, ordinary, overlapping_crowds, seams, shutters, slivers,
    surface_bumps, terminator_at_rim, touching, triple_points, wide_lenses,
};
use super::together::together;
use marbles_tests::numbers::Numbers;

/// The families whose scenes are quick to judge.
const QUICK: [fn(&mut Numbers) -> Draft; 25] = [
    ordinary,
    touching,
    coincident,
    triple_points,
    grazing_shadows,
    terminator_at_rim,
    exponents,
    highlights,
    highlights,
    long_lenses,
    far_away,
    wide_lenses,
    floors,
    floors,
    crowds,
    slivers,
    aligned_grids,
    many_lights,
    near_lights,
    lights_between_spheres,
    lights_inside,
    grazing_cones,
    seams,
    outlined,
    near_eyes,
];

/// Scenes of other families with pixels up to five times as wide as high, or as high as wide.
pub(super) fn rectangular_pixels(numbers: &mut Numbers) -> Draft {
    loop {
        let mut draft = match numbers.below(60) {
            0..=3 => huge_floors(numbers),
            4..=9 => {
                let row = numbers.below(1 << 20) as u64;
                together(numbers, row)
            }
            10..=11 => brightness(numbers),
            12 => shutters(numbers),
            13 => overlapping_crowds(numbers),
            14 => surface_bumps(numbers, [-0.3, 2.0]),
            _ => numbers.either(&QUICK)(numbers),
        };
        let aspect = match numbers.below(5) {
            // Of a camera whose manufacturer calls its pixels square.
            0 => 1.0 + numbers.between(-0.01, 0.01),
            _ => libm::pow(5.0, numbers.between(-1.0, 1.0)),
        };
        if let Some(lens) = matrix(&draft, aspect) {
            draft.head[1] = lens;
            draft.kind = format!("fx / fy {:.3} {}", 1.0 / aspect, draft.kind);
            return draft;
        }
    }
}

/// The lens of a scene, unless it is parallel, as a matrix with fy / fx equal to `aspect`.
fn matrix(draft: &Draft, aspect: f64) -> Option<String> {
    let lens = draft.head[1].strip_prefix("lens: Retina(")?;
    let [width, distance] = [("width: ", lens), ("distance: ", lens)].map(after);
    let side = after(("width: ", &draft.head[0]))?;
    let pixel = width? / side;
    let focal = distance? / pixel / aspect.sqrt();
    let shift = lens.split_once("shift: (").map(|(_, shift)| shift);
    let shift: Vec<f64> = shift
        .into_iter()
        .flat_map(|shift| shift.trim_end_matches(')').split(", "))
        .filter_map(|part| part.parse().ok())
        .collect();
    let [x, y] = *shift.first_chunk().unwrap_or(&[0.0; 2]);
    let middle = 0.5 * (side - 1.0);
    Some(format!(
        "lens: Matrix(fx: {focal}, fy: {}, cx: {}, cy: {})",
        focal * aspect,
        middle - x / pixel,
        middle + y / pixel
    ))
}

/// The number after a word in a text.
fn after((word, text): (&str, &str)) -> Option<f64> {
    let (_, rest) = text.split_once(word)?;
    let end = rest.find([',', ')']).unwrap_or(rest.len());
    rest[..end].parse().ok()
}
