//! The spheres in view.

use marbles_core::{Sphere, View};

/// Returns false only if a sphere cannot be in the picture.
pub(super) fn may_be_seen(sphere: &Sphere, view: &View) -> bool {
    let camera = &view.camera;
    let from_eye = camera.world_from_camera.transpose() * (sphere.center() - camera.position);
    let radius = sphere.radius();
    let (middle, size) = view.screen_window();
    let half = 0.5 * size;
    let (x, y, z) = (from_eye.x, from_eye.y, from_eye.z);
    if z + radius <= 0.0 {
        return false;
    }
    // How far the center is outside of a side of the picture, across it.
    let outside = |along: f64, middle: f64, half: f64| {
        if view.lens.is_parallel() {
            (along - middle).abs() - half
        } else {
            let of_side =
                |slope: f64, sign: f64| sign * (along - slope * z) / (1.0 + slope * slope).sqrt();
            of_side(middle + half, 1.0).max(of_side(middle - half, -1.0))
        }
    };
    outside(x, middle.x, half.x) < radius && outside(y, middle.y, half.y) < radius
}
