//! Tests of `cutoffs.rs`.

use glam::{DMat3, DVec3};

use crate::edges::tests::{ball_in_front, cell_at, direction, first_hit, magnitude, ray};
use crate::exact::edged::boundary::lit_sphere::{Checked, LitSphere};
use crate::light::lobe::Lobe;
use crate::light::near_light::NearLight;
use crate::model::color::Color;
use crate::model::emission::Emission;
use crate::model::light::{LightFalloff, PointLight};
use crate::search::tests::Random;

#[test]
fn light_of_lamps_is_summed_up_along_chords() {
    let mut random = Random(7);
    let mut all = Checked::default();
    for case in 0..120 {
        let mu = [0.01, 0.1, 0.3, 0.5, 0.9, 1.3, 2.6, 5.5][case % 8];
        let exponent = [1.0, 1.0, 0.6][case % 3];
        let ball = ball_in_front(&mut random);
        let widths = magnitude(&mut random, 1e-2, 1.0);
        let mut cell = cell_at(&mut random, &ball, widths);
        cell.middle += direction(&mut random).with_z(0.0) * (0.9 * ball.radius / ball.center.z);
        let Some(point) = first_hit(ray(&cell, 0.0, 0.0), &ball) else {
            continue;
        };
        // Its plane passes near the middle of the cell.
        let normal = (point - ball.center) / ball.radius;
        let way = (normal * 1.5 + direction(&mut random)).normalize() * (3.0 * ball.radius);
        let facing = direction(&mut random).cross(way).normalize();
        let aside = 0.5 * random.number() * cell.size[0] * point.z;
        let lamp = point + way + facing * aside;
        let falloff = LightFalloff::InverseSquare;
        let light = PointLight::new(lamp, Color::ONE, falloff, ball.radius).unwrap();
        let lobe = Lobe::new(&Emission::new(facing, mu).unwrap(), &DMat3::IDENTITY);
        let sphere = LitSphere {
            cell,
            ball,
            exponent,
            toward: DVec3::Z,
            near: Some(NearLight::new(&light, lamp, Some(lobe))),
            is_to_right: case % 2 == 1,
        };
        all.add(sphere.check(true, |point| {
            let way = lamp - point;
            let toward = way.normalize();
            let cosine = toward.dot(point - ball.center) / ball.radius;
            // Whole powers go on where the surface turns away.
            let diffuse = match exponent {
                1.0 => cosine,
                _ => libm::pow(cosine.max(0.0), exponent),
            };
            let ahead = (-toward.dot(facing)).max(0.0);
            let fall = ball.radius * ball.radius / way.length_squared();
            diffuse * libm::pow(ahead, mu) * fall
        }));
    }
    assert!(all.chords > 200 && all.partly > 30, "{all:?}");
    assert!(all.doubt < 1e-5, "{all:?}");
}
