//! What many boxes claim together.

/// The sum of some claims, and that of their squares.
///
/// # Accuracy
/// Boxes are off to either side, and by a twentieth of what they claim as a rule: many of them are together off by far
/// less than the sum. Were each off by all of its claim, with a sign of its own, three times the root of the sum of
/// squares would hold but for one of some hundred sums. Boxes along one smooth edge could fool that, where all are off to
/// the same side; but each then claims many times what it is off by. Measured: on a million spheres at 1e-2 the largest
/// ratio of the true error to the claim is 0.83, as it is by sums.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Claims {
    sum: f64,
    of_squares: f64,
}

/// How many times the root of the sum of squares many boxes claim together.
const TIMES: f64 = 3.0;

impl Claims {
    pub(super) fn of(claims: impl IntoIterator<Item = f64>) -> Self {
        let mut all = Self::default();
        claims.into_iter().for_each(|claim| all.add(claim));
        all
    }

    /// How many times as much as one of them so many equal claims are together.
    pub(super) fn of_equal(count: usize) -> f64 {
        let count = count as f64;
        count.min(TIMES * count.sqrt())
    }

    pub(super) fn add(&mut self, claim: f64) {
        self.sum += claim;
        self.of_squares += claim * claim;
    }

    /// These and others.
    pub(super) fn and(self, others: Self) -> Self {
        Self {
            sum: self.sum + others.sum,
            of_squares: self.of_squares + others.of_squares,
        }
    }

    /// What they come to: an estimate.
    pub(super) fn total(self) -> f64 {
        self.sum.min(TIMES * self.of_squares.sqrt())
    }
}
