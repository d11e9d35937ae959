//! The planes through lamps beyond which these send nothing, in what a cell sees.

use glam::DVec3;

use super::active::Active;
use super::contents::{Contents, Kind, ROUNDINGS};
use super::patch::Patch;
use crate::edges::cell::Cell;
use crate::edges::cutoff::cutoff;
use crate::edges::terminator::Plane;
use crate::model::camera::Projection;
use crate::numeric::rounding::GEOMETRY_SLACK;

impl Active {
    /// Returns whether all that a cell sees of the sphere lies beyond the plane of the cutoff of a lamp at this position.
    pub(super) fn is_beyond(&self, cell: &Cell, plane: &Plane, position: DVec3) -> bool {
        let patch = Patch::new(cell, &self.ball, &self.discriminant, &self.along);
        patch.widths().into_iter().all(|(end, around)| {
            let slack = GEOMETRY_SLACK * (end.length() + position.length());
            (end - position).dot(plane.axis) + around < -slack
        })
    }
}

impl Contents {
    /// Adds the circle in which the plane of the cutoff of a lamp cuts an active sphere, if it may be in the cell.
    pub(super) fn add_cutoff(
        &mut self,
        cell: &Cell,
        (position, light): (usize, usize),
        plane: &Plane,
        lamp: DVec3,
    ) {
        let active = &self.active[position];
        let ball = &active.ball;
        let conic = cutoff(cell, ball, plane, lamp);
        if !conic.may_vanish() {
            return;
        }
        self.conics.push((Kind::Cutoff(position, light), conic));
        let patch = Patch::new(cell, ball, &active.discriminant, &active.along);
        let side = cell.size[0].min(cell.size[1]);
        let size = match cell.projection {
            Projection::Central => side * patch.ends[0].length() / cell.middle.length(),
            Projection::Parallel => side,
        };
        // A small circle moves by more than its plane.
        let circle_sq = (ball.radius - plane.offset) * (ball.radius + plane.offset);
        let flat = ball.radius / circle_sq.max(0.0).sqrt().max(size);
        let length = lamp.length() + ball.center.length() + ball.radius;
        self.rounding = self.rounding.max(ROUNDINGS * length * flat.max(1.0) / size);
    }
}
