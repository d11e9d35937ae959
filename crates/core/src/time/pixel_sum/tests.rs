//! Tests of `pixel_sum.rs`.

use super::*;
use crate::time::panel::MOMENTS;

#[test]
fn what_is_claimed_is_of_area_and_of_time() {
    let panel = Panel { level: 0, index: 0 };
    let first = FirstPanels {
        level: 0,
        missed: 2e-4,
        is_fine: true,
    };
    for (is_fine, expected) in [(true, Status::Met), (false, Status::OutOfBudget)] {
        let mut sum = PixelSum::new(FirstPanels { is_fine, ..first }, 1.5);
        let pixel = Pixel {
            value: Color::splat(0.5),
            alpha: 1.0,
            error: 1e-4,
            evidence: Evidence::Estimate,
            status: Status::Met,
        };
        sum.add(Part::new(panel, &[pixel; MOMENTS]));
        sum.halve(1e-3, |panel| panic!("{panel:?} is not needed"));
        let found = sum.pixel(1e-3);
        assert_eq!((found.value.x, found.status), (0.5, expected));
        assert!((found.error - 4e-4).abs() < 1e-15, "{:e}", found.error);
    }
}
