//! Scenes with lamps that send light in some directions more than in others, by random numbers.

use glam::DVec3;

use super::draft::Draft;
use super::extremes::power_of_ten;
use super::scenes::{DISTANCE, add_balls, place};
use super::together::together;
use marbles_tests::numbers::Numbers;

/// A surface with any exponent, with or without a highlight, smooth or with bumps.
fn surface(numbers: &mut Numbers) -> String {
    let exponent = numbers.either(&["1", "1", "1", "2", "0.5", "1.7"]);
    let shininess = power_of_ten(numbers, 0.3, 3.0);
    let highlight = match numbers.below(3) {
        0 => format!(", highlight: (strength: 0.4, shininess: {shininess})"),
        _ => String::new(),
    };
    let size = power_of_ten(numbers, 0.3, 1.3);
    let rough = match numbers.below(16) {
        0 => format!(", rough: (amplitude: 0.4, grain: Surface({size}), seed: 3)"),
        1 => ", rough: (amplitude: 0.3, grain: Pixel, seed: 3)".to_owned(),
        _ => String::new(),
    };
    format!("albedo: (0.9, 0.6, 0.3), exponent: {exponent}{highlight}{rough}")
}

/// A power from 0.3 to 80, whole ones and those of a half space among them.
fn mu(numbers: &mut Numbers) -> f64 {
    let whole = numbers.either(&[0.0, 1.0, 1.0, 2.0, 3.0, 5.0, 12.0, 40.0]);
    let any = power_of_ten(numbers, -0.523, 1.903);
    let tiny = power_of_ten(numbers, -3.0, -0.6);
    match numbers.below(8) {
        0..3 => whole,
        3 => tiny,
        _ => any,
    }
}

/// A unit vector across another one.
fn across(numbers: &mut Numbers, unit: DVec3) -> DVec3 {
    let any = DVec3::from_array(numbers.direction());
    (any - unit * any.dot(unit)).normalize()
}

/// The direction of a lamp beside a ball at `way` from it: toward any of it, past it, with the plane of the cutoff through a
/// point of it, almost tangent to it, or away.
fn direction(numbers: &mut Numbers, way: DVec3, radius: f64) -> DVec3 {
    let distance = way.length();
    let unit = way / distance;
    let aside = across(numbers, unit);
    match numbers.below(6) {
        0 => unit + aside * (numbers.between(0.0, 1.2) * radius / distance),
        1 => unit * numbers.between(-0.2, 1.0) + aside,
        2 | 3 => {
            let point = way + DVec3::from_array(numbers.direction()) * radius;
            across(numbers, point.normalize())
        }
        4 => {
            // Its distance from the center is the radius, or nearly.
            let off = numbers.either(&[0.0, 1e-9, -1e-9, 1e-3, -1e-3, -0.1]);
            let sine = (radius * (1.0 + off) / distance).min(1.0);
            let sine = sine * numbers.either(&[1.0, -1.0]);
            unit * sine + aside * (1.0 - sine * sine).sqrt()
        }
        _ => -unit + aside * numbers.between(0.0, 2.0),
    }
}

/// LEDs beside, between and inside balls, on floors or not.
pub(super) fn leds(numbers: &mut Numbers) -> Draft {
    let directional = numbers.below(4) / 3;
    let mut draft = Draft::new(numbers, DISTANCE, directional);
    draft.material = surface(numbers);
    if numbers.below(5) == 0 {
        let width = numbers.between(60.0, 120.0);
        draft.head[1] = format!("lens: Parallel(width: {width})");
    }
    let mut balls = Vec::new();
    for _ in 0..numbers.below(2) + 1 {
        let depth = numbers.between(80.0, 120.0);
        let (center, radius) = (place(numbers, depth), numbers.between(6.0, 25.0));
        draft.sphere(center, radius);
        balls.push((DVec3::from_array(center), radius));
    }
    let more = numbers.below(4);
    add_balls(numbers, &mut draft, more, [1.0, 5.0]);
    if numbers.below(4) == 0 {
        let radius = power_of_ten(numbers, 2.0, 7.0);
        let below = numbers.between(8.0, 25.0);
        let center = [0.0, -below - radius, 100.0];
        draft.sphere(center, radius);
        balls.push((DVec3::from_array(center), radius));
    }
    let mut last: Option<(DVec3, DVec3)> = None;
    for _ in 0..numbers.below(3) + 1 {
        if let (Some((position, facing)), 0) = (last, numbers.below(4)) {
            // On one panel with the last one, or on its back.
            let aside = across(numbers, facing.normalize()) * numbers.between(2.0, 20.0);
            let facing = facing * numbers.either(&[1.0, 1.0, -1.0]);
            draft.point_light((position + aside).to_array(), 0.5, Some(20.0));
            draft.face(facing.to_array(), mu(numbers));
            continue;
        }
        let (center, radius) = balls[numbers.below(balls.len())];
        let [u, v, w] = numbers.direction();
        // More often than not on the side that is seen.
        let w = if numbers.below(3) > 0 { -w.abs() } else { w };
        let up = if radius > 100.0 { v.abs() } else { v };
        let unit = DVec3::new(u, up, w);
        let size = radius.min(30.0);
        let near = power_of_ten(numbers, -2.0, 0.7) * size;
        let apart = match numbers.below(12) {
            0 => 0.7 * radius,
            _ => radius + near,
        };
        // Over what is seen of a floor.
        let (center, radius, position) = if radius > 100.0 {
            let [x, _, z] = place(numbers, 100.0);
            let top = DVec3::new(x, center.y + radius, z);
            (top - DVec3::Y * 10.0, 10.0, top + DVec3::Y * near)
        } else {
            (center, radius, center + unit * apart)
        };
        let distance = numbers.either(&[near, size, 3.0 * size]);
        let reference = (numbers.below(4) > 0).then_some(distance);
        draft.point_light(position.to_array(), numbers.between(0.3, 0.8), reference);
        let facing = direction(numbers, center - position, radius);
        draft.face(facing.to_array(), mu(numbers));
        last = Some((position, facing));
    }
    draft
}

/// The scenes that combine several features, whose lamps are LEDs.
pub(super) fn leds_together(numbers: &mut Numbers, index: u64) -> Draft {
    let mut draft = together(numbers, index);
    let lights = std::mem::take(&mut draft.lights);
    for light in lights {
        draft.lights.push(light);
        let facing = DVec3::from_array(numbers.direction()) + DVec3::Z * numbers.between(0.0, 1.0);
        draft.face(facing.to_array(), mu(numbers));
    }
    draft
}
