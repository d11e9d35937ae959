//! The camera of a scene file, and its animation.

use std::ops::Range;

use glam::DVec3;
use serde::Deserialize;

use super::Up;
use super::sky::Sky;
use crate::text::{Placed, present};
use crate::values::{
    Axis, Color, Degrees, Diameter, Fill, Frame, FrameCount, FrameRange, FramesPerSecond,
    LightName, Mu, Point, Radius, Rotation, Shutter, Swing, Turns, Zoom,
};

/// The camera; a `Free` one stands at the origin and looks along z by default.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Camera {
    Free {
        #[serde(default)]
        position: Placed<Point>,
        #[serde(default)]
        pan: Placed<Degrees>,
        #[serde(default)]
        tilt: Placed<Degrees>,
        #[serde(default)]
        roll: Placed<Degrees>,
    },
    LookAt {
        position: Placed<Point>,
        target: Placed<Point>,
        #[serde(default)]
        roll: Placed<Degrees>,
    },
    Orbit {
        target: Placed<Point>,
        radius: Placed<Radius>,
        #[serde(default)]
        azimuth: Placed<Degrees>,
        #[serde(default)]
        elevation: Placed<Degrees>,
        #[serde(default)]
        roll: Placed<Degrees>,
    },
    Frame {
        #[serde(default)]
        azimuth: Placed<Degrees>,
        #[serde(default)]
        elevation: Placed<Degrees>,
        #[serde(default)]
        roll: Placed<Degrees>,
        #[serde(default)]
        fill: Placed<Fill>,
        #[serde(default)]
        frame_over: Placed<FrameOver>,
    },
    Pose {
        rotation: Placed<Rotation>,
        translation: Placed<Point>,
        axes: Placed<Axes>,
    },
}

/// The spheres that a framing camera has in its picture.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq)]
pub(crate) enum FrameOver {
    /// Those of all steps of clouds that change over time.
    #[default]
    Series,
    /// Those of the frame's step.
    Step,
}

/// The axes in which a pose is given.
#[derive(Clone, Copy, Debug, Deserialize)]
pub(crate) enum Axes {
    /// x right, y down, z forward, in the right-handed world with z negated.
    OpenCV,
}

/// An animation of 24 frames per second by default; keyframes last from the first key to the last,
/// a turntable 120 frames and one turn.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Animation {
    Keyframes {
        #[serde(default, deserialize_with = "present")]
        frames: Option<Placed<FrameRange>>,
        #[serde(default)]
        fps: Placed<FramesPerSecond>,
        #[serde(default, deserialize_with = "present")]
        shutter: Option<Placed<Shutter>>,
        #[serde(default)]
        keys: Vec<Placed<Key>>,
    },
    Turntable {
        #[serde(default)]
        frames: Placed<FrameCount>,
        #[serde(default)]
        fps: Placed<FramesPerSecond>,
        #[serde(default, deserialize_with = "present")]
        shutter: Option<Placed<Shutter>>,
        #[serde(default)]
        turns: Placed<Turns>,
        #[serde(default)]
        what: Placed<Turned>,
        #[serde(default, deserialize_with = "present")]
        axis: Option<Placed<Axis>>,
        #[serde(default, deserialize_with = "present")]
        up: Option<Placed<Up>>,
        #[serde(default, deserialize_with = "present")]
        swing: Option<Placed<Swing>>,
    },
}

/// The thing that a turntable turns.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq)]
pub(crate) enum Turned {
    #[default]
    Camera,
    /// All lights that are not attached to the camera.
    Lights,
}

/// The values of some channels at a frame: of the camera and the sky, or of a light.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Key {
    pub(crate) frame: Placed<Frame>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) light: Option<Placed<LightName>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) position: Option<Placed<Point>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) target: Option<Placed<Point>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) radius: Option<Placed<Radius>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) pan: Option<Placed<Degrees>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) tilt: Option<Placed<Degrees>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) roll: Option<Placed<Degrees>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) azimuth: Option<Placed<Degrees>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) elevation: Option<Placed<Degrees>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) zoom: Option<Placed<Zoom>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) sky: Option<Placed<Sky>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) toward: Option<Placed<Point>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) direction: Option<Placed<Point>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) mu: Option<Placed<Mu>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) intensity: Option<Placed<Color>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) diameter: Option<Placed<Diameter>>,
    #[serde(default)]
    pub(crate) ease: Placed<Ease>,
}

