//! Frame rates as the fractions that film and television use.

/// Rates that television reduces by the factor 1000 / 1001.
const SLOWED: [u32; 5] = [24, 30, 48, 60, 120];
/// The distance from such a rate at which people write it: 23.98, 29.97.
const SLOWED_WITHIN: f64 = 0.005;
/// The largest denominator that is tried.
const LARGEST_DENOMINATOR: f64 = 1e6;

/// The fraction (numerator, denominator) closest to `rate`, in lowest terms except for rates such as 24000/1001; `None`
/// if no fraction is close.
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
mod tests;
