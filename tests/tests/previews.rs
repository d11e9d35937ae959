//! Tolerances so large that samples meet them.

use glam::DVec3;
use marbles_core::{Color, Image, World};

use crate::studio::{exact_picture, looking_forward, pixels, world_of};

const SIDE: u32 = 24;

/// Balls at random positions that fill the picture; their radius in pixels is about this.
fn crowd(count: u32, radius: f64) -> World {
    let mut state = u64::from(count);
    let mut random = || {
        // Knuth's linear congruence, of which the upper bits are good.
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let side = f64::from(SIDE);
    let balls: Vec<_> = (0..count)
        .map(|_| {
            let center = DVec3::new(side * random(), side * random(), 100.0 + side * random());
            (center, radius, Color::ONE)
        })
        .collect();
    world_of(&balls, &[DVec3::new(-1.0, 1.0, -1.0)])
}

/// The largest difference of two pictures.
fn apart(one: &Image, other: &Image) -> f64 {
    let differences = pixels(one).flat_map(|(col, row)| {
        let [one, other] = [one, other].map(|image| image.rgba(col, row));
        [0, 1, 2].map(|channel| (one[channel] - other[channel]).abs())
    });
    differences.fold(0.0, f64::max)
}

#[test]
fn parts_of_the_contrast_are_met() {
    let view = looking_forward(SIDE, SIDE, 100.0);
    for (count, radius) in [(1000, 0.7), (1000, 1.5), (100, 3.0)] {
        let world = crowd(count, radius);
        let truth = exact_picture(&world, &view, 1e-5, false);
        for tolerance in [0.9, 0.5, 0.3, 0.2] {
            let image = exact_picture(&world, &view, tolerance, false);
            let summary = image.summary();
            assert_eq!(summary.over_tolerance, 0);
            assert!(
                summary.largest_error <= tolerance,
                "{}",
                summary.largest_error
            );
            let apart = apart(&image, &truth);
            assert!(apart < 0.6 * tolerance, "{count} at {tolerance}: {apart}");
        }
    }
}
