//! Edges of shadows against points of the sphere, one by one.

use fearless_simd::{Level, SimdFrom, dispatch};

use super::*;
use crate::edges::tests::{
    ball, ball_in_front, cell_at, coordinate, direction, first_hit, magnitude, ray,
};
use crate::search::tests::Random;

fn caster_at(center: DVec3, radius: f64, toward: DVec3) -> Caster {
    let (right, up) = toward.any_orthonormal_pair();
    Caster {
        center,
        radius,
        right,
        up,
    }
}

/// The crossings of each of eight lines, from left to right: where, and whether rising.
fn crossings(cell: &Cell, ball: &Ball, caster: &Caster, y: [f64; 8]) -> Vec<Vec<(f64, bool)>> {
    let mut lines = vec![Vec::new(); 8];
    let mut scratch = Vec::new();
    dispatch!(Level::new(), simd => {
        let arcs = Arcs::new(simd, cell, ball, f64x8::simd_from(simd, y));
        let places = arcs.crossings(simd, cell, caster, &mut scratch);
        for (kind, places) in places.into_iter().enumerate() {
            for places in places {
                let places: [f64; 8] = places.into();
                for (line, x) in lines.iter_mut().zip(places).filter(|(_, x)| !x.is_nan()) {
                    line.push((x, kind == 0));
                }
            }
        }
    });
    for line in &mut lines {
        line.sort_by(|one, other| one.0.total_cmp(&other.0));
    }
    lines
}

/// How far a seen point is outside of the caster's cylinder, in radii of the sphere; in the shadow
/// it is negative.
fn beyond(cell: &Cell, ball: &Ball, caster: &Caster, x: f64, y: f64) -> Option<f64> {
    let point = first_hit(ray(cell, x, y), ball)?;
    Some((caster.project(point).length() - caster.radius) / ball.radius)
}

/// A caster that has something to do with a ball, most of the time.
fn any_caster(random: &mut Random, ball: &Ball) -> Caster {
    let toward = direction(random);
    let center = ball.center + (random.point() + toward * 3.0) * ball.radius;
    caster_at(center, ball.radius * magnitude(random, 0.05, 2.0), toward)
}

#[test]
fn shadows_end_where_light_touches_the_caster() {
    let mut random = Random(1);
    let mut checked = 0;
    for step in 0..1500 {
        let ball = ball_in_front(&mut random);
        // All of the ball, or a part of it that fills the cell.
        let widths = [3.0, 0.3, 0.01][step % 3];
        let cell = cell_at(&mut random, &ball, widths);
        let caster = any_caster(&mut random, &ball);
        let y = [0.0; 8].map(|_| coordinate(&mut random));
        for (line, y) in crossings(&cell, &ball, &caster, y).iter().zip(y) {
            for &(x, rises) in line.iter().filter(|(x, _)| x.abs() <= 0.5) {
                let Some(off) = beyond(&cell, &ball, &caster, x, y) else {
                    continue;
                };
                // At the outline a little of x is much of the sphere.
                assert!(off.abs() < 1e-6, "{off:e}, {cell:?} {ball:?} {caster:?}");
                let aside = |by: f64| beyond(&cell, &ball, &caster, x + by, y);
                if let (Some(left), Some(right)) = (aside(-1e-5), aside(1e-5)) {
                    // Unless the line only touches the shadow.
                    if left.signum() != right.signum() {
                        assert_eq!(rises, right > left, "{cell:?} {ball:?} {caster:?}");
                    }
                }
                checked += 1;
            }
        }
    }
    assert!(checked > 1000, "{checked}");
}

/// Between many points of a line, one in the shadow and the next not, there is one crossing; between
/// others there are none, or two that are close.
#[test]
fn every_change_between_shadow_and_light_has_its_crossing() {
    const STEPS: u32 = 400;
    let mut random = Random(2);
    let mut lines_with = [0; 5];
    for step in 0..400 {
        let ball = ball_in_front(&mut random);
        let widths = [2.2, 0.5][step % 2];
        let cell = cell_at(&mut random, &ball, widths);
        let caster = any_caster(&mut random, &ball);
        let y = [0.0; 8].map(|_| coordinate(&mut random));
        for (line, y) in crossings(&cell, &ball, &caster, y).iter().zip(y) {
            let place = |step: u32| f64::from(step) / f64::from(STEPS) - 0.5;
            let mut changes = 0;
            for step in 0..STEPS {
                let (low, high) = (place(step), place(step + 1));
                let at = |x| beyond(&cell, &ball, &caster, x, y);
                let (Some(before), Some(after)) = (at(low), at(high)) else {
                    continue;
                };
                if before.abs().min(after.abs()) < 1e-7 {
                    continue;
                }
                let between = line.iter().filter(|(x, _)| low < *x && *x < high);
                let expected = usize::from((before < 0.0) != (after < 0.0));
                assert_eq!(
                    between.count() % 2,
                    expected,
                    "{cell:?} {ball:?} {caster:?} {y}"
                );
                changes += expected;
            }
            lines_with[changes] += 1;
        }
    }
    assert!(
        lines_with[0] > 100 && lines_with[1] > 100 && lines_with[2] > 50,
        "{lines_with:?}"
    );
}

