//! Tests of `fractional.rs`.

use crate::edges::tests::{ball_in_front, cell_at, direction, first_hit, magnitude, ray};
use crate::exact::edged::boundary::lit_sphere::{Checked, LitSphere};
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
