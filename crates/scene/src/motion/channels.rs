//! The channels of a camera: its numbers, each of them a curve.

use glam::{DVec2, DVec3};
use marbles_core::{Angle, Camera};

use super::curve::{Curve, CurveKey};
use super::error::FrameFault;
use super::framing::Framing;
use crate::file::{self, Key};
use crate::text::Placed;
use crate::values::Point;

/// The numbers of a camera, each of them a curve.
#[derive(Clone, Debug)]
pub(super) enum Channels {
    Free {
        position: PointCurve,
        pan: Curve,
        tilt: Curve,
        roll: Curve,
    },
    LookAt {
        position: PointCurve,
        target: PointCurve,
        roll: Curve,
    },
    Orbit {
        target: PointCurve,
        radius: Curve,
        /// The displacement of a camera that frames, left and down, in multiples of the radius.
        aside: Option<DVec2>,
        azimuth: Curve,
        elevation: Curve,
        roll: Curve,
    },
}

impl Channels {
    /// The channels of the file's camera through its keys; one that frames waits for [`Self::frame`].
    pub(super) fn new(camera: &file::Camera, keys: &Keys<'_>) -> Option<Self> {
        Some(match camera {
            file::Camera::Free {
                position,
                pan,
                tilt,
                roll,
            } => Self::Free {
                position: keys.points(position, |key| &key.position)?,
                pan: keys.numbers(pan, |key| &key.pan)?,
                tilt: keys.numbers(tilt, |key| &key.tilt)?,
                roll: keys.numbers(roll, |key| &key.roll)?,
            },
            file::Camera::LookAt {
                position,
                target,
                roll,
            } => Self::LookAt {
                position: keys.points(position, |key| &key.position)?,
                target: keys.points(target, |key| &key.target)?,
                roll: keys.numbers(roll, |key| &key.roll)?,
            },
            file::Camera::Orbit {
                target,
                radius,
                azimuth,
                elevation,
                roll,
            } => Self::Orbit {
                target: keys.points(target, |key| &key.target)?,
                radius: keys.numbers(radius, |key| &key.radius)?,
                aside: None,
                azimuth: keys.numbers(azimuth, |key| &key.azimuth)?,
                elevation: keys.numbers(elevation, |key| &key.elevation)?,
                roll: keys.numbers(roll, |key| &key.roll)?,
            },
            file::Camera::Frame {
                azimuth,
                elevation,
                roll,
                ..
            } => Self::Orbit {
                target: PointCurve::constant(DVec3::ZERO),
                radius: Curve::constant(0.0),
                aside: None,
                azimuth: keys.numbers(azimuth, |key| &key.azimuth)?,
                elevation: keys.numbers(elevation, |key| &key.elevation)?,
                roll: keys.numbers(roll, |key| &key.roll)?,
            },
        })
    }

    /// Azimuth, elevation and roll of an orbit.
    pub(super) fn angles(&self) -> Option<[&Curve; 3]> {
        match self {
            Self::Orbit {
                azimuth,
                elevation,
                roll,
                ..
            } => Some([azimuth, elevation, roll]),
            _ => None,
        }
    }

    /// Places an orbit where it frames its spheres.
    pub(super) fn frame(&mut self, framing: &Framing) {
        if let Self::Orbit {
            target,
            radius,
            aside,
            ..
        } = self
        {
            *target = PointCurve::constant(framing.target);
            *radius = Curve::constant(framing.distance);
            *aside = Some(framing.aside);
        }
    }

    /// The camera at a time in frames; `turned_degrees` is added to the azimuth of an orbit.
    pub(super) fn at(&self, time: f64, turned_degrees: f64) -> Result<Camera, FrameFault> {
        let angle = |curve: &Curve| Angle::from_degrees(curve.at(time));
        let camera = match self {
            Self::Free {
                position,
                pan,
                tilt,
                roll,
            } => Camera::free(position.at(time), angle(pan), angle(tilt), angle(roll)),
            Self::LookAt {
                position,
                target,
                roll,
            } => {
                let (position, target) = (position.at(time), target.at(time));
                look_at(position, target, angle(roll)).ok_or(FrameFault::LooksNowhere)?
            }
            Self::Orbit {
                target,
                radius,
                aside,
                azimuth,
                elevation,
                roll,
            } => {
                let azimuth = Angle::from_degrees(azimuth.at(time) + turned_degrees);
                let (elevation, roll) = (angle(elevation), angle(roll));
                let radius = radius.at(time);
                let mut camera = Camera::orbit(target.at(time), radius, azimuth, elevation, roll);
                if let Some(aside) = aside {
                    let aside = radius * *aside;
                    let axes = camera.world_from_camera;
                    camera.position -= axes.x_axis * aside.x + axes.y_axis * aside.y;
                }
                camera
            }
        };
        if camera.position.is_finite() {
            Ok(camera)
        } else {
            Err(FrameFault::TooFar)
        }
    }
}

fn look_at(position: DVec3, target: DVec3, roll: Angle) -> Option<Camera> {
    if (target - position).is_finite() {
        return Camera::look_at(position, target, roll);
    }
    // Half as long, the way to the target is finite.
    let (pan, tilt) = Camera::pan_and_tilt_toward(0.5 * target - 0.5 * position)?;
    Some(Camera::free(position, pan, tilt, roll))
}

/// A point over time, each coordinate on its own.
#[derive(Clone, Debug)]
pub(super) struct PointCurve([Curve; 3]);

impl PointCurve {
    fn constant(point: DVec3) -> Self {
        Self(point.to_array().map(Curve::constant))
    }

    fn at(&self, time: f64) -> DVec3 {
        DVec3::from_array(self.0.each_ref().map(|curve| curve.at(time)))
    }
}

/// The keys of an animation that were not refused, none for a still.
pub(super) struct Keys<'f>(pub(super) Vec<&'f Key>);

impl Keys<'_> {
    /// The curve of a channel of numbers: `rest` where no key names it.
    pub(super) fn numbers<T: Copy + Into<f64>>(
        &self,
        rest: &Placed<T>,
        channel: impl Fn(&Key) -> &Option<Placed<T>>,
    ) -> Option<Curve> {
        let value = |key: &Key| Some(channel(key).as_ref()?.get()?.into());
        Some(self.curve(rest.get()?.into(), value))
    }

    /// The curve of a channel of points.
    fn points(
        &self,
        rest: &Placed<Point>,
        channel: impl Fn(&Key) -> &Option<Placed<Point>>,
    ) -> Option<PointCurve> {
        let rest = rest.get()?.0;
        let axis = |axis: usize| {
            let value = |key: &Key| Some(channel(key).as_ref()?.get()?.0[axis]);
            self.curve(rest[axis], value)
        };
        Some(PointCurve([0, 1, 2].map(axis)))
    }

    fn curve(&self, rest: f64, value: impl Fn(&Key) -> Option<f64>) -> Curve {
        let keys = self.0.iter().filter_map(|key| {
            let (frame, ease) = (key.frame.get()?.0, key.ease.get()?);
            Some(CurveKey::new(frame, value(key)?, ease))
        });
        Curve::new(rest, keys.collect())
    }
}