/// The points of a great circle at the angle φ from the one nearest the eye lie at (cos φ, b sin φ)
/// before a light across it; a disc with its center at (p, 0) cuts them where a quadratic in cos φ
/// vanishes.
#[test]
fn a_line_crosses_a_shadow_four_times() {
    let (narrow, first, second) = (0.5, 0.9, 0.6);
    let leading = 1.0 - narrow * narrow;
    let p: f64 = 0.5 * leading * (first + second);
    let radius = (p * p + narrow * narrow - leading * first * second).sqrt();
    let toward = DVec3::new(leading.sqrt(), narrow, 0.0);
    let ball = ball(DVec3::Z * 100.0, 1.0);
    let caster = caster_at(ball.center - DVec3::Z * p + toward * 5.0, radius, toward);
    let cell = Cell {
        middle: DVec3::Z,
        size: [0.025; 2],
        is_transposed: false,
    };
    let lines = crossings(&cell, &ball, &caster, [0.0; 8]);
    let expected = [(-1.0, second), (-1.0, first), (1.0, first), (1.0, second)];
    for line in lines {
        assert_eq!(line.len(), 4);
        for (index, (&(x, rises), (side, cos))) in line.iter().zip(expected).enumerate() {
            let sin = side * f64::sqrt(1.0 - cos * cos);
            let (place, _) = cell.place(ball.center + DVec3::new(sin, 0.0, -cos));
            assert!((x - place).abs() < 1e-12, "{x} instead of {place}");
            assert_eq!(rises, index % 2 == 1);
        }
    }
}

/// A small ball before a large one, lit along the view: its shadow is a disc.
#[test]
fn a_shadow_in_the_middle_is_entered_and_left() {
    let ball = ball(DVec3::Z * 10.0, 1.0);
    let caster = caster_at(DVec3::Z * 8.0, 0.3, DVec3::NEG_Z);
    for is_transposed in [false, true] {
        let cell = Cell {
            middle: DVec3::Z,
            size: [0.3; 2],
            is_transposed,
        };
        let point = ball.center + DVec3::new(0.3, 0.0, -f64::sqrt(1.0 - 0.09));
        let expected = point.x / point.z / 0.3;
        for line in crossings(&cell, &ball, &caster, [0.0; 8]) {
            let [(enters, false), (leaves, true)] = line[..] else {
                panic!("{line:?}")
            };
            assert!((enters + expected).abs() < 1e-12 && (leaves - expected).abs() < 1e-12);
        }
    }
}

#[test]
fn neither_wholly_lit_nor_wholly_dark_lines_are_crossed() {
    let ball = ball(DVec3::Z * 10.0, 1.0);
    let cell = Cell {
        middle: DVec3::Z,
        size: [0.3; 2],
        is_transposed: false,
    };
    let y = [-0.4, -0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3];
    for (aside, radius) in [(0.0, 1.5), (3.0, 1.5), (1e3, 900.0), (0.9e3, 1e3)] {
        let center = ball.center + DVec3::new(aside, 5.0, 0.0);
        let caster = caster_at(center, radius, DVec3::Y);
        let lines = crossings(&cell, &ball, &caster, y);
        assert!(lines.iter().all(Vec::is_empty), "{aside}: {lines:?}");
    }
}

#[test]
fn lines_that_miss_the_sphere_see_no_shadow() {
    let ball = ball(DVec3::Z * 10.0, 1.0);
    let caster = caster_at(DVec3::Z * 8.0, 0.3, DVec3::NEG_Z);
    let cell = Cell {
        middle: DVec3::new(0.0, 0.5, 1.0),
        size: [0.3; 2],
        is_transposed: false,
    };
    let lines = crossings(
        &cell,
        &ball,
        &caster,
        [-0.5, 0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.5],
    );
    assert!(lines.iter().all(Vec::is_empty));
}
