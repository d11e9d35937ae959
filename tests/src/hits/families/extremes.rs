//! Numbers near the limits of doubles, and sizes that no ordinary scene combines.

use glam::DVec3;

use super::{Draft, Random, ordinary};

/// A case with the sizes of ordinary scenes.
fn plain(random: &mut Random) -> Draft {
    match random.integer(0, 4) {
        0 => ordinary::inside(random),
        1 => super::grazing::oblique(random).scaled(1e-9),
        2 => super::near::cancellation(random),
        _ => ordinary::generic(random),
    }
}

pub(super) fn denormal_scene(random: &mut Random) -> Draft {
    let scale = random.power_of_two(-1074, -1015);
    plain(random).scaled(scale)
}

pub(super) fn denormal_direction(random: &mut Random) -> Draft {
    let scale = random.power_of_two(-1074, -1015);
    plain(random).stretched(scale)
}

pub(super) fn all_denormal(random: &mut Random) -> Draft {
    let scale = random.power_of_two(-1074, -1030);
    let draft = if random.one_in(2) {
        ordinary::lattice(random)
    } else {
        plain(random)
    };
    draft.scaled(scale).stretched(scale)
}

/// Components of the direction that differ by up to 200 decimal orders.
pub(super) fn wild_direction(random: &mut Random) -> Draft {
    let draft = plain(random);
    let axis = random.integer(0, 2) as usize;
    let mut direction = draft.direction;
    direction[axis] *= random.magnitude(1e-200, 1.0);
    if random.one_in(2) {
        direction[(axis + 1) % 3] *= random.magnitude(1e-200, 1.0);
    }
    Draft { direction, ..draft }
}

/// Coordinates that differ by up to 200 decimal orders.
pub(super) fn wild_position(random: &mut Random) -> Draft {
    let mut draft = plain(random);
    for _ in 0..random.integer(1, 4) {
        let axis = random.integer(0, 2) as usize;
        let factor = random.magnitude(1e-200, 1.0);
        if random.one_in(2) {
            draft.center[axis] *= factor;
        } else {
            draft.origin[axis] *= factor;
        }
    }
    draft
}

/// Differences that overflow, squares that overflow, and radii near the largest double.
pub(super) fn huge_coordinates(random: &mut Random) -> Draft {
    let scale = random.power_of_two(1000, 1023);
    let draft = plain(random).scaled(scale);
    let direction = match random.integer(0, 2) {
        0 => draft.direction,
        1 => draft.direction * random.magnitude(1e-300, 1e300),
        _ => draft.direction * scale,
    };
    Draft { direction, ..draft }
}

/// A radius that is far larger, or far smaller, than all distances.
pub(super) fn extreme_radius(random: &mut Random) -> Draft {
    let draft = plain(random);
    let power = random.between(-300.0, 300.0);
    let radius = draft.radius * libm::exp10(power);
    let through = random.one_in(2);
    Draft {
        radius,
        // A tiny sphere is met on the way to its center only.
        direction: if through {
            draft.center - draft.origin
        } else {
            draft.direction
        },
        ..draft
    }
}

/// t near or beyond the largest double.
pub(super) fn overflowing_distance(random: &mut Random) -> Draft {
    let draft = plain(random);
    let scene = random.power_of_two(0, 1020);
    let exponent = libm::ilogb(scene) - random.integer(1018, 1028) as i32;
    draft
        .scaled(scene)
        .stretched(libm::scalbn(1.0, exponent.max(-1074)))
}

/// t near or below the smallest double.
pub(super) fn underflowing_distance(random: &mut Random) -> Draft {
    let draft = plain(random);
    let scene = random.power_of_two(-1070, -60);
    let exponent = libm::ilogb(scene) + random.integer(1010, 1080) as i32;
    draft
        .scaled(scene)
        .stretched(libm::scalbn(1.0, exponent.min(1020)))
}

/// Squares around 2^±256, where the first kind of arithmetic gives up.
pub(super) fn limits_of_moderation(random: &mut Random) -> Draft {
    let side = |random: &mut Random| match random.integer(0, 2) {
        0 => random.power_of_two(-140, -110),
        1 => random.power_of_two(110, 140),
        _ => 1.0,
    };
    let (scene, direction) = (side(random), side(random));
    let draft = match random.integer(0, 4) {
        0 => ordinary::far_and_small(random),
        1 => wild_direction(random),
        2 => wild_position(random),
        _ => plain(random),
    };
    draft.scaled(scene).stretched(direction)
}

/// Numbers with independent exponents.
pub(super) fn any_exponents(random: &mut Random) -> Draft {
    let reach = random.integer(1, 1000);
    let mut number =
        || random.sign() * random.between(1.0, 2.0) * random.power_of_two(-reach, reach);
    let mut vector = || DVec3::new(number(), number(), number());
    let (origin, direction, center) = (vector(), vector(), vector());
    let radius = number().abs();
    Draft {
        origin,
        direction,
        center,
        radius: radius.max(center.length() * f64::from(random.one_in(3))),
    }
}

/// Ten random bit patterns, with an occasional zero.
pub(super) fn any_bits(random: &mut Random) -> Draft {
    let mut number = || {
        if random.one_in(5) {
            0.0
        } else {
            random.any_finite()
        }
    };
    let mut vector = || DVec3::new(number(), number(), number());
    let (origin, direction, center) = (vector(), vector(), vector());
    Draft {
        origin,
        direction,
        center,
        radius: number().abs(),
    }
}
