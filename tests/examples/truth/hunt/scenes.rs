//! A random scene of each family.

use super::draft::{Draft, OPEN, SIDE};
use marbles_tests::numbers::Numbers;

/// The distance of the lens, in pixels, for families in which the lens is not the difficulty.
pub(super) const DISTANCE: f64 = 50.0;

/// A point of the picture, at a depth.
pub(super) fn place(numbers: &mut Numbers, depth: f64) -> [f64; 3] {
    let half = 0.4 * f64::from(SIDE) / DISTANCE * depth;
    [
        numbers.between(-half, half),
        numbers.between(-half, half),
        depth,
    ]
}

pub(super) fn add_balls(numbers: &mut Numbers, draft: &mut Draft, count: usize, sizes: [f64; 2]) {
    for _ in 0..count {
        let depth = numbers.between(60.0, 200.0);
        let center = place(numbers, depth);
        let radius = numbers.between(sizes[0], sizes[1]) * depth / DISTANCE;
        draft.sphere(center, radius);
    }
}

pub(super) fn ordinary(numbers: &mut Numbers) -> Draft {
    let lights = numbers.below(3) + 1;
    let mut draft = Draft::new(numbers, DISTANCE, lights);
    let exponent = numbers.either(&["1", "2", "3"]);
    draft.material = format!("albedo: (0.9, 0.6, 0.3), exponent: {exponent}");
    let count = numbers.below(6) + 2;
    add_balls(numbers, &mut draft, count, [1.0, 9.0]);
    draft
}

/// Balls that touch from outside or inside.
pub(super) fn touching(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 1);
    let depth = numbers.between(80.0, 120.0);
    let ([x, y, z], radius) = (place(numbers, depth), numbers.between(5.0, 20.0));
    draft.sphere([x, y, z], radius);
    for _ in 0..2 {
        let other = numbers.between(1.0, 15.0);
        let apart = if numbers.below(3) == 0 {
            (radius - other).abs()
        } else {
            radius + other
        };
        let [u, v, w] = numbers.direction();
        draft.sphere([x + u * apart, y + v * apart, z + w * apart], other);
    }
    draft
}

/// Balls exactly behind another ball, with the same contour.
pub(super) fn coincident(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 1);
    let depth = numbers.between(60.0, 100.0);
    let ([x, y, z], radius) = (place(numbers, depth), numbers.between(3.0, 15.0));
    draft.sphere([x, y, z], radius);
    for _ in 0..numbers.below(2) + 1 {
        let factor = numbers.either(&[2.0, 1.25, 0.5, 1.0, 3.0]) + 0.0;
        draft.sphere([x * factor, y * factor, z * factor], radius * factor);
    }
    add_balls(numbers, &mut draft, 1, [3.0, 9.0]);
    draft
}

/// Three balls whose contours, or contours and seams, meet in a point.
pub(super) fn triple_points(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 1);
    let [x, y, z] = place(numbers, 100.0);
    for _ in 0..3 {
        let radius = numbers.between(4.0, 15.0);
        let turn = numbers.between(0.0, std::f64::consts::TAU);
        let depth = z * numbers.between(0.8, 1.2);
        // The contour of a ball passes by the point to within some thousandths.
        let sine = radius / depth;
        let aside = depth * sine / (1.0 - sine * sine).sqrt() * (1.0 - sine * sine);
        let along = depth / z;
        let (cos, sin) = (libm::cos(turn), libm::sin(turn));
        draft.sphere(
            [x * along + aside * cos, y * along + aside * sin, depth],
            radius,
        );
    }
    draft
}

/// Shadows that touch a contour, or another shadow's edge.
pub(super) fn grazing_shadows(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 0);
    draft.head.retain(|field| !field.starts_with("shadows"));
    let toward = [numbers.between(-1.0, 1.0), numbers.between(-1.0, 1.0), -0.8];
    draft.light(toward, 0.9);
    let length = toward.iter().map(|part| part * part).sum::<f64>().sqrt();
    let unit = toward.map(|part| part / length);
    let ([x, y, z], radius) = (place(numbers, 100.0), numbers.between(8.0, 20.0));
    draft.sphere([x, y, z], radius);
    for _ in 0..2 {
        // Across the light by about the sum, or the difference, of the radii.
        let other = numbers.between(1.0, 10.0);
        let sum = if numbers.below(2) == 0 {
            radius + other
        } else {
            (radius - other).abs()
        };
        let [u, v, w] = numbers.direction();
        let along = u * unit[0] + v * unit[1] + w * unit[2];
        let across = [
            u - along * unit[0],
            v - along * unit[1],
            w - along * unit[2],
        ];
        let size = across.iter().map(|part| part * part).sum::<f64>().sqrt();
        let (aside, ahead) = (
            sum * numbers.between(0.99, 1.0) / size,
            numbers.between(15.0, 40.0),
        );
        let at = |axis: usize| across[axis] * aside + unit[axis] * ahead;
        draft.sphere([x + at(0), y + at(1), z + at(2)], other);
    }
    draft
}

