//! Tests of `results.rs`.

use super::*;

#[test]
fn the_worst_pixel_does_not_depend_on_the_order_of_strips() {
    let pixel = |col, row, error| Results {
        worst: Some(WorstPixel { col, row, error }),
        clipped: 1,
        ..Results::default()
    };
    let parts = [
        pixel(9, 0, 2e-3),
        pixel(3, 4, 5e-3),
        pixel(1, 5, 5e-3),
        Results::default(),
        pixel(0, 5, 5e-3),
    ];
    for first in 0..parts.len() {
        let mut sum = Results::default();
        for step in 0..parts.len() {
            sum.add(&parts[(first + 2 * step) % parts.len()]);
        }
        assert_eq!(
            sum,
            Results {
                clipped: 4,
                ..parts[2]
            }
        );
    }
}
