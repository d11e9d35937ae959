//! Rays that pass the rim of a sphere so closely that rounding could decide: 1 − (distance from the center / r)² is
//! between ±2⁻¹ and ±2⁻¹¹⁰.

use glam::DVec3;

use super::tangent::{self, Rotation};
use super::{Draft, Random};

/// The relative distance of the discriminant from 0, on either side.
fn gap(random: &mut Random) -> f64 {
    random.sign() * random.power_of_two(-110, -1) * random.between(1.0, 2.0)
}

/// The point of contact of a tangent ray from the origin of the coordinates, relative to the center.
fn contact(draft: &Draft) -> DVec3 {
    let along = draft.direction.dot(draft.center) / draft.direction.length_squared();
    draft.direction * along - draft.center
}

/// A tangent ray from the origin of the coordinates, moved sideways by a component of its origin.
fn opened(random: &mut Random, mut draft: Draft) -> Draft {
    let contact = contact(&draft);
    let axis = contact.abs().max_position();
    draft.origin[axis] = -gap(random) * 0.5 * draft.radius * (draft.radius / contact[axis]);
    draft
}

pub(super) fn along_axis(random: &mut Random) -> Draft {
    let draft = tangent::along_axis(random);
    opened(random, draft)
}

pub(super) fn oblique(random: &mut Random) -> Draft {
    let draft = tangent::oblique(random);
    opened(random, draft)
}

/// A tangent along an axis, turned slightly by one of the other components of the direction.
pub(super) fn turned(random: &mut Random) -> Draft {
    let mut draft = tangent::along_axis(random);
    let contact = contact(&draft);
    let axis = contact.abs().max_position();
    let length = draft.direction.length();
    let depth = draft.direction.dot(draft.center) / length;
    if depth > 0.0 {
        let across = -gap(random) * 0.5 * draft.radius * (draft.radius / contact[axis]);
        draft.direction[axis] = across * length / depth;
    }
    draft
}

/// All of these together: a moved origin, whole multiples of the direction, another scale.
pub(super) fn mixed(random: &mut Random) -> Draft {
    let draft = match random.integer(0, 2) {
        0 => along_axis(random),
        1 => oblique(random),
        _ => turned(random),
    };
    let draft = if random.one_in(3) {
        draft.nudged(random, 8)
    } else {
        draft
    };
    let by = DVec3::from([(); 3].map(|()| random.integer(-1 << 50, 1 << 50) as f64));
    let moved = Draft {
        center: draft.center + by,
        origin: draft.origin + by,
        ..draft
    };
    let draft = if random.one_in(2) { moved } else { draft };
    let scale = random.power_of_two(-40, 40);
    let stretch = random.integer(1, 1 << 9) as f64;
    draft.scaled(scale).stretched(stretch).shuffled(random)
}

/// Numbers without a pattern: the radius, or the aim, comes from a rounded computation.
pub(super) fn rounded(random: &mut Random) -> Draft {
    let (origin, center) = (random.in_cube(10.0), random.in_cube(10.0));
    let to_center = center - origin;
    let aside = to_center.cross(random.unit_vector()).normalize();
    let radius = to_center.length() * random.magnitude(1e-3, 0.99);
    // The tangent's direction: its angle to the center has the sine r / |f|.
    let sine = radius * (1.0 - 0.5 * gap(random)) / to_center.length();
    let cosine = (1.0 - sine * sine).max(0.0).sqrt();
    let direction = to_center.normalize() * cosine + aside * sine;
    Draft {
        origin,
        direction: direction * random.magnitude(0.1, 10.0),
        center,
        radius,
    }
}

/// Whole numbers up to 2⁵³ whose discriminant is 1 or −1 times the square of the direction.
///
/// If the product of two Gaussian integers has the imaginary part 1, the product of their norms is a square plus 1:
/// (a² + b²) (c² + d²) = e² + 1 with e = a c + b d, if a d − b c = 1.
pub(super) fn by_whole_numbers(random: &mut Random) -> Draft {
    let (mut a, mut b) = (1_i64, 0_i64);
    let (mut c, mut d) = (0_i64, 1_i64);
    // Shears keep a d − b c = 1; e stays below 2⁵².
    let limit = 1_i64 << random.integer(4, 25);
    loop {
        let factor = random.integer(-3, 3);
        if random.one_in(2) {
            (a, b) = (a + factor * c, b + factor * d);
        } else {
            (c, d) = (c + factor * a, d + factor * b);
        }
        if [a, b, c, d].iter().any(|part| part.abs() > limit) {
            break;
        }
    }
    let product = a * c + b * d;
    let (p, q) = (a * a + b * b, c * c + d * d);
    // e² + 1 = p q is also (a c − b d)² + (a d + b c)².
    let (x, y, radius) = if random.one_in(2) && (p - q) % 2 == 0 {
        // ((p + q) / 2)² = ((p − q) / 2)² + e² + 1: the ray passes within.
        ((p - q) / 2, product, (p + q) / 2)
    } else {
        (a * c - b * d, a * d + b * c, product.abs())
    };
    let draft = Draft {
        origin: DVec3::ZERO,
        direction: DVec3::Z * random.integer(1, 99) as f64,
        center: DVec3::new(x as f64, y as f64, random.integer(1, 1 << 53) as f64),
        radius: radius as f64,
    };
    draft.shuffled(random)
}

/// Grazing rays whose distance, radius and direction have very different sizes.
pub(super) fn at_any_scale(random: &mut Random) -> Draft {
    let radius = random.magnitude(1e-30, 1e30);
    let rotation = Rotation::draw(random, 9);
    let depth = radius * random.magnitude(1e-12, 1e12);
    let across = radius * (1.0 - 0.5 * gap(random));
    let length = rotation.square;
    let center =
        rotation.turn(DVec3::X) * (across / length) + rotation.turn(DVec3::Z) * (depth / length);
    Draft {
        origin: DVec3::ZERO,
        direction: rotation.turn(DVec3::Z) * random.magnitude(1e-20, 1e20),
        center,
        radius,
    }
}
