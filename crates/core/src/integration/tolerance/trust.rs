//! Which spheres and views plain doubles can be trusted with.

use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};

use super::scene::{FEWEST_TO_SHARE, InCamera};
use crate::View;

/// For every sphere whether its numbers are so moderate that no square of a square over- or
/// underflows. Edges are found in plain doubles, without the floors of exact hits; where they cannot
/// be trusted, a pixel makes no claim.
pub(super) fn trusted(camera: &InCamera<'_>, view: &View) -> Vec<bool> {
    const MODERATE: std::ops::Range<f64> = 1e-60..1e60;
    let distance = view.lens.distance * view.zoom;
    let is_moderate = |number: f64| MODERATE.contains(&number);
    let pixel = view.pixel_size() / distance;
    let sees = is_moderate(distance) && is_moderate(view.pixel_size()) && is_moderate(pixel);
    let balls = camera.balls.par_iter().with_min_len(FEWEST_TO_SHARE);
    let balls = balls.map(|ball| {
        let far = ball.center.length() + ball.radius;
        sees && is_moderate(ball.radius) && is_moderate(far) && ball.outside.is_finite()
    });
    balls.collect()
}
