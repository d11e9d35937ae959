//! The light of a uniform sky by stratified rays.

use std::cell::Cell;
use std::f64::consts::TAU;

use glam::DVec3;
use marbles_core::{View, World};

/// A point of a sphere that is seen in the middle of a pixel.
pub(crate) struct Place {
    pub(crate) col: u32,
    pub(crate) row: u32,
    normal: DVec3,
    /// The spheres that may hide the sky, those that look largest first, but for those that one other hides.
    occluders: Vec<Occluder>,
}

/// A sphere, seen from a place: its center, and what the square of the distance along a ray must exceed to meet it.
struct Occluder {
    to_center: DVec3,
    least_square: f64,
}

/// The places of all pixels whose middle shows a sphere.
pub(crate) fn places(world: &World, view: &View) -> Vec<Place> {
    let pixels = (0..view.height).flat_map(|row| (0..view.width).map(move |col| (col, row)));
    pixels
        .filter_map(|(col, row)| place(world, view, col, row))
        .collect()
}

fn place(world: &World, view: &View, col: u32, row: u32) -> Option<Place> {
    let ray = view.ray(view.cell_center(col.into(), row.into(), 1));
    let direction = ray.direction.normalize();
    let distance_to = |center: DVec3, radius: f64| {
        let to_center = center - ray.origin;
        let along = to_center.dot(direction);
        let square = radius * radius - (to_center - direction * along).length_squared();
        (square >= 0.0 && along > 0.0).then(|| along - square.sqrt())
    };
    let spheres = world.spheres();
    let hits = spheres.iter().enumerate().filter_map(|(index, sphere)| {
        distance_to(sphere.center(), sphere.radius()).map(|distance| (distance, index))
    });
    let (distance, own) = hits.min_by(|one, other| one.0.total_cmp(&other.0))?;
    let position = ray.origin + direction * distance;
    let normal = (position - spheres[own].center()).normalize();
    // The axes and the angles of the caps.
    let mut caps: Vec<(DVec3, f64, Occluder)> = Vec::new();
    for (index, sphere) in spheres.iter().enumerate() {
        let to_center = sphere.center() - position;
        if index == own || to_center.dot(normal) <= -sphere.radius() {
            continue;
        }
        let distance = to_center.length();
        let angle = (sphere.radius() / distance).min(1.0).asin();
        let least_square = distance * distance - sphere.radius() * sphere.radius();
        let occluder = Occluder {
            to_center,
            least_square,
        };
        caps.push((to_center / distance, angle, occluder));
    }
    caps.sort_by(|one, other| other.1.total_cmp(&one.1));
    let mut kept: Vec<(DVec3, f64, Occluder)> = Vec::new();
    for cap in caps {
        let is_hidden = kept
            .iter()
            .any(|(axis, angle, _)| axis.dot(cap.0).clamp(-1.0, 1.0).acos() + cap.1 < *angle);
        if !is_hidden {
            kept.push(cap);
        }
    }
    Some(Place {
        col,
        row,
        normal,
        occluders: kept.into_iter().map(|(_, _, occluder)| occluder).collect(),
    })
}

impl Place {
    /// The part of the light that side × side rays find, one in each cell of the square that is mapped to the directions above
    /// the surface, as densely as light arrives.
    pub(crate) fn light(&self, side: u32) -> f64 {
        let x = self.normal.any_orthonormal_vector();
        let y = self.normal.cross(x);
        let state = Cell::new(u64::from(self.col) << 32 | u64::from(self.row));
        let random = || {
            let next = state.get().wrapping_mul(6_364_136_223_846_793_005);
            state.set(next.wrapping_add(1_442_695_040_888_963_407));
            (state.get() >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut seen = 0;
        for row in 0..side {
            for col in 0..side {
                let square = (f64::from(row) + random()) / f64::from(side);
                let turn = TAU * (f64::from(col) + random()) / f64::from(side);
                let aside = (x * turn.cos() + y * turn.sin()) * square.sqrt();
                let direction = aside + self.normal * (1.0 - square).sqrt();
                seen += u32::from(!self.is_hidden(direction));
            }
        }
        f64::from(seen) / f64::from(side * side)
    }

    fn is_hidden(&self, direction: DVec3) -> bool {
        self.occluders.iter().any(|occluder| {
            let along = occluder.to_center.dot(direction);
            along > 0.0 && along * along > occluder.least_square
        })
    }
}
