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
    for (rule, is_star) in [(STAR, true), (GRID, false)] {
        let missed =
            |degree| missed_of_degree(degree, |at| if is_star { at.star } else { at.gauss });
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
/// pixel against its average in 256-bit arithmetic.
#[test]
fn nothing_is_farther_from_its_average_than_is_proved() {
    const PLACES: usize = 1500;
    let nodes = fixed::gauss(20);
    let mut random = Random(15);
    let (mut proved, mut asked, mut largest) = (0, 0, 0.0_f64);
    while proved < PLACES {
        let place = Place::new(&mut random);
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
    // Most are proved, and not by claiming much more than is wrong.
    assert!(asked < PLACES * 4 / 3, "{asked}");
    assert!(largest > 0.1, "{largest}");
}
