//! Rectangles of the retina, each with coordinates of its own.

use glam::DVec3;

use super::shadow::Caster;
use crate::numeric::polynomial::{Linear, Quadratic};

/// A rectangle of the retina: a pixel or a part of one.
///
/// Its points have the coordinates −½ ≤ x, y ≤ ½. Lines run along x; a transposed cell has lines
/// that are upright in the picture. The ray through (x, y) has in the camera's frame the direction
/// (u, v, 1), where u and v grow with x and y, or, transposed, with y and x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cell {
    /// The ray through the middle.
    pub(crate) middle: DVec3,
    /// What one unit of x adds to the ray, and one of y; positive.
    pub(crate) size: [f64; 2],
    pub(crate) is_transposed: bool,
}

/// A sphere in the camera's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    /// K = |center|² − radius², positive for an eye outside.
    pub(crate) outside: f64,
}

impl Ball {
    /// Whether K is computed from the center and the radius without harm: the sphere does not
    /// come so near to the eye that the two nearly cancel.
    pub(crate) fn is_apart(&self) -> bool {
        self.radius * self.radius <= self.outside
    }

    /// The point of this sphere that lies deepest in the shadow of a caster under the light in the
    /// unit direction `toward`, should any of it lie there.
    pub(crate) fn under(&self, caster: &Caster, toward: DVec3) -> DVec3 {
        let to_caster = caster.center - self.center;
        let aside = to_caster - toward * to_caster.dot(toward);
        let aside_sq = aside.length_squared();
        let rest = self.radius * self.radius - aside_sq;
        if rest > 0.0 {
            self.center + aside + toward * rest.sqrt()
        } else {
            self.center + aside * (self.radius / aside_sq.sqrt())
        }
    }
}

impl Cell {
    /// Which component of a ray depends on x, and which on y.
    pub(crate) fn axes(&self) -> [usize; 2] {
        if self.is_transposed { [1, 0] } else { [0, 1] }
    }

    /// The same rectangle with lines in the other direction.
    pub(crate) fn transposed(&self) -> Self {
        Self {
            size: [self.size[1], self.size[0]],
            is_transposed: !self.is_transposed,
            ..*self
        }
    }

    /// The part between two values of x and two of y.
    pub(crate) fn part(&self, x: [f64; 2], y: [f64; 2]) -> Self {
        let [along, across] = self.axes();
        let mut middle = self.middle;
        middle[along] += 0.5 * (x[0] + x[1]) * self.size[0];
        middle[across] += 0.5 * (y[0] + y[1]) * self.size[1];
        Self {
            middle,
            size: [self.size[0] * (x[1] - x[0]), self.size[1] * (y[1] - y[0])],
            ..*self
        }
    }

    /// The coordinates at which a point of the camera's frame is seen.
    pub(crate) fn place(&self, point: DVec3) -> (f64, f64) {
        let [along, across] = self.axes();
        (
            (point[along] / point.z - self.middle[along]) / self.size[0],
            (point[across] / point.z - self.middle[across]) / self.size[1],
        )
    }

    /// d · vector.
    pub(crate) fn dot(&self, vector: DVec3) -> Linear {
        let [along, across] = self.axes();
        Linear {
            one: self.middle.dot(vector),
            x: self.size[0] * vector[along],
            y: self.size[1] * vector[across],
        }
    }

    /// d × vector.
    pub(crate) fn cross(&self, vector: DVec3) -> [Linear; 3] {
        let [along, across] = self.axes();
        let one = self.middle.cross(vector);
        let x = DVec3::AXES[along].cross(vector) * self.size[0];
        let y = DVec3::AXES[across].cross(vector) * self.size[1];
        [0, 1, 2].map(|axis| Linear {
            one: one[axis],
            x: x[axis],
            y: y[axis],
        })
    }

    /// d · d.
    pub(crate) fn ray_sq(&self) -> Quadratic {
        let [along, across] = self.axes();
        Quadratic {
            one: self.middle.length_squared(),
            x: 2.0 * self.size[0] * self.middle[along],
            y: 2.0 * self.size[1] * self.middle[across],
            xx: self.size[0] * self.size[0],
            xy: 0.0,
            yy: self.size[1] * self.size[1],
        }
    }
}

/// The scalar product of two vectors of polynomials.
pub(super) fn dot(a: &[Linear; 3], b: &[Linear; 3]) -> Quadratic {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests;
