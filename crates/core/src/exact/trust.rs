//! Which spheres and views plain doubles can be trusted with.

use crate::edges::cell::Ball;
use crate::model::view::View;

/// Squares of squares of these neither over- nor underflow.
const MODERATE: std::ops::Range<f64> = 1e-60..1e60;

/// Whether the numbers of a view are moderate. Edges are found in plain doubles, without the floors of
/// exact hits; where they cannot be trusted, a pixel makes no claim.
pub(crate) fn trusts_view(view: &View) -> bool {
    let distance = view.lens.distance * view.zoom;
    let pixel = view.pixel_size() / distance;
    [distance, view.pixel_size(), pixel]
        .iter()
        .all(|number| MODERATE.contains(number))
}

/// Whether the numbers of a sphere are moderate.
pub(crate) fn trusts(ball: &Ball) -> bool {
    let far = ball.center.length() + ball.radius;
    MODERATE.contains(&ball.radius) && MODERATE.contains(&far) && ball.outside.is_finite()
}
