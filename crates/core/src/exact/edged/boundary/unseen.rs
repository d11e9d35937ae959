//! What lies between the lines of an arc, or behind the outermost of them, where all lines miss it.

use crate::exact::edged::rule::NODES;

/// How far a value may go beyond zero where no line is.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Unseen {
    /// Between neighboring lines.
    pub(super) between: f64,
    /// Behind the outermost ones.
    pub(super) at_ends: f64,
}

impl Unseen {
    /// Adds what values at the same places of all lines tell.
    #[inline(always)]
    pub(super) fn add(&mut self, values: &[f64; 8]) {
        self.between = self.between.max(beyond_zero(values));
        self.at_ends = self.at_ends.max(beyond_ends(values));
    }
}

/// The distance beyond zero that a value may go between neighboring lines on which it has one sign: it is a smaller part of
/// what the value changes by beside them than half. Then all lines miss what lies there, and their sums agree.
#[inline(always)]
fn beyond_zero(values: &[f64; 8]) -> f64 {
    const NEAR: f64 = 0.5;
    let step = |node: usize| (values[node] - values[node - 1]).abs();
    let mut most = 0.0_f64;
    for node in 1..NODES {
        let (one, other) = (values[node - 1], values[node]);
        if one * other > 0.0 {
            let before = step((node - 1).max(1));
            let after = step((node + 1).min(NODES - 1));
            let change = step(node).max(before).max(after);
            most = most.max(NEAR * change - one.abs().min(other.abs()));
        }
    }
    most
}

/// How far a value may go beyond zero at either end of the lines if the outermost line is nearly the first to tell: it is
/// smaller there than what it may still change by. Then a corner of light, or of darkness, that begins at this line, or
/// behind it, is next to nothing in all sums.
///
/// The end is a fifth of a step behind the outermost line; values may bend.
#[inline(always)]
fn beyond_ends(values: &[f64; 8]) -> f64 {
    const AHEAD: f64 = 0.4;
    let mut most = 0.0_f64;
    for (last, next) in [(0, 1), (NODES - 1, NODES - 2)] {
        let (last, next) = (values[last], values[next]);
        let change = AHEAD * (last - next).abs();
        if last.abs() < change {
            let has_begun = last * next < 0.0;
            most = most.max(change + if has_begun { last.abs() } else { -last.abs() });
        }
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::edged::rule::RULE;

    /// The values of a function at the lines of an arc whose y go from 0 to 1.
    fn at_lines(value: impl Fn(f64) -> f64) -> Unseen {
        let mut unseen = Unseen::default();
        unseen.add(&RULE.nodes.map(value));
        unseen
    }

    #[test]
    fn a_corner_behind_the_outermost_line_is_told() {
        let [first, last] = [RULE.nodes[0], RULE.nodes[NODES - 1]];
        // Zeros from the end to a little before the outermost line, on both sides.
        for share in [0.1, 0.5, 0.9, 1.2] {
            let ends = [first * share, 1.0 - (1.0 - last) * share];
            for (zero, end) in ends.into_iter().zip([0.0, 1.0]) {
                for sign in [-1.0, 1.0] {
                    let value = |y: f64| sign * (y - zero) * (1.0 + 0.3 * y);
                    let told = at_lines(value).at_ends;
                    assert!(told >= value(end).abs(), "{share} {end}: {told}");
                }
            }
        }
    }

    #[test]
    fn nothing_is_told_of_values_far_from_zero_or_of_a_zero_between_lines() {
        for value in [|y: f64| y + 0.1, |y: f64| -2.0 + y, |y: f64| 0.45 - y] {
            assert_eq!(at_lines(value).at_ends, 0.0);
        }
    }

    #[test]
    fn a_dip_between_lines_is_told() {
        let middle = 0.5 * (RULE.nodes[3] + RULE.nodes[4]);
        let dip = |y: f64| (y - middle) * (y - middle) - 0.005;
        assert!(dip(RULE.nodes[3]) > 0.0);
        assert!(at_lines(dip).between >= 0.005);
    }
}
