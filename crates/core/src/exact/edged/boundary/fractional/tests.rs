//! Tests of `fractional.rs`.

use glam::DVec3;

use crate::edges::tests::{ball_in_front, cell_at, direction, first_hit, magnitude, ray};
use crate::exact::edged::boundary::lit_sphere::{Checked, LitSphere};
use crate::light::near_light::NearLight;
use crate::model::color::Color;
use crate::model::light::{LightFalloff, PointLight};
use crate::search::tests::Random;

#[test]
fn powers_are_summed_up_along_chords() {
    let mut random = Random(5);
    let mut all = Checked::default();
    for case in 0..100 {
        let exponent = [0.02, 0.1, 0.5, 0.9, 1.3, 2.6, 5.5][case % 7];
        let ball = ball_in_front(&mut random);
        let widths = magnitude(&mut random, 1e-2, 2.0);
        let mut cell = cell_at(&mut random, &ball, widths);
        cell.middle += direction(&mut random).with_z(0.0) * (0.9 * ball.radius / ball.center.z);
        // Its terminator passes near the middle of the cell.
        let mut toward = direction(&mut random);
        if let Some(point) = first_hit(ray(&cell, 0.0, 0.0), &ball) {
            let normal = (point - ball.center) / ball.radius;
            let aside = 0.5 * random.number() * cell.size[0] * point.z / ball.radius;
            toward = (toward - normal * (toward.dot(normal) + aside)).normalize();
        }
        let sphere = LitSphere {
            cell,
            ball,
            exponent,
            toward,
            near: None,
            is_to_right: case % 2 == 1,
        };
        all.add(sphere.check(false, |point| {
            let cosine = toward.dot(point - ball.center) / ball.radius;
            libm::pow(cosine.max(0.0), exponent)
        }));
    }
    assert!(all.chords > 200 && all.partly > 30, "{all:?}");
    assert!(all.doubt < 1e-7, "{all:?}");
}

/// The terminators pass behind the contours: powers of n·l begin at roots on the far sides, near the ends of chords.
#[test]
fn powers_under_lamps_are_summed_up_to_contours() {
    let mut random = Random(6);
    let mut all = Checked::default();
    for case in 0..100 {
        let exponent = [0.1, 0.5, 0.9, 1.3, 2.6][case % 5];
        let ball = ball_in_front(&mut random);
        let widths = magnitude(&mut random, 1e-2, 1.0);
        let mut cell = cell_at(&mut random, &ball, widths);
        let aside = direction(&mut random).with_z(0.0).normalize();
        let share = ball.radius / (ball.center.length_squared() - ball.radius * ball.radius).sqrt();
        cell.middle += aside * (share * (1.0 - 0.3 * random.number() * widths));
        let Some(point) = first_hit(ray(&cell, 0.0, 0.0), &ball) else {
            continue;
        };
        // Light of the lamp comes from above the contour, more or less from where the eye is.
        let normal = (point - ball.center) / ball.radius;
        let back = -point.normalize();
        let way = (back + normal * (0.5 * random.number())).normalize();
        let lamp = point + way * (ball.radius * magnitude(&mut random, 2.0, 50.0));
        let light = PointLight::new(lamp, Color::ONE, LightFalloff::InverseSquare, ball.radius);
        let sphere = LitSphere {
            cell,
            ball,
            exponent,
            toward: DVec3::Z,
            near: Some(NearLight::new(&light.unwrap(), lamp, None)),
            is_to_right: case % 2 == 1,
        };
        all.add(sphere.check(false, |point| {
            let way = lamp - point;
            let cosine = way.normalize().dot(point - ball.center) / ball.radius;
            let fall = ball.radius * ball.radius / way.length_squared();
            libm::pow(cosine.max(0.0), exponent) * fall
        }));
    }
    assert!(all.chords > 200, "{all:?}");
    assert!(all.doubt < 1e-6, "{all:?}");
}
