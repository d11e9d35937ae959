//! The typical distance between neighboring points, from which spheres without radii get one.

use marbles_core::{Sphere, parallel};

/// The radius of spheres without one, as a share of the typical distance to the nearest neighbor. Spheres at this
/// distance leave a small gap.
const SHARE: f64 = 0.45;
/// The radius of a single point.
const ALONE: f64 = 1.0;
/// The points whose nearest neighbors are sought: at most and at least so many, and in between as many as keep the
/// distances that are computed below this number.
const MOST_SAMPLES: usize = 256;
const LEAST_SAMPLES: usize = 16;
const DISTANCES: usize = 200_000_000;

/// A radius for spheres at these centers: a share of the median distance from a center to the nearest other one.
pub(super) fn radius(spheres: &[Sphere]) -> f64 {
    let count = spheres.len();
    let samples = (DISTANCES / count.max(1)).clamp(LEAST_SAMPLES, MOST_SAMPLES);
    let step = count.div_ceil(samples).max(1);
    let nearest = |sphere: &Sphere| {
        let squares = spheres
            .iter()
            .map(|other| (other.center() - sphere.center()).length_squared());
        // Centers that coincide say nothing.
        let apart = squares.filter(|square| *square > 0.0);
        apart.fold(f64::INFINITY, f64::min).sqrt()
    };
    let mut distances: Vec<f64> = parallel::map(count.div_ceil(step), |index| {
        nearest(&spheres[index * step])
    });
    distances.retain(|distance| distance.is_finite());
    distances.sort_unstable_by(f64::total_cmp);
    let median = distances.get(distances.len() / 2);
    median.map_or(ALONE, |median| SHARE * median)
}
