//! The channels of a camera: its numbers, each of them a curve.

use glam::{DVec2, DVec3};
use marbles_core::{Angle, Camera, Extrinsics};

use super::curve::{Curve, CurveKey};
use super::error::FrameFault;
use super::framing::Framing;
use crate::file::{self, Key};
use crate::text::Placed;
use crate::values::{Point, Rotation};

/// The numbers of a camera, each of them a curve; those that its kind lacks are 0.
#[derive(Clone, Debug)]
pub(super) struct Channels {
    kind: Kind,
    position: PointCurve,
    target: PointCurve,
    radius: Curve,
    /// The displacement of a camera that frames, left and down, in multiples of the radius.
    aside: Option<DVec2>,
    pan: Curve,
    tilt: Curve,
    azimuth: Curve,
    elevation: Curve,
    roll: Curve,
}

/// The way in which channels give a camera.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Free,
    LookAt,
    Orbit,
    /// No channel has a part in this one.
    Pose(Camera),
}

impl Channels {
    /// The channels of the file's camera; one that frames waits for [`Self::frame`].
    pub(super) fn new(camera: &file::Camera, keys: &Keys<'_>) -> Option<Self> {
        let rest = camera.at_rest()?;
        Some(Self {
            kind: match camera {
                file::Camera::Free { .. } => Kind::Free,
                file::Camera::LookAt { .. } => Kind::LookAt,
                file::Camera::Orbit { .. } | file::Camera::Frame { .. } => Kind::Orbit,
                file::Camera::Pose {
                    rotation,
                    translation,
                    axes,
                } => Kind::Pose(pose(rotation.get()?, translation.get()?, axes.get()?)),
            },
            position: keys.points(rest.position, |key| &key.position),
            target: keys.points(rest.target, |key| &key.target),
            radius: keys.numbers(rest.radius, |key| &key.radius),
            aside: None,
            pan: keys.numbers(rest.pan, |key| &key.pan),
            tilt: keys.numbers(rest.tilt, |key| &key.tilt),
            azimuth: keys.numbers(rest.azimuth, |key| &key.azimuth),
            elevation: keys.numbers(rest.elevation, |key| &key.elevation),
            roll: keys.numbers(rest.roll, |key| &key.roll),
        })
    }

    /// The target where no time has passed; the origin where there is none.
    pub(super) fn target(&self) -> DVec3 {
        self.target.at(0.0)
    }

    /// The radius where no time has passed; 0 where there is none.
    pub(super) fn radius(&self) -> f64 {
        self.radius.at(0.0)
    }

    /// The target at a time in frames, of cameras that have one.
    pub(super) fn target_at(&self, time: f64) -> Option<DVec3> {
        matches!(self.kind, Kind::LookAt | Kind::Orbit).then(|| self.target.at(time))
    }

    /// Azimuth, elevation and roll of an orbit.
    pub(super) fn angles(&self) -> [&Curve; 3] {
        [&self.azimuth, &self.elevation, &self.roll]
    }

    /// Returns whether some key names a channel.
    pub(super) fn is_keyed(&self) -> bool {
        let points = [&self.position, &self.target];
        let numbers = [
            &self.radius,
            &self.pan,
            &self.tilt,
            &self.azimuth,
            &self.elevation,
            &self.roll,
        ];
        let of_points = points.iter().flat_map(|point| &point.0);
        of_points.chain(numbers).any(Curve::is_keyed)
    }

    /// Returns whether this is an orbit, which may frame its spheres.
    pub(super) fn is_orbit(&self) -> bool {
        matches!(self.kind, Kind::Orbit)
    }

    /// Makes this a still orbit with these angles in degrees. Without a target and a radius it keeps its own.
    pub(super) fn orbit(&mut self, around: Option<(DVec3, f64)>, degrees: [f64; 3]) {
        self.kind = Kind::Orbit;
        [self.azimuth, self.elevation, self.roll] = degrees.map(Curve::constant);
        if let Some((target, radius)) = around {
            self.target = PointCurve::constant(target);
            self.radius = Curve::constant(radius);
            self.aside = None;
        }
    }

    /// Places an orbit where it frames its spheres.
    pub(super) fn frame(&mut self, framing: &Framing) {
        self.target = PointCurve::constant(framing.target);
        self.radius = Curve::constant(framing.distance);
        self.aside = Some(framing.aside);
    }

