//! What one cap leaves of a disc.

use std::f64::consts::TAU;

use glam::DVec3;

use super::cap::{Cap, Meeting};

/// The integral of the directions ω, as vectors, over what a cap leaves of a disc; none if their circles do not cross, or if
/// the axes are nearly opposite.
///
/// It is bounded by two arcs with the same ends, so of the integral along its border the chords cancel: what is left are the
/// segments between the arcs and their chords, ½ s² (φ − sin φ) a of each circle.
pub(crate) fn left_of(disc: &Cap, cap: &Cap) -> Option<DVec3> {
    let (Meeting::Crossing(inside), Meeting::Crossing(covered)) =
        (cap.meeting(disc, false), disc.meeting(cap, true))
    else {
        return None;
    };
    let of_cap = segment(2.0 * inside.half_width());
    let of_disc = segment(TAU - 2.0 * covered.half_width());
    let part = |cap: &Cap, segment: f64| cap.axis * (0.5 * cap.sine * cap.sine * segment);
    Some(part(disc, of_disc) - part(cap, of_cap))
}

/// φ − sin φ.
pub(super) fn segment(angle: f64) -> f64 {
    if angle > 0.5 {
        return angle - libm::sin(angle);
    }
    // φ³/3! − φ⁵/5! + …, to 2⁻⁶⁰ of the first term.
    let square = angle * angle;
    let mut sum = 0.0;
    for order in [15.0, 13.0, 11.0, 9.0, 7.0, 5.0] {
        sum = square / (order * (order - 1.0)) * (1.0 - sum);
    }
    square * angle / 6.0 * (1.0 - sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soft::visible::Hidden;

    #[test]
    fn what_is_left_agrees_with_arcs() {
        let mut hidden = Hidden::default();
        let mut counted = 0;
        for number in 0..2_000 {
            let turn = f64::from(number);
            let size = |phase: f64| 0.5 + 0.5 * libm::sin(phase * turn);
            let toward = DVec3::new(libm::cos(turn), libm::sin(turn), size(0.7) - 0.5).normalize();
            let angle = libm::exp(-9.0 * size(0.31));
            let disc = Cap::within(toward, angle);
            let cap_angle = 1.5 * libm::exp(-6.0 * size(0.57));
            // Between where one touches the other from inside and from outside.
            let (nearest, width) = ((cap_angle - angle).abs(), 2.0 * angle.min(cap_angle));
            let reach = nearest + size(0.83) * width;
            let aside = toward.any_orthonormal_vector();
            let (sine, cosine) = libm::sincos(reach);
            let cap = Cap::within(toward * cosine + aside * sine, cap_angle);
            let Some(left) = left_of(&disc, &cap) else {
                continue;
            };
            counted += 1;
            hidden.clear();
            hidden.add(cap);
            let by_arcs = hidden.seen_by_arcs_of(&disc);
            let error = (left - by_arcs).length() / disc.solid_angle();
            // Rounding of the axes matters more to small discs.
            assert!(error < 1e-14 / angle, "{number}: {error:e}");
        }
        assert!(counted > 1_000, "{counted}");
    }
}
