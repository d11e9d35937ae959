//! The spheres and views whose numbers are moderate enough for plain doubles.

use crate::edges::cell::Ball;
use crate::model::view::View;
use crate::numeric::pair::both;

/// Squares of squares of these neither over- nor underflow: the fourth power of 1e60, 1e240, leaves room
/// for sums and for a product with 1e60 below the largest double, 1.8e308.
const MODERATE: std::ops::Range<f64> = 1e-60..1e60;

/// Returns whether the numbers of a view are moderate. Edges are found in plain doubles, without the floors of
/// exact hits; where they cannot be trusted, a pixel makes no claim.
pub(crate) fn is_view_moderate(view: &View) -> bool {
    let distance = view.magnification();
    let pixel = view.pixel_size();
    let sides = both([pixel, pixel / distance], |sides| sides.to_array());
    let mut numbers = sides.as_flattened().iter().chain([&distance]);
    numbers.all(|number| MODERATE.contains(number))
}

/// Returns whether the numbers of a sphere are moderate.
pub(crate) fn is_ball_moderate(ball: &Ball) -> bool {
    let far = ball.center.length() + ball.radius;
    MODERATE.contains(&ball.radius) && MODERATE.contains(&far) && ball.outside.is_finite()
}
