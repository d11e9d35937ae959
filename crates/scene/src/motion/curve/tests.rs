use super::*;

fn curve(keys: &[(i32, f64, Ease)]) -> Curve {
    let keys = keys
        .iter()
        .map(|&(frame, value, ease)| CurveKey::new(frame, value, ease))
        .collect();
    Curve::new(7.0, keys)
}

/// The slope of a curve just before and just after a time.
fn slopes(curve: &Curve, time: f64) -> (f64, f64) {
    const STEP: f64 = 1e-6;
    let here = curve.at(time);
    (
        (here - curve.at(time - STEP)) / STEP,
        (curve.at(time + STEP) - here) / STEP,
    )
}

/// A linear congruential generator, with Knuth's constants for MMIX.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    /// Keys with values that are often equal, and now and then enormous or tiny.
    fn keys(&mut self) -> Vec<(i32, f64, Ease)> {
        let mut frame = self.next() as i32 % 1000 - 500;
        let sizes = [1.0, 1.0, 1e-320, 1e-9, 1e9, 1.5e307];
        let count = 1 + self.next() % 8;
        (0..count)
            .map(|_| {
                frame += 1 + (self.next() % 40) as i32;
                let value = (self.next() % 21) as f64 - 10.0;
                let size = sizes[self.next() as usize % sizes.len()];
                let ease = [Ease::Smooth, Ease::Smooth, Ease::Linear, Ease::Hold];
                (frame, value * size, ease[self.next() as usize % 4])
            })
            .collect()
    }
}

#[test]
fn no_keys_leave_the_value_at_rest() {
    assert_eq!(curve(&[]).at(-3.0), 7.0);
    assert_eq!(curve(&[]).at(1e9), 7.0);
}

#[test]
fn ends_are_held() {
    let curve = curve(&[(10, 1.0, Ease::Linear), (20, 3.0, Ease::Linear)]);
    for (time, value) in [
        (f64::from(i32::MIN), 1.0),
        (9.0, 1.0),
        (21.0, 3.0),
        (1e9, 3.0),
    ] {
        assert_eq!(curve.at(time), value);
    }
}

#[test]
fn linear_is_a_line_and_hold_jumps() {
    let curve = curve(&[
        (0, 0.0, Ease::Linear),
        (10, 5.0, Ease::Hold),
        (20, 1.0, Ease::Linear),
    ]);
    assert_eq!(curve.at(4.0), 2.0);
    assert_eq!(curve.at(10.0), 5.0);
    assert_eq!(curve.at(19.999), 5.0);
    assert_eq!(curve.at(20.0), 1.0);
}

#[test]
fn smooth_between_two_keys_starts_and_ends_at_rest() {
    let curve = curve(&[(0, 0.0, Ease::Smooth), (10, 4.0, Ease::Smooth)]);
    // 3s² − 2s³
    for (time, value) in [(2.5, 0.625), (5.0, 2.0), (7.5, 3.375)] {
        assert!((curve.at(time) - value).abs() < 1e-15);
    }
    assert!(slopes(&curve, 0.0).1.abs() < 1e-5);
    assert!(slopes(&curve, 10.0).0.abs() < 1e-5);
}

#[test]
fn smooth_goes_through_evenly_spaced_keys_on_a_line_with_its_slope() {
    let curve = curve(&[
        (0, 0.0, Ease::Smooth),
        (10, 10.0, Ease::Smooth),
        (30, 30.0, Ease::Smooth),
        (40, 40.0, Ease::Smooth),
    ]);
    for time in [10.0, 14.0, 20.0, 29.0] {
        assert!((curve.at(time) - time).abs() < 1e-14);
    }
}

#[test]
fn smooth_has_no_slope_at_a_local_extremum() {
    let curve = curve(&[
        (0, 0.0, Ease::Smooth),
        (10, 5.0, Ease::Smooth),
        (20, 5.0, Ease::Smooth),
        (30, -1.0, Ease::Smooth),
        (40, 3.0, Ease::Smooth),
    ]);
    for key in [10.0, 20.0, 30.0] {
        let (before, after) = slopes(&curve, key);
        assert!(before.abs() < 1e-5 && after.abs() < 1e-5, "at {key}");
    }
    assert_eq!(curve.at(15.0), 5.0);
}

