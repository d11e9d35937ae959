//! The camera of a scene over time.

use std::ops::RangeInclusive;

use glam::DVec3;
use marbles_core::Pose;

use super::channels::{Channels, Keys};
use super::checks;
use super::curve::Curve;
use super::error::FrameError;
use super::framing::{Framed, Framing, Picture, Turning, axes_of_orbit};
use super::turntable::{Turntable, turned_about};
use crate::file::{Animation, File, Key, Turned};
use crate::text::{Placed, optional, refuse};
use crate::values::{FramesPerSecond, MOST_FRAMES};

/// The camera of a scene over time.
#[derive(Clone, Debug)]
pub(crate) struct CameraMotion {
    channels: Channels,
    zoom: Curve,
    turntable: Option<Turntable>,
    timing: Option<Timing>,
}

/// The frames of an animation.
#[derive(Clone, Debug)]
pub(crate) struct Timing {
    pub(crate) frames: RangeInclusive<i32>,
    /// The file says nothing of the frames.
    is_open: bool,
    pub(crate) frames_per_second: f64,
    /// The time for which the shutter is open, in frames; `None` where frames show a moment.
    pub(crate) shutter: Option<f64>,
    /// The frames of the camera's keys, which increase: at no other time a motion bends or jumps.
    key_frames: Vec<i32>,
}

impl CameraMotion {
    /// The motion that the file with this text describes; `None` where a fault was reported.
    pub(crate) fn new(file: &File, text: &str) -> Option<Self> {
        checks::check(file, text);
        let (mut timing, mut turntable) = (None, None);
        let mut keys: &[Placed<Key>] = &[];
        if let Some(animation) = &file.animation {
            let animation = animation.value.as_ref()?;
            timing = Some(Timing::new(animation)?);
            match animation {
                Animation::Keyframes { keys: all, .. } => keys = all,
                Animation::Turntable { what, .. } => {
                    if what.get()? == Turned::Camera {
                        turntable = Some(Turntable::new(animation)?);
                    }
                }
            }
        }
        let keys = keys.iter().filter_map(|key| key.value.as_ref());
        let keys = Keys(keys.filter(|key| key.light.is_none()).collect());
        Some(Self {
            channels: Channels::new(file.camera.value.as_ref()?, &keys)?,
            zoom: keys.numbers(file.zoom.get()?.0, |key| &key.zoom),
            turntable,
            timing,
        })
    }

    /// Places a camera that frames; returns the factor on the sizes of its lens, `None` where there is nothing to
    /// be framed.
    pub(crate) fn frame(&mut self, framed: Framed<'_>, picture: &Picture) -> Option<f64> {
        let angles = self.channels.angles();
        let turning = match &self.turntable {
            Some(turntable) => turntable.turning(),
            None if angles.iter().all(|curve| curve.is_constant()) => Turning::Still,
            None => Turning::Freely,
        };
        let axes = axes_of_orbit(angles.map(|curve| curve.at(0.0)));
        let axes = match &self.turntable {
            Some(turntable) => turntable.stand(axes),
            None => axes,
        };
        let framing = Framing::of(framed, picture, turning, axes)?;
        self.channels.frame(&framing);
        Some(framing.scale)
    }

    /// Returns whether some key moves the camera, or changes its zoom.
    pub(crate) fn is_keyed(&self) -> bool {
        self.channels.is_keyed() || self.zoom.is_keyed()
    }

    /// The azimuth, elevation and roll, in degrees, that a still orbit or a camera that frames has in the file.
    pub(crate) fn orbit_angles(&self) -> Option<[f64; 3]> {
        let angles = self.channels.angles().map(|curve| curve.at(0.0));
        self.channels.is_orbit().then_some(angles)
    }

    /// The target and the radius of a still orbit.
    pub(crate) fn orbit_center(&self) -> Option<(DVec3, f64)> {
        let is_orbit = self.channels.is_orbit();
        is_orbit.then(|| (self.channels.target(), self.channels.radius()))
    }

    /// Makes the camera a still orbit with these angles in degrees and this zoom. Without a target and a radius it keeps
    /// its own. A turntable still turns it.
    pub(crate) fn orbit(&mut self, around: Option<(DVec3, f64)>, degrees: [f64; 3], zoom: f64) {
        self.channels.orbit(around, degrees);
        self.zoom(zoom);
    }

    /// Makes this the zoom at all times.
    pub(crate) fn zoom(&mut self, zoom: f64) {
        self.zoom = Curve::constant(zoom);
    }

