//! A camera that has all spheres in its picture.
//!
//! The camera looks at the middle m of the box around all spheres, which it sees in the middle of
//! the picture, from as near as it can. With x, y, z the camera's axes, s the retina's shift and
//! h half its width (or height), all divided by its distance, the viewpoint is m − d (sx, sy, 1).
//! A plane through it and the right side of the picture (or where that would be, were the picture
//! smaller by `fill`) has the normal n = (1, 0, −(sx + fill·h)), and a sphere at p from m with
//! the radius r is inside where n·p + r |n| ≤ d·fill·h. So with the other sides: d is the largest
//! of the left sides over their right ones, and some contour touches a side.
//!
//! On a turntable a sphere at height y passes on a circle of radius ρ around the axis: the largest
//! n·p of it is n_y y + √(n_x² + n_z²) ρ, if the axis is the world's y. If it swings by less than a turn,
//! it may not come to the angle at which it has this. For a camera that turns freely it is |n| |p|.
//!
//! What a parallel lens sees is as large from anywhere. There the lens is scaled: n is (1, 0, 0), and the
//! largest n·p + r over fill·h is the scale. The camera stands twice as far back as puts all spheres
//! before the plane through it.

use std::f64::consts::PI;

use glam::{DMat3, DVec2, DVec3};
use marbles_core::{Angle, Camera, Lens, Sphere, parallel};

use crate::bounds::Bounds;

/// The axes of an orbiting camera with this azimuth, elevation and roll in degrees, in the world.
pub(crate) fn axes_of_orbit(degrees: [f64; 3]) -> DMat3 {
    let [azimuth, elevation, roll] = degrees.map(Angle::from_degrees);
    Camera::orbit(DVec3::ZERO, 0.0, azimuth, elevation, roll).world_from_camera
}

/// The motion of a camera that frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Turning {
    /// Not at all.
    Still,
    /// About an axis through the middle, of which this is the unit vector, by an angle of at most so many radians to
    /// both sides.
    Around { axis: DVec3, swing: f64 },
    /// In any way.
    Freely,
}

impl Turning {
    /// A whole turn about the vertical.
    pub(crate) const UPRIGHT: Self = Self::Around {
        axis: DVec3::Y,
        swing: PI,
    };
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
    /// The factor on the sizes of the lens.
    pub(crate) scale: f64,
}

/// The spheres that are framed, all at once or some at a time.
pub(crate) struct Framed<'a> {
    /// The box around them.
    pub(crate) bounds: Bounds,
    /// The largest of what is found of some spheres at a time.
    pub(crate) largest: Largest<'a>,
}

/// Finds the largest of what the function finds of some spheres at a time.
pub(crate) type Largest<'a> = &'a mut dyn FnMut(&dyn Fn(&[Sphere]) -> Option<f64>) -> Option<f64>;

impl Framing {
    /// The nearest place from which these spheres are inside the picture; `None` without spheres.
    pub(crate) fn new(
        spheres: &[Sphere],
        picture: &Picture,
        turning: Turning,
        world_from_camera: DMat3,
    ) -> Option<Self> {
        let framed = Framed {
            bounds: Bounds::of(spheres),
            largest: &mut |find| find(spheres),
        };
        Self::of(framed, picture, turning, world_from_camera)
    }

    /// The nearest place from which all spheres are inside the picture; `None` without spheres.
    pub(crate) fn of(
        framed: Framed<'_>,
        picture: &Picture,
        turning: Turning,
        world_from_camera: DMat3,
    ) -> Option<Self> {
        /// More than rounding moves a contour.
        const SLACK: f64 = 1.0 + 1e-12;
        let target = framed.bounds.middle()?;
        let lens = &picture.lens;
        if lens.is_parallel() {
            return Self::parallel(framed.largest, target, picture, turning, world_from_camera);
        }
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
        let distance = (framed.largest)(&|spheres| needed(spheres, target, &sides, turning))?;
        Some(Self {
            target,
            distance: distance * SLACK,
            aside: shift,
            scale: 1.0,
        })
    }

    /// The same for a parallel lens, which is scaled.
    fn parallel(
        largest: Largest<'_>,
        target: DVec3,
        picture: &Picture,
        turning: Turning,
        world_from_camera: DMat3,
    ) -> Option<Self> {
        /// More than rounding moves a contour.
        const SLACK: f64 = 1.0 + 1e-12;
        let lens = &picture.lens;
        let half_width = 0.5 * picture.fill * lens.width;
        let sides = [
            (DVec3::X, half_width),
            (-DVec3::X, half_width),
            (DVec3::Y, half_width * picture.aspect),
            (-DVec3::Y, half_width * picture.aspect),
        ];
        let side = |(normal, half)| Side::new(world_from_camera * normal, half);
        let (sides, behind) = (sides.map(side), [side((-DVec3::Z, 0.5))]);
        let scale = largest(&|spheres| needed(spheres, target, &sides, turning))? * SLACK;
        let distance = largest(&|spheres| needed(spheres, target, &behind, turning))?;
        Some(Self {
            target,
            distance,
            aside: lens.shift * (scale / distance),
            scale,
        })
    }
}

/// The largest distance, or scale, that a sphere needs to be on the inner side of all sides.
fn needed(spheres: &[Sphere], target: DVec3, sides: &[Side], turning: Turning) -> Option<f64> {
    let of_sphere = |sphere: &Sphere| {
        let from_target = sphere.center() - target;
        let distance = |side: &Side| side.distance(from_target, sphere.radius(), turning);
        sides.iter().map(distance).fold(f64::NEG_INFINITY, f64::max)
    };
    let of_pieces = parallel::map_pieces(spheres, |piece| {
        let of_spheres = piece.iter().map(of_sphere);
        of_spheres.reduce(f64::max)
    });
    of_pieces.into_iter().flatten().reduce(f64::max)
}

/// A side of the picture.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// The normal n of the plane through it and the viewpoint, outward, in the world's axes.
    normal: DVec3,
    /// |n|.
    length: f64,
    /// Half of the side that the picture has here, over the retina's distance.
    half: f64,
}

impl Side {
    fn new(normal: DVec3, half: f64) -> Self {
        Self {
            normal,
            length: normal.length(),
            half,
        }
    }

    /// The least distance from which a sphere is on the inner side.
    fn distance(&self, from_target: DVec3, radius: f64, turning: Turning) -> f64 {
        let reach = match turning {
            Turning::Still => self.normal.dot(from_target),
            Turning::Around { axis, swing } => {
                largest_turned(self.normal, from_target, axis, swing)
            }
            Turning::Freely => self.length * from_target.length(),
        };
        (reach + radius * self.length) / self.half
    }
}

/// The largest product n·p of a normal and a point that turns about an axis by at most the angle `swing` to both sides.
fn largest_turned(normal: DVec3, point: DVec3, axis: DVec3, swing: f64) -> f64 {
    let (slope, height) = (normal.dot(axis), point.dot(axis));
    let (out, across) = (normal - slope * axis, point - height * axis);
    let most = out.length() * across.length();
    if swing >= PI {
        return slope * height + most;
    }
    let angle = libm::atan2(out.cross(across).length(), out.dot(across));
    slope * height + most * libm::cos((angle - swing).max(0.0))
}

#[cfg(test)]
mod tests;
