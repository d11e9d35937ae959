//! Chords: parts of lines of a cell on which one sphere is seen.

use fearless_simd::Simd;

use crate::numeric::lanes::f64x8;
use crate::numeric::polynomial::{Linear, Quadratic};
use crate::numeric::rounding::UNIT_ROUNDOFF;

/// The line on which chords of a sphere begin: at x = `start` + `slope` · y.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference {
    start: f64,
    slope: f64,
}

/// Values of y that count as the same.
const SAME: f64 = 1e-12;

impl Reference {
    /// A reference inside the cell and the contour with this discriminant and this d · c, in every
    /// line of the cell that meets the contour.
    ///
    /// It is a side of the cell where the contour holds all of it: arcs there need no sums. Otherwise
    /// it leads from the lowest point of what is seen to the highest one: what is seen is convex.
    pub(super) fn new(discriminant: &Quadratic, along: &Linear) -> Self {
        let q = discriminant;
        let is_ahead = |x: f64, y: f64| along.one + along.x * x + along.y * y > 0.0;
        let is_inside = |x: f64, y: f64| {
            (q.xx * x + q.xy * y + q.x) * x + (q.yy * y + q.y) * y + q.one >= 0.0 && is_ahead(x, y)
        };
        let corners = [[-0.5, -0.5], [-0.5, 0.5], [0.5, -0.5], [0.5, 0.5]];
        let holds = corners.map(|[x, y]| is_inside(x, y));
        if holds[0] && holds[1] {
            return Self::upright(-0.5);
        }
        if holds[2] && holds[3] {
            return Self::upright(0.5);
        }
        let mut seen = Extent::NOTHING;
        for ([x, y], holds) in corners.into_iter().zip(holds) {
            if holds {
                seen.take(x, y);
            }
        }
        let mut note = |x: f64, y: f64| {
            if x.abs() <= 0.5 && y.abs() <= 0.5 && is_ahead(x, y) {
                seen.take(x, y);
            }
        };
        for side in [-0.5, 0.5] {
            for y in q.transposed().crossings(side) {
                note(side, y);
            }
            for x in q.crossings(side) {
                note(x, side);
            }
        }
        for (x, y) in q.extremes() {
            note(x, y);
        }
        seen.reference()
    }

    /// The y at which the zeros of a polynomial cross the reference; NaN where they do not.
    pub(super) fn crossings(&self, q: &Quadratic) -> [f64; 2] {
        let along = Quadratic {
            one: (q.xx * self.start + q.x) * self.start + q.one,
            x: (2.0 * q.xx * self.start + q.x) * self.slope + q.xy * self.start + q.y,
            xx: (q.xx * self.slope + q.xy) * self.slope + q.yy,
            ..Quadratic::default()
        };
        along.crossings(0.0)
    }

    /// Its x on some lines.
    #[inline(always)]
    pub(super) fn at<S: Simd>(&self, y: f64x8<S>) -> f64x8<S> {
        y * self.slope + self.start
    }

    pub(super) fn upright(x: f64) -> Self {
        Self {
            start: x,
            slope: 0.0,
        }
    }
}

/// The lowest and the highest points that were seen: their y, and between which x they lie.
#[derive(Clone, Copy, Debug)]
struct Extent {
    lowest: (f64, [f64; 2]),
    highest: (f64, [f64; 2]),
}

impl Extent {
    const NOTHING: Self = Self {
        lowest: (f64::INFINITY, [0.0; 2]),
        highest: (f64::NEG_INFINITY, [0.0; 2]),
    };

    fn take(&mut self, x: f64, y: f64) {
        for (end, sign) in [(&mut self.lowest, -1.0), (&mut self.highest, 1.0)] {
            if sign * (y - end.0) > SAME {
                *end = (y, [x; 2]);
            } else if (y - end.0).abs() <= SAME {
                end.1 = [end.1[0].min(x), end.1[1].max(x)];
            }
        }
    }

    fn reference(&self) -> Reference {
        let middle = |[left, right]: [f64; 2]| 0.5 * (left + right);
        let (low, high) = (middle(self.lowest.1), middle(self.highest.1));
        let rise = self.highest.0 - self.lowest.0;
        if self.lowest.0.is_infinite() {
            return Reference::upright(0.0);
        }
        if rise <= SAME {
            return Reference::upright(0.5 * (low + high));
        }
        let slope = (high - low) / rise;
        Reference {
            start: low - slope * self.lowest.0,
            slope,
        }
    }
}

/// The chords of eight lines, from a reference to some x.
///
/// On a line the root w of the discriminant Q makes x and w a conic w² = Q(x): an ellipse, where the
/// sphere lies in front of the eye, a hyperbola, where it reaches behind it. A parameter σ from −1 to 1
/// passes along the conic from one end of the chord to the other as the rational curve of degree 2
/// between them, whose weights are 1, W, 1: with h half of the chord,
///
/// > x = middle + h (σ + ½ (1 − σ²) E) / (1 − ½ (1 − σ²) (1 − W)).
///
/// So the root is rational, too, and light is smooth to the very contour. With w₁ and w₂ the roots at the
/// ends and G = w₁ w₂ + P, where P = Q(middle) − Q″ h² / 2 is the polar form of Q between the ends,
/// W = (w₁ + w₂) / √(2 G) and E = (w₁ − w₂) / √(2 G). On an ellipse W is the cosine of half of the angle
/// that the chord spans. As w₁² + w₂² = 2 Q(middle) + Q″ h², G is ½ (w₁ + w₂)² − Q″ h², too.
///
/// # Source
/// Farin, Curves and Surfaces for CAGD, 2002, chapter 12.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord<S: Simd> {
    middle: f64x8<S>,
    /// Half of its length, negative where it leads to the left.
    half: f64x8<S>,
    weight: f64x8<S>,
    lean: f64x8<S>,
    /// √(2 G).
    scale: f64x8<S>,
    /// The roots at the ends.
    roots: [f64x8<S>; 2],
    /// The square of the half axis of an ellipse, times −Q″ / 2.
    spread_sq: f64x8<S>,
}

