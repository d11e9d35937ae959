//! Rays.

use glam::DVec3;

/// A half line: the points `origin + t · direction` with `t > 0`, in the world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where the ray starts.
    pub origin: DVec3,
    /// Where it goes; need not be unit.
    pub direction: DVec3,
}

impl Ray {
    /// The point at `t` multiples of the direction.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}
