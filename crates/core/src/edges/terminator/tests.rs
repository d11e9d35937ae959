//! Tests of `terminator.rs`.

use super::*;
use crate::edges::tests::{ball_in_front, cell_at, direction, ray, zeros};
use crate::search::tests::Random;

/// The plane n·l = 0 of a far light, and that of a point light, is met where the sphere is: at distance r from its
/// center.
#[test]
fn light_grazes_where_the_terminator_is() {
    let mut random = Random(1);
    let mut checked = 0;
    for _ in 0..2000 {
        let ball = ball_in_front(&mut random);
        let cell = cell_at(&mut random, &ball, 3.0);
        let toward = direction(&mut random);
        let distance = ball.radius * (1.0 + 3.0 * random.number());
        let plane = match random.number() < 0.5 {
            true => Plane::of_near_light(toward * distance, ball.radius).unwrap(),
            false => far(toward),
        };
        for (x, y) in zeros(&mut random, &terminator(&cell, &ball, &plane)) {
            let d = ray(&cell, x, y).normalize();
            // In such a plane the ray lies almost, and where it meets it says little.
            if d.dot(toward).abs() < 0.01 {
                continue;
            }
            let point = d * ((ball.center.dot(toward) + plane.offset) / d.dot(toward));
            let off = (point - ball.center).length() / ball.radius - 1.0;
            let rounding = ball.center.length() / ball.radius;
            assert!(
                off.abs() < 1e-11 * rounding,
                "{off:e} of {ball:?}, {plane:?}"
            );
            checked += 1;
        }
    }
    assert!(checked > 5000, "{checked}");
}

/// The plane of a directional light.
fn far(toward: DVec3) -> Plane {
    Plane {
        axis: toward,
        offset: 0.0,
    }
}

/// A point light grazes a sphere where the ways to it and to the center are at right angles.
#[test]
fn a_near_light_grazes_along_tangents() {
    let (light, radius) = (DVec3::new(0.0, 0.0, -2.5), 1.5);
    let plane = Plane::of_near_light(light, radius).unwrap();
    let aside = (radius * radius - plane.offset * plane.offset).sqrt();
    let point = plane.axis * plane.offset + DVec3::X * aside;
    assert!(point.dot(light - point).abs() < 1e-15);
    assert_eq!(Plane::of_near_light(light, 2.5), None);
}

/// Light from the eye's side along the ray to the center: half of the sphere, a circle.
#[test]
fn light_from_behind_the_eye_has_a_circle_for_its_terminator() {
    let ball = Ball {
        center: DVec3::Z * 4.0,
        radius: 1.0,
        outside: 15.0,
        power: 15.0,
        projection: crate::model::camera::Projection::Central,
    };
    let cell = Cell {
        middle: DVec3::Z,
        size: [1.0; 2],
        projection: crate::model::camera::Projection::Central,
    };
    let circle = terminator(&cell, &ball, &far(DVec3::NEG_Z));
    let [rising, falling] = super::super::tests::crossings(&circle, [0.0; 8]);
    for x in [rising[0], falling[0]] {
        assert!((x.abs() - 0.25).abs() < 1e-15, "{x}");
    }
    assert!(circle.xy.abs() < 1e-15 && (circle.xx - circle.yy).abs() < 1e-15);
}
