//! Tests of `jumps.rs`.

use fearless_simd::{Level, dispatch};
use glam::DVec2;

use super::*;
use crate::edges::silhouette::silhouette;
use crate::exact::edged::boundary::chord::Reference;
use crate::exact::edged::boundary::primitive::ray;
use crate::exact::edged::rule::RULE;
use crate::exact::points::Points;
use crate::model::camera::Projection;
use crate::model::material::{Grain, Roughness};
use crate::numeric::lanes::f64x8;

/// Rules for the squares of distances on one side of a place.
#[test]
fn rules_miss_no_more_of_jumps() {
    let mut worst = 0.0_f64;
    for place in 0..1000 {
        let place = f64::from(place) / 1000.0;
        let light = |at: f64| (at - place).max(0.0) * (at - place).max(0.0);
        let nodes = RULE.nodes.iter().zip(&RULE.fine);
        let sum: f64 = nodes.map(|(&node, weight)| weight * light(node)).sum();
        let exact = light(1.0) * (1.0 - place) / 3.0;
        worst = worst.max(0.5 * (sum - exact).abs());
    }
    assert!(worst <= OF_JUMP && worst > 0.9 * OF_JUMP, "{worst:e}");
}

/// A cell that sees a part of a ball, and chords on one of its lines from a side to the other, or to the contour.
fn passages(cell: &Cell, ball: &Ball, bumps: &Bumps) -> Option<[Vec<(usize, f64)>; 2]> {
    const STEPS: u32 = 4000;
    const Y: f64 = 0.1;
    let frame = DMat3::from_rotation_y(0.7) * DMat3::from_rotation_x(-0.4);
    let q = silhouette(cell, ball);
    let [falling, rising] = q.crossings(Y);
    let (left, right) = (falling.min(rising).max(-0.5), falling.max(rising).min(0.5));
    let there = 0.5 * (left + right);
    let seen = (q.xx * there + q.xy * Y + q.x) * there + (q.yy * Y + q.y) * Y + q.one;
    if left >= right || seen <= 0.0 {
        return None;
    }
    dispatch!(Level::new(), simd => {
        let lanes = |value: f64| f64x8::splat(simd, value);
        let chord = Chord::new(simd, &q, &Reference::upright(left), lanes(right), lanes(Y));
        let way = Way::new(simd, (cell, ball), &frame, &chord, lanes(Y));
        let mut found = Vec::new();
        way.passages(bumps, &mut found);
        let found = found.iter().filter(|passage| passage.lane == 3);
        let found = found.map(|passage| (passage.axis, passage.sigma)).collect();
        let mut met = Vec::new();
        let mut before = None;
        for step in 0..=STEPS {
            let sigma = f64::from(step) / f64::from(STEPS) * 2.0 - 1.0;
            let (x, _) = chord.at(lanes(sigma));
            let points = Points::new(simd, ball, ray(simd, cell, x, lanes(Y)));
            let place = (frame * points.normal.lane(0)) * bumps.cells();
            let here = place.round();
            if let Some(before) = before.replace(here) {
                for axis in (0..3).filter(|&axis| here[axis] != before[axis]) {
                    met.push((axis, sigma));
                }
            }
        }
        Some([found, met])
    })
}

/// Places where points of chords, found one by one, lie in other cells than those before.
#[test]
fn chords_pass_where_their_points_do() {
    const CLOSE: f64 = 1e-3;
    let (mut chords, mut passed) = (0, 0);
    for projection in [Projection::Central, Projection::Parallel] {
        for place in 0..60 {
            let place = f64::from(place) / 30.0 - 1.0;
            let center = DVec3::new(0.2, -0.1, 1.3);
            let radius = 0.5;
            let middle = center.truncate() / 1.3 + DVec2::new(0.55, 0.4) * (place * radius);
            let cell = Cell {
                middle: middle.extend(1.0),
                size: [0.05; 2],
                projection,
            };
            let ball = Ball {
                center,
                radius,
                outside: center.length_squared() - radius * radius,
                power: center.length_squared() - radius * radius,
                projection,
            };
            for size in [0.02, 0.1] {
                let grain = Roughness {
                    amplitude: 0.5,
                    grain: Grain::Surface(size),
                    seed: 1,
                };
                let bumps = grain.bumps(radius, 0).unwrap();
                let Some([mut found, mut met]) = passages(&cell, &ball, &bumps) else {
                    continue;
                };
                chords += 1;
                passed += met.len();
                let order = |one: &(usize, f64), other: &(usize, f64)| {
                    one.0.cmp(&other.0).then(one.1.total_cmp(&other.1))
                };
                found.sort_by(order);
                met.sort_by(order);
                assert_eq!(found.len(), met.len(), "{place} {size}: {found:?} {met:?}");
                for (found, met) in found.iter().zip(&met) {
                    assert_eq!(found.0, met.0);
                    assert!((found.1 - met.1).abs() < CLOSE, "{found:?} {met:?}");
                }
            }
        }
    }
    assert!(chords > 150 && passed > 200, "{chords} {passed}");
}
