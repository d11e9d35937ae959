//! Rays that are exactly tangent, from Pythagorean triples, and their nearest neighbors.

use glam::DVec3;

use super::{Draft, Random};

/// A tangent ray along z in whole numbers below 2²⁷. It touches at (x, y) = (m² − n², 2 m n), so r = m² + n².
pub(super) fn along_axis(random: &mut Random) -> Draft {
    let size = 1 << random.integer(1, 13);
    let (m, n) = (random.integer(1, size), random.integer(0, size));
    let x = (m * m - n * n) as f64;
    let y = (2 * m * n) as f64;
    let draft = Draft {
        origin: DVec3::ZERO,
        direction: DVec3::Z * random.integer(1, 1 << 12) as f64,
        center: DVec3::new(x, y, random.integer(1, 1 << 27) as f64),
        radius: (m * m + n * n) as f64,
    };
    draft.shuffled(random)
}

/// A rotation matrix in whole numbers times N, the squared norm of the quaternion it comes from.
pub(super) struct Rotation {
    columns: [DVec3; 3],
    pub(super) square: f64,
}

impl Rotation {
    pub(super) fn draw(random: &mut Random, size: i64) -> Self {
        let [a, b, c, d] = [(); 4].map(|()| random.integer(-size, size) as f64);
        if a == 0.0 && b == 0.0 && c == 0.0 && d == 0.0 {
            return Self::draw(random, size);
        }
        let column = |x, y, z| DVec3::new(x, y, z);
        Self {
            columns: [
                column(
                    a * a + b * b - c * c - d * d,
                    2.0 * (b * c + a * d),
                    2.0 * (b * d - a * c),
                ),
                column(
                    2.0 * (b * c - a * d),
                    a * a - b * b + c * c - d * d,
                    2.0 * (c * d + a * b),
                ),
                column(
                    2.0 * (b * d + a * c),
                    2.0 * (c * d - a * b),
                    a * a - b * b - c * c + d * d,
                ),
            ],
            square: a * a + b * b + c * c + d * d,
        }
    }

    /// Exact as long as all numbers stay below 2⁵³.
    pub(super) fn turn(&self, vector: DVec3) -> DVec3 {
        self.columns[0] * vector.x + self.columns[1] * vector.y + self.columns[2] * vector.z
    }
}

/// A tangent ray at any angle.
pub(super) fn oblique(random: &mut Random) -> Draft {
    let rotation = Rotation::draw(random, 31);
    let draft = along_axis(random);
    Draft {
        direction: rotation.turn(draft.direction),
        center: rotation.turn(draft.center),
        radius: draft.radius * rotation.square,
        ..draft
    }
}

/// A tangent ray at any position and of any size, still exact.
pub(super) fn scaled(random: &mut Random) -> Draft {
    let by = DVec3::from([(); 3].map(|()| random.integer(-1 << 50, 1 << 50) as f64));
    let by = if random.one_in(2) { by } else { DVec3::ZERO };
    let scene = random.power_of_two(-900, 900);
    let direction = random.power_of_two(-900, 900);
    oblique(random).moved(by).scaled(scene).stretched(direction)
}

/// A tangent case with one input replaced by one of its nearest neighbors.
pub(super) fn neighbors(random: &mut Random) -> Draft {
    let tangent = match random.integer(0, 2) {
        0 => along_axis(random),
        1 => oblique(random),
        _ => scaled(random),
    };
    // Rarely neighbors of zero, whose exponent makes long integers.
    let nudged = tangent.nudged(random, 2);
    let has_denormal = |vector: DVec3| vector.to_array().iter().any(|part| part.is_subnormal());
    let extreme = has_denormal(nudged.origin) || has_denormal(nudged.direction);
    if extreme && !random.one_in(8) {
        return neighbors(random);
    }
    nudged
}

/// A ray that touches the sphere at its own origin, or next to it.
pub(super) fn at_origin(random: &mut Random) -> Draft {
    let rotation = Rotation::draw(random, 100);
    let (x, y) = (
        random.integer(-99, 99) as f64,
        random.integer(-99, 99) as f64,
    );
    let radius = random.integer(1, 1 << 20) as f64;
    let by = random.integer(-1, 1) as f64;
    Draft {
        // Exactly at the point of contact, or as many whole directions before or behind it.
        origin: rotation.turn(DVec3::new(x, y, 0.0)) * -by,
        direction: rotation.turn(DVec3::new(x, y, 0.0)),
        center: rotation.turn(DVec3::Z * radius),
        radius: radius * rotation.square,
    }
}
