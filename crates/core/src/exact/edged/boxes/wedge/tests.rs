use fearless_simd::{Level, dispatch};

use super::super::by_points::by_points;
use super::*;
use crate::numeric::lanes::f64x8;

type Plane = (f64, [f64; 2]);

/// The share and the moments of the part of a box in which both functions are positive.
fn truth(planes: [Plane; 2]) -> [f64; 3] {
    by_points(|u, v| {
        planes
            .iter()
            .all(|(value, [x, y])| value + x * u + y * v > 0.0)
    })
}

fn found(planes: [Plane; 2]) -> [f64; 3] {
    dispatch!(Level::new(), simd => {
        let splat = |number| f64x8::splat(simd, number);
        let [one, other] = planes.map(|(value, across)| {
            HalfPlane::new(simd, splat(value), across.map(splat), splat(0.0))
        });
        let (area, [x, y]) = intersection(simd, &one, &other);
        [area, x, y].map(|lanes| lanes[5])
    })
}

#[test]
fn two_half_planes_share_what_points_say() {
    let values = [-0.45, -0.2, 0.03, 0.31, 0.48];
    for (index, value) in values.into_iter().enumerate() {
        for turn in 0..12 {
            // Twelve pairs of directions, none along the sides.
            let (one, other) = (0.3 + 0.53 * turn as f64, 1.1 + 0.37 * turn as f64);
            let planes = [
                (value, [one.cos(), one.sin()]),
                (
                    0.6 * values[(index + turn) % 5],
                    [other.sin() * 1.7, other.cos() * 1.7],
                ),
            ];
            let (found, truth) = (found(planes), truth(planes));
            for (found, truth) in found.iter().zip(truth) {
                assert!(
                    (found - truth).abs() < 4e-4,
                    "{planes:?}: {found} for {truth}"
                );
            }
        }
    }
}

#[test]
fn parallel_lines_and_those_along_sides_share_what_points_say() {
    let cases = [
        [(0.2, [1.0, 0.5]), (0.1, [1.0, 0.5])],
        [(0.2, [1.0, 0.5]), (0.2, [1.0, 0.5])],
        [(0.2, [1.0, 0.5]), (0.1, [-1.0, -0.5])],
        [(-0.2, [1.0, 0.5]), (0.1, [-1.0, -0.5])],
        [(0.2, [1.0, 0.0]), (0.1, [0.0, 1.0])],
        [(0.2, [1.0, 0.0]), (-0.3, [0.0, -3.0])],
        [(0.2, [1.0, 0.0]), (0.4, [2.0, 1e-14])],
        [(0.2, [-1.0, 0.0]), (-0.1, [-1.0, 0.0])],
    ];
    for planes in cases {
        let (found, truth) = (found(planes), truth(planes));
        for (found, truth) in found.iter().zip(truth) {
            assert!(
                (found - truth).abs() < 4e-4,
                "{planes:?}: {found} for {truth}"
            );
        }
    }
}

/// Against points along the line.
#[test]
fn a_line_lies_beside_another_where_points_say() {
    const POINTS: u32 = 40_000;
    for turn in 0..24 {
        let angle = 0.3 + 0.53 * f64::from(turn);
        let line = (0.3 * (0.9 * angle).sin(), [angle.cos(), angle.sin()]);
        let other = (
            0.25 * angle.cos(),
            [(2.3 * angle).sin(), (1.1 * angle).cos()],
        );
        let found = dispatch!(Level::new(), simd => {
            let splat = |number| f64x8::splat(simd, number);
            let [line, other] = [line, other].map(|(value, across): Plane| {
                HalfPlane::new(simd, splat(value), across.map(splat), splat(0.0))
            });
            part_beside(simd, &line, &other)[2]
        });
        let (value, [x, y]) = line;
        let [mut inside, mut beside] = [0_u32; 2];
        for point in 0..POINTS {
            let along = 2.0 * f64::from(point) / f64::from(POINTS) - 1.0;
            let [u, v] = [-value * x - along * y, -value * y + along * x];
            if u.abs() < 0.5 && v.abs() < 0.5 {
                inside += 1;
                beside += u32::from(other.0 + other.1[0] * u + other.1[1] * v > 0.0);
            }
        }
        let expected = f64::from(beside) / f64::from(inside);
        assert!(
            (found - expected).abs() < 1e-3,
            "{turn}: {found} for {expected}"
        );
    }
}
