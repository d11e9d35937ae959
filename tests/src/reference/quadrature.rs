//! Gauss–Kronrod quadrature, zeros of functions, and changes of the result of a probe.

use glam::DVec4;

/// Nodes of the Kronrod rule with 15 points on [−1, 1], from the outside to the middle, their weights, and the weights
/// of the Gauss rule with 7 points (0 at the other nodes).
///
/// # Source
/// Piessens, de Doncker-Kapenga, Überhuber, Kahaner: QUADPACK, 1983, routine QK15.
const RULE: [(f64, f64, f64); 8] = [
    (0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0),
    (
        0.949_107_912_342_758_5,
        0.063_092_092_629_978_55,
        0.129_484_966_168_869_7,
    ),
    (0.864_864_423_359_769_1, 0.104_790_010_322_250_18, 0.0),
    (
        0.741_531_185_599_394_4,
        0.140_653_259_715_525_92,
        0.279_705_391_489_276_67,
    ),
    (0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0),
    (
        0.405_845_151_377_397_2,
        0.190_350_578_064_785_4,
        0.381_830_050_505_118_9,
    ),
    (0.207_784_955_007_898_47, 0.204_432_940_075_298_9, 0.0),
    (0.0, 0.209_482_141_084_727_83, 0.417_959_183_673_469_4),
];

/// The number of halvings without improvement after which halving is abandoned.
const IDLE: u32 = 6;

/// If a range has more changes than this, they are noise.
const MOST_CHANGES: usize = 300;

/// An integral, and an estimate of its error.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Integral {
    pub(crate) value: DVec4,
    pub(crate) error: f64,
    /// The estimate that is also valid if the function is not smooth: the difference of two rules.
    pub(crate) cautious: f64,
}

impl Integral {
    pub(crate) fn add(&mut self, other: Self) {
        self.value += other.value;
        self.error += other.error;
        self.cautious += other.cautious;
    }
}

/// The integral from `start` to `end`. Parts are halved, at most `depth` times, until the error of each is within its
/// share of `tolerance`.
///
/// Both ends may have singularities like a square root: the substitution x²(3 − 2x) removes them.
pub(crate) fn integrate(
    start: f64,
    end: f64,
    tolerance: f64,
    depth: u32,
    f: &mut impl FnMut(f64) -> DVec4,
) -> Integral {
    let width = end - start;
    let mut substituted = |x: f64| {
        // From the nearer end, which keeps distances from it exact.
        let at = if x < 0.5 {
            start + width * (x * x * (3.0 - 2.0 * x))
        } else {
            let y = 1.0 - x;
            end - width * (y * y * (3.0 - 2.0 * y))
        };
        f(at) * (width * 6.0 * x * (1.0 - x))
    };
    halve(
        (0.0, 1.0),
        tolerance,
        depth,
        (f64::MAX, IDLE),
        &mut substituted,
    )
}

/// `before` is the error of the part that was halved, and the number of halvings that may still bring no improvement.
fn halve(
    (start, end): (f64, f64),
    tolerance: f64,
    depth: u32,
    before: (f64, u32),
    f: &mut impl FnMut(f64) -> DVec4,
) -> Integral {
    let whole = rule(start, end, f);
    // Noise, or a jump, shrinks only as the width; smooth functions and roots do better.
    let idle = before.1 - u32::from(whole.error > 0.4 * before.0);
    if whole.error <= tolerance || depth == 0 || idle == 0 {
        return whole;
    }
    let middle = 0.5 * (start + end);
    // Rounding leaves nothing to gain below.
    let share = (0.5 * tolerance).max(1e-15);
    let before = (whole.error, idle);
    let mut sum = halve((start, middle), share, depth - 1, before, f);
    sum.add(halve((middle, end), share, depth - 1, before, f));
    sum
}

/// The Kronrod rule with QUADPACK's estimate. The difference from the Gauss rule would be the error of the weaker rule,
/// so the estimate is its power 3/2, in units of the function's variation.
fn rule(start: f64, end: f64, f: &mut impl FnMut(f64) -> DVec4) -> Integral {
    let (middle, half) = (0.5 * (start + end), 0.5 * (end - start));
    let mut values = [(DVec4::ZERO, 0.0); 15];
    let (mut kronrod, mut gauss) = (DVec4::ZERO, DVec4::ZERO);
    for (index, (node, weight, gauss_weight)) in RULE.into_iter().enumerate() {
        let left = f(middle - half * node);
        values[2 * index] = (left, weight);
        let both = if node == 0.0 {
            left
        } else {
            let right = f(middle + half * node);
            values[2 * index + 1] = (right, weight);
            left + right
        };
        kronrod += both * weight;
        gauss += both * gauss_weight;
    }
    let mean = kronrod * 0.5;
    let variation = values
        .iter()
        .map(|(value, weight)| (value - mean).abs() * *weight)
        .sum::<DVec4>()
        .max_element()
        * half;
    let apart = ((kronrod - gauss) * half).abs().max_element();
    let error = if variation > 0.0 {
        apart.min(variation * (200.0 * apart / variation).powf(1.5))
    } else {
        apart
    };
    Integral {
        value: kronrod * half,
        error,
        cautious: apart,
    }
}

