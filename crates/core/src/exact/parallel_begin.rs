//! The place where parallel rays begin.

use glam::DVec3;
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};

use crate::model::camera::Camera;
use crate::model::sphere::Sphere;
use crate::model::world::World;
use crate::numeric::rounding::WIDER;

/// The least number of spheres that a task takes: fewer are hardly worth its start. Not tuned.
const FEWEST_TO_SHARE: usize = 4096;

/// A viewpoint of parallel rays, moved along them to just before the nearest sphere that they may meet: how far away they
/// begin changes nothing about them, but what rounding moves grows with it. Where their plane cuts a sphere it stays.
pub(super) fn moved_ahead(world: &World, camera: &Camera) -> DVec3 {
    let (viewpoint, forward) = (camera.position, camera.forward());
    let spheres = world.spheres().par_iter().with_min_len(FEWEST_TO_SHARE);
    let begin = |sphere: &Sphere| {
        let ahead = (sphere.center() - viewpoint).dot(forward);
        let slack = WIDER * sphere.radius() + (ahead.abs() + viewpoint.length()) * (WIDER - 1.0);
        if ahead >= slack {
            // In the world, so that the place does not depend on the viewpoint's.
            sphere.center().dot(forward) - WIDER * sphere.radius()
        } else if ahead <= -slack {
            f64::INFINITY
        } else {
            f64::NAN
        }
    };
    let nearest = spheres.map(begin).reduce(
        || f64::INFINITY,
        |one, other| {
            if one <= other {
                one
            } else if other < one {
                other
            } else {
                f64::NAN
            }
        },
    );
    let moved = camera.on_axis_at(nearest);
    if nearest.is_finite() && moved.is_finite() {
        moved
    } else {
        viewpoint
    }
}
