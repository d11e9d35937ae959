//! Roots of polynomials of degree 4 in an interval.

/// Adds the roots of a polynomial of degree 4, given by its Bernstein coefficients on 0 to 1.
///
/// Intervals without a change of sign have no root (Descartes' rule in Bernstein form); those with
/// one are narrowed by bisection and Newton's step; others are halved.
pub(crate) fn roots(bernstein: [f64; 5], roots: &mut Vec<f64>) {
    isolate(bernstein, 0.0, 1.0, 0, roots);
}

fn isolate(b: [f64; 5], low: f64, high: f64, depth: u32, roots: &mut Vec<f64>) {
    const DEEPEST: u32 = 48;
    let changes = sign_changes(&b);
    if changes == 0 {
        return;
    }
    if changes == 1 {
        roots.push(single_root(b, low, high));
        return;
    }
    let middle = 0.5 * (low + high);
    if depth == DEEPEST {
        // Roots this close are one, or none.
        if (b[0] < 0.0) != (b[4] < 0.0) {
            roots.push(middle);
        }
        return;
    }
    let (left, right) = halves(b);
    isolate(left, low, middle, depth + 1, roots);
    isolate(right, middle, high, depth + 1, roots);
}

fn sign_changes(b: &[f64; 5]) -> u32 {
    let mut changes = 0;
    let mut last = 0.0_f64;
    for &value in b {
        if value != 0.0 {
            changes += u32::from(last != 0.0 && (value > 0.0) != (last > 0.0));
            last = value;
        }
    }
    changes
}

/// de Casteljau's construction at ½.
fn halves(b: [f64; 5]) -> ([f64; 5], [f64; 5]) {
    let (mut left, mut right, mut row) = ([0.0; 5], [0.0; 5], b);
    for level in 0..5 {
        left[level] = row[0];
        right[4 - level] = row[4 - level];
        for index in 0..4 - level {
            row[index] = 0.5 * (row[index] + row[index + 1]);
        }
    }
    (left, right)
}

/// The value at s from 0 to 1.
pub(crate) fn value(bernstein: &[f64; 5], s: f64) -> f64 {
    evaluate(*bernstein, s).0
}

/// Value and derivative at s from 0 to 1.
fn evaluate(b: [f64; 5], s: f64) -> (f64, f64) {
    let mut row = b;
    for level in 1..4 {
        for index in 0..5 - level {
            row[index] += s * (row[index + 1] - row[index]);
        }
    }
    (row[0] + s * (row[1] - row[0]), 4.0 * (row[1] - row[0]))
}

/// The root where there is exactly one sign change, in the interval that `b` stands for.
fn single_root(b: [f64; 5], low: f64, high: f64) -> f64 {
    let rising = b[4] > 0.0 || (b[4] == 0.0 && b[0] < 0.0);
    let (mut left, mut right, mut s) = (0.0, 1.0, 0.5);
    for _ in 0..80 {
        let (value, slope) = evaluate(b, s);
        if (value > 0.0) == rising {
            right = s;
        } else {
            left = s;
        }
        let newton = s - value / slope;
        let next = if newton > left && newton < right {
            newton
        } else {
            0.5 * (left + right)
        };
        if (next - s).abs() < 1e-15 || right - left < 1e-15 {
            s = next;
            break;
        }
        s = next;
    }
    low + (high - low) * s
}

#[cfg(test)]
mod tests {
    /// The Bernstein coefficients of the product of four factors s − root.
    fn bernstein_of_roots(roots: [f64; 4]) -> [f64; 5] {
        // By powers first: the product grows by one factor at a time.
        let mut powers = [1.0, 0.0, 0.0, 0.0, 0.0];
        for (count, root) in roots.into_iter().enumerate() {
            for index in (0..=count + 1).rev() {
                let below = if index > 0 { powers[index - 1] } else { 0.0 };
                powers[index] = below - root * powers[index];
            }
        }
        let choose = [
            [1.0, 0.0, 0.0, 0.0, 0.0],
            [1.0, 1.0, 0.0, 0.0, 0.0],
            [1.0, 2.0, 1.0, 0.0, 0.0],
            [1.0, 3.0, 3.0, 1.0, 0.0],
            [1.0, 4.0, 6.0, 4.0, 1.0],
        ];
        let mut bernstein = [0.0; 5];
        for (index, value) in bernstein.iter_mut().enumerate() {
            *value = (0..=index)
                .map(|power| choose[index][power] / choose[4][power] * powers[power])
                .sum();
        }
        bernstein
    }

    #[test]
    fn quartics_have_all_their_roots_in_the_interval() {
        for roots in [
            [0.1, 0.4, 0.5, 0.9],
            [-3.0, 0.25, 0.26, 7.0],
            [0.3, 0.300_1, 0.7, 1.5],
        ] {
            let mut found = Vec::new();
            super::roots(bernstein_of_roots(roots), &mut found);
            let inside: Vec<f64> = roots
                .into_iter()
                .filter(|root| (0.0..=1.0).contains(root))
                .collect();
            assert_eq!(found.len(), inside.len(), "{found:?} instead of {inside:?}");
            for (found, expected) in found.iter().zip(inside) {
                assert!((found - expected).abs() < 1e-9);
            }
        }
        let mut none = Vec::new();
        super::roots(bernstein_of_roots([-1.0, -2.0, 3.0, 4.0]), &mut none);
        assert!(none.is_empty());
    }
}
