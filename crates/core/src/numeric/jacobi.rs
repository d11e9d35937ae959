//! Gauss's rules for functions that go with a power of the distance to an end, which is where they begin.

/// A rule on 0 to 1 for t^p · g(t) with a smooth g: nodes, and weights by which the values of the whole
/// product are multiplied.
///
/// # Accuracy
/// Exact, to rounding, where g is a polynomial of a degree below twice the nodes. A function that is analytic
/// around the whole of 0 to 1 has an error that falls as fast as that of Gauss's plain rule, which is the one
/// with p = 0.
///
/// # Source
/// Golub and Welsch, Calculation of Gauss quadrature rules, Mathematics of Computation 23, 1969: weights are
/// those of Christoffel. Roots are found between those of the polynomial before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JacobiRule<const NODES: usize> {
    pub(crate) nodes: [f64; NODES],
    pub(crate) weights: [f64; NODES],
}

impl<const NODES: usize> JacobiRule<NODES> {
    pub(crate) const ZERO: Self = Self {
        nodes: [0.0; NODES],
        weights: [0.0; NODES],
    };

    /// The rule for a power p above −1. It costs some thousand bisections: prepare it once.
    pub(crate) fn new(power: f64) -> Self {
        /// Steps after which a bracket has no double inside.
        const BISECTIONS: u32 = 60;
        let recurrence = Recurrence { power };
        let mut roots = [1.0; NODES];
        for degree in 1..=NODES {
            // Between two roots of a polynomial lies one of the polynomial before.
            let known = roots;
            for (index, root) in roots.iter_mut().enumerate().take(degree) {
                let mut low = if index > 0 { known[index - 1] } else { -1.0 };
                let mut high = if index + 1 < degree {
                    known[index]
                } else {
                    1.0
                };
                let sign_of_high = if (degree - index) % 2 == 1 { 1.0 } else { -1.0 };
                for _ in 0..BISECTIONS {
                    let middle = 0.5 * (low + high);
                    if recurrence.value(degree, middle) * sign_of_high > 0.0 {
                        high = middle;
                    } else {
                        low = middle;
                    }
                }
                *root = 0.5 * (low + high);
            }
        }
        let mut rule = Self::ZERO;
        for (index, root) in roots.into_iter().enumerate() {
            let node = 0.5 * (1.0 + root);
            let weight = 1.0 / recurrence.sum_of_squares(NODES, root);
            rule.nodes[index] = node;
            rule.weights[index] = weight / libm::pow(node, power);
        }
        rule
    }
}

/// The recurrence of the polynomials that are orthogonal on −1 to 1 with the weight (1 + x)^p.
#[derive(Clone, Copy, Debug)]
struct Recurrence {
    power: f64,
}

impl Recurrence {
    /// The number that is subtracted from x, and the factor of the polynomial before the last, which for the first is
    /// not used.
    fn coefficients(&self, degree: usize) -> (f64, f64) {
        let (degree, power) = (degree as f64, self.power);
        let double = 2.0 * degree + power;
        let shift = if degree == 0.0 {
            power / (power + 2.0)
        } else {
            power * power / (double * (double + 2.0))
        };
        // Of the first, degree + power is double − 1.
        let factor = if degree == 1.0 {
            4.0 * (1.0 + power) / (double * double * (double + 1.0))
        } else {
            let product = degree * (degree + power);
            4.0 * product * product / (double * double * (double * double - 1.0))
        };
        (shift, factor)
    }

    /// The polynomial of a degree with the leading coefficient 1.
    fn value(&self, degree: usize, x: f64) -> f64 {
        let (mut before, mut last) = (0.0, 1.0);
        for step in 0..degree {
            let (shift, factor) = self.coefficients(step);
            let next = (x - shift) * last - if step > 0 { factor * before } else { 0.0 };
            (before, last) = (last, next);
        }
        last
    }

    /// The sum of the squares of the orthonormal polynomials below a degree, for the weight t^p on 0 to 1.
    fn sum_of_squares(&self, degree: usize, x: f64) -> f64 {
        let mut norm_sq = 1.0 / (1.0 + self.power);
        let mut sum = 1.0 / norm_sq;
        for step in 1..degree {
            let (_, factor) = self.coefficients(step);
            norm_sq *= factor;
            let value = self.value(step, x);
            sum += value * value / norm_sq;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integral<const NODES: usize>(rule: &JacobiRule<NODES>, of: impl Fn(f64) -> f64) -> f64 {
        let weighed = rule.nodes.iter().zip(&rule.weights);
        weighed.map(|(node, weight)| weight * of(*node)).sum()
    }

    #[test]
    fn powers_are_integrated_exactly() {
        for power in [0.0, 0.02, 0.1, 0.5, 0.9, 1.3, 2.6, 5.9] {
            let rule = JacobiRule::<8>::new(power);
            for degree in 0..16 {
                let more = power + f64::from(degree);
                let error = integral(&rule, |t| libm::pow(t, more)) * (more + 1.0) - 1.0;
                assert!(error.abs() < 2e-14, "{power} {degree}: {error:e}");
            }
            let beyond = power + 16.0;
            let error = integral(&rule, |t| libm::pow(t, beyond)) * (beyond + 1.0) - 1.0;
            assert!(error.abs() > 1e-12, "{power}: {error:e}");
        }
    }

    #[test]
    fn without_a_power_it_is_plain() {
        let rule = JacobiRule::<3>::new(0.0);
        let outer = 0.5 - 0.5 * 0.6_f64.sqrt();
        let nodes = [outer, 0.5, 1.0 - outer];
        for (index, weight) in [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0].into_iter().enumerate() {
            assert!((rule.nodes[index] - nodes[index]).abs() < 1e-15);
            assert!((rule.weights[index] - weight).abs() < 1e-15);
        }
    }
}