/// Light from behind, and nearly perpendicular to the view.
pub(super) fn terminator_at_rim(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 0);
    for _ in 0..numbers.below(2) + 1 {
        let turn = numbers.between(0.0, std::f64::consts::TAU);
        let ahead = numbers.either(&[1.0, 0.3, 0.02, -0.02]) * numbers.between(0.5, 1.0);
        draft.light([libm::cos(turn), libm::sin(turn), ahead], 0.8);
    }
    let exponent = numbers.either(&["1", "0.5", "0.3", "1.5"]);
    draft.material = format!("albedo: 0.8, exponent: {exponent}");
    add_balls(numbers, &mut draft, 3, [2.0, 10.0]);
    draft
}

pub(super) fn exponents(numbers: &mut Numbers) -> Draft {
    let lights = numbers.below(2) + 1;
    let mut draft = Draft::new(numbers, DISTANCE, lights);
    let exponent = numbers.either(&[0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 1.3, 2.6, 7.0, 40.0, 300.0]);
    draft.material = format!("albedo: 0.9, exponent: {exponent}");
    let count = numbers.below(3) + 1;
    add_balls(numbers, &mut draft, count, [2.0, 12.0]);
    draft
}

pub(super) fn highlights(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 2);
    let power = numbers.between(0.3, 5.0);
    let shininess = libm::pow(10.0, power);
    let strength = numbers.either(&[0.2, 1.0]);
    draft.material =
        format!("albedo: 0.6, highlight: (strength: {strength}, shininess: {shininess})");
    add_balls(numbers, &mut draft, 2, [2.0, 14.0]);
    draft
}

pub(super) fn long_lenses(numbers: &mut Numbers) -> Draft {
    let power = numbers.between(1.0, 5.0);
    let far = libm::pow(10.0, power);
    let mut draft = Draft::new(numbers, DISTANCE * far, 1);
    for _ in 0..4 {
        let [x, y, z] = place(numbers, 100.0);
        draft.sphere(
            [x, y, z * far + numbers.between(-20.0, 20.0)],
            numbers.between(1.0, 12.0),
        );
    }
    draft
}

/// Scenes of other families from a distance that is 10 to 1e6 times larger: nearly parallel rays.
pub(super) fn far_away(numbers: &mut Numbers) -> Draft {
    let mut draft = match numbers.below(8) {
        0 => ordinary(numbers),
        1 => touching(numbers),
        2 => grazing_shadows(numbers),
        3 => terminator_at_rim(numbers),
        4 => exponents(numbers),
        5 => highlights(numbers),
        6 => slivers(numbers),
        _ => seams(numbers),
    };
    draft.step_back(libm::pow(10.0, numbers.between(1.0, 6.0)));
    draft
}

/// Rough balls from a large distance.
pub(super) fn far_bumps(numbers: &mut Numbers) -> Draft {
    let mut draft = surface_bumps(numbers, [-0.3, 2.0]);
    draft.step_back(libm::pow(10.0, numbers.between(1.0, 6.0)));
    draft
}

pub(super) fn wide_lenses(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, 3.0, 1);
    for _ in 0..4 {
        let depth = numbers.between(5.0, 30.0);
        let [x, y, _] = place(numbers, 8.0 * depth);
        let distance = (x * x + y * y + depth * depth).sqrt();
        draft.sphere([x, y, depth], distance * numbers.between(0.05, 0.7));
    }
    draft
}

pub(super) fn floors(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 1);
    let power = numbers.between(3.0, 9.0);
    let radius = libm::pow(10.0, power);
    let below = numbers.between(5.0, 30.0);
    draft.sphere([0.0, -radius - below, 100.0], radius);
    for _ in 0..3 {
        let [x, _, z] = place(numbers, 100.0);
        let size = numbers.between(2.0, 12.0);
        draft.sphere([x, size - below, z + numbers.between(-30.0, 60.0)], size);
    }
    draft
}

pub(super) fn crowds(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 1);
    for _ in 0..300 {
        let depth = numbers.between(90.0, 110.0);
        let center =
            place(numbers, depth).map(|part| part * if part.abs() < 50.0 { 0.2 } else { 1.0 });
        draft.sphere(center, numbers.between(0.1, 1.5));
    }
    draft
}

/// Dozens of overlapping balls in each pixel: most of them hidden, or all visible.
pub(super) fn overlapping_crowds(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 1);
    let depth = numbers.between(80.0, 120.0);
    let [x, y, z] = place(numbers, depth);
    let radius = numbers.between(5.0, 20.0);
    let count = 20.0 * libm::pow(10.0, numbers.between(0.0, 1.2));
    let spread = radius * libm::pow(10.0, numbers.between(-2.0, 0.0));
    for _ in 0..count as usize {
        let [u, v, w] = [(); 3].map(|()| numbers.between(-spread, spread));
        draft.sphere([x + u, y + v, z + w], radius * numbers.between(0.98, 1.0));
    }
    draft
}

