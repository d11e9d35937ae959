//! Rectangles of the retina, each with coordinates of its own.

use glam::DVec3;

use crate::model::camera::Projection;
use crate::numeric::pair::three;
use crate::numeric::polynomial::{Linear, Quadratic};

/// A rectangle of the retina: a pixel or a part of one.
///
/// Its points have the coordinates −½ ≤ x, y ≤ ½. The ray through (x, y) has in the camera's frame the
/// direction (u, v, 1), where u and v grow with x and y. A parallel one has the direction (0, 0, 1), and
/// begins at (u, v, 0): a cell keeps it as (u, v, 1), too, whose third component then means nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cell {
    /// The ray through the middle.
    pub(crate) middle: DVec3,
    /// The changes of the ray per unit of x, and per unit of y; positive.
    pub(crate) size: [f64; 2],
    pub(crate) projection: Projection,
}

/// A sphere in the camera's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    /// K for an eye. For parallel rays the center's distance from the plane in which they begin, where the sphere lies
    /// before it; not positive where the plane cuts it.
    ///
    /// In both cases, if two spheres are apart, the nearer one has the smaller value.
    pub(crate) outside: f64,
    /// K = |center|² − radius², positive for an eye outside: rounded once, from the world's numbers.
    pub(crate) power: f64,
    pub(crate) projection: Projection,
}

impl Ball {
    /// Returns whether the rays that see it are parallel.
    #[inline(always)]
    pub(crate) fn is_parallel(&self) -> bool {
        self.projection == Projection::Parallel
    }

    /// The distance from the eye, or from the plane of parallel rays, at which it begins.
    pub(crate) fn begin(&self) -> f64 {
        if self.is_parallel() {
            self.center.z - self.radius
        } else {
            self.power / (self.center.length() + self.radius)
        }
    }

    /// Returns whether parallel rays begin inside of it, some of them.
    pub(crate) fn is_cut(&self) -> bool {
        self.is_parallel() && self.outside <= 0.0
    }

    /// Whether K is computed from the center and the radius without harm: the sphere does not
    /// come so near to the eye that the two nearly cancel.
    #[inline(always)]
    pub(crate) fn is_apart(&self) -> bool {
        self.radius * self.radius <= self.power
    }

    /// Whether directions toward the eye turn across a cell by more than nothing beside the normals that are seen in it. Of
    /// a sphere that is many radii away normals turn that many times as far, at least.
    #[inline(always)]
    pub(crate) fn is_near_eye(&self) -> bool {
        /// The square of the distance in radii from which on they count as still. Chosen by what it costs, not derived: a
        /// highlight that is narrow beside a tenth of what normals turn could fool it.
        const FAR_SQ: f64 = 100.0;
        !self.is_parallel() && self.power < FAR_SQ * self.radius * self.radius
    }

    /// K of a point: the square of its distance from the center less that of the radius.
    #[inline(always)]
    pub(crate) fn power_of(&self, point: DVec3) -> f64 {
        if self.is_apart() {
            let distance = (point - self.center).length();
            (distance - self.radius) * (distance + self.radius)
        } else {
            point.dot(point - 2.0 * self.center) + self.power
        }
    }

    /// The length that rounding moves the contour by which parallel rays see, in units of the roundoff.
    pub(crate) fn contour_scale(&self, cell: &Cell) -> f64 {
        let aside = cell.extent();
        if self.is_apart() {
            return self.center.length() + self.radius;
        }
        // That of the discriminant, over its slope.
        let terms = self.center.z * self.center.z
            + self.power.abs()
            + aside * (aside + 2.0 * self.center.length());
        0.5 * terms / self.radius
    }
}

impl Cell {
    /// The part between two values of x and two of y.
    pub(crate) fn part(&self, x: [f64; 2], y: [f64; 2]) -> Self {
        let mut middle = self.middle;
        middle[0] += 0.5 * (x[0] + x[1]) * self.size[0];
        middle[1] += 0.5 * (y[0] + y[1]) * self.size[1];
        Self {
            middle,
            size: [self.size[0] * (x[1] - x[0]), self.size[1] * (y[1] - y[0])],
            projection: self.projection,
        }
    }

    #[inline(always)]
    pub(crate) fn is_parallel(&self) -> bool {
        self.projection == Projection::Parallel
    }

    /// The length of the ray through the middle; 1 for parallel ones.
    pub(crate) fn ray_length(&self) -> f64 {
        match self.projection {
            Projection::Central => self.middle.length(),
            Projection::Parallel => 1.0,
        }
    }

    /// The length that positions at distance 1 are rounded by: that of the ray through the middle, or, of
    /// parallel ones, how far from the axis they are.
    pub(crate) fn extent(&self) -> f64 {
        match self.projection {
            Projection::Central => self.middle.length(),
            Projection::Parallel => self.middle.truncate().length(),
        }
    }

    /// A bound of the angle by which rays turn across it along an axis; none for parallel ones.
    pub(crate) fn turn(&self) -> [f64; 2] {
        match self.projection {
            Projection::Central => self.size,
            Projection::Parallel => [0.0; 2],
        }
    }

    /// The point of the ray through the middle at this distance, in multiples of the ray.
    pub(crate) fn at(&self, t: f64) -> DVec3 {
        match self.projection {
            Projection::Central => self.middle * t,
            Projection::Parallel => self.middle.with_z(t),
        }
    }

    /// d · center: the place of the middle of a ball's chord along rays, times d · d.
    pub(crate) fn along(&self, center: DVec3) -> Linear {
        match self.projection {
            Projection::Central => self.dot(center),
            Projection::Parallel => Linear {
                one: center.z,
                x: 0.0,
                y: 0.0,
            },
        }
    }

    /// The ways from a point to parallel rays, across these: along the axes x and y of the retina.
    pub(super) fn aside(&self, point: DVec3) -> [Linear; 2] {
        [
            Linear {
                one: self.middle[0] - point[0],
                x: self.size[0],
                y: 0.0,
            },
            Linear {
                one: self.middle[1] - point[1],
                x: 0.0,
                y: self.size[1],
            },
        ]
    }

    /// d · vector.
    pub(crate) fn dot(&self, vector: DVec3) -> Linear {
        Linear {
            one: self.middle.dot(vector),
            x: self.size[0] * vector[0],
            y: self.size[1] * vector[1],
        }
    }

    /// d × vector.
    pub(crate) fn cross(&self, vector: DVec3) -> [Linear; 3] {
        let one = self.middle.cross(vector);
        let x = DVec3::AXES[0].cross(vector) * self.size[0];
        let y = DVec3::AXES[1].cross(vector) * self.size[1];
        three([0, 1, 2], |axis| Linear {
            one: one[axis],
            x: x[axis],
            y: y[axis],
        })
    }

    /// d · d.
    pub(crate) fn ray_sq(&self) -> Quadratic {
        Quadratic {
            one: self.middle.length_squared(),
            x: 2.0 * self.size[0] * self.middle[0],
            y: 2.0 * self.size[1] * self.middle[1],
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
