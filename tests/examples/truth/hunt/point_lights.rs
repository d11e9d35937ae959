//! Scenes with point lights, by random numbers.

use super::draft::Draft;
use super::scenes::{DISTANCE, add_balls, place};
use marbles_tests::numbers::Numbers;

/// A surface with or without a highlight.
fn surface(numbers: &mut Numbers) -> String {
    let exponent = numbers.either(&["1", "1", "2", "0.5"]);
    let highlight = numbers.either(&["", ", highlight: (strength: 0.4, shininess: 20)"]);
    format!("albedo: (0.9, 0.6, 0.3), exponent: {exponent}{highlight}")
}

/// The distance at which the light has its intensity; `None` without falloff.
fn falloff(numbers: &mut Numbers, reference: f64) -> Option<f64> {
    (numbers.below(4) > 0).then_some(reference)
}

/// Lights next to spheres, at a distance from the surface that is a fraction of the radius.
pub(super) fn near_lights(numbers: &mut Numbers) -> Draft {
    let directional = numbers.below(2);
    let mut draft = Draft::new(numbers, DISTANCE, directional);
    draft.material = surface(numbers);
    let depth = numbers.between(80.0, 120.0);
    let ([x, y, z], radius) = (place(numbers, depth), numbers.between(8.0, 25.0));
    draft.sphere([x, y, z], radius);
    add_balls(numbers, &mut draft, 2, [1.0, 5.0]);
    for _ in 0..numbers.below(2) + 1 {
        let [u, v, w] = numbers.direction();
        // More often than not on the side that is seen.
        let w = if numbers.below(3) > 0 { -w.abs() } else { w };
        let apart = radius * (1.0 + libm::pow(10.0, numbers.between(-2.0, 0.5)));
        let position = [x + u * apart, y + v * apart, z + w * apart];
        let falloff = falloff(numbers, apart - radius);
        draft.point_light(position, numbers.between(0.3, 0.8), falloff);
    }
    draft
}

/// Lights in the middle of a group of spheres.
pub(super) fn lights_between_spheres(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 0);
    draft.material = surface(numbers);
    let count = numbers.below(8) + 3;
    add_balls(numbers, &mut draft, count, [1.0, 9.0]);
    for _ in 0..numbers.below(3) + 1 {
        let depth = numbers.between(40.0, 200.0);
        let position = place(numbers, depth);
        let reference = numbers.between(10.0, 60.0);
        let falloff = falloff(numbers, reference);
        draft.point_light(position, numbers.between(0.2, 0.6), falloff);
    }
    draft
}

/// Lights inside spheres, some of which also contain the viewpoint.
pub(super) fn lights_inside(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 0);
    draft.material = surface(numbers);
    if numbers.below(3) > 0 {
        draft.sphere([0.0, 0.0, 100.0], numbers.between(250.0, 400.0));
    }
    let depth = numbers.between(80.0, 120.0);
    let ([x, y, z], radius) = (place(numbers, depth), numbers.between(8.0, 20.0));
    draft.sphere([x, y, z], radius);
    let count = numbers.below(4) + 1;
    add_balls(numbers, &mut draft, count, [1.0, 7.0]);
    for _ in 0..2 {
        let [u, v, w] = numbers.direction();
        let apart = radius * numbers.either(&[0.5, 0.99, 1.01, 2.0, 4.0]);
        let position = [x + u * apart, y + v * apart, z + w * apart];
        let falloff = falloff(numbers, radius);
        draft.point_light(position, numbers.between(0.2, 0.5), falloff);
    }
    draft
}

/// Cones of shadow that touch an contour, or the edge of another shadow.
pub(super) fn grazing_cones(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 0);
    draft.head.retain(|field| !field.starts_with("shadows"));
    draft.material = surface(numbers);
    let ([x, y, z], radius) = (place(numbers, 100.0), numbers.between(8.0, 20.0));
    draft.sphere([x, y, z], radius);
    let light = [
        x + numbers.between(-60.0, 60.0),
        y + numbers.between(-60.0, 60.0),
        z - numbers.between(20.0, 70.0),
    ];
    let way = [x - light[0], y - light[1], z - light[2]];
    let distance = way.iter().map(|part| part * part).sum::<f64>().sqrt();
    let unit = way.map(|part| part / distance);
    let falloff = falloff(numbers, distance);
    draft.point_light(light, 0.9, falloff);
    for _ in 0..2 {
        // At a part of the way, aside by about the sum, or the difference, of what the radii are seen as from the light.
        let share = numbers.between(0.3, 0.8);
        let other = numbers.between(1.0, 8.0) * share;
        let own = libm::asin(radius / distance);
        let angle = libm::asin((other / (share * distance)).min(0.9));
        let apart = if numbers.below(2) == 0 {
            own + angle
        } else {
            (own - angle).abs()
        };
        let [u, v, w] = numbers.direction();
        let along = u * unit[0] + v * unit[1] + w * unit[2];
        let across = [0, 1, 2].map(|axis| [u, v, w][axis] - along * unit[axis]);
        let size = across.iter().map(|part| part * part).sum::<f64>().sqrt();
        let apart = apart * numbers.between(0.99, 1.0);
        let (sine, cosine) = (libm::sin(apart), libm::cos(apart));
        let center = [0, 1, 2].map(|axis| {
            let turned = unit[axis] * cosine + across[axis] / size * sine;
            light[axis] + turned * (share * distance)
        });
        draft.sphere(center, other);
    }
    draft
}
