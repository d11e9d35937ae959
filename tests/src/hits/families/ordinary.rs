//! Rays toward spheres of all sizes and positions.

use glam::DVec3;

use super::{Draft, Random};

/// A ray from `origin` toward the sphere, or slightly past it.
fn aimed(random: &mut Random, origin: DVec3, center: DVec3, radius: f64) -> Draft {
    let target = center + random.in_unit_ball() * (1.3 * radius);
    let direction = target - origin;
    let direction = match random.integer(0, 2) {
        0 => direction,
        1 => direction.normalize(),
        _ => direction * random.magnitude(1e-3, 1e3),
    };
    Draft {
        origin,
        direction,
        center,
        radius,
    }
}

pub(super) fn generic(random: &mut Random) -> Draft {
    let (origin, center) = (random.in_cube(10.0), random.in_cube(10.0));
    let radius = random.magnitude(0.1, 5.0);
    aimed(random, origin, center, radius)
}

pub(super) fn inside(random: &mut Random) -> Draft {
    let (center, radius) = (random.in_cube(10.0), random.magnitude(0.1, 100.0));
    let origin = center + random.in_unit_ball() * radius;
    let direction = random.unit_vector() * random.magnitude(1e-3, 1e3);
    Draft {
        origin,
        direction,
        center,
        radius,
    }
}

pub(super) fn behind(random: &mut Random) -> Draft {
    let draft = generic(random);
    draft.stretched(-1.0)
}

/// Directions exactly toward the center, or away from it, including along axes.
pub(super) fn through_center(random: &mut Random) -> Draft {
    let origin = match random.integer(0, 1) {
        0 => DVec3::ZERO,
        _ => random.in_cube(10.0),
    };
    let mut center = random.in_cube(10.0);
    if random.one_in(3) {
        center = origin + random.axis() * random.between(0.1, 10.0);
    }
    Draft {
        origin,
        direction: (center - origin) * random.sign() * random.magnitude(1e-3, 1e3),
        center,
        radius: random.magnitude(0.1, 20.0),
    }
}

pub(super) fn far_and_small(random: &mut Random) -> Draft {
    let radius = 1e-3 * random.magnitude(0.1, 10.0);
    let center = random.unit_vector() * random.magnitude(1e6, 1e12);
    let eye = random.in_cube(1.0);
    let origin = if random.one_in(2) { eye } else { DVec3::ZERO };
    aimed(random, origin, center, radius)
}

pub(super) fn offset(random: &mut Random) -> Draft {
    let by = DVec3::new(random.sign(), random.sign(), random.sign()) * 1e8;
    let moved = generic(random).moved(by + random.in_cube(1e3));
    let (origin, center) = (moved.origin, moved.center);
    aimed(random, origin, center, moved.radius)
}

pub(super) fn scaled_direction(random: &mut Random) -> Draft {
    let factor = if random.one_in(2) { 1e150 } else { 1e-150 };
    let draft = match random.integer(0, 2) {
        0 => generic(random),
        1 => inside(random),
        _ => super::grazing::rounded(random),
    };
    draft.stretched(factor)
}

pub(super) fn scaled_scene(random: &mut Random) -> Draft {
    let factor = if random.one_in(2) { 1e150 } else { 1e-150 };
    let draft = match random.integer(0, 2) {
        0 => generic(random),
        1 => inside(random),
        _ => super::grazing::rounded(random),
    };
    draft.scaled(factor)
}

/// Whole numbers so small that many cases are degenerate: tangents, origins on the surface or in the center, directions
/// parallel to the surface.
pub(super) fn lattice(random: &mut Random) -> Draft {
    let size = random.integer(2, 12);
    let mut point = || {
        let mut part = || random.integer(-size, size) as f64;
        DVec3::new(part(), part(), part())
    };
    let (origin, direction, center) = (point(), point(), point());
    Draft {
        origin,
        direction,
        center,
        radius: random.integer(1, size) as f64,
    }
}

/// Distances close to a power of two, where the unit in the last place changes.
pub(super) fn binade(random: &mut Random) -> Draft {
    let draft = if random.one_in(2) {
        generic(random)
    } else {
        inside(random)
    };
    let Draft {
        origin,
        direction,
        center,
        radius,
    } = draft;
    // The school formula is good enough to stretch the direction by.
    let from_center = origin - center;
    let a = direction.length_squared();
    let b = direction.dot(from_center);
    let root = (b * b - a * (from_center.length_squared() - radius * radius)).sqrt();
    let t = if -b - root > 0.0 { -b - root } else { root - b } / a;
    if t > 0.0 && t.is_finite() {
        draft.stretched(t).nudged(random, 4)
    } else {
        draft
    }
}
