//! Spheres that shade nothing of what a cell sees under a point light.

use glam::DVec3;

use crate::edges::cell::Ball;
use crate::numeric::rounding::GEOMETRY_SLACK;

/// Returns whether a sphere lies behind all that is within `around` of a point and outside of the sphere, seen from a
/// point light: it shades nothing of that.
///
/// # Source
/// Outside of the sphere a way p + t (a − p) to the light at a meets it only where (c − p) · (a − p) > 0, as it comes
/// nearer to the center at first. By Thales p lies outside of the ball whose diameter goes from a to c there.
pub(super) fn is_behind(center: DVec3, light: DVec3, (middle, around): (DVec3, f64)) -> bool {
    let radius = 0.5 * (light - center).length();
    let distance = (middle - 0.5 * (light + center)).length();
    let slack = GEOMETRY_SLACK * (light.length() + center.length() + middle.length());
    distance + around + slack < radius
}

/// Returns whether no way from a point light to what lies within `around` of a point and outside of a large ball passes
/// through that ball.
///
/// # Source
/// The height F = K' / 2r of points above the ball, to first order, is convex along a way. So it nowhere falls below that
/// of an end from which it rises, and nowhere farther below that of both ends than L² / 8r, with the length L.
pub(super) fn is_above(ball: &Ball, light: DVec3, (middle, around): (DVec3, f64)) -> bool {
    if ball.is_apart() {
        return false;
    }
    let height = |point: DVec3| ball.power_of(point) / (2.0 * ball.radius);
    let length = (middle - light).length() + around;
    let [of_light, of_middle] = [height(light), height(middle)];
    // The slope of the height is its distance from the center, in radii.
    let reach = around * ((middle - ball.center).length() + around) / ball.radius;
    let sag = length * length / (2.0 * ball.radius);
    let slack = GEOMETRY_SLACK * (light.length() + middle.length() + length);
    let rises = of_light > of_middle + reach + sag + slack;
    rises || of_light.min(of_middle - reach) > 0.25 * sag + slack
}

/// Returns whether rays from the eye, or parallel rays from its plane, may begin inside of a sphere.
pub(super) fn may_begin_inside(is_parallel: bool, center: DVec3, radius: f64) -> bool {
    /// Far more than rounding.
    const WIDER: f64 = 1.0 + 1e-9;
    let distance = if is_parallel {
        center.z.abs()
    } else {
        center.length()
    };
    distance <= radius * WIDER
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_behind_a_point_are_met_by_no_way_to_the_light() {
        let place = |index: u32, step: f64| {
            let turn = f64::from(index) * step;
            (turn - turn.floor()) * 8.0 - 4.0
        };
        let mut behind = 0;
        for index in 0..4000 {
            let light = DVec3::new(place(index, 0.137), 6.0, place(index, 0.731));
            let point = DVec3::new(
                place(index, 0.319),
                place(index, 0.457),
                place(index, 0.593),
            );
            let (center, around) = (DVec3::ZERO, 0.05);
            let radius = (point.length() - around) * 0.999;
            if !is_behind(center, light, (point, around)) {
                continue;
            }
            behind += 1;
            for side in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_ONE.normalize()] {
                let from = point + side * around;
                let way = light - from;
                let share = (-from.dot(way) / way.length_squared()).clamp(0.0, 1.0);
                assert!((from + way * share).length() > radius, "{point} {light}");
            }
        }
        assert!((200..3000).contains(&behind), "{behind}");
    }
}
