//! Frame rates as the fractions that film and television use.

/// The rates that television slows down by 1000 / 1001.
const SLOWED: [u32; 5] = [24, 30, 48, 60, 120];
/// The distance from such a rate at which people write it: 23.98, 29.97.
const SLOWED_WITHIN: f64 = 0.005;
/// The largest denominator that is tried.
const LARGEST_DENOMINATOR: f64 = 1e6;

/// The fraction (numerator, denominator) closest to `rate`, in lowest terms except for
/// 24000/1001 and its kind; `None` where there is none near.
pub(crate) fn nearest(rate: f64) -> Option<(i32, u32)> {
    for nominal in SLOWED {
        let slowed = f64::from(nominal) * (1000.0 / 1001.0);
        if (rate - slowed).abs() <= SLOWED_WITHIN {
            return Some((nominal as i32 * 1000, 1001));
        }
    }
    if !(rate > 0.0 && rate <= f64::from(i32::MAX)) {
        return None;
    }
    // The convergents of the continued fraction, until one rounds to the rate.
    let (mut before, mut last) = ((0.0, 1.0), (1.0, 0.0));
    let mut rest = rate;
    loop {
        let whole = rest.floor();
        let next = (whole * last.0 + before.0, whole * last.1 + before.1);
        if next.1 > LARGEST_DENOMINATOR || next.0 > f64::from(i32::MAX) {
            break;
        }
        (before, last) = (last, next);
        if last.0 / last.1 == rate || rest == whole {
            break;
        }
        rest = 1.0 / (rest - whole);
    }
    (last.0 > 0.0).then_some((last.0 as i32, last.1 as u32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_and_simple_rates_are_exact() {
        assert_eq!(nearest(24.0), Some((24, 1)));
        assert_eq!(nearest(12.5), Some((25, 2)));
        assert_eq!(nearest(0.1), Some((1, 10)));
        assert_eq!(nearest(1.0 / 3.0), Some((1, 3)));
        assert_eq!(nearest(1000.0), Some((1000, 1)));
        assert_eq!(nearest(15.36), Some((384, 25)));
    }

    #[test]
    fn television_rates_are_recognized() {
        for rate in [23.976, 23.98, 24000.0 / 1001.0] {
            assert_eq!(nearest(rate), Some((24000, 1001)));
        }
        assert_eq!(nearest(29.97), Some((30000, 1001)));
        assert_eq!(nearest(59.94), Some((60000, 1001)));
        assert_eq!(nearest(119.88), Some((120_000, 1001)));
    }

    #[test]
    fn rates_out_of_range_have_none() {
        for rate in [0.0, -24.0, 1e-9, 1e10, f64::MAX, f64::INFINITY, f64::NAN] {
            assert_eq!(nearest(rate), None, "{rate}");
        }
    }

    #[test]
    fn odd_rates_are_close() {
        for rate in [std::f64::consts::PI, 1_234.567_891, 0.017_453] {
            let (numerator, denominator) = nearest(rate).unwrap();
            let fraction = f64::from(numerator) / f64::from(denominator);
            assert!((fraction / rate - 1.0).abs() < 1e-9, "{rate}");
        }
    }
}
