//! Scenes under soft light: suns with a disc, and skies.

use glam::DVec3;

use super::draft::Draft;
use super::extremes::power_of_ten;
use super::outlines::outlined;
use super::parallel::{parallel_lenses, planes_that_cut};
use super::scenes::{
    DISTANCE, add_balls, coincident, exponents, floors, grazing_shadows, highlights, ordinary,
    place, seams, slivers, surface_bumps, touching, wide_lenses,
};
use marbles_tests::numbers::Numbers;

/// The size of the pictures: soft light takes long. A pixel is twice as wide as in other families.
const SIZE: &str = "image: (width: 16, height: 12)";
const PIXEL: f64 = 2.0;

/// A penumbra is as wide as a pixel for a sun of about a degree.
pub(super) fn soft_suns(numbers: &mut Numbers) -> Draft {
    let shape = numbers.either(&[
        ordinary,
        touching,
        coincident,
        grazing_shadows,
        exponents,
        highlights,
        wide_lenses,
        floors,
        seams,
        slivers,
        parallel_lenses,
        planes_that_cut,
    ]);
    let mut draft = small(shape(numbers), numbers);
    soften(&mut draft, numbers);
    draft
}

pub(super) fn soft_skies(numbers: &mut Numbers) -> Draft {
    let shape = numbers.either(&[
        ordinary,
        touching,
        coincident,
        wide_lenses,
        floors,
        seams,
        slivers,
        parallel_lenses,
        planes_that_cut,
        resting,
        centered_on_surfaces,
        around_the_eye,
    ]);
    let mut draft = small(shape(numbers), numbers);
    add_sky(&mut draft, numbers);
    draft
}

/// Two to four balls, each of which touches the first one, overlaps it by little, or almost touches it, seen from close to
/// a contact.
pub(super) fn soft_contacts(numbers: &mut Numbers) -> Draft {
    let mut draft = small(Draft::new(numbers, 1.5 * DISTANCE, 1), numbers);
    let contact = DVec3::from(place(numbers, 100.0));
    let radius = power_of_ten(numbers, 0.7, 3.5);
    let count = numbers.below(3) + 1;
    let aside = DVec3::from(numbers.direction())
        .with_z(0.0)
        .normalize_or(DVec3::X);
    let first = aside + DVec3::Z * numbers.between(-0.2, 0.6);
    let first = first.normalize();
    let center = contact - first * radius;
    draft.sphere(center.to_array(), radius);
    for number in 0..count {
        let other = power_of_ten(numbers, 0.3, 2.0);
        let gap = numbers.either(&[0.0, 0.0, 1e-9, 1e-5, 1e-2, -1e-8, -1e-3, -0.1]) * other;
        let way = match number {
            0 => first,
            _ => (first + 0.3 * DVec3::from(numbers.direction())).normalize(),
        };
        let at = center + way * (radius + other + gap);
        draft.sphere(at.to_array(), other);
    }
    light(&mut draft, numbers);
    draft
}

/// Suns that are partly below the horizon of a point that is seen, or of a floor.
pub(super) fn soft_horizons(numbers: &mut Numbers) -> Draft {
    let diameter = diameter(numbers);
    let mut draft = small(Draft::new(numbers, DISTANCE, 0), numbers);
    let exponent = numbers.either(&["1", "1", "0.5", "2"]);
    draft.material = format!("albedo: 0.8, exponent: {exponent}");
    if numbers.below(3) == 0 {
        draft.material += ", highlight: (strength: 0.4, shininess: 10)";
    }
    let normal = match numbers.below(2) {
        0 => {
            let radius = power_of_ten(numbers, 2.0, 9.0);
            let below = numbers.between(5.0, 30.0);
            draft.sphere([0.0, -radius - below, 100.0], radius);
            for _ in 0..2 {
                let [x, _, z] = place(numbers, 100.0);
                let size = numbers.between(2.0, 8.0);
                draft.sphere([x, size - below, z + numbers.between(-20.0, 20.0)], size);
            }
            DVec3::Y
        }
        _ => {
            let normal = DVec3::from(numbers.direction());
            add_balls(numbers, &mut draft, 3, [2.0, 12.0]);
            normal.with_z(-normal.z.abs())
        }
    };
    let aside = DVec3::from(numbers.direction())
        .cross(normal)
        .normalize_or(DVec3::X);
    let above = numbers.between(-1.2, 1.2) * (0.5 * diameter).to_radians();
    draft.light((aside + normal * libm::tan(above)).to_array(), 0.9);
    widen(&mut draft, |_| diameter);
    draft
}

pub(super) fn soft_outlines(numbers: &mut Numbers) -> Draft {
    // Shutters and bumps, which some of these have, are slow enough without soft light.
    let mut draft = loop {
        let draft = outlined(numbers);
        let is_open = draft.head.iter().any(|field| field.contains("shutter"));
        if !is_open && !draft.material.contains("rough") && draft.spheres.len() < 100 {
            break small(draft, numbers);
        }
    };
    light(&mut draft, numbers);
    draft
}

pub(super) fn soft_bumps(numbers: &mut Numbers) -> Draft {
    let mut draft = small(surface_bumps(numbers, [0.7, 2.0]), numbers);
    light(&mut draft, numbers);
    draft
}

