//! The box around spheres.

use glam::DVec3;
use marbles_core::Sphere;
use rayon::prelude::*;

/// The middle of the box around spheres, `None` for none.
pub(crate) fn middle(spheres: &[Sphere]) -> Option<DVec3> {
    let corners = |sphere: &Sphere| {
        let reach = DVec3::splat(sphere.radius());
        (sphere.center() - reach, sphere.center() + reach)
    };
    let corners = spheres.par_iter().map(corners);
    let (low, high) = corners.reduce_with(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
    // Halved, no sum overflows.
    Some(0.5 * low + 0.5 * high)
}
