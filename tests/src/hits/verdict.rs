//! Compares hits with the claims of [`Sphere::hit`](marbles_core::Sphere::hit), by means of the judge.

use marbles_core::Hit;

use super::judge::ExactHit;
use super::tally::Tally;

/// The claimed error of t, in units in the last place.
const DISTANCE_CLAIM: f64 = 1.0;

/// The claimed angle between the normal and the exact one, in 2⁻⁵³ radians.
const ANGLE_CLAIM: f64 = 2.0;

/// The claimed difference between the length of the normal and 1, in 2⁻⁵³. In the first kind of arithmetic it includes
/// the rounding of 1 / r as well as that of the components.
const LENGTH_CLAIM: f64 = 2.5;

/// Counts a case; returns a message if a claim is wrong.
pub fn verdict(tally: &mut Tally, exact: Option<&ExactHit>, found: Option<Hit>) -> Option<String> {
    let (distance, angle) = tally.count(exact, found.map(|hit| (hit.t, hit.normal)));
    let (exact, found) = match (exact, found) {
        (None, None) => return None,
        (Some(exact), Some(found)) => (exact, found),
        (Some(_), None) => return Some("a false miss".to_owned()),
        (None, Some(_)) => return Some("a false hit".to_owned()),
    };
    let length = ExactHit::excess_length(found.normal);
    let right = distance <= DISTANCE_CLAIM
        && angle <= ANGLE_CLAIM
        && length <= LENGTH_CLAIM
        && found.inner_side == exact.inner_side;
    let inner_side = exact.inner_side;
    (!right).then(|| {
        format!(
            "t is off by {distance} ulp, n by {angle} · 2^-53 rad and {length} · 2^-53 in \
             length, inner side {inner_side}: {found:?}"
        )
    })
}
