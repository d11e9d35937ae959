//! Tests of `terminator.rs`.

use super::*;
use crate::edges::tests::{ball_in_front, cell_at, direction, ray, zeros};
use crate::search::tests::Random;

/// The plane n·l = 0 is met where the sphere is: at distance r from its center.
#[test]
fn light_grazes_where_the_terminator_is() {
    let mut random = Random(1);
    let mut checked = 0;
    for _ in 0..2000 {
        let ball = ball_in_front(&mut random);
        let cell = cell_at(&mut random, &ball, 3.0);
        let toward = direction(&mut random);
        for (x, y) in zeros(&mut random, &terminator(&cell, &ball, toward)) {
            let d = ray(&cell, x, y).normalize();
            // In such a plane the ray lies almost, and where it meets it says little.
            if d.dot(toward).abs() < 0.01 {
                continue;
            }
            let point = d * (ball.center.dot(toward) / d.dot(toward));
            let off = (point - ball.center).length() / ball.radius - 1.0;
            let rounding = ball.center.length() / ball.radius;
            assert!(
                off.abs() < 1e-11 * rounding,
                "{off:e} of {ball:?}, {toward}"
            );
            checked += 1;
        }
    }
    assert!(checked > 5000, "{checked}");
}

/// Light from the eye's side along the ray to the center: half of the sphere, a circle.
#[test]
fn light_from_behind_the_eye_has_a_circle_for_its_terminator() {
    let ball = Ball {
        center: DVec3::Z * 4.0,
        radius: 1.0,
        outside: 15.0,
        projection: crate::model::camera::Projection::Central,
    };
    let cell = Cell {
        middle: DVec3::Z,
        size: [1.0; 2],
        projection: crate::model::camera::Projection::Central,
    };
    let circle = terminator(&cell, &ball, DVec3::NEG_Z);
    let [rising, falling] = super::super::tests::crossings(&circle, [0.0; 8]);
    for x in [rising[0], falling[0]] {
        assert!((x.abs() - 0.25).abs() < 1e-15, "{x}");
    }
    assert!(circle.xy.abs() < 1e-15 && (circle.xx - circle.yy).abs() < 1e-15);
}
