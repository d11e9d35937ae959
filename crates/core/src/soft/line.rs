//! The spheres that are seen along a horizontal line of the picture.

use super::candidate::Candidate;
use super::seam::Seam;
use crate::model::camera::Projection;

/// A part of a line on which one sphere, or none, is met.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub(crate) begin: f64,
    pub(crate) end: f64,
    /// The place of the candidate that is met there.
    pub(crate) met: Option<usize>,
    /// The place of the candidate that is seen there with light; none where light is known to be none.
    pub(crate) seen: Option<usize>,
}

/// The candidate that a ray meets first, and whether its light is seen.
pub(super) fn first(
    candidates: &[Candidate],
    u: f64,
    v: f64,
    projection: Projection,
) -> Option<(usize, bool)> {
    let mut nearest: Option<(usize, f64, bool)> = None;
    let mut is_hidden = false;
    for (place, candidate) in candidates.iter().enumerate() {
        let Some((distance, is_inside)) = candidate.distance(u, v, projection) else {
            continue;
        };
        is_hidden |= is_inside && candidate.hides_light;
        if nearest.is_none_or(|(_, least, _)| distance < least) {
            nearest = Some((place, distance, is_inside));
        }
    }
    let (place, _, is_inside) = nearest?;
    Some((
        place,
        !is_hidden && candidates[place].has_light(u, v, projection, is_inside),
    ))
}

/// Finds what is seen along the line at the height `v` from one place to another: it changes only at contours and at seams.
pub(crate) fn spans(
    (candidates, seams): (&[Candidate], &[Seam]),
    [from, to]: [f64; 2],
    v: f64,
    projection: Projection,
    ends: &mut Vec<f64>,
    spans: &mut Vec<Span>,
) {
    ends.clear();
    for candidate in candidates {
        candidate.add_ends(v, candidate.radius, projection, ends);
        if let Some(inner) = candidate.inner {
            candidate.add_ends(v, inner, projection, ends);
        }
        if let Some(cut) = candidate.cut(projection) {
            candidate.add_ends(v, cut, projection, ends);
        }
    }
    for seam in seams {
        seam.add_ends(v, projection, ends);
    }
    ends.retain(|&end| end > from && end < to);
    ends.push(to);
    ends.sort_unstable_by(f64::total_cmp);
    spans.clear();
    let mut begin = from;
    for &end in &*ends {
        if end <= begin {
            continue;
        }
        let first = first(candidates, 0.5 * (begin + end), v, projection);
        let met = first.map(|(place, _)| place);
        let seen = first.and_then(|(place, has_light)| has_light.then_some(place));
        match spans.last_mut() {
            Some(last) if (last.met, last.seen) == (met, seen) => last.end = end,
            _ => spans.push(Span {
                begin,
                end,
                met,
                seen,
            }),
        }
        begin = end;
    }
}
