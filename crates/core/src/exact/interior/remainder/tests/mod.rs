//! Tests of `remainder.rs`.

mod fixed;
mod place;

use super::*;
use crate::exact::interior::samples::{POINTS, Sample};
use crate::picture::pixel::Evidence;
use crate::search::tests::Random;
use place::Place;

/// The sum of what a rule misses of all monomials of a degree, in half sides.
fn missed_of_degree(degree: i32, weight: impl Fn(&Sample) -> f64) -> f64 {
    let mut sum = 0.0;
    for x in (0..=degree).step_by(2) {
        let y = degree - x;
        let value = |at: &Sample| (2.0 * at.u).powi(x) * (2.0 * at.v).powi(y);
        let rule: f64 = POINTS.iter().map(|at| weight(at) * value(at)).sum();
        sum += (rule - 1.0 / f64::from((x + 1) * (y + 1))).abs();
    }
    sum
}

/// Beyond degree 80 the sums are less than those of the integrals, Σ 1 / ((j + 1) (k + 1)), and of (m + 1) 0.6^m,
/// both of which fall.
#[test]
fn rules_miss_no_more_of_monomials() {
    let middle = |at: &Sample| f64::from(at.u == 0.0 && at.v == 0.0);
    let weights: [&dyn Fn(&Sample) -> f64; 3] = [&middle, &|at| at.star, &|at| at.gauss];
    for (rule, weight) in [MIDDLE, STAR, GRID].iter().zip(weights) {
        let missed = |degree| missed_of_degree(degree, weight);
        for order in 0..rule.order {
            assert!(missed(2 * order) < 1e-15);
        }
        let first = missed(2 * rule.order);
        assert!(
            (0.99 * rule.first..rule.first + 1e-15).contains(&first),
            "{first}"
        );
        let more = (rule.order + 1..=40).map(|order| missed(2 * order));
        let most = more.fold(0.0, f64::max);
        assert!((0.95 * rule.more..rule.more).contains(&most), "{most}");
    }
}

/// Balls near and far, small and large, seen straight and grazing, under all kinds of light: what is proved of a
/// pixel against its average in 256-bit arithmetic, by five samples and more, and at loose tolerances by one.
#[test]
fn nothing_is_farther_from_its_average_than_is_proved() {
    hold(Place::new);
}

#[test]
fn nothing_that_parallel_rays_see_is_farther_from_its_average_than_is_proved() {
    hold(Place::of_parallel_rays);
}

fn hold(place: impl Fn(&mut Random, [f64; 2]) -> Place) {
    const PLACES: usize = 800;
    let nodes = fixed::gauss(14);
    let mut random = Random(15);
    let mut asked = 0;
    for (tolerances, tight) in [([-8.0, -4.0], 0.1), ([-4.0, -1.0], 0.05)] {
        let (mut proved, mut largest) = (0, 0.0_f64);
        while proved < PLACES {
            let place = place(&mut random, tolerances);
            let pixel = place.pixel();
            if pixel.alpha < 1.0 || !place.is_lit() {
                continue;
            }
            asked += 1;
            if pixel.evidence == Evidence::Estimate {
                continue;
            }
            proved += 1;
            let off = place.distance_from_average(&nodes, pixel.value.x);
            assert!(off <= pixel.error, "{off:e} {:e}: {place:?}", pixel.error);
            largest = largest.max(off / pixel.error);
        }
        // Not by claiming much more than is wrong.
        assert!(largest > tight, "{largest}");
    }
    // Most are proved.
    assert!(asked < 2 * PLACES * 4 / 3, "{asked}");
}
