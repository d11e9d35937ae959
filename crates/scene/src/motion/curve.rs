//! A number that changes over time.

use crate::file::Ease;

/// A number over time: held before its first and after its last key, and between them led from
/// key to key.
///
/// At a key the curve has the key's value to the bit, and between two keys it never leaves the
/// interval of their values. A `Smooth` stretch has no slope at the curve's first and last key, at
/// a local extremum and next to `Hold`; it shares its slope with a `Smooth` neighbor, and takes it
/// from a `Linear` one where that does not overshoot.
///
/// # Source
/// F. N. Fritsch, R. E. Carlson: Monotone Piecewise Cubic Interpolation, SIAM Journal on Numerical
/// Analysis 17 (1980), 238–246. A cubic is monotone where both its slopes have the sign of the
/// secant and are at most three times as steep.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    /// The value where there are no keys.
    rest: f64,
    keys: Vec<CurveKey>,
    /// The power of two by which values are multiplied before differences are taken.
    scale: f64,
}

/// A value that a curve has at a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CurveKey {
    /// The frame.
    pub(super) frame: i32,
    /// The value there.
    pub(super) value: f64,
    /// The way to the next key.
    pub(super) ease: Ease,
    /// Slope of the `Smooth` stretches that start or end here, in scaled values a frame.
    slope: f64,
}

impl CurveKey {
    /// A key; the curve gives it its slope.
    pub(super) fn new(frame: i32, value: f64, ease: Ease) -> Self {
        Self {
            frame,
            value,
            ease,
            slope: 0.0,
        }
    }
}

impl Curve {
    /// The curve through `keys`, whose frames increase; constantly `rest` without keys.
    pub(super) fn new(rest: f64, keys: Vec<CurveKey>) -> Self {
        // Differences of larger values might overflow.
        const LARGE: f64 = 1e300;
        const REDUCTION: f64 = 1.0 / 65536.0;
        let is_large = keys.iter().any(|key| key.value.abs() > LARGE);
        let scale = if is_large { REDUCTION } else { 1.0 };
        let mut curve = Self { rest, keys, scale };
        let slopes: Vec<f64> = (0..curve.keys.len()).map(|key| curve.slope(key)).collect();
        for (key, slope) in curve.keys.iter_mut().zip(slopes) {
            key.slope = slope;
        }
        curve
    }

    /// The curve that has this value at all times.
    pub(super) fn constant(value: f64) -> Self {
        Self::new(value, Vec::new())
    }

    /// Returns whether some key names it.
    pub(super) fn is_keyed(&self) -> bool {
        !self.keys.is_empty()
    }

    /// Returns whether the value is the same at all times.
    pub(super) fn is_constant(&self) -> bool {
        let mut pairs = self.keys.windows(2);
        pairs.all(|pair| pair[0].value == pair[1].value)
    }

    /// The value at a time in frames, finite whatever the keys.
    pub(super) fn at(&self, time: f64) -> f64 {
        let (Some(first), Some(last)) = (self.keys.first(), self.keys.last()) else {
            return self.rest;
        };
        let is_reached = |key: &CurveKey| f64::from(key.frame) <= time;
        let reached = self.keys.partition_point(is_reached);
        if reached == 0 {
            return first.value;
        }
        let from = self.keys[reached - 1];
        let Some(to) = self.keys.get(reached) else {
            return last.value;
        };
        let since = time - f64::from(from.frame);
        if since == 0.0 || from.ease == Ease::Hold {
            return from.value;
        }
        let duration = frames_between(&from, to);
        let part = since / duration;
        let (start, end) = (from.value * self.scale, to.value * self.scale);
        let way = end - start;
        let value = if from.ease == Ease::Linear {
            start + way * part
        } else {
            // The cubic in Hermite's form.
            let rest = 1.0 - part;
            let ease = part * part * (3.0 - 2.0 * part);
            let bend = part * rest * (from.slope * rest - to.slope * part) * duration;
            start + way * ease + bend
        };
        let (low, high) = (from.value.min(to.value), from.value.max(to.value));
        (value / self.scale).clamp(low, high)
    }

    /// The slope of the `Smooth` stretches at the key with this index.
    fn slope(&self, key: usize) -> f64 {
        let Some(before) = key.checked_sub(1).map(|before| &self.keys[before]) else {
            return 0.0;
        };
        let Some(after) = self.keys.get(key + 1) else {
            return 0.0;
        };
        let here = &self.keys[key];
        let duration_before = frames_between(before, here);
        let duration_after = frames_between(here, after);
        let [before_value, value, after_value] =
            [before, here, after].map(|key| key.value * self.scale);
        let secant_before = (value - before_value) / duration_before;
        let secant_after = (after_value - value) / duration_after;
        match (before.ease, here.ease) {
            (Ease::Hold, _) | (_, Ease::Hold) => 0.0,
            (Ease::Linear, _) => limited(secant_before, &[secant_after]),
            (_, Ease::Linear) => limited(secant_after, &[secant_before]),
            (Ease::Smooth, Ease::Smooth) => {
                // The slope of the parabola through the three keys.
                let part = duration_before / (duration_before + duration_after);
                let slope = secant_before + (secant_after - secant_before) * part;
                limited(slope, &[secant_before, secant_after])
            }
        }
    }
}

/// The slope nearest to `slope` with which cubics along all the `secants` are monotone.
fn limited(slope: f64, secants: &[f64]) -> f64 {
    // Fritsch and Carlson's square; the region of all monotone cubics is a little larger.
    const STEEPEST: f64 = 3.0;
    let all = |sign: f64| secants.iter().all(|secant| secant * sign > 0.0);
    let sign = if all(1.0) {
        1.0
    } else if all(-1.0) {
        -1.0
    } else {
        return 0.0;
    };
    let limits = secants.iter().map(|secant| STEEPEST * secant.abs());
    let limit = limits.fold(f64::INFINITY, f64::min);
    sign * (sign * slope).clamp(0.0, limit)
}

/// Frames from a key to a later one.
fn frames_between(from: &CurveKey, to: &CurveKey) -> f64 {
    (i64::from(to.frame) - i64::from(from.frame)) as f64
}

#[cfg(test)]
mod tests;
