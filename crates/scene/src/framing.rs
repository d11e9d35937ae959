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

/// The box around spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
}

impl Bounds {
    pub(crate) fn middle(&self) -> DVec3 {
        // Halved, no sum overflows.
        0.5 * self.low + 0.5 * self.high
    }

    fn around(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }
}

/// The box around spheres, `None` for none.
pub(crate) fn bounds(spheres: &[Sphere]) -> Option<Bounds> {
    let one = |sphere: &Sphere| {
        let reach = DVec3::splat(sphere.radius());
        Bounds {
            low: sphere.center() - reach,
            high: sphere.center() + reach,
        }
    };
    spheres.par_iter().map(one).reduce_with(Bounds::around)
}

/// The axes of an orbiting camera with these angles in degrees, in the world.
pub(crate) fn axes_of_orbit(azimuth: f64, elevation: f64, roll: f64) -> DMat3 {
    let [azimuth, elevation, roll] = [azimuth, elevation, roll].map(Angle::from_degrees);
    Camera::orbit(DVec3::ZERO, 0.0, azimuth, elevation, roll).world_from_camera
}

/// How a camera that frames moves.
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
pub(crate) struct Frame {
    pub(crate) lens: Lens,
    /// Its height over its width.
    pub(crate) aspect: f64,
    /// How much of it is filled, from 0 to 1.
    pub(crate) fill: f64,
}

/// Where a camera stands that frames.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Framing {
    /// What it looks at.
    pub(crate) target: DVec3,
    /// How far before it, along the axis of view.
    pub(crate) distance: f64,
    /// How far left of it and below, in multiples of the distance.
    pub(crate) aside: DVec2,
}

impl Framing {
    /// The nearest place from which all spheres are inside the frame; `None` without spheres.
    pub(crate) fn new(
        spheres: &[Sphere],
        frame: &Frame,
        turning: Turning,
        world_from_camera: DMat3,
    ) -> Option<Self> {
        /// More than rounding moves an outline.
        const SLACK: f64 = 1.0 + 1e-12;
        let target = bounds(spheres)?.middle();
        let lens = &frame.lens;
        let shift = lens.shift / lens.distance;
        let half_width = 0.5 * lens.width / lens.distance;
        let half = frame.fill * DVec2::new(half_width, half_width * frame.aspect);
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

/// A side of the frame.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// The normal n of the plane through it and the viewpoint, outward, in the world's axes.
    normal: DVec3,
    /// |n|.
    length: f64,
    /// √(n_x² + n_z²).
    across: f64,
    /// Half of the side that the frame has here, over the retina's distance.
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
