use fearless_simd::{Level, dispatch};

use super::super::by_points::by_points;
use super::*;
use crate::numeric::lanes::f64x8;

type Plane = (f64, [f64; 2]);

/// The share of a box inside of all half-planes, how much it may be off, and the largest that it may be.
fn found(planes: &[Plane]) -> [f64; 3] {
    dispatch!(Level::new(), simd => {
        let splat = |number| f64x8::splat(simd, number);
        let mut region = Region::whole(simd);
        for (value, [x, y]) in planes {
            let across = [splat(*x), splat(*y)];
            region.cut(simd, &HalfPlane::new(simd, splat(*value), across, splat(0.0)));
        }
        let share = region.share(simd);
        [share.area, share.ambiguity, region.most].map(|lanes| lanes[6])
    })
}

fn truth(planes: &[Plane]) -> f64 {
    let [area, ..] = by_points(|u, v| {
        planes
            .iter()
            .all(|(value, [x, y])| value + x * u + y * v > 0.0)
    });
    area
}

/// Half-planes in turning directions, at changing distances.
fn plane(index: usize) -> Plane {
    let (sine, cosine) = (1.3 * index as f64).sin_cos();
    (0.4 * (0.7 * index as f64).sin(), [cosine, sine])
}

#[test]
fn two_half_planes_are_exact_and_three_claim_enough() {
    for index in 0..24 {
        let planes = [plane(index), plane(index + 7), plane(2 * index + 3)];
        let [share, ambiguity, _] = found(&planes[..2]);
        assert_eq!(ambiguity, 0.0);
        assert!((share - truth(&planes[..2])).abs() < 4e-4, "{planes:?}");
        let [share, ambiguity, most] = found(&planes);
        let truth = truth(&planes);
        let error = (share - truth).abs();
        assert!(
            error < ambiguity + 4e-4 && truth < most + 4e-4,
            "{planes:?}: {share} for {truth}, claims {ambiguity}, at most {most}"
        );
    }
}

#[test]
fn a_strip_inside_of_nested_lines_and_a_third_claims_enough() {
    for index in 0..24 {
        let aside = 0.02 * f64::from(index) - 0.1;
        let nested = |value: f64| (value, [1e-6, 1.0]);
        let planes = [
            nested(-0.330),
            nested(-0.328),
            (0.5 - aside, [0.05 + aside, -1.0]),
        ];
        let [share, ambiguity, _] = found(&planes);
        let error = (share - truth(&planes)).abs();
        assert!(error < ambiguity + 4e-4, "{planes:?}: {error}, {ambiguity}");
        // A bound is no larger than what may be there.
        assert!(ambiguity < 0.172, "{planes:?}: {ambiguity}");
    }
}

#[test]
fn what_is_inside_of_both_of_two_half_planes_claims_enough() {
    for index in 0..24 {
        let [one, other, third] = [plane(index), plane(index + 7), plane(2 * index + 3)];
        let [share, ambiguity] = dispatch!(Level::new(), simd => {
            let splat = |number| f64x8::splat(simd, number);
            let part = |(value, [x, y]): Plane| {
                HalfPlane::new(simd, splat(value), [splat(x), splat(y)], splat(0.0))
            };
            let mut region = Region::whole(simd);
            region.cut(simd, &part(third));
            let (one, other) = (part(one), part(other));
            region.cut(simd, &one.left_by_both(simd, &other));
            region.leave_of_both(simd, &one, &other);
            let share = region.share(simd);
            [share.area, share.ambiguity].map(|lanes| lanes[3])
        });
        let inside = |(value, [x, y]): Plane, u: f64, v: f64| value + x * u + y * v > 0.0;
        let [truth, ..] =
            by_points(|u, v| inside(third, u, v) && !(inside(one, u, v) && inside(other, u, v)));
        let error = (share - truth).abs();
        assert!(
            error < ambiguity + 4e-4,
            "{index}: {share} for {truth}, claims {ambiguity}"
        );
    }
}

#[test]
fn half_planes_that_do_not_cut_boxes_leave_the_region() {
    let planes = [
        (2.0, [1.0, 0.3]),
        plane(1),
        (3.0, [0.0, -1.0]),
        plane(4),
        (1.0, [0.1, 0.1]),
    ];
    let [share, ambiguity, _] = found(&planes);
    assert_eq!(ambiguity, 0.0);
    assert!((share - truth(&planes)).abs() < 4e-4);
    let [share, _, most] = found(&[plane(1), (-2.0, [1.0, 1.0])]);
    assert_eq!([share, most], [0.0; 2]);
}
