//! Squares of a sphere's surface.

use glam::{DVec2, DVec3};

use crate::model::sphere::Sphere;
use crate::numeric::pair::both;

/// A square on one of six faces of a cube around a sphere, in the world's axes, seen from the sphere's center: a face that is
/// halved along both sides `level` times.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub(crate) struct Square {
    pub(crate) sphere: u32,
    level: u8,
    /// The axis that the face is across, and its side.
    axis: u8,
    is_positive: bool,
    /// The number of squares before it along the next axis and the one after that.
    place: [u64; 2],
}

/// Doubles tell no finer squares apart.
const FINEST: i32 = 50;

/// The face that a direction meets, and where, from −1 to 1.
fn face(normal: DVec3) -> (usize, bool, DVec2) {
    let size = normal.abs();
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let toward = DVec2::new(normal[(axis + 1) % 3], normal[(axis + 2) % 3]);
    (axis, normal[axis] > 0.0, toward / size[axis])
}

impl Square {
    /// The square of a level in which a normal lies.
    pub(crate) fn around(sphere: usize, normal: DVec3, level: i32) -> Self {
        let (axis, is_positive, at) = face(normal);
        let side = libm::scalbn(1.0, level);
        let place = ((at + 1.0) * (0.5 * side)).clamp(DVec2::ZERO, DVec2::splat(side - 1.0));
        Self {
            sphere: sphere as u32,
            level: level as u8,
            axis: axis as u8,
            is_positive,
            place: [place.x as u64, place.y as u64],
        }
    }

    /// The coarsest level whose squares at a normal are no wider than an angle in radians.
    pub(crate) fn level_of(normal: DVec3, angle: f64) -> i32 {
        let (_, _, at) = face(normal);
        // A square of a face is seen under an angle that is smaller by this factor.
        let square = 1.0 + at.length_squared();
        let width = angle * square.sqrt() * square.sqrt().sqrt();
        libm::ceil(libm::log2(2.0 / width)).clamp(0.0, FINEST.into()) as i32
    }

    /// The unit normal at a place from 0 to 1 along either side.
    pub(crate) fn normal(&self, at: DVec2) -> DVec3 {
        let side = libm::scalbn(1.0, self.level.into());
        let place = DVec2::new(self.place[0] as f64, self.place[1] as f64);
        let on_face = (place * 2.0 - side + at * 2.0) / side;
        let axis = usize::from(self.axis);
        let mut toward = DVec3::ZERO;
        toward[axis] = if self.is_positive { 1.0 } else { -1.0 };
        toward[(axis + 1) % 3] = on_face.x;
        toward[(axis + 2) % 3] = on_face.y;
        toward.normalize()
    }

    /// How the normal at a place changes along both sides.
    pub(crate) fn tangents(&self, at: DVec2) -> [DVec3; 2] {
        let side = libm::scalbn(1.0, self.level.into());
        let normal = self.normal(at);
        // The length of the vector on the face is the inverse of the normal's largest component.
        let axis = usize::from(self.axis);
        let step = 2.0 / side * normal[axis].abs();
        both([axis + 1, axis + 2], |across| {
            let mut along = DVec3::ZERO;
            along[across % 3] = step;
            along - normal * (normal[across % 3] * step)
        })
    }

    /// The place of a normal in it, from 0 to 1 along either side.
    pub(crate) fn locate(&self, normal: DVec3) -> DVec2 {
        let (_, _, at) = face(normal);
        let side = libm::scalbn(1.0, self.level.into());
        let place = DVec2::new(self.place[0] as f64, self.place[1] as f64);
        ((at + 1.0) * (0.5 * side) - place).clamp(DVec2::ZERO, DVec2::ONE)
    }

    /// The square of a level, at most its own, that it is a part of.
    pub(crate) fn ancestor(&self, level: u8) -> Self {
        let finer = self.level - level;
        Self {
            level,
            place: both(self.place, |place| place >> finer),
            ..*self
        }
    }

    /// The square, perhaps one around it, that has a list of the spheres that may hide light from it and its nodes. Its own level
    /// is at least [`WIDEST`].
    pub(crate) fn home(&self) -> Self {
        self.ancestor(listed(self.level.saturating_sub(1)))
    }

    /// The next larger square that has such a list; none of the widest ones.
    pub(crate) fn next_home(&self) -> Option<Self> {
        (self.level > WIDEST).then(|| self.home())
    }

    /// One of its 2 × 2 quarters.
    pub(crate) fn quarter(&self, row: usize, col: usize) -> Self {
        let [x, y] = both(self.place, |place| 2 * place);
        Self {
            level: self.level + 1,
            place: [x + col as u64, y + row as u64],
            ..*self
        }
    }