    /// The camera at a time in frames; `turned_degrees` is added to the azimuth of an orbit.
    pub(super) fn at(&self, time: f64, turned_degrees: f64) -> Result<Camera, FrameFault> {
        let angle = |curve: &Curve| Angle::from_degrees(curve.at(time));
        let roll = angle(&self.roll);
        let camera = match self.kind {
            Kind::Free => {
                let (pan, tilt) = (angle(&self.pan), angle(&self.tilt));
                Camera::free(self.position.at(time), pan, tilt, roll)
            }
            Kind::LookAt => {
                let (position, target) = (self.position.at(time), self.target.at(time));
                look_at(position, target, roll).ok_or(FrameFault::LooksNowhere)?
            }
            Kind::Orbit => {
                let azimuth = Angle::from_degrees(self.azimuth.at(time) + turned_degrees);
                let (target, radius) = (self.target.at(time), self.radius.at(time));
                let elevation = angle(&self.elevation);
                let camera = Camera::orbit(target, radius, azimuth, elevation, roll);
                match self.aside {
                    Some(aside) => {
                        let aside = radius * aside;
                        let axes = camera.world_from_camera;
                        camera.moved(-(axes.x_axis * aside.x + axes.y_axis * aside.y))
                    }
                    None => camera,
                }
            }
            Kind::Pose(camera) => camera,
        };
        if camera.position.is_finite() {
            Ok(camera)
        } else {
            Err(FrameFault::TooFar)
        }
    }
}

/// The camera that is given as a pose.
fn pose(rotation: Rotation, translation: Point, axes: file::Axes) -> Camera {
    match axes {
        file::Axes::OpenCV => {
            let (rotation, translation) = (rotation.0, translation.0);
            Extrinsics {
                rotation,
                translation,
            }
            .camera()
        }
    }
}

fn look_at(position: DVec3, target: DVec3, roll: Angle) -> Option<Camera> {
    if (target - position).is_finite() {
        return Camera::look_at(position, target, roll).ok();
    }
    // Half as long, the way to the target is finite.
    let (pan, tilt) = Camera::pan_and_tilt_toward(0.5 * target - 0.5 * position)?;
    Some(Camera::free(position, pan, tilt, roll))
}

/// A point over time, each coordinate on its own.
#[derive(Clone, Debug)]
pub(super) struct PointCurve(pub(super) [Curve; 3]);

impl PointCurve {
    fn constant(point: DVec3) -> Self {
        Self(point.to_array().map(Curve::constant))
    }

    /// Returns whether its coordinates, which are a color's, differ at some time.
    pub(super) fn may_have_color(&self) -> bool {
        let [red, green, blue] = &self.0;
        red != green || red != blue
    }

    pub(super) fn at(&self, time: f64) -> DVec3 {
        DVec3::from_array(self.0.each_ref().map(|curve| curve.at(time)))
    }
}

/// The keys of an animation that were not refused, none for a still.
pub(super) struct Keys<'f>(pub(super) Vec<&'f Key>);

impl Keys<'_> {
    /// The curve of a channel of numbers: `rest` where no key names it.
    pub(super) fn numbers<T: Copy + Into<f64>>(
        &self,
        rest: f64,
        channel: impl Fn(&Key) -> &Option<Placed<T>>,
    ) -> Curve {
        self.curve(rest, |key| Some(channel(key).as_ref()?.get()?.into()))
    }

    /// The curve of a channel of points.
    fn points(&self, rest: DVec3, channel: impl Fn(&Key) -> &Option<Placed<Point>>) -> PointCurve {
        self.vectors(rest, |key| Some(channel(key).as_ref()?.get()?.0))
    }

    /// The curve of a channel of points, or of colors.
    pub(super) fn vectors(
        &self,
        rest: DVec3,
        channel: impl Fn(&Key) -> Option<DVec3>,
    ) -> PointCurve {
        PointCurve([0, 1, 2].map(|axis| self.curve(rest[axis], |key| Some(channel(key)?[axis]))))
    }

    fn curve(&self, rest: f64, value: impl Fn(&Key) -> Option<f64>) -> Curve {
        let keys = self.0.iter().filter_map(|key| {
            let (frame, ease) = (key.frame.get()?.0, key.ease.get()?);
            Some(CurveKey::new(frame, value(key)?, ease))
        });
        Curve::new(rest, keys.collect())
    }
}
