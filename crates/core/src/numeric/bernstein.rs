//! The error of the mean of random samples.

/// ln(3/δ), where δ = 10⁻⁹ is the probability with which a claim may be too small.
const CONFIDENCE: f64 = 21.822;

/// The error of the mean of independent samples in strata, two in each, from the sum of the squared differences in these
/// pairs; samples lie within a range of so much.
///
/// # Accuracy
/// An estimate that holds with a probability. With V the sum of the variances in the strata, of which half the squared
/// difference of both samples is an estimate without bias, and R the range, the mean of N samples is off by more than
/// √(2 V L) / N + 3 R L / N with a probability of at most 3 exp(−L). The second part counts what samples missed
/// altogether, such as tops of highlights.
///
/// # Source
/// Audibert, Munos, Szepesvári, Exploration–exploitation tradeoff using variance estimates in multi-armed bandits,
/// Theoretical Computer Science 410, 2009, theorem 1.
pub(crate) fn error_of_mean(squares: f64, range: f64, count: f64) -> f64 {
    // Both samples of a stratum have the variance.
    ((2.0 * CONFIDENCE * squares).sqrt() + least_error(range, 1.0)) / count
}

/// The least error that the mean of so many samples may claim: that of samples that are all alike.
pub(crate) fn least_error(range: f64, count: f64) -> f64 {
    3.0 * CONFIDENCE * range / count
}
