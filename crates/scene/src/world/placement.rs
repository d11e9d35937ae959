//! The place of a cloud in the world.

use glam::{DMat3, DVec3};
use marbles_core::{Angle, Sphere, parallel};

use crate::bounds::Bounds;
use crate::file::Up;

/// The steps by which a cloud is placed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    pub(super) is_centered: bool,
    /// The middle of all steps of a cloud that changes over time.
    pub(super) middle: Option<DVec3>,
    /// The axes of the table are right-handed; `None` for those that its format has.
    pub(super) is_right_handed: Option<bool>,
    pub(super) up: Up,
    pub(super) scale: f64,
    pub(super) turn: Option<DMat3>,
    pub(super) position: DVec3,
}

impl Placement {
    /// True where the axes are right-handed of a table whose format has such ones by default, or not.
    pub(super) fn is_right_handed(&self, by_default: bool) -> bool {
        self.is_right_handed.unwrap_or(by_default)
    }

    /// True where z points up, and nothing but the format says that the axes are left-handed.
    pub(super) fn may_be_mirrored(&self, by_default: bool) -> bool {
        self.up == Up::Z && self.is_right_handed.is_none() && !by_default
    }

    /// Puts spheres, whose axes are right-handed or not, to their place; returns whether they are still finite and have
    /// radii.
    pub(super) fn place(&self, spheres: &mut [Sphere], is_right_handed: bool) -> bool {
        let middle = match self.is_centered {
            true => self
                .middle
                .or_else(|| Bounds::of(spheres).middle())
                .unwrap_or(DVec3::ZERO),
            false => DVec3::ZERO,
        };
        let is_as_it_is = middle == DVec3::ZERO
            && !is_right_handed
            && self.up == Up::Y
            && self.scale == 1.0
            && self.turn.is_none()
            && self.position == DVec3::ZERO;
        if is_as_it_is {
            return true;
        }
        let mut axes = DVec3::splat(self.scale);
        if is_right_handed {
            axes.z = -axes.z;
        }
        parallel::change_all(spheres, |_, sphere| {
            let mut center = (sphere.center() - middle) * axes;
            // A quarter turn by which the axis becomes y: no picture is mirrored.
            center = match (self.up, is_right_handed) {
                (Up::Y, _) => center,
                (Up::X, _) => DVec3::new(-center.y, center.x, center.z),
                (Up::Z, false) => DVec3::new(center.x, center.z, -center.y),
                (Up::Z, true) => DVec3::new(center.x, -center.z, center.y),
            };
            if let Some(turn) = self.turn {
                center = turn * center;
            }
            let placed = Sphere::new(center + self.position, sphere.radius() * self.scale);
            placed.map(|placed| *sphere = placed).is_ok()
        })
    }
}

/// The turn about x by the first angle, then about y, then about z; `None` for no turn.
///
/// Positive angles lead from y to z, from z to x, and from x to y.
pub(super) fn turn(degrees: DVec3) -> Option<DMat3> {
    if degrees == DVec3::ZERO {
        return None;
    }
    let [x, y, z] = degrees.to_array().map(Angle::from_degrees);
    let about_x = DMat3::from_cols(
        DVec3::X,
        DVec3::new(0.0, x.cos, x.sin),
        DVec3::new(0.0, -x.sin, x.cos),
    );
    let about_y = DMat3::from_cols(
        DVec3::new(y.cos, 0.0, -y.sin),
        DVec3::Y,
        DVec3::new(y.sin, 0.0, y.cos),
    );
    let about_z = DMat3::from_cols(
        DVec3::new(z.cos, z.sin, 0.0),
        DVec3::new(-z.sin, z.cos, 0.0),
        DVec3::Z,
    );
    Some(about_z * about_y * about_x)
}

#[cfg(test)]
mod tests;
