//! From the file's camera and animation to a camera over time.

use std::ops::RangeInclusive;

use glam::DVec3;
use marbles_core::Sphere;

use crate::curve::{Curve, CurveKey};
use crate::fault::{Fault, report};
use crate::file::{self, Camera, File, Key};
use crate::framing::{Frame, Framing, Turning, axes_of_orbit};
use crate::placed::Placed;
use crate::rig::{PointCurve, Rig};
use crate::suggest::{closest, either};
use crate::token;
use crate::turntable::Turntable;

/// What changes from frame to frame.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    pub(crate) rig: Rig,
    pub(crate) zoom: Curve,
    pub(crate) turntable: Option<Turntable>,
    pub(crate) timing: Option<Timing>,
}

/// The frames of an animation.
#[derive(Clone, Debug)]
pub(crate) struct Timing {
    pub(crate) frames: RangeInclusive<i32>,
    pub(crate) frames_per_second: f64,
    /// How long the shutter is open, in frames; `None` where frames show a moment.
    pub(crate) shutter: Option<f64>,
    /// The frames of the keys, which increase: at no other time a motion bends or jumps.
    pub(crate) key_frames: Vec<i32>,
}

impl Motion {
    /// Places a camera that frames; `false` where there is nothing to be framed.
    pub(crate) fn frame(&mut self, spheres: &[Sphere], frame: &Frame) -> bool {
        let Rig::Frame {
            framing,
            azimuth,
            elevation,
            roll,
        } = &mut self.rig
        else {
            return true;
        };
        let turns = [&*azimuth, elevation, roll];
        let turning = match self.turntable {
            Some(_) => Turning::Around,
            None if turns.iter().all(|curve| curve.is_constant()) => Turning::Still,
            None => Turning::Freely,
        };
        let [azimuth, elevation, roll] = turns.map(|curve| curve.at(0.0));
        let axes = axes_of_orbit(azimuth, elevation, roll);
        let found = Framing::new(spheres, frame, turning, axes);
        if let Some(found) = found {
            *framing = found;
        }
        found.is_some()
    }
}

/// The motion of the file with this text; `None` where a fault was reported.
pub(crate) fn motion(file: &File, text: &str) -> Option<Motion> {
    let camera = file.camera.value.as_ref();
    if let Some(camera) = camera {
        check_gaze(camera);
    }
    let mut keys: &[Placed<Key>] = &[];
    let mut turntable = None;
    let mut timing = None;
    if let Some(animation) = &file.animation {
        let (frames, fps, shutter) = match animation.value.as_ref()? {
            file::Animation::Keyframes {
                frames,
                fps,
                shutter,
                keys: all_keys,
            } => {
                check_keys(all_keys, camera, text);
                keys = all_keys;
                let frames = match frames {
                    Some(frames) => frames.get().map(|range| range.first..=range.last),
                    None => Some(frames_of(keys)),
                };
                (frames, fps.get(), shutter)
            }
            file::Animation::Turntable {
                frames,
                fps,
                shutter,
                turns,
            } => {
                if let Some(camera) = camera {
                    check_orbit(camera, animation, text);
                }
                let last = frames.get().map(|count| count.0);
                if let (Some(frames), Some(turns)) = (last, turns.get()) {
                    turntable = Some(Turntable {
                        frames,
                        turns: turns.0,
                    });
                }
                (last.map(|last| 1..=last), fps.get(), shutter)
            }
        };
        timing = Some(Timing {
            frames: frames?,
            frames_per_second: fps?.0,
            shutter: match shutter {
                Some(shutter) => Some(shutter.get()?.0),
                None => None,
            },
            key_frames: keys.iter().filter_map(frame_of).collect(),
        });
    }
    let keys: Vec<&Key> = keys.iter().filter_map(|key| key.value.as_ref()).collect();
    Some(Motion {
        rig: rig(camera?, &keys)?,
        zoom: curve(file.zoom.get()?.0, &keys, |key| {
            key.zoom.as_ref()?.get().map(|zoom| zoom.0)
        }),
        turntable,
        timing,
    })
}

fn rig(camera: &Camera, keys: &[&Key]) -> Option<Rig> {
    macro_rules! scalar {
        ($channel:ident) => {
            curve($channel.get()?.0, keys, |key| {
                key.$channel.as_ref()?.get().map(|value| value.0)
            })
        };
    }
    macro_rules! point {
        ($channel:ident) => {
            point_curve($channel.get()?.0, keys, |key| {
                key.$channel.as_ref()?.get().map(|value| value.0)
            })
        };
    }
    Some(match camera {
        Camera::Free {
            position,
            pan,
            tilt,
            roll,
        } => Rig::Free {
            position: point!(position),
            pan: scalar!(pan),
            tilt: scalar!(tilt),
            roll: scalar!(roll),
        },
        Camera::LookAt {
            position,
            target,
            roll,
        } => Rig::LookAt {
            position: point!(position),
            target: point!(target),
            roll: scalar!(roll),
        },
        Camera::Orbit {
            target,
            radius,
            azimuth,
            elevation,
            roll,
        } => Rig::Orbit {
            target: point!(target),
            radius: scalar!(radius),
            azimuth: scalar!(azimuth),
            elevation: scalar!(elevation),
            roll: scalar!(roll),
        },
        Camera::Frame {
            azimuth,
            elevation,
            roll,
            ..
        } => Rig::Frame {
            // Until the spheres are known.
            framing: Framing::default(),
            azimuth: scalar!(azimuth),
            elevation: scalar!(elevation),
            roll: scalar!(roll),
        },
    })
}

