//! The camera over time.

use glam::DVec3;
use marbles_core::{Angle, Camera};

use crate::curve::Curve;
use crate::error::FrameFault;
use crate::framing::Framing;

/// A camera whose every number is a curve.
#[derive(Clone, Debug)]
pub(crate) enum Rig {
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
        azimuth: Curve,
        elevation: Curve,
        roll: Curve,
    },
    Frame {
        framing: Framing,
        azimuth: Curve,
        elevation: Curve,
        roll: Curve,
    },
}

/// A point over time, each coordinate on its own.
#[derive(Clone, Debug)]
pub(crate) struct PointCurve {
    pub(crate) x: Curve,
    pub(crate) y: Curve,
    pub(crate) z: Curve,
}

impl PointCurve {
    fn at(&self, time: f64) -> DVec3 {
        DVec3::new(self.x.at(time), self.y.at(time), self.z.at(time))
    }
}

impl Rig {
    /// The camera at a time in frames; `turned_degrees` is added to the azimuth of an orbit.
    pub(crate) fn camera(&self, time: f64, turned_degrees: f64) -> Result<Camera, FrameFault> {
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
                azimuth,
                elevation,
                roll,
            } => Camera::orbit(
                target.at(time),
                radius.at(time),
                Angle::from_degrees(azimuth.at(time) + turned_degrees),
                angle(elevation),
                angle(roll),
            ),
            Self::Frame {
                framing,
                azimuth,
                elevation,
                roll,
            } => {
                let mut camera = Camera::orbit(
                    framing.target,
                    framing.distance,
                    Angle::from_degrees(azimuth.at(time) + turned_degrees),
                    angle(elevation),
                    angle(roll),
                );
                let aside = framing.distance * framing.aside;
                let axes = camera.world_from_camera;
                camera.position -= axes.x_axis * aside.x + axes.y_axis * aside.y;
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
