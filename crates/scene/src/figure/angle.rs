//! The direction from which most of some spheres is seen.
//!
//! The centers have three principal axes, along which they vary most, less, and least. A camera that looks along the
//! axis of least extent sees the other two in full. A slight tilt away from it shows depth.

use glam::{DMat3, DVec3};
use marbles_core::Sphere;

use super::view::ViewAngle;
use crate::motion::axes_of_orbit;

/// The view of spheres that look alike from every side.
const USUAL: ViewAngle = ViewAngle {
    azimuth: 25.0,
    elevation: 20.0,
};
/// The tilt away from the axis of least extent.
const TILT: f64 = 15.0;
/// The elevation of turntables, whose azimuth passes through all directions.
const TURNTABLE_ELEVATION: f64 = 15.0;
/// The elevation from which a view counts as one from above.
const STEEP: f64 = 60.0;
/// Two extents are alike if the smaller one is at least this share of the larger.
const ALIKE: f64 = 0.8;
/// An extent below this share of the largest is none: the centers lie in a plane.
const FLAT: f64 = 1e-3;

/// The view that shows most of the spheres.
pub(super) fn of(spheres: &[Sphere], is_turntable: bool) -> ViewAngle {
    let view = still(spheres).unwrap_or(USUAL);
    match is_turntable {
        true => ViewAngle {
            elevation: TURNTABLE_ELEVATION,
            ..view
        },
        false => view,
    }
}

/// The view along the least extent, tilted; `None` where no direction is better than the usual one.
fn still(spheres: &[Sphere]) -> Option<ViewAngle> {
    let (deviations, axes) = principal_axes(spheres)?;
    let [largest, middle, least] = deviations;
    let usual = axes_of_orbit([USUAL.azimuth, USUAL.elevation, 0.0]).z_axis;
    let is_rod = least >= ALIKE * middle;
    let along = if is_rod {
        if middle >= ALIKE * largest {
            return None;
        }
        // A rod: of all directions across it the one next to the usual view.
        let across = usual - usual.dot(axes.x_axis) * axes.x_axis;
        across.try_normalize()?
    } else {
        axes.z_axis
    };
    let along = if along.dot(usual) < 0.0 {
        -along
    } else {
        along
    };
    let elevation = libm::asin((-along.y).clamp(-1.0, 1.0)).to_degrees();
    // From above or below, x is to the right.
    let azimuth = match elevation.abs() {
        steep if steep >= STEEP => 0.0,
        _ => libm::atan2(along.x, along.z).to_degrees(),
    };
    let round = |degrees: f64| libm::round(degrees) + 0.0;
    // A rod seen across lies level or stands upright, which a tilt would spoil.
    if is_rod || least <= FLAT * largest {
        return Some(ViewAngle {
            azimuth: round(azimuth),
            elevation: round(elevation),
        });
    }
    let elevation = match elevation {
        steep if steep.abs() >= STEEP => steep - TILT * steep.signum(),
        _ => elevation + TILT,
    };
    Some(ViewAngle {
        azimuth: round(azimuth + TILT),
        elevation: round(elevation),
    })
}

/// The standard deviations along the principal axes of the centers, the largest first, and these axes. `None` for
/// centers without extent, or numbers too large to tell.
fn principal_axes(spheres: &[Sphere]) -> Option<([f64; 3], DMat3)> {
    let count = spheres.len() as f64;
    let mut centers = spheres.iter().map(Sphere::center);
    let (low, high) = centers.clone().fold(
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
        |(low, high), center| (low.min(center), high.max(center)),
    );
    let (middle, extent) = (0.5 * low + 0.5 * high, (high - low).max_element());
    if !(extent > 0.0 && extent.is_finite()) {
        return None;
    }
    // Numbers of any size become numbers near 1.
    let scaled = |center: DVec3| (center - middle) / extent;
    let mean = centers.clone().map(scaled).sum::<DVec3>() / count;
    let covariance = centers.try_fold(DMat3::ZERO, |sum, center| {
        let from_mean = scaled(center) - mean;
        let product = DMat3::from_cols(
            from_mean * from_mean.x,
            from_mean * from_mean.y,
            from_mean * from_mean.z,
        );
        product.is_finite().then_some(sum + product)
    })?;
    let (variances, axes) = eigenvectors(covariance * (1.0 / count));
    let mut order = [0, 1, 2];
    order.sort_by(|&one, &other| variances[other].total_cmp(&variances[one]));
    let deviations = order.map(|index| variances[index].max(0.0).sqrt());
    let [first, second, third] = order.map(|index| axes.col(index));
    Some((deviations, DMat3::from_cols(first, second, third)))
}

/// The eigenvalues and eigenvectors of a symmetric matrix, by Jacobi's rotations.
fn eigenvectors(mut matrix: DMat3) -> ([f64; 3], DMat3) {
    /// Each sweep squares what is left beside the diagonal.
    const SWEEPS: usize = 12;
    let mut vectors = DMat3::IDENTITY;
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let beside = matrix.col(q)[p];
            if beside == 0.0 {
                continue;
            }
            let theta = 0.5 * (matrix.col(q)[q] - matrix.col(p)[p]) / beside;
            let tangent = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
            let sine = tangent * cosine;
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(p)[p] = cosine;
            turn.col_mut(q)[q] = cosine;
            turn.col_mut(q)[p] = sine;
            turn.col_mut(p)[q] = -sine;
            matrix = turn.transpose() * matrix * turn;
            vectors *= turn;
        }
    }
    let values = [0, 1, 2].map(|index| matrix.col(index)[index]);
    (values, vectors)
}