#[test]
fn smooth_joins_a_line_with_the_slope_of_the_line() {
    let curve = curve(&[
        (0, 0.0, Ease::Linear),
        (10, 10.0, Ease::Smooth),
        (20, 15.0, Ease::Linear),
        (30, 30.0, Ease::Smooth),
    ]);
    for key in [10.0, 20.0] {
        let (before, after) = slopes(&curve, key);
        assert!((before - after).abs() < 1e-5, "at {key}: {before}, {after}");
    }
}

#[test]
fn smooth_does_not_take_from_a_line_a_slope_that_would_overshoot() {
    let steep = curve(&[
        (0, 0.0, Ease::Linear),
        (1, 100.0, Ease::Smooth),
        (11, 110.0, Ease::Smooth),
    ]);
    assert!((slopes(&steep, 1.0).1 - 3.0).abs() < 1e-4);
    let turning = curve(&[
        (0, 0.0, Ease::Linear),
        (10, 10.0, Ease::Smooth),
        (20, 0.0, Ease::Smooth),
    ]);
    assert!(slopes(&turning, 10.0).1.abs() < 1e-5);
}

#[test]
fn smooth_is_at_rest_next_to_hold() {
    let curve = curve(&[
        (0, 0.0, Ease::Hold),
        (10, 5.0, Ease::Smooth),
        (20, 15.0, Ease::Hold),
        (30, 20.0, Ease::Smooth),
    ]);
    assert!(slopes(&curve, 10.0).1.abs() < 1e-5);
    assert!(slopes(&curve, 20.0).0.abs() < 1e-5);
}

#[test]
fn smooth_slopes_agree_on_both_sides_of_a_key() {
    let mut random = Random(3);
    for _ in 0..200 {
        let mut frame = 0;
        let keys: Vec<_> = (0..6)
            .map(|_| {
                frame += 5 + (random.next() % 40) as i32;
                (frame, (random.next() % 100) as f64, Ease::Smooth)
            })
            .collect();
        let curve = curve(&keys);
        for &(frame, ..) in &keys {
            let (before, after) = slopes(&curve, f64::from(frame));
            assert!((before - after).abs() < 1e-3, "{keys:?} at {frame}");
        }
    }
}

#[test]
fn nothing_overshoots_and_keys_are_exact() {
    let mut random = Random(1);
    for _ in 0..2000 {
        let keys = random.keys();
        let curve = curve(&keys);
        for &(frame, value, _) in &keys {
            assert_eq!(curve.at(f64::from(frame)).to_bits(), value.to_bits());
        }
        for pair in keys.windows(2) {
            let (low, high) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
            let rises = pair[1].1 >= pair[0].1;
            let mut previous = pair[0].1;
            for step in 0..=64 {
                let part = f64::from(step) / 64.0;
                let (from, to) = (f64::from(pair[0].0), f64::from(pair[1].0));
                let value = curve.at(from + (to - from) * part);
                assert!(value >= low && value <= high, "{keys:?}");
                // Monotone up to the rounding of the cubic's terms. Among the subnormal numbers
                // slopes round to a fixed step, and count once a frame.
                let size = low
                    .abs()
                    .max(high.abs())
                    .max(f64::MIN_POSITIVE * (to - from));
                let slack = 4.0 * f64::EPSILON * size;
                let back = if rises {
                    previous - value
                } else {
                    value - previous
                };
                assert!(back <= slack, "{keys:?}");
                previous = value;
            }
        }
    }
}

#[test]
fn huge_values_stay_finite() {
    for ease in [Ease::Smooth, Ease::Linear, Ease::Hold] {
        let curve = curve(&[
            (i32::MIN, -f64::MAX, ease),
            (0, f64::MAX, ease),
            (1, -f64::MAX, ease),
            (2, f64::MIN_POSITIVE, ease),
            (i32::MAX, f64::MAX, ease),
        ]);
        for time in [-2e9, -1.0, 0.25, 0.5, 1.5, 2.0, 1e9, 2.147e9] {
            assert!(curve.at(time).is_finite());
        }
        assert_eq!(curve.at(2.0), f64::MIN_POSITIVE);
    }
}
