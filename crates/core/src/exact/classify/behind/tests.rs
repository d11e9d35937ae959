//! The spheres that covers are said to hide, against rays through many points of cells.

use glam::DVec3;

use super::*;
use crate::edges::tests::{ball, cell_at, coordinate, magnitude, ray};
use crate::model::camera::Projection;
use crate::search::tests::Random;

/// A ray of a cell: where it begins, and its direction.
fn ray_of(cell: &Cell, x: f64, y: f64) -> (DVec3, DVec3) {
    let through = ray(cell, x, y);
    match cell.projection {
        Projection::Central => (DVec3::ZERO, through.normalize()),
        Projection::Parallel => (through.with_z(0.0), DVec3::Z),
    }
}

/// The distance along a ray at which it meets the near side of a ball.
fn near_side((origin, direction): (DVec3, DVec3), ball: &Ball) -> Option<f64> {
    let to_center = ball.center - origin;
    let along = to_center.dot(direction);
    let aside_sq = (to_center - direction * along).length_squared();
    let half_chord_sq = ball.radius * ball.radius - aside_sq;
    let place = along - half_chord_sq.max(0.0).sqrt();
    (half_chord_sq >= 0.0 && place > 0.0).then_some(place)
}

/// A cell, and spheres that overlap in front of it.
fn crowd(random: &mut Random, projection: Projection) -> (Cell, Vec<(usize, Ball)>) {
    let middle = (random.point() * 2.0 + DVec3::Z * 10.0) * magnitude(random, 0.01, 100.0);
    let radius = middle.length() * magnitude(random, 0.003, 0.5);
    let spread = radius * magnitude(random, 1e-3, 2.0);
    let of_one = |place: usize, random: &mut Random| {
        let center = middle + random.point() * spread;
        let radius = radius * (0.7 + 0.6 * random.number());
        let mut one = ball(center, radius.min(0.9 * center.length()));
        one.projection = projection;
        if projection == Projection::Parallel {
            one.outside = if center.z > one.radius { center.z } else { 0.0 };
        }
        (place, one)
    };
    let spheres: Vec<_> = (0..24).map(|place| of_one(place, random)).collect();
    let widths = magnitude(random, 1e-4, 1.0);
    let mut cell = cell_at(random, &spheres[0].1, widths);
    if projection == Projection::Parallel {
        cell.middle *= spheres[0].1.center.z;
        cell.size = cell.size.map(|side| side * spheres[0].1.center.z);
        cell.projection = projection;
    }
    (cell, spheres)
}

#[test]
fn what_a_cover_hides_is_behind_it_on_all_rays() {
    let mut random = Random(7);
    for projection in [Projection::Central, Projection::Parallel] {
        let (mut covers, mut hidden, mut left) = (0, 0, 0);
        for _ in 0..3000 {
            let (cell, spheres) = crowd(&mut random, projection);
            let Some(cover) = Cover::of(&cell, &spheres) else {
                continue;
            };
            covers += 1;
            let rays: Vec<_> = (0..20)
                .map(|_| {
                    // Corners and sides, too.
                    let mut at = || (1.3 * coordinate(&mut random)).clamp(-0.5, 0.5);
                    ray_of(&cell, at(), at())
                })
                .collect();
            for (_, ball) in &spheres {
                let along = cell.along(ball.center);
                if !cover.hides(ball, &silhouette(&cell, ball), &along) {
                    left += 1;
                    continue;
                }
                hidden += 1;
                for ray in &rays {
                    let front = near_side(*ray, &cover.ball);
                    assert!(front.is_some(), "{cell:?} {cover:?}");
                    let behind = near_side(*ray, ball).unwrap_or(f64::INFINITY);
                    assert!(
                        front.is_some_and(|front| front < behind),
                        "{ball:?} {cover:?}"
                    );
                }
            }
        }
        assert!(covers > 1000, "{covers}");
        assert!(hidden > 10_000 && left > 1000, "{hidden} {left}");
    }
}

#[test]
fn a_cover_hides_neither_itself_nor_what_is_as_near() {
    let cell = Cell {
        middle: DVec3::Z,
        size: [0.01; 2],
        projection: Projection::Central,
    };
    let twins = vec![(0, ball(DVec3::Z * 10.0, 3.0)); FEWEST];
    let cover = Cover::of(&cell, &twins).unwrap();
    let along = cell.along(twins[0].1.center);
    assert!(!cover.hides(&twins[0].1, &silhouette(&cell, &twins[0].1), &along));
    // Nor are few asked.
    assert!(Cover::of(&cell, &twins[1..]).is_none());
    // What the eye is inside of covers nothing.
    let around = vec![(0, ball(DVec3::Z, 3.0)); FEWEST];
    assert!(Cover::of(&cell, &around).is_none());
}