/// Balls next to others, which leave only thin slivers of them visible.
pub(super) fn slivers(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 2);
    for _ in 0..3 {
        let depth = numbers.between(80.0, 120.0);
        let ([x, y, z], radius) = (place(numbers, depth), numbers.between(4.0, 15.0));
        draft.sphere([x, y, z], radius);
        let (near, shift) = (
            numbers.between(0.7, 0.99),
            numbers.between(-0.02, 0.02) * radius,
        );
        draft.sphere(
            [x * near + shift, y * near, z * near],
            radius * near * numbers.between(0.98, 1.001),
        );
    }
    draft
}

/// Balls whose contours run along rows and columns, and through corners of pixels.
pub(super) fn aligned_grids(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 0);
    draft.head[1] = format!("lens: Retina(width: {SIDE}, distance: 64)");
    draft.light(
        numbers.either(&[[0.0, 0.0, -1.0], [1.0, 0.0, -1.0], [-1.0, 1.0, -1.0]]),
        1.0,
    );
    let step = numbers.either(&[4.0, 6.0, 8.0]);
    let radius = step * numbers.either(&[0.5, 0.25, 0.75]);
    for column in -2..=2 {
        for row in -2..=2 {
            let [x, y] = [column, row].map(|index| f64::from(index) * step);
            draft.sphere([x, y, numbers.either(&[128.0, 64.0])], radius);
        }
    }
    draft
}

pub(super) fn many_lights(numbers: &mut Numbers) -> Draft {
    let lights = numbers.below(8) + 10;
    let mut draft = Draft::new(numbers, DISTANCE, lights);
    add_balls(numbers, &mut draft, 3, [3.0, 10.0]);
    draft
}

/// Balls that intersect.
pub(super) fn seams(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 2);
    let [x, y, z] = place(numbers, 100.0);
    for _ in 0..4 {
        let [u, v, w] = numbers.direction();
        let apart = numbers.between(0.0, 12.0);
        draft.sphere(
            [x + u * apart, y + v * apart, z + w * apart],
            numbers.between(4.0, 14.0),
        );
    }
    draft
}

/// A camera that moves by a tenth of a pixel to ten pixels while the shutter is open.
pub(super) fn shutters(numbers: &mut Numbers) -> Draft {
    let lights = numbers.below(2) + 1;
    let mut draft = Draft::new(numbers, DISTANCE, lights);
    let exponent = numbers.either(&["1", "1", "2"]);
    let highlight = numbers.either(&["", ", highlight: (strength: 0.5, shininess: 30)"]);
    draft.material = format!("albedo: (0.9, 0.6, 0.3), exponent: {exponent}{highlight}");
    let count = numbers.below(4) + 1;
    add_balls(numbers, &mut draft, count, [0.5, 9.0]);
    let power = numbers.between(-1.0, 1.0);
    // Twice as far from key to key as while the shutter is open; a pixel is about 2 units wide there.
    let way = 4.0 * libm::pow(10.0, power);
    let [x, y, z] = numbers.direction().map(|part| part * way);
    let [pan, roll] = [numbers.between(-1.0, 1.0) * way, numbers.between(-3.0, 3.0)];
    let key = match numbers.below(3) {
        0 => format!("position: ({x}, {y}, {z})"),
        1 => format!("pan: {pan}, roll: {roll}"),
        _ => format!("position: ({x}, {y}, {z}), pan: {pan}, zoom: 1.1"),
    };
    draft.head.push(format!(
        "animation: Keyframes({OPEN}, keys: [\
         (frame: 1, position: (0, 0, 0), pan: 0, roll: 0, zoom: 1, ease: Linear), (frame: 3, {key})])"
    ));
    draft
}

/// Bumps on the surface; the decimal logarithm of their size in pixels is between two numbers.
pub(super) fn surface_bumps(numbers: &mut Numbers, logarithms: [f64; 2]) -> Draft {
    let size = libm::pow(10.0, numbers.between(logarithms[0], logarithms[1]));
    rough(numbers, &format!("Surface({size})"))
}

/// Rough balls at a distance, in units, of about the distance of the lens in pixels: a unit is about a pixel.
pub(super) fn rough(numbers: &mut Numbers, grain: &str) -> Draft {
    let lights = numbers.below(2) + 1;
    let mut draft = Draft::new(numbers, DISTANCE, lights);
    draft.head[1] = format!("lens: Retina(width: {SIDE}, distance: {DISTANCE})");
    let exponent = numbers.either(&[1.0, 1.0, 0.5, 2.0]);
    let amplitude = numbers.between(0.1, 0.9);
    let seed = numbers.below(1000);
    draft.material = format!(
        "albedo: 0.8, exponent: {exponent}, rough: (amplitude: {amplitude}, grain: {grain}, seed: {seed})"
    );
    if numbers.below(2) == 0 {
        let shininess = libm::pow(10.0, numbers.between(0.0, 3.3));
        draft.material += &format!(", highlight: (strength: 0.5, shininess: {shininess})");
    }
    for _ in 0..2 {
        let depth = DISTANCE * numbers.between(0.9, 1.2);
        let center = place(numbers, depth);
        draft.sphere(center, numbers.between(3.0, 12.0));
    }
    draft
}