/// A place of chords, as quotients with one denominator.
#[derive(Clone, Copy, Debug)]
pub(super) struct Homogeneous<S: Simd> {
    /// x, times the denominator.
    pub(super) x: f64x8<S>,
    /// The root w, times the denominator.
    pub(super) root: f64x8<S>,
    /// The derivative of x by the parameter, times the square of the denominator.
    pub(super) slope: f64x8<S>,
    pub(super) denominator: f64x8<S>,
}

impl<S: Simd> Chord<S> {
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        discriminant: &Quadratic,
        reference: &Reference,
        x: f64x8<S>,
        y: f64x8<S>,
    ) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let q = discriminant;
        let start = y * reference.slope + reference.start;
        let half = (x - start) * 0.5;
        let middle = (x + start) * 0.5;
        let slope = (middle * q.xx) + (y * q.xy + q.x) * 0.5;
        let there = (middle * q.xx + y * q.xy + q.x) * middle + (y * q.yy + q.y) * y + q.one;
        let bend = half * half * q.xx;
        let rise = half * slope * 2.0;
        let first = (there + bend - rise).max(zero).sqrt();
        let last = (there + bend + rise).max(zero).sqrt();
        let sum = first + last;
        let tiny = one * f64::MIN_POSITIVE;
        let between = if q.xx < 0.0 {
            // The same in another form, of an ellipse a sum of what is positive.
            (sum * sum * 0.5 - bend * 2.0).max(tiny)
        } else {
            // Rounding leaves no more of it.
            let rounded = (there.abs() + bend) * UNIT_ROUNDOFF;
            (first * last + there - bend).max(rounded).max(tiny)
        };
        let scale = (between * 2.0).sqrt();
        let inverse = one / scale;
        Self {
            middle,
            half,
            weight: sum * inverse,
            lean: (first - last) * inverse,
            scale,
            roots: [first, last],
            spread_sq: (slope * slope - there * q.xx).max(zero),
        }
    }

    /// The square of how far the parameter tan(φ/2) of an ellipse goes: 2 tan(Δφ/4).
    #[inline(always)]
    pub(super) fn way_sq(&self) -> f64x8<S> {
        let weight = self.weight;
        (weight - 1.0).abs() / (weight + 1.0) * 4.0
    }

    /// The half axis of an ellipse times the third power of the way.
    #[inline(always)]
    pub(super) fn size_of_way(&self) -> f64x8<S> {
        let more = self.weight + 1.0;
        let product = more * self.scale;
        let root = (self.spread_sq * self.way_sq()).sqrt();
        self.half * self.half * root * 16.0 / (product * product)
    }

    /// Whether there is nothing of them.
    #[inline(always)]
    pub(super) fn is_empty(&self) -> bool {
        self.half.simd_eq(0.0).to_bitmask() == 0xff
    }

    /// The place x of the parameter on the lines, and the derivative of x by it.
    #[inline(always)]
    pub(super) fn at(&self, sigma: f64x8<S>) -> (f64x8<S>, f64x8<S>) {
        let one = sigma * 0.0 + 1.0;
        let bow = (one - sigma * sigma) * 0.5;
        let less = one - self.weight;
        let inverse = one / (one - bow * less);
        let share = (sigma + bow * self.lean) * inverse;
        let slope = (one - sigma * self.lean - share * sigma * less) * inverse;
        (self.middle + self.half * share, self.half * slope)
    }

    /// The place with the parameter σ: the root is the rational curve of degree 2 between those at the ends,
    /// with √(G / 2) between them.
    #[inline(always)]
    pub(super) fn homogeneous(&self, sigma: f64) -> Homogeneous<S> {
        let bow = 0.5 * (1.0 - sigma * sigma);
        let [before, after] = [
            0.25 * (1.0 - sigma) * (1.0 - sigma),
            0.25 * (1.0 + sigma) * (1.0 + sigma),
        ];
        let denominator = self.weight * bow + (1.0 - bow);
        let share = self.lean * bow + sigma;
        let less = self.weight * sigma - sigma;
        Homogeneous {
            x: self.middle * denominator + self.half * share,
            root: self.roots[0] * before + self.roots[1] * after + self.scale * (0.5 * bow),
            slope: self.half * ((1.0 - self.lean * sigma) * denominator + share * less),
            denominator,
        }
    }

    /// The places with these parameters, which may lie beyond the ends.
    #[inline(always)]
    pub(super) fn homogeneous_lanes(&self, sigma: f64x8<S>) -> Homogeneous<S> {
        let one = sigma * 0.0 + 1.0;
        let bow = (one - sigma * sigma) * 0.5;
        let (before, after) = (one - sigma, one + sigma);
        let denominator = self.weight * bow + (one - bow);
        let share = self.lean * bow + sigma;
        let less = self.weight * sigma - sigma;
        let of_ends = self.roots[0] * (before * before) + self.roots[1] * (after * after);
        Homogeneous {
            x: self.middle * denominator + self.half * share,
            root: of_ends * 0.25 + self.scale * (bow * 0.5),
            slope: self.half * ((one - self.lean * sigma) * denominator + share * less),
            denominator,
        }
    }

    /// The length of the chords.
    #[inline(always)]
    pub(super) fn length(&self) -> f64x8<S> {
        self.half * 2.0
    }
}

#[cfg(test)]
mod tests;
