//! The motion of the camera by keys.

use marbles_scene::OrbitCamera;

use crate::terminal::keys::{Direction, Key};

/// The turn by a key, in degrees, and with Shift.
const TURN: f64 = 5.0;
const FINE_TURN: f64 = 1.0;
/// The number of keys that double the zoom.
const ZOOM_STEPS: f64 = 4.0;
/// The range of the zoom, relative to that of the file, in doublings.
const MOST_DOUBLINGS: f64 = 20.0;
/// The poles, over which the camera does not go.
const POLE: f64 = 90.0;

/// A motion of the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Motion {
    /// To the right and up, around what it looks at, in degrees.
    Around { right: f64, up: f64 },
    /// Clockwise, about the axis of view, in degrees.
    Roll(f64),
    /// Steps of the zoom.
    Zoom(i32),
    /// Back to the camera of the file.
    Home,
}

impl Motion {
    /// The motion by a key.
    pub(super) fn of(key: Key) -> Option<Self> {
        Some(match key {
            Key::Arrow { to, shift } => {
                let turn = if shift { FINE_TURN } else { TURN };
                let (right, up) = match to {
                    Direction::Left => (-turn, 0.0),
                    Direction::Right => (turn, 0.0),
                    Direction::Up => (0.0, turn),
                    Direction::Down => (0.0, -turn),
                };
                Self::Around { right, up }
            }
            Key::Letter(b'r') => Self::Roll(TURN),
            Key::Letter(b'R') => Self::Roll(-TURN),
            // Which are the same keys on many keyboards.
            Key::Letter(b'+' | b'=') => Self::Zoom(1),
            Key::Letter(b'-' | b'_') => Self::Zoom(-1),
            Key::Home => Self::Home,
            _ => return None,
        })
    }
}

/// A camera that is moved by hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hand {
    /// The camera of the file.
    file: OrbitCamera,
    /// The camera now, but for its zoom.
    camera: OrbitCamera,
    /// The steps of the zoom.
    zoom: i32,
}

/// The way in which the camera differs from that of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Change {
    None,
    /// Only its zoom, which a camera of any kind has.
    Zoom(OrbitCamera),
    Turn(OrbitCamera),
}

impl Hand {
    /// The camera of the file.
    pub(super) fn new(file: OrbitCamera) -> Self {
        Self {
            file,
            camera: file,
            zoom: 0,
        }
    }

    /// Moves the camera.
    pub(super) fn apply(&mut self, motion: Motion) {
        let camera = &mut self.camera;
        match motion {
            // A camera to the right looks to the left.
            Motion::Around { right, up } => {
                if right != 0.0 {
                    camera.azimuth = whole_turns_left_out(camera.azimuth - right);
                }
                if up != 0.0 {
                    // A file may have it beyond a pole.
                    let pole = POLE.max(camera.elevation.abs());
                    camera.elevation = tidy(camera.elevation + up).clamp(-pole, pole);
                }
            }
            Motion::Roll(clockwise) => camera.roll = whole_turns_left_out(camera.roll + clockwise),
            Motion::Zoom(steps) => {
                let most = (MOST_DOUBLINGS * ZOOM_STEPS) as i32;
                self.zoom = (self.zoom + steps).clamp(-most, most);
            }
            Motion::Home => *self = Self::new(self.file),
        }
    }

    /// The camera now.
    pub(super) fn camera(&self) -> OrbitCamera {
        let zoom = match self.zoom {
            0 => self.file.zoom,
            steps => four_digits(self.file.zoom * libm::exp2(f64::from(steps) / ZOOM_STEPS)),
        };
        OrbitCamera {
            zoom,
            ..self.camera
        }
    }

    /// The way in which the camera differs from that of the file.
    pub(super) fn change(&self) -> Change {
        match (self.camera == self.file, self.zoom) {
            (true, 0) => Change::None,
            (true, _) => Change::Zoom(self.camera()),
            (false, _) => Change::Turn(self.camera()),
        }
    }

    /// The file has the camera now.
    pub(super) fn is_written(&mut self) {
        *self = Self::new(self.camera());
    }
}

/// The same angle, from -180 to 180 degrees, without what rounding leaves of sums.
fn whole_turns_left_out(degrees: f64) -> f64 {
    let angle = libm::remainder(tidy(degrees), 360.0);
    // The same as -180, and shorter.
    if angle == -180.0 { 180.0 } else { tidy(angle) }
}

/// The angle to a ten-thousandth of a degree.
fn tidy(degrees: f64) -> f64 {
    const PARTS: f64 = 1e4;
    (degrees * PARTS).round() / PARTS + 0.0
}

/// A number of four digits.
fn four_digits(number: f64) -> f64 {
    format!("{number:.3e}").parse().unwrap_or(number)
}

#[cfg(test)]
mod tests;