    /// One of its 3 × 3 nodes.
    pub(crate) fn node(&self, row: usize, col: usize) -> Node {
        let mut corner = Self {
            level: self.level + 1,
            place: [
                2 * self.place[0] + col as u64,
                2 * self.place[1] + row as u64,
            ],
            ..*self
        };
        while corner.level > 0 && corner.place.iter().all(|place| place % 2 == 0) {
            corner.place = [corner.place[0] / 2, corner.place[1] / 2];
            corner.level -= 1;
        }
        Node(corner)
    }

    /// A number that is about as likely as any other.
    pub(crate) fn hash(&self) -> u64 {
        let kind =
            u64::from(self.level) * 8 + u64::from(self.axis) * 2 + u64::from(self.is_positive);
        let parts = [self.sphere.into(), kind, self.place[0], self.place[1]];
        parts.into_iter().fold(0, |hash: u64, part| {
            let mixed = (hash ^ part).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            mixed ^ (mixed >> 29)
        })
    }

    /// The normal in its middle, and the longest chord from there to another normal.
    pub(crate) fn extent(&self) -> (DVec3, f64) {
        let middle = self.normal(DVec2::splat(0.5));
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        let mut longest: f64 = 0.0;
        for (x, y) in corners {
            longest = longest.max((self.normal(DVec2::new(x, y)) - middle).length());
        }
        (middle, longest)
    }
}

/// A place that squares have in common: a corner, the middle of a side, or the middle.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub(crate) struct Node(
    /// The square of the coarsest level of which it is the first corner; it may lie beside the face.
    Square,
);

impl Node {
    pub(crate) fn normal(&self) -> DVec3 {
        self.0.normal(DVec2::ZERO)
    }

    /// The square of which it is the first corner.
    pub(crate) fn corner(&self) -> Square {
        self.0
    }

    /// A square around it that has a list of the spheres that may hide light from it: if it is small, the one of a square whose
    /// node it is, or one beside that.
    pub(crate) fn home(&self) -> Square {
        let level = listed(self.0.level.saturating_sub(2));
        let last = (1_u64 << level) - 1;
        let at_level = |place: u64| {
            if level > self.0.level {
                place << (level - self.0.level)
            } else {
                place >> (self.0.level - level)
            }
        };
        let [x, y] = self.0.place;
        Square {
            level,
            place: [at_level(x).min(last), at_level(y).min(last)],
            ..self.0
        }
    }
}

/// The level of the widest squares. From wider ones spheres hide little.
pub(crate) const WIDEST: u8 = 2;

/// The level from a level down, or [`WIDEST`], whose squares have lists of spheres. Not each one has: the next finer lists are
/// hardly shorter.
fn listed(level: u8) -> u8 {
    const STEP: u8 = 2;
    WIDEST + level.saturating_sub(WIDEST) / STEP * STEP
}

/// The point of a sphere with a normal.
pub(crate) fn point(sphere: &Sphere, normal: DVec3) -> DVec3 {
    sphere.center() + normal * sphere.radius()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_are_found_where_their_squares_say() {
        for (number, level) in (0..400).zip([0, 1, 2, 5, 20, 36].into_iter().cycle()) {
            let angle = f64::from(number);
            let normal = DVec3::new(libm::cos(angle), libm::sin(angle), libm::sin(2.7 * angle));
            let normal = normal.normalize();
            let square = Square::around(7, normal, level);
            let found = square.normal(square.locate(normal));
            assert!((found - normal).length() < 1e-15, "{square:?}");
            let (middle, chord) = square.extent();
            assert!((middle - normal).length() <= chord * (1.0 + 1e-9));
            let quarter = square.quarter(1, 0);
            assert_eq!(quarter.ancestor(level as u8), square);
            let apart = square.normal(DVec2::new(0.25, 0.75)) - quarter.node(1, 1).normal();
            assert!(apart.length() < 1e-15);
        }
    }

    #[test]
    fn squares_share_their_nodes() {
        let normal = DVec3::new(0.3, -0.2, 0.9).normalize();
        let square = Square::around(1, normal, 4);
        let right = Square {
            place: [square.place[0] + 1, square.place[1]],
            ..square
        };
        for row in 0..3 {
            assert_eq!(square.node(row, 2), right.node(row, 0));
        }
        let parent = right.ancestor(3);
        let quarter = right.place.map(|place| (place % 2) as usize);
        assert_eq!(right.node(0, 0), parent.node(quarter[1], quarter[0]));
        for (row, col) in [(0, 0), (1, 1), (2, 1), (2, 2)] {
            let node = square.node(row, col);
            let place = DVec2::new(col as f64, row as f64) * 0.5;
            assert!((node.normal() - square.normal(place)).length() < 1e-15);
            let home = node.home();
            let (middle, chord) = home.extent();
            assert!((node.normal() - middle).length() <= chord * (1.0 + 1e-9));
        }
    }
}