/// Dozens or hundreds of small balls beside each other.
pub(super) fn soft_crowds(numbers: &mut Numbers) -> Draft {
    let mut draft = small(Draft::new(numbers, DISTANCE, 1), numbers);
    let count = if numbers.below(3) == 0 {
        numbers.below(500) + 300
    } else {
        numbers.below(250) + 50
    };
    let size = 20.0 / libm::cbrt(count as f64);
    for _ in 0..count {
        let center = [(); 3].map(|()| numbers.between(-25.0, 25.0));
        let center = DVec3::from(center) + DVec3::Z * 110.0;
        draft.sphere(center.to_array(), size * numbers.between(0.3, 1.2));
    }
    light(&mut draft, numbers);
    draft
}

/// Small balls on a large one, at the places where they touch it.
fn resting(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 1);
    let radius = power_of_ten(numbers, 1.0, 6.0);
    let top = DVec3::new(0.0, -numbers.between(2.0, 10.0), 100.0);
    let center = top - DVec3::Y * radius;
    draft.sphere(center.to_array(), radius);
    for _ in 0..numbers.below(4) + 1 {
        let [x, _, _] = place(numbers, 100.0);
        let beside = DVec3::new(x, 0.0, numbers.between(-20.0, 20.0));
        let size = power_of_ten(numbers, 0.0, 1.1);
        let way = (top + beside - center).normalize();
        let at = center + way * (radius + size);
        draft.sphere(at.to_array(), size);
    }
    draft
}

/// Balls whose centers are on the surface of another one, at places where the renderer is likely to compute light.
fn centered_on_surfaces(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 1);
    let center = DVec3::from(place(numbers, 100.0));
    let radius = numbers.between(4.0, 15.0);
    draft.sphere(center.to_array(), radius);
    for _ in 0..numbers.below(3) + 1 {
        let way = [(); 3].map(|()| numbers.either(&[-1.0, 0.0, 0.0, 1.0]));
        let way = DVec3::from(way).normalize_or(DVec3::NEG_Z);
        let size = radius * numbers.between(0.1, 1.0);
        draft.sphere((center + way * radius).to_array(), size);
    }
    draft
}

/// Balls in a large one that the eye is inside of, too.
fn around_the_eye(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 1);
    let radius = power_of_ten(numbers, 1.5, 4.0);
    let center = DVec3::from(numbers.direction()) * (radius * numbers.between(0.0, 0.95));
    draft.sphere(center.to_array(), radius);
    add_balls(numbers, &mut draft, 3, [2.0, 12.0]);
    draft
}

/// A draft of another family as a small picture, nearly always with shadows.
fn small(mut draft: Draft, numbers: &mut Numbers) -> Draft {
    SIZE.clone_into(&mut draft.head[0]);
    draft.pixel = PIXEL;
    draft.head.retain(|field| !field.starts_with("shadows"));
    if numbers.below(12) == 0 {
        draft.head.push("shadows: false".to_owned());
    }
    draft
}

/// Suns or a sky, or both.
fn light(draft: &mut Draft, numbers: &mut Numbers) {
    match numbers.below(5) {
        0 | 1 => soften(draft, numbers),
        2 | 3 => add_sky(draft, numbers),
        _ => {
            let lights = draft.lights.clone();
            add_sky(draft, numbers);
            draft.lights = lights;
            soften(draft, numbers);
        }
    }
}

/// The angle that a sun has across, in degrees.
fn diameter(numbers: &mut Numbers) -> f64 {
    match numbers.below(8) {
        0 => 0.53,
        1 => 170.0,
        _ => power_of_ten(numbers, -2.0, 2.2),
    }
}

/// Gives at most two directional lights a disc, and removes the others.
fn soften(draft: &mut Draft, numbers: &mut Numbers) {
    draft
        .lights
        .retain(|light| light.starts_with("Directional"));
    draft.lights.truncate(2);
    if draft.lights.is_empty() {
        let [x, y] = [(); 2].map(|()| numbers.between(-1.0, 1.0));
        draft.light([x, y, -0.6], 0.9);
    }
    widen(draft, |_| diameter(numbers));
}

fn widen(draft: &mut Draft, mut diameter: impl FnMut(usize) -> f64) {
    for (number, light) in draft.lights.iter_mut().enumerate() {
        let degrees = diameter(number);
        light.truncate(light.len() - 1);
        light.push_str(&format!(", diameter: {degrees})"));
    }
    draft.kind += " suns";
}

/// Replaces the lights by a sky.
fn add_sky(draft: &mut Draft, numbers: &mut Numbers) {
    draft.lights.clear();
    let above = numbers.either(&["1", "(0.3, 0.4, 0.9)"]);
    let below = numbers.either(&[above, "0.2", "0"]);
    let [x, y, z] = match numbers.below(2) {
        0 => [0.0, 1.0, 0.0],
        _ => numbers.direction(),
    };
    draft.head.push(format!(
        "sky: (above: {above}, below: {below}, up: ({x}, {y}, {z}))"
    ));
    draft.kind += " sky";
}
