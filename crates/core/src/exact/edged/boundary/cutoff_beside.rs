//! The side of the cutoff of a light on which a curve lies.

use super::setting::{Curve, Edge, Setting};
use crate::edges::terminator::Plane;

/// The side of the cutoff of a light on which a curve on an active sphere lies.
#[derive(Clone, Copy, Debug)]
pub(super) enum CutoffBeside {
    /// All of it ahead of the lamp, or on its own cutoff.
    Ahead,
    /// All of it beyond.
    Beyond,
    /// The plane decides.
    Plane(Plane),
}

impl CutoffBeside {
    /// That of a light on a curve. Where the cutoffs of several lamps coincide, as those of lamps on a panel do, rounding
    /// must not decide: of lamps that face one way they end one after the other, in their order, and of two that face
    /// opposite ways both have ended.
    pub(super) fn of(
        setting: &Setting<'_, '_>,
        curve: &Curve,
        sphere: usize,
        light: usize,
    ) -> Self {
        let (lights, ball) = (&setting.scene.lights, &setting.contents.active[sphere].ball);
        let Some(plane) = lights[light].cutoff(ball) else {
            return Self::Ahead;
        };
        let Edge::Cutoff(other) = curve.edge else {
            return Self::Plane(plane);
        };
        if curve.own[0] != sphere {
            return Self::Plane(plane);
        }
        if light == other {
            return Self::Ahead;
        }
        let Some(of_curve) = lights[other].cutoff(ball) else {
            return Self::Plane(plane);
        };
        if !are_alike(&plane, &of_curve, ball.radius) {
            return Self::Plane(plane);
        }
        let is_one_way = plane.axis.dot(of_curve.axis) > 0.0;
        if is_one_way && light < other {
            Self::Ahead
        } else {
            Self::Beyond
        }
    }
}

/// Returns whether two planes coincide where they cut a ball, whichever way their axes lead.
fn are_alike(one: &Plane, other: &Plane, radius: f64) -> bool {
    /// The relative difference of lengths that count as equal: more than rounding.
    const ALIKE: f64 = 1e-12;
    let sign = one.axis.dot(other.axis).signum();
    let apart = (one.offset - sign * other.offset).abs();
    (one.axis - other.axis * sign).length() <= ALIKE && apart <= ALIKE * radius
}
