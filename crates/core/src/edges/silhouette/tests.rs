//! Rays at contours touch, whatever the size and distance of the sphere.

use glam::DVec3;

use super::*;
use crate::edges::tests::{any_cell, ball, ball_in_front, cell_at, magnitude, ray, value, zeros};
use crate::search::tests::Random;

/// The distance of the ray from the ball's center, in radii.
fn distance(ray: DVec3, ball: &Ball) -> f64 {
    ray.cross(ball.center).length() / ray.length() / ball.radius
}

#[test]
fn rays_at_the_contour_touch_the_sphere() {
    let mut random = Random(1);
    let (mut apart, mut near) = (0, 0);
    for _ in 0..2000 {
        let ball = ball_in_front(&mut random);
        let cell = cell_at(&mut random, &ball, 3.0);
        for (x, y) in zeros(&mut random, &silhouette(&cell, &ball)) {
            let off = (distance(ray(&cell, x, y), &ball) - 1.0).abs();
            let rounding = ball.center.length() / ball.radius;
            assert!(
                off < 1e-13 * (1.0 + rounding),
                "{off:e} of {ball:?} in {cell:?}"
            );
            *(if ball.is_apart() {
                &mut apart
            } else {
                &mut near
            }) += 1;
        }
    }
    assert!(apart > 5000 && near > 100, "{apart} {near}");
}

/// A marble as far away as a million of its radii: plain B² − A K would be off by a tenth of r².
#[test]
fn far_and_small_spheres_keep_their_contour() {
    // Everything is a whole number of 2⁻³⁰ in the directions, so that integers know the answer.
    const UNIT: f64 = (1_u64 << 30) as f64;
    let center = [300_001_i128, -200_003, 1_000_003];
    let ball = ball(DVec3::from_array(center.map(|part| part as f64)), 1.0);
    let [u, v] = [0, 1].map(|axis| (UNIT * ball.center[axis] / ball.center.z).round());
    let half = 1024_i128;
    let cell = Cell {
        middle: DVec3::new(u / UNIT, v / UNIT, 1.0),
        size: [2.0 * half as f64 / UNIT; 2],
        projection: crate::model::camera::Projection::Central,
    };
    let contour = silhouette(&cell, &ball);
    for row in (-half..=half).step_by(128) {
        for col in (-half..=half).step_by(128) {
            let d = [u as i128 + col, v as i128 + row, 1 << 30];
            let [a, b, c] = [(1, 2), (2, 0), (0, 1)]
                .map(|(i, j): (usize, usize)| d[i] * center[j] - d[j] * center[i]);
            let ray_sq = d.iter().map(|part| part * part).sum::<i128>();
            let exact = (ray_sq - (a * a + b * b + c * c)) as f64 / ray_sq as f64;
            let place = [col, row].map(|offset| 0.5 * offset as f64 / half as f64);
            let (found, _) = value(&contour, place[0], place[1]);
            let found = found / (ray_sq as f64 / UNIT / UNIT);
            assert!((found - exact).abs() < 1e-9, "{found} instead of {exact}");
        }
    }
}

#[test]
fn both_forms_agree() {
    let mut random = Random(2);
    for _ in 0..1000 {
        let cell = any_cell(&mut random);
        let ball = ball(random.point() * 3.0, magnitude(&mut random, 0.1, 3.0));
        let along = cell.dot(ball.center);
        let plain = along * along - cell.ray_sq() * ball.outside;
        let difference = silhouette(&cell, &ball) - plain;
        let scale = cell.ray_sq().one + cell.ray_sq().spread();
        let scale = scale * (ball.center.length_squared() + ball.radius * ball.radius);
        assert!(
            difference.one.abs() + difference.spread() < 1e-13 * scale,
            "{ball:?} {cell:?}"
        );
    }
}

#[test]
fn from_inside_a_sphere_has_no_contour() {
    let mut random = Random(3);
    for _ in 0..500 {
        let cell = any_cell(&mut random);
        let ball = ball(random.point() * 0.5, 1.0);
        let contour = silhouette(&cell, &ball);
        for (x, y) in [(0.0, 0.0), (-0.5, 0.5), (0.5, 0.5), (0.1, -0.5)] {
            assert!(value(&contour, x, y).0 > 0.0);
        }
    }
}
