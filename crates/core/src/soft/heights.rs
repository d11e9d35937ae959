//! The heights at which what is seen along horizontal lines of a cell may change other than smoothly.
//!
//! Contours and seams are circles in space. Between the heights at which they enter and leave the cell at its sides, and
//! those of their highest and lowest points, the ends of spans move smoothly, but for places where three spheres meet.

use glam::{DVec2, DVec3};

use super::candidate::Candidate;
use super::line::{Span, spans};
use super::seam::Seam;
use crate::model::camera::Projection;
use crate::numeric::order::sort_by_number;

/// A height, and whether something begins or ends there that widens with the square root of the distance from it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Height {
    pub(crate) v: f64,
    pub(crate) is_turn: bool,
}

impl Height {
    /// One at which something crosses a side of the cell.
    pub(crate) fn crossing(v: f64) -> Self {
        Self { v, is_turn: false }
    }
}

/// A circle in space.
struct Circle {
    center: DVec3,
    /// Two vectors from its center to points of it, at right angles.
    arms: [DVec3; 2],
}

impl Circle {
    fn new(center: DVec3, normal: DVec3, radius_sq: f64) -> Self {
        let across = normal.any_orthonormal_vector();
        let radius = radius_sq.max(0.0).sqrt();
        Self {
            center,
            arms: [across * radius, normal.cross(across) * radius],
        }
    }

    /// Its highest and its lowest point in the picture.
    fn extremes(&self, projection: Projection) -> Option<[DVec2; 2]> {
        let [a, b] = self.arms;
        // Where c cos φ + s sin φ + rest = 0, the height of the point c cos φ + … does not change with φ.
        let (c, s, rest) = match projection {
            Projection::Central => (
                self.center.z * b.y - self.center.y * b.z,
                self.center.y * a.z - self.center.z * a.y,
                b.y * a.z - a.y * b.z,
            ),
            Projection::Parallel => (b.y, -a.y, 0.0),
        };
        let square = c * c + s * s;
        let root = (square - rest * rest).sqrt();
        if !(root.is_finite() && square > 0.0) {
            return None;
        }
        let extreme = |sign: f64| {
            let cosine = (-rest * c - sign * s * root) / square;
            let sine = (-rest * s + sign * c * root) / square;
            let point = self.center + a * cosine + b * sine;
            match projection {
                Projection::Central => point.truncate() / point.z,
                Projection::Parallel => point.truncate(),
            }
        };
        Some([extreme(1.0), extreme(-1.0)])
    }
}

/// The contour of a sphere with the candidate's center and some radius.
fn contour(candidate: &Candidate, radius: f64, projection: Projection) -> Circle {
    let center = candidate.center;
    match projection {
        Projection::Central => {
            let distance_sq = center.length_squared();
            let outside = distance_sq - radius * radius;
            let share = outside / distance_sq;
            Circle::new(
                center * share,
                center / distance_sq.sqrt(),
                radius * radius * share,
            )
        }
        Projection::Parallel => Circle::new(center, DVec3::Z, radius * radius),
    }
}

/// Finds these heights within those of a cell, from its lowest to its highest. Calls `visit` with what is seen along the cell's
/// left and right side, and with more heights to add.
pub(crate) fn heights(
    (candidates, seams): (&[Candidate], &[Seam]),
    (u, v): ([f64; 2], [f64; 2]),
    projection: Projection,
    (ends, found): (&mut Vec<f64>, &mut Vec<Span>),
    mut visit: impl FnMut(f64, &Span, &mut Vec<Height>),
) -> Vec<Height> {
    let mut heights = v.map(Height::crossing).to_vec();
    let turned: Vec<Candidate> = candidates.iter().map(Candidate::transposed).collect();
    let turned_seams: Vec<Seam> = seams.iter().map(Seam::transposed).collect();
    for side in u {
        spans((&turned, &turned_seams), v, side, projection, ends, found);
        heights.extend(found.iter().map(|span| Height::crossing(span.end)));
        for span in &*found {
            visit(side, span, &mut heights);
        }
    }
    let contours = candidates.iter().flat_map(|candidate| {
        let radii = [
            Some(candidate.radius),
            candidate.inner,
            candidate.cut(projection),
        ];
        let radii = radii.into_iter().flatten();
        radii.map(|radius| contour(candidate, radius, projection))
    });
    let of_seams = seams
        .iter()
        .map(|seam| Circle::new(seam.center, seam.normal, seam.radius_sq));
    for circle in contours.chain(of_seams) {
        let points = circle.extremes(projection).into_iter().flatten();
        let inside = points.filter(|point| (u[0]..=u[1]).contains(&point.x));
        heights.extend(inside.map(|point| Height {
            v: point.y,
            is_turn: true,
        }));
    }
    heights.retain(|height| (v[0]..=v[1]).contains(&height.v));
    let pair = |height: &Height| (height.v, usize::from(height.is_turn));
    let mut pairs: Vec<(f64, usize)> = heights.iter().map(pair).collect();
    sort_by_number(&mut pairs);
    heights.clear();
    for (v, is_turn) in pairs {
        let is_turn = is_turn == 1;
        match heights.last_mut() {
            Some(last) if last.v == v => last.is_turn |= is_turn,
            _ => heights.push(Height { v, is_turn }),
        }
    }
    heights
}
