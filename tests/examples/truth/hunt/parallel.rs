//! Scenes through parallel lenses.

use super::draft::{Draft, SIDE};
use super::point_lights::{grazing_cones, lights_between_spheres, lights_inside, near_lights};
use super::scenes::{
    DISTANCE, aligned_grids, coincident, crowds, exponents, floors, grazing_shadows, highlights,
    many_lights, ordinary, place, seams, shutters, slivers, terminator_at_rim, touching,
    triple_points,
};
use marbles_tests::numbers::Numbers;

/// Scenes of other families through a parallel lens, with each sphere at its place in the picture at a depth of 100.
pub(super) fn parallel_lenses(numbers: &mut Numbers) -> Draft {
    let family = numbers.either(&[
        ordinary,
        touching,
        coincident,
        triple_points,
        grazing_shadows,
        terminator_at_rim,
        exponents,
        highlights,
        floors,
        crowds,
        slivers,
        aligned_grids,
        many_lights,
        seams,
        near_lights,
        lights_between_spheres,
        lights_inside,
        grazing_cones,
    ]);
    let mut draft = match numbers.below(20) {
        0 => shutters(numbers),
        _ => family(numbers),
    };
    if numbers.below(2) == 0 {
        draft
            .spheres
            .iter_mut()
            .for_each(|sphere| *sphere = flattened(sphere));
    }
    draft.head[1] = parallel_lens(numbers);
    // A light at the camera, exactly.
    if numbers.below(5) == 0 {
        draft.light([0.0, 0.0, -1.0], 0.5);
    }
    draft
}

/// A parallel lens whose pictures show a unit as about half a pixel, or a pixel.
fn parallel_lens(numbers: &mut Numbers) -> String {
    let width = f64::from(SIDE) * numbers.between(1.0, 3.0);
    let shift = numbers.between(-5.0, 5.0);
    let shift = numbers.either(&[0.0, 0.0, 1.0]) * shift;
    format!("lens: Parallel(width: {width}, shift: ({shift}, 0))")
}

/// A sphere that appears in a parallel lens at the same place and in the same size as in a pinhole camera.
fn flattened(sphere: &str) -> String {
    const DEPTH: f64 = 100.0;
    let is_number = |part: &&str| part.parse::<f64>().is_ok();
    let parts = sphere.split(['(', ')', ',', ' ', ':']).filter(is_number);
    let numbers: Vec<f64> = parts.filter_map(|part| part.parse().ok()).collect();
    let [x, y, z, radius] = numbers[..] else {
        return sphere.to_owned();
    };
    if z < radius {
        return sphere.to_owned();
    }
    let [x, y, radius] = [x, y, radius].map(|length| length * (DEPTH / z));
    format!(
        "(center: ({x}, {y}, {}), radius: {radius}, material: \"m\")",
        z.max(radius)
    )
}

/// Balls cut by the plane in which parallel rays begin, and others behind and in front of it. Every third scene has a
/// point light, inside a ball or not.
pub(super) fn planes_that_cut(numbers: &mut Numbers) -> Draft {
    let lights = numbers.below(2) + 1;
    let mut draft = Draft::new(numbers, DISTANCE, lights);
    draft.head[1] = parallel_lens(numbers);
    let exponent = numbers.either(&["1", "1", "2", "0.5"]);
    draft.material = format!("albedo: (0.9, 0.6, 0.3), exponent: {exponent}");
    for _ in 0..numbers.below(4) + 1 {
        let [x, y, _] = place(numbers, 100.0);
        let depth = numbers.between(-12.0, 25.0);
        let radius = numbers.between(2.0, 16.0);
        // Some touch the plane.
        let depth = numbers.either(&[depth, depth, depth, radius, -radius]);
        draft.sphere([x, y, depth], radius);
    }
    if numbers.below(3) == 0 {
        let depth = numbers.between(-20.0, 30.0);
        let reference = numbers.between(10.0, 60.0);
        let [x, y, _] = place(numbers, 100.0);
        draft.point_light([x, y, depth], 0.5, Some(reference));
    }
    draft
}
