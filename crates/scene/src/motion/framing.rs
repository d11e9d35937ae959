//! A camera that has all spheres in its picture.
//!
//! The camera looks at the middle m of the box around all spheres, which it sees in the middle of
//! the picture, from as near as it can. With x, y, z the camera's axes, s the retina's shift and
//! h half its width (or height), all divided by its distance, the viewpoint is m − d (sx, sy, 1).
//! A plane through it and the right side of the picture (or where that would be, were the picture
//! smaller by `fill`) has the normal n = (1, 0, −(sx + fill·h)), and a sphere at p from m with
//! the radius r is inside where n·p + r |n| ≤ d·fill·h. So with the other sides: d is the largest
//! of the left sides over their right ones, and some outline touches a side.
//!
//! On a turntable a sphere at height y passes on a circle of radius ρ around the axis: the largest
//! n·p of it is n_y y + √(n_x² + n_z²) ρ, in the world's axes. For a camera that turns freely it
//! is |n| |p|.

use glam::{DMat3, DVec2, DVec3};
use marbles_core::{Angle, Camera, Lens, Sphere};
use rayon::prelude::*;

use crate::bounds::middle;

/// The axes of an orbiting camera with this azimuth, elevation and roll in degrees, in the world.
pub(crate) fn axes_of_orbit(degrees: [f64; 3]) -> DMat3 {
    let [azimuth, elevation, roll] = degrees.map(Angle::from_degrees);
    Camera::orbit(DVec3::ZERO, 0.0, azimuth, elevation, roll).world_from_camera
}

/// The motion of a camera that frames.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Turning {
    /// Not at all.
    Still,
    /// About the vertical through the middle.
    Around,
    /// In any way.
    Freely,
}

/// The picture that is to be filled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Picture {
    pub(crate) lens: Lens,
    /// Its height over its width.
    pub(crate) aspect: f64,
    /// The part of it that is filled, from 0 to 1.
    pub(crate) fill: f64,
}

/// The place of a camera that frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Framing {
    /// The point that it looks at.
    pub(crate) target: DVec3,
    /// Its distance from the target, along the axis of view.
    pub(crate) distance: f64,
    /// Its displacement left and down, in multiples of the distance.
    pub(crate) aside: DVec2,
}

impl Framing {
    /// The nearest place from which all spheres are inside the picture; `None` without spheres.
    pub(crate) fn new(
        spheres: &[Sphere],
        picture: &Picture,
        turning: Turning,
        world_from_camera: DMat3,
    ) -> Option<Self> {
        /// More than rounding moves an outline.
        const SLACK: f64 = 1.0 + 1e-12;
        let target = middle(spheres)?;
        let lens = &picture.lens;
        let shift = lens.shift / lens.distance;
        let half_width = 0.5 * lens.width / lens.distance;
        let half = picture.fill * DVec2::new(half_width, half_width * picture.aspect);
        let sides = [
            (DVec3::new(1.0, 0.0, -shift.x - half.x), half.x),
            (DVec3::new(-1.0, 0.0, shift.x - half.x), half.x),
            (DVec3::new(0.0, 1.0, -shift.y - half.y), half.y),
            (DVec3::new(0.0, -1.0, shift.y - half.y), half.y),
        ];
        let sides = sides.map(|(normal, half)| Side::new(world_from_camera * normal, half));
        let needed = |sphere: &Sphere| {
            let from_target = sphere.center() - target;
            let distances = sides.map(|side| side.distance(from_target, sphere.radius(), turning));
            distances.into_iter().fold(f64::NEG_INFINITY, f64::max)
        };
        let distance = spheres.par_iter().map(needed).reduce_with(f64::max)?;
        Some(Self {
            target,
            distance: distance * SLACK,
            aside: shift,
        })
    }
}

/// A side of the picture.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// The normal n of the plane through it and the viewpoint, outward, in the world's axes.
    normal: DVec3,
    /// |n|.
    length: f64,
    /// √(n_x² + n_z²).
    across: f64,
    /// Half of the side that the picture has here, over the retina's distance.
    half: f64,
}

impl Side {
    fn new(normal: DVec3, half: f64) -> Self {
        Self {
            normal,
            length: normal.length(),
            across: (normal.x * normal.x + normal.z * normal.z).sqrt(),
            half,
        }
    }

    /// The least distance from which a sphere is on the inner side.
    fn distance(&self, from_target: DVec3, radius: f64, turning: Turning) -> f64 {
        let DVec3 { x, y, z } = from_target;
        let reach = match turning {
            Turning::Still => self.normal.dot(from_target),
            Turning::Around => self.normal.y * y + self.across * (x * x + z * z).sqrt(),
            Turning::Freely => self.length * from_target.length(),
        };
        (reach + radius * self.length) / self.half
    }
}

#[cfg(test)]
mod tests;
