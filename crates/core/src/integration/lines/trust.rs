//! For which spheres plain doubles carry a tolerance.

use super::scene::{Ball, InCamera};
use crate::View;
use crate::rounding::UNIT_ROUNDOFF;

/// For every sphere whether rounding moves nothing on it by more than a tenth of the tolerance of
/// a pixel. Lines compute in plain doubles, without the floors of exact hits; where they cannot be
/// trusted, a pixel makes no claim.
pub(super) fn trusted(camera: &InCamera, view: &View, tolerance: f64) -> Vec<bool> {
    let distance = camera.distance;
    let corner = 0.5 * view.pixel_size() * f64::from(view.width.max(view.height))
        + view.lens.shift.abs().max_element();
    // The angle of the smallest pixel.
    let pixel = view.pixel_size() * distance / (distance * distance + 2.0 * corner * corner);
    let allowed = 0.1 * tolerance * pixel;
    let reach = |ball: &Ball| ball.center.length() + ball.radius;
    let farthest = camera.balls.iter().map(reach).fold(0.0, f64::max);
    let is_trusted = |ball: &Ball| {
        /// Beyond these, squares of squares over- or underflow.
        const MODERATE: std::ops::Range<f64> = 1e-60..1e60;
        let far = ball.center.length();
        let moderate = [
            distance,
            view.pixel_size(),
            ball.radius,
            far + ball.radius,
            farthest,
        ]
        .iter()
        .all(|value| MODERATE.contains(value));
        // Places are off by some roundings of the largest coordinates; seen from the viewpoint
        // they count most where the sphere is nearest.
        let nearest = ball.outside.abs() / reach(ball);
        let places = 8.0 * UNIT_ROUNDOFF * farthest <= allowed * nearest;
        // The outline's angle is off by a rounding over itself, unless it is a speck.
        let angle = ball.radius / far;
        let outline = 8.0 * UNIT_ROUNDOFF <= allowed * angle
            || angle * angle <= 0.01 * tolerance * pixel * pixel
            || ball.outside <= 0.0;
        moderate && places && outline
    };
    camera.balls.iter().map(is_trusted).collect()
}