    /// The camera's target, at rest; the origin where it has none.
    pub(crate) fn target(&self) -> DVec3 {
        self.channels.target()
    }

    /// The camera's target at a time in frames, where it has one.
    pub(crate) fn target_at(&self, time: f64) -> Option<DVec3> {
        self.channels.target_at(time)
    }

    /// The frames of the animation, `None` for a still.
    pub(crate) fn timing(&self) -> Option<&Timing> {
        self.timing.as_ref()
    }

    /// Makes so many frames, from 1 on, the animation of a scene that says nothing of its frames.
    pub(crate) fn last(&mut self, frames: i32) {
        let timing = self.timing.get_or_insert(Timing {
            frames: 1..=1,
            is_open: true,
            frames_per_second: FramesPerSecond::default().0,
            shutter: None,
            key_frames: Vec::new(),
        });
        if timing.is_open {
            timing.frames = 1..=frames;
        }
    }

    /// The place of the camera so many frames after frame `frame`, fewer than 1.
    pub(crate) fn pose(&self, frame: i32, later: f64) -> Result<Pose, FrameError> {
        let time = f64::from(frame) + later;
        let turntable = self.turntable.as_ref();
        let turn = turntable.map(|turntable| turntable.turn(turntable.degrees_at(frame, later)));
        let (azimuth, rotation) = turn.unwrap_or((0.0, None));
        let camera = self.channels.at(time, azimuth);
        let mut camera = camera.map_err(|fault| FrameError { frame, fault })?;
        if let Some(rotation) = rotation {
            camera = turned_about(camera, self.target(), rotation);
        }
        Ok(Pose {
            camera,
            zoom: self.zoom.at(time),
        })
    }

    /// The number of the frame by which noise is drawn, the same in every turn of a turntable.
    pub(crate) fn looped(&self, frame: i32) -> i32 {
        let turntable = self.turntable.as_ref();
        turntable.map_or(frame, |turntable| turntable.looped(frame))
    }

    /// Returns whether some key is at this frame.
    pub(super) fn has_key_at(&self, frame: i32) -> bool {
        let has_key = |timing: &Timing| timing.key_frames.binary_search(&frame).is_ok();
        self.timing.as_ref().is_some_and(has_key)
    }
}

impl Timing {
    fn new(animation: &Animation) -> Option<Self> {
        let mut is_open = false;
        let (frames, fps, shutter, keys) = match animation {
            Animation::Keyframes {
                frames,
                fps,
                shutter,
                keys,
            } => {
                let given = optional(frames, |range| Some(range.first..=range.last))?;
                is_open = given.is_none() && keys.is_empty();
                let frames = match given {
                    Some(frames) => frames,
                    None => frames_of(keys)?,
                };
                (frames, fps, shutter, &keys[..])
            }
            Animation::Turntable {
                frames,
                fps,
                shutter,
                ..
            } => (1..=frames.get()?.0, fps, shutter, &[][..]),
        };
        Some(Self {
            frames,
            is_open,
            frames_per_second: fps.get()?.0,
            shutter: optional(shutter, |shutter| Some(shutter.0))?,
            key_frames: keys.iter().filter_map(frame_of_camera).collect(),
        })
    }
}

/// The frames from the first key to the last; frame 1 alone without keys. `None` where they are too many, which is
/// reported.
fn frames_of(keys: &[Placed<Key>]) -> Option<RangeInclusive<i32>> {
    let frames = || keys.iter().filter_map(frame_of);
    let (Some(first), Some(last)) = (frames().min(), frames().max()) else {
        return Some(1..=1);
    };
    if first.abs_diff(last) < MOST_FRAMES.unsigned_abs() {
        return Some(first..=last);
    }
    let mut known = keys
        .iter()
        .filter_map(|key| Some(&key.value.as_ref()?.frame));
    let place = known.find(|frame| frame.get().is_some_and(|frame| frame.0 == last));
    let place = place.map(|frame| frame.place.clone()).unwrap_or_default();
    let message = format!(
        "expected at most {MOST_FRAMES} frames from the first key to the last, found keys from {first} to {last}"
    );
    refuse(place, message)
}

fn frame_of_camera(key: &Placed<Key>) -> Option<i32> {
    let of_light = key.value.as_ref()?.light.is_some();
    frame_of(key).filter(|_| !of_light)
}

fn frame_of(key: &Placed<Key>) -> Option<i32> {
    Some(key.value.as_ref()?.frame.get()?.0)
}
