//! Origins on a surface, exactly or nearly.

use glam::DVec3;

use super::tangent::Rotation;
use super::{Draft, Random};

/// A floor of enormous radius below a low viewpoint, or a dome around it.
pub(super) fn huge(random: &mut Random) -> Draft {
    let radius = random.magnitude(1e6, 1e12);
    let altitude = random.magnitude(1e-6, 1.0) * if random.one_in(4) { -1.0 } else { 1.0 };
    let up = match random.integer(0, 2) {
        0 => DVec3::Y,
        1 => random.axis(),
        _ => random.unit_vector(),
    };
    let origin = up * altitude
        + if random.one_in(2) {
            DVec3::ZERO
        } else {
            random.in_cube(1e-3)
        };
    // Steeply down, or around the horizon, whose dip is √(2 altitude / r).
    let along = up.any_orthonormal_vector();
    let dip = (2.0 * altitude.abs() / radius).sqrt();
    let slope = match random.integer(0, 2) {
        0 => random.between(-1.0, 0.3),
        1 => -dip * random.between(0.0, 2.0),
        _ => -dip * (1.0 + random.sign() * random.magnitude(1e-16, 0.1)),
    };
    Draft {
        origin,
        direction: (along + up * slope) * random.magnitude(0.1, 10.0),
        center: up * -radius,
        radius,
    }
}

/// An origin exactly on the surface: the first column of a rotation matrix of whole numbers.
pub(super) fn on_surface(random: &mut Random) -> Draft {
    let size = 1 << random.integer(1, 23);
    let rotation = Rotation::draw(random, size);
    let to_center = rotation.turn(DVec3::X);
    let direction = match random.integer(0, 3) {
        0 => to_center * random.sign(),
        1 => rotation.turn(DVec3::Y) * random.sign(),
        2 => {
            // Along the surface but for one unit in the last place of one component.
            let mut along = rotation.turn(DVec3::Y);
            let axis = random.integer(0, 2) as usize;
            along[axis] = if random.one_in(2) {
                along[axis].next_up()
            } else {
                along[axis].next_down()
            };
            along
        }
        _ => random.unit_vector(),
    };
    let origin = match random.integer(0, 1) {
        0 => DVec3::ZERO,
        _ => DVec3::from([(); 3].map(|()| random.integer(-1 << 50, 1 << 50) as f64)),
    };
    let draft = Draft {
        origin,
        direction,
        center: origin + to_center,
        radius: rotation.square,
    };
    draft.scaled(random.power_of_two(-60, 20))
}

/// A case of this kind with one input replaced by a neighbor.
pub(super) fn on_surface_neighbors(random: &mut Random) -> Draft {
    let draft = on_surface(random);
    let draft = if random.one_in(2) {
        draft.moved(DVec3::from([(); 3].map(|()| {
            random.integer(-1 << 40, 1 << 40) as f64 * draft.radius.recip()
        })))
    } else {
        draft
    };
    draft.nudged(random, 3)
}

/// An origin as close to the surface as doubles allow, and a direction in or out.
pub(super) fn rounded_surface(random: &mut Random) -> Draft {
    let (center, radius) = (random.in_cube(10.0), random.magnitude(1e-3, 1e3));
    let normal = random.unit_vector();
    Draft {
        origin: center + normal * radius,
        direction: random.unit_vector(),
        center,
        radius,
    }
}

/// An origin on the surface or nearly so, and a direction nearly parallel to it.
pub(super) fn along_surface(random: &mut Random) -> Draft {
    let draft = rounded_surface(random);
    let normal = (draft.origin - draft.center) / draft.radius;
    let along = normal.any_orthonormal_vector();
    let lift = random.sign() * random.magnitude(1e-20, 0.1);
    Draft {
        origin: draft.origin
            + normal * (draft.radius * random.sign() * random.magnitude(1e-17, 1e-2)),
        direction: along + normal * lift,
        ..draft
    }
}

/// An origin within 1e-14 to 1e-3 radii of the surface, on either side.
pub(super) fn cancellation(random: &mut Random) -> Draft {
    let (center, radius) = (random.in_cube(10.0), random.magnitude(1e-3, 1e3));
    let height = 1.0 + random.sign() * random.magnitude(1e-14, 1e-3);
    let normal = random.unit_vector();
    let toward = center + random.in_unit_ball() * radius;
    let origin = center + normal * (radius * height);
    let direction = if random.one_in(2) {
        toward - origin
    } else {
        random.unit_vector()
    };
    Draft {
        origin,
        direction,
        center,
        radius,
    }
}

/// One of two shells that nearly coincide; the ray begins on the other one.
pub(super) fn concentric(random: &mut Random) -> Draft {
    let (center, radius) = (random.in_cube(10.0), random.magnitude(0.1, 10.0));
    let other = radius * (1.0 + random.sign() * random.magnitude(1e-16, 1e-3));
    let outside = center + random.unit_vector() * (radius * random.between(0.0, 3.0));
    let target = center + random.unit_vector() * radius;
    Draft {
        origin: if random.one_in(2) { target } else { outside },
        direction: (target - outside) * random.sign(),
        center,
        radius: if random.one_in(2) { radius } else { other },
    }
}

/// One of two spheres that nearly touch, and a ray through the gap.
pub(super) fn touching(random: &mut Random) -> Draft {
    let (center, radius) = (random.in_cube(10.0), random.magnitude(0.1, 10.0));
    let axis = random.unit_vector();
    let gap = 1.0 + random.sign() * random.magnitude(1e-16, 1e-6);
    let other = random.magnitude(0.1, 10.0);
    let contact = center + axis * (radius * gap);
    let along =
        axis.any_orthonormal_vector() + axis * random.sign() * random.magnitude(1e-16, 1e-3);
    let (center, radius) = if random.one_in(2) {
        (center, radius)
    } else {
        (center + axis * (radius * gap + other), other)
    };
    Draft {
        origin: contact - along * random.between(0.0, 10.0),
        direction: along,
        center,
        radius,
    }
}

/// A direction exactly or nearly orthogonal to the direction toward the center, from both sides of the surface.
pub(super) fn orthogonal(random: &mut Random) -> Draft {
    let rotation = Rotation::draw(random, 1 << 10);
    let to_center = rotation.turn(DVec3::X);
    let radius = match random.integer(0, 2) {
        0 => rotation.square * random.magnitude(0.1, 10.0),
        1 => rotation.square.next_up(),
        _ => rotation.square.next_down(),
    };
    let draft = Draft {
        origin: DVec3::ZERO,
        direction: rotation.turn(DVec3::Y),
        center: to_center,
        radius,
    };
    if random.one_in(2) {
        return draft.nudged(random, 2);
    }
    draft
}
