//! The points of seams lie on both spheres.

use super::*;
use crate::edges::tests::{
    ball, ball_in_front, cell_at, crossings, direction, magnitude, place, ray, value, zeros,
};
use crate::search::tests::Random;

/// A ball that intersects another one.
fn across(random: &mut Random, one: &Ball) -> Ball {
    let radius = one.radius * magnitude(random, 0.2, 5.0);
    let (low, high) = ((one.radius - radius).abs(), one.radius + radius);
    let apart = low + (high - low) * (0.1 + 0.8 * random.number());
    ball(one.center + direction(random) * apart, radius)
}

#[test]
fn points_of_a_seam_lie_on_both_spheres() {
    let mut random = Random(1);
    let mut checked = 0;
    for _ in 0..3000 {
        let one = ball_in_front(&mut random);
        let other = across(&mut random, &one);
        if other.outside <= 0.0 {
            continue;
        }
        let cell = cell_at(&mut random, &one, 3.0);
        for (x, y) in zeros(&mut random, &SeamPlane::new(&one, &other).seen(&cell)) {
            // Where the ray meets the plane of the seam.
            let d = ray(&cell, x, y).normalize();
            let between = one.center - other.center;
            let w = between.normalize();
            if d.dot(w).abs() < 0.01 {
                continue;
            }
            let from_one =
                (other.radius * other.radius - one.radius * one.radius - between.length_squared())
                    / (2.0 * between.length());
            let point = d * ((one.center.dot(w) + from_one) / d.dot(w));
            for ball in [&one, &other] {
                let off = (point - ball.center).length() / ball.radius - 1.0;
                let smallest = one.radius.min(other.radius);
                let rounding = (one.center.length() + other.center.length()) / smallest;
                assert!(off.abs() < 1e-11 * rounding, "{off:e}: {one:?}, {other:?}");
            }
            checked += 1;
        }
    }
    assert!(checked > 3000, "{checked}");
}

#[test]
fn either_sphere_may_come_first() {
    let mut random = Random(2);
    for _ in 0..500 {
        let one = ball_in_front(&mut random);
        let other = across(&mut random, &one);
        let cell = cell_at(&mut random, &one, 3.0);
        let seen = |one, other| SeamPlane::new(one, other).seen(&cell);
        assert_eq!(seen(&one, &other), seen(&other, &one));
    }
}

/// A ball sunk by half into a floor like the earth's: the circle is known.
#[test]
fn a_huge_floor_cuts_a_small_ball_in_its_circle() {
    for floor_radius in [1e3, 1e6, 1e9] {
        let small = ball(DVec3::new(0.5, -0.5, 8.0), 1.0);
        let distance = floor_radius + 0.5;
        let floor = ball(small.center - DVec3::Y * distance, floor_radius);
        // The center lies below by the radius and 1: K as the world computes it, exactly.
        let floor = Ball {
            outside: 64.25 + 2.0 * floor_radius + 1.0,
            power: 64.25 + 2.0 * floor_radius + 1.0,
            ..floor
        };
        let height =
            ((floor_radius - distance) * (floor_radius + distance) - 1.0) / (2.0 * distance);
        let radius = (1.0 - height * height).sqrt();
        let cell = Cell {
            middle: small.center / 8.0,
            size: [0.4; 2],
            projection: crate::model::camera::Projection::Central,
        };
        let seam = SeamPlane::new(&floor, &small).seen(&cell);
        for step in 0..40 {
            let (sin, cos) = (0.157 * f64::from(step) + 0.1).sin_cos();
            let point = small.center + DVec3::new(cos * radius, height, sin * radius);
            let (x, y) = place(&cell, point);
            let found = crossings(&seam, [y; 8]);
            let off = (found[0][0] - x).abs().min((found[1][0] - x).abs());
            // Near the ends of the circle rounding moves a crossing by its root.
            let (value, terms) = value(&seam, x, y);
            let is_near = off < 1e-9 || value.abs() < 1e-12 * terms;
            assert!(
                is_near,
                "radius {floor_radius:e}: off by {off:e} at step {step}"
            );
        }
    }
}

/// For an eye near a sphere and one far from it there are two formulas.
#[test]
fn both_forms_of_a_plane_agree() {
    let mut random = Random(3);
    let mut near = 0;
    for _ in 0..1000 {
        let ball = ball_in_front(&mut random);
        let cell = cell_at(&mut random, &ball, 2.0);
        let w = direction(&mut random);
        let offset = ball.radius * (random.number() - 0.5);
        let m = ball.center.dot(w) + offset;
        let (along, q) = (cell.dot(ball.center), cell.dot(w));
        let plain = cell.ray_sq() * (m * m) - along * q * (2.0 * m) + q * q * ball.outside;
        let difference = plane_cut(&cell, &ball, w, offset) - plain;
        let scale = cell.ray_sq().one * (ball.center.length_squared() + ball.radius * ball.radius);
        assert!(difference.one.abs() + difference.spread() < 1e-12 * scale);
        near += u32::from(!ball.is_apart());
    }
    assert!((10..990).contains(&near), "{near}");
}