/// The way of a channel from a key to the next.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq)]
pub(crate) enum Ease {
    /// A cubic without overshoot.
    #[default]
    Smooth,
    /// A straight line.
    Linear,
    /// Not at all, until it jumps.
    Hold,
}

/// The numbers of a camera; those that its kind lacks are 0.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CameraNumbers {
    pub(crate) position: DVec3,
    pub(crate) target: DVec3,
    pub(crate) radius: f64,
    pub(crate) pan: f64,
    pub(crate) tilt: f64,
    pub(crate) azimuth: f64,
    pub(crate) elevation: f64,
    pub(crate) roll: f64,
}

impl Camera {
    /// The numbers of this camera where no key names them; `None` where a fault was reported.
    pub(crate) fn at_rest(&self) -> Option<CameraNumbers> {
        let mut all = CameraNumbers::default();
        let roll = match self {
            Self::Free {
                position,
                pan,
                tilt,
                roll,
            } => {
                all.position = position.get()?.0;
                (all.pan, all.tilt) = (pan.get()?.0, tilt.get()?.0);
                roll
            }
            Self::LookAt {
                position,
                target,
                roll,
            } => {
                (all.position, all.target) = (position.get()?.0, target.get()?.0);
                roll
            }
            Self::Orbit {
                target,
                radius,
                azimuth,
                elevation,
                roll,
            } => {
                (all.target, all.radius) = (target.get()?.0, radius.get()?.0);
                (all.azimuth, all.elevation) = (azimuth.get()?.0, elevation.get()?.0);
                roll
            }
            Self::Frame {
                azimuth,
                elevation,
                roll,
                ..
            } => {
                (all.azimuth, all.elevation) = (azimuth.get()?.0, elevation.get()?.0);
                roll
            }
            // It has no numbers that keys could name.
            Self::Pose { .. } => return Some(all),
        };
        all.roll = roll.get()?.0;
        Some(all)
    }

    /// The kind of this camera as the file writes it.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Free { .. } => "Free",
            Self::LookAt { .. } => "LookAt",
            Self::Orbit { .. } => "Orbit",
            Self::Frame { .. } => "Frame",
            Self::Pose { .. } => "Pose",
        }
    }

    /// The channels that keys of this camera may name.
    pub(crate) fn channels(&self) -> &'static [&'static str] {
        match self {
            Self::Free { .. } => &["position", "pan", "tilt", "roll", "zoom"],
            Self::LookAt { .. } => &["position", "target", "roll", "zoom"],
            Self::Orbit { .. } => &["target", "radius", "azimuth", "elevation", "roll", "zoom"],
            Self::Frame { .. } => &["azimuth", "elevation", "roll", "zoom"],
            Self::Pose { .. } => &["zoom"],
        }
    }
}

impl Animation {
    /// The kind of this animation as the file writes it.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Keyframes { .. } => "Keyframes",
            Self::Turntable { .. } => "Turntable",
        }
    }
}

/// The name of a channel, and the place of its value where a key names it.
pub(crate) type Channel = (&'static str, Option<Range<usize>>);

impl Key {
    /// Every channel with the place of its value, where the key names it.
    pub(crate) fn channels(&self) -> [Channel; 15] {
        fn place<T>(channel: &Option<Placed<T>>) -> Option<Range<usize>> {
            channel.as_ref().map(|value| value.place.clone())
        }
        [
            ("position", place(&self.position)),
            ("target", place(&self.target)),
            ("radius", place(&self.radius)),
            ("pan", place(&self.pan)),
            ("tilt", place(&self.tilt)),
            ("roll", place(&self.roll)),
            ("azimuth", place(&self.azimuth)),
            ("elevation", place(&self.elevation)),
            ("zoom", place(&self.zoom)),
            ("sky", place(&self.sky)),
            ("toward", place(&self.toward)),
            ("direction", place(&self.direction)),
            ("mu", place(&self.mu)),
            ("intensity", place(&self.intensity)),
            ("diameter", place(&self.diameter)),
        ]
    }
}
