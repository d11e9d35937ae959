//! The turntable: an orbit around its target in a loop, or lights that turn so.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};
use marbles_core::{Angle, Camera};

use super::framing::Turning;
use crate::file::{Animation, Up};
use crate::text::{optional, refuse};

/// A turn in degrees.
const TURN: f64 = 360.0;

/// A turn of the camera around its target, or of the lights, in frames 1 to `frames`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turntable {
    /// Frames of a loop, at least 1.
    pub(super) frames: i32,
    /// Turns in a loop, or swings there and back.
    pub(super) turns: f64,
    /// The unit vector along the axis; `None` for the one that points up.
    pub(super) axis: Option<DVec3>,
    /// The axis that points up.
    pub(super) up: Up,
    /// The angle in degrees to which it swings, to both sides; `None` where it goes around.
    pub(super) swing: Option<f64>,
}

impl Turntable {
    /// The turntable of an animation; `None` where it is none, or a fault was reported.
    pub(super) fn new(animation: &Animation) -> Option<Self> {
        let Animation::Turntable {
            frames,
            turns,
            axis,
            up,
            swing,
            ..
        } = animation
        else {
            return None;
        };
        if let (Some(_), Some(up)) = (axis, up) {
            let message = "expected `axis` or `up`, found both";
            return refuse(up.place.clone(), message);
        }
        let axis = optional(axis, |axis| Some(axis.0))?;
        Some(Self {
            frames: frames.get()?.0,
            turns: turns.get()?.0,
            axis: axis.filter(|axis| *axis != DVec3::Y),
            up: optional(up, |up| Some(*up))?.unwrap_or_default(),
            swing: optional(swing, |swing| Some(swing.0))?,
        })
    }

    /// The angle about the axis so many frames after frame `frame`, fewer than 1, in degrees.
    ///
    /// For whole turns it is the same in frame `frame + frames`, to the bit.
    pub(super) fn degrees_at(&self, frame: i32, later: f64) -> f64 {
        let phase = self.phase_degrees_at(frame, later);
        match self.swing {
            Some(swing) => swing * Angle::from_degrees(phase).sin,
            None => phase,
        }
    }

    /// The rotation in frame `frame`.
    pub(super) fn rotation(&self, frame: i32) -> DMat3 {
        self.rotation_by(self.degrees_at(frame, 0.0))
    }

    /// The rotation by an angle in degrees about the axis: from z toward x about y, from x toward y about z.
    fn rotation_by(&self, degrees: f64) -> DMat3 {
        let angle = Angle::from_degrees(degrees);
        let Some(axis) = self.axis else {
            let still = Angle::from_degrees(0.0);
            let forward = Camera::free(DVec3::ZERO, angle, still, still).forward();
            let right = DVec3::new(forward.z, 0.0, -forward.x);
            let about_y = DMat3::from_cols(right, DVec3::Y, forward);
            let upright = upright(self.up);
            return upright * about_y * upright.transpose();
        };
        // Rodrigues' formula, for each vector of the world's axes.
        let turned = |vector: DVec3| {
            let along = axis * axis.dot(vector);
            along + (vector - along) * angle.cos + axis.cross(vector) * angle.sin
        };
        DMat3::from_cols(turned(DVec3::X), turned(DVec3::Y), turned(DVec3::Z))
    }

    /// The angle in degrees by which the azimuth of a camera grows, where the axis is that of the azimuth, and the rotation
    /// about the target that follows, where there is one.
    pub(super) fn turn(&self, degrees: f64) -> (f64, Option<DMat3>) {
        match (self.axis, self.up) {
            (Some(_), _) => (0.0, Some(self.rotation_by(degrees))),
            (None, Up::Y) => (degrees, None),
            (None, up) => (degrees, Some(upright(up))),
        }
    }

    /// The camera's axes in the world, before it turns, where they would be these if y pointed up.
    pub(super) fn stand(&self, world_from_camera: DMat3) -> DMat3 {
        upright(self.up) * world_from_camera
    }

    /// The motion of a camera that it turns.
    pub(super) fn turning(&self) -> Turning {
        Turning::Around {
            axis: self.axis.unwrap_or(upright(self.up).y_axis),
            swing: self.swing.map_or(PI, f64::to_radians),
        }
    }

    /// The angle of its turns in frame `frame`.
    ///
    /// For whole turns frame `frame + frames` is the same as `frame` to the bit: the fraction of
    /// the turn is a quotient of whole numbers, and whole turns are dropped before the division.
    fn phase_degrees(&self, frame: i32) -> f64 {
        let frames = f64::from(self.frames);
        let part_of_turn = if self.loops() {
            // Less than 2^31 each, so that the product is a whole number of 64 bits.
            let turns = libm::fmod(self.turns, frames) as i64;
            let since_first = i64::from(self.looped(frame)) - 1;
            (turns * since_first).rem_euclid(i64::from(self.frames)) as f64
        } else {
            libm::fmod(self.turns * (f64::from(frame) - 1.0), frames)
        };
        TURN * part_of_turn / frames
    }

    /// The angle of its turns so many frames after frame `frame`, fewer than 1.
    ///
    /// For whole turns it is the same in frame `frame + frames`, to the bit.
    fn phase_degrees_at(&self, frame: i32, later: f64) -> f64 {
        let turns = libm::fmod(self.turns * later / f64::from(self.frames), 1.0);
        self.phase_degrees(frame) + TURN * turns
    }

    /// The number of the frame by which noise is drawn: from 1 to `frames` where the last frame
    /// leads back to the first.
    pub(super) fn looped(&self, frame: i32) -> i32 {
        if self.loops() {
            let since_first = (i64::from(frame) - 1).rem_euclid(i64::from(self.frames));
            since_first as i32 + 1
        } else {
            frame
        }
    }

    /// Returns whether the frame after the last is the first.
    fn loops(&self) -> bool {
        libm::fmod(self.turns, 1.0) == 0.0
    }
}

/// The quarter turn by which y becomes the axis that points up, as the one of a table's `up` goes back.
fn upright(up: Up) -> DMat3 {
    match up {
        Up::X => DMat3::from_cols(-DVec3::Y, DVec3::X, DVec3::Z),
        Up::Y => DMat3::IDENTITY,
        Up::Z => DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y),
    }
}

/// A camera that is turned by a rotation about `target`.
pub(super) fn turned_about(camera: Camera, target: DVec3, rotation: DMat3) -> Camera {
    let about_target = |point: DVec3| target + rotation * (point - target);
    Camera {
        position: about_target(camera.position),
        on_axis: about_target(camera.on_axis),
        world_from_camera: rotation * camera.world_from_camera,
    }
}

#[cfg(test)]
mod tests;