/// The curve of one channel: `rest` where no key names it.
fn curve(rest: f64, keys: &[&Key], channel: impl Fn(&Key) -> Option<f64>) -> Curve {
    let curve_keys = keys.iter().filter_map(|key| {
        let (frame, ease) = (key.frame.get()?.0, key.ease.get()?);
        Some(CurveKey::new(frame, channel(key)?, ease))
    });
    Curve::new(rest, curve_keys.collect())
}

fn point_curve(rest: DVec3, keys: &[&Key], channel: impl Fn(&Key) -> Option<DVec3>) -> PointCurve {
    PointCurve {
        x: curve(rest.x, keys, |key| Some(channel(key)?.x)),
        y: curve(rest.y, keys, |key| Some(channel(key)?.y)),
        z: curve(rest.z, keys, |key| Some(channel(key)?.z)),
    }
}

/// From the first key to the last; frame 1 alone without keys.
fn frames_of(keys: &[Placed<Key>]) -> RangeInclusive<i32> {
    let (first, last) = (keys.first(), keys.last());
    match (first.and_then(frame_of), last.and_then(frame_of)) {
        (Some(first), Some(last)) => first..=last,
        _ => 1..=1,
    }
}

fn frame_of(key: &Placed<Key>) -> Option<i32> {
    Some(key.value.as_ref()?.frame.get()?.0)
}

/// Refuses a camera that looks nowhere.
fn check_gaze(camera: &Camera) {
    if let Camera::LookAt {
        position, target, ..
    } = camera
        && let (Some(from), Some(to)) = (position.get(), target.get())
        && from.0 == to.0
    {
        report(Fault::new(
            target.place.clone(),
            String::from(
                "expected a target other than the camera's position, found the same point",
            ),
        ));
    }
}

/// Refuses a turntable without an orbit.
fn check_orbit(camera: &Camera, animation: &Placed<file::Animation>, text: &str) {
    if !matches!(camera, Camera::Orbit { .. } | Camera::Frame { .. }) {
        let start = animation.place.start;
        report(Fault::new(
            start..token::token_end(text, start),
            format!(
                "expected an `Orbit` or `Frame` camera for a `Turntable`, found a `{}` camera",
                kind(camera)
            ),
        ));
    }
}

/// Refuses keys out of order, and channels that the camera lacks.
fn check_keys(keys: &[Placed<Key>], camera: Option<&Camera>, text: &str) {
    let mut before = None;
    for placed in keys {
        let Some(key) = &placed.value else { continue };
        if let Some(frame) = key.frame.get() {
            if let Some(before) = before
                && frame.0 <= before
            {
                report(Fault::new(
                    key.frame.place.clone(),
                    format!(
                        "expected a frame after {before}, the frame of the key before, found {}",
                        frame.0
                    ),
                ));
            }
            before = Some(frame.0);
        }
        if let Some(camera) = camera {
            check_channels(placed.place.start, key, camera, text);
        }
    }
}

fn check_channels(key_start: usize, key: &Key, camera: &Camera, text: &str) {
    let kind = kind(camera);
    let channels = channels(camera);
    for (name, value) in named_channels(key) {
        let Some(value) = value else { continue };
        if channels.contains(&name) {
            continue;
        }
        let mut message = format!(
            "expected a channel of the `{kind}` camera ({}), found `{name}`",
            either(channels.iter().copied())
        );
        if let Some(close) = closest(name, channels.iter().copied()) {
            message += &format!(", did you mean `{close}`?");
        }
        let place = token::field_name(text, key_start, value.start);
        report(Fault::new(place, message));
    }
}

/// Every channel with the place of its value, where the key names it.
fn named_channels(key: &Key) -> [(&'static str, Option<std::ops::Range<usize>>); 9] {
    fn place<T>(channel: &Option<Placed<T>>) -> Option<std::ops::Range<usize>> {
        channel.as_ref().map(|value| value.place.clone())
    }
    [
        ("position", place(&key.position)),
        ("target", place(&key.target)),
        ("radius", place(&key.radius)),
        ("pan", place(&key.pan)),
        ("tilt", place(&key.tilt)),
        ("roll", place(&key.roll)),
        ("azimuth", place(&key.azimuth)),
        ("elevation", place(&key.elevation)),
        ("zoom", place(&key.zoom)),
    ]
}

/// The channels that keys of a camera may name.
fn channels(camera: &Camera) -> &'static [&'static str] {
    match camera {
        Camera::Free { .. } => &["position", "pan", "tilt", "roll", "zoom"],
        Camera::LookAt { .. } => &["position", "target", "roll", "zoom"],
        Camera::Orbit { .. } => &["target", "radius", "azimuth", "elevation", "roll", "zoom"],
        Camera::Frame { .. } => &["azimuth", "elevation", "roll", "zoom"],
    }
}

/// The kind of a camera as the file writes it.
pub(crate) fn kind(camera: &Camera) -> &'static str {
    match camera {
        Camera::Free { .. } => "Free",
        Camera::LookAt { .. } => "LookAt",
        Camera::Orbit { .. } => "Orbit",
        Camera::Frame { .. } => "Frame",
    }
}