/// A zero of `f` between two places with values of different sign, by regula falsi in the variant of Anderson and
/// Björck.
pub(crate) fn zero_between(
    mut a: (f64, f64),
    mut b: (f64, f64),
    f: &mut impl FnMut(f64) -> f64,
) -> f64 {
    for step in 0..100 {
        let width = b.0 - a.0;
        if width.abs() <= 4e-16 * a.0.abs().max(b.0.abs()).max(1e-3) || a.1 == 0.0 {
            return a.0;
        }
        if b.1 == 0.0 {
            return b.0;
        }
        // A bisection now and then keeps it from creeping.
        let at = if step % 6 == 5 {
            0.5 * (a.0 + b.0)
        } else {
            (a.0 + width * (a.1 / (a.1 - b.1))).clamp(a.0.min(b.0), a.0.max(b.0))
        };
        let value = f(at);
        if (value > 0.0) == (b.1 > 0.0) {
            let scale = 1.0 - value / b.1;
            a.1 *= if scale > 0.0 { scale } else { 0.5 };
        } else {
            a = b;
        }
        b = (at, value);
        if (b.0 - a.0).abs() <= 1e-16 {
            break;
        }
    }
    0.5 * (a.0 + b.0)
}

/// The zeros of a smooth function that was evaluated at the places `at`: where the sign changes between two places, and
/// where a minimum of the absolute value may hide a pair of zeros.
pub(crate) fn zeros(
    at: &[f64],
    values: &[f64],
    f: &mut impl FnMut(f64) -> f64,
    found: &mut Vec<f64>,
) {
    let differ = |a: f64, b: f64| (a > 0.0) != (b > 0.0);
    for index in 1..at.len() {
        let (a, b) = (
            (at[index - 1], values[index - 1]),
            (at[index], values[index]),
        );
        if differ(a.1, b.1) {
            found.push(zero_between(a, b, f));
        }
        if index + 1 == at.len() {
            break;
        }
        let c = (at[index + 1], values[index + 1]);
        let is_dip = b.1.abs() <= a.1.abs() && b.1.abs() <= c.1.abs();
        if is_dip && !differ(a.1, b.1) && !differ(b.1, c.1) {
            dip(a, b, c, f, found);
        }
    }
}

/// A pair of zeros in a dip, found by parabolas through three places.
fn dip(
    mut a: (f64, f64),
    mut b: (f64, f64),
    mut c: (f64, f64),
    f: &mut impl FnMut(f64) -> f64,
    found: &mut Vec<f64>,
) {
    for step_number in 0..14 {
        let slopes = ((b.1 - a.1) / (b.0 - a.0), (c.1 - b.1) / (c.0 - b.0));
        let bend = (slopes.1 - slopes.0) / (c.0 - a.0);
        if bend == 0.0 || !bend.is_finite() {
            return;
        }
        // The parabola's slope at b, and from there its vertex.
        let slope = slopes.0 + bend * (b.0 - a.0);
        let step = -0.5 * slope / bend;
        let lowest = b.1 + 0.5 * step * slope;
        // Nothing more to gain; but the first parabolas are rough pictures of the function.
        if step_number > 2 && lowest * b.1 > 0.0 && lowest.abs() > 0.8 * b.1.abs() {
            return;
        }
        let mut x = (b.0 + step).clamp(a.0, c.0);
        if (x - b.0).abs() < 1e-3 * (c.0 - a.0) {
            x = b.0
                + 0.05
                    * if c.0 - b.0 > b.0 - a.0 {
                        c.0 - b.0
                    } else {
                        a.0 - b.0
                    };
        }
        let new = (x, f(x));
        if (new.1 > 0.0) != (b.1 > 0.0) {
            let (left, right) = if x < b.0 { (a, b) } else { (b, c) };
            found.push(zero_between(left, new, f));
            found.push(zero_between(new, right, f));
            return;
        }
        if new.1.abs() < b.1.abs() {
            if x < b.0 {
                c = b;
            } else {
                a = b;
            }
            b = new;
        } else if x < b.0 {
            a = new;
        } else {
            c = new;
        }
    }
}

/// Finds all places between two probes with different results where the result changes.
///
/// A place among `seeds` is accepted if the results on both sides of it agree with those of the probes; otherwise the
/// range is bisected down to `width`. Changes that cancel between probes are not found.
pub(crate) fn changes<S: PartialEq + Clone>(
    from: (f64, &S),
    to: (f64, &S),
    seeds: &[f64],
    width: f64,
    probe: &mut impl FnMut(f64) -> S,
    found: &mut Vec<f64>,
) {
    if from.1 == to.1 || found.len() >= MOST_CHANGES {
        return;
    }
    for &seed in seeds {
        let (before, after) = (seed - width, seed + width);
        if before > from.0 && after < to.0 && probe(before) == *from.1 && probe(after) == *to.1 {
            found.push(seed);
            return;
        }
    }
    let middle = 0.5 * (from.0 + to.0);
    if to.0 - from.0 <= width || middle <= from.0 || middle >= to.0 {
        found.push(middle);
        return;
    }
    let between = probe(middle);
    changes(from, (middle, &between), &[], width, probe, found);
    changes((middle, &between), to, &[], width, probe, found);
}
