//! Properties of an arc that make it hard for a rule along it.

use fearless_simd::Simd;
use glam::DVec3;

use super::circle::Trace;
use super::functions::polynomial;
use super::primitive::ray;
use super::setting::{Arc, Curve, Edge, NONE, Setting};
use crate::exact::edged::rule::{MIDDLE, NODES};
use crate::exact::points::Points;

/// The ends of an arc at which the contour of a sphere beside it begins, on which the arc does not lie: there
/// light goes with the root of the distance, as the contour's own points do. Between its nodes in the middle and
/// beside the ends the discriminant is nearly linear.
#[inline(always)]
pub(super) fn roots_at_ends<S: Simd>(
    setting: &Setting<'_, '_>,
    curve: &Curve,
    arc: &Arc,
    places: &Trace<S>,
) -> [bool; 2] {
    /// The least value at an end, relative to that in the middle; for a line that vanishes at the end it is 0.04.
    const LEAST: f64 = 0.08;
    let (sphere, lit) = match curve.edge {
        Edge::Left | Edge::Right => (arc.inner, arc.lit[0]),
        Edge::Limb => (arc.outer, arc.lit[1]),
        _ => return [false; 2],
    };
    if sphere == NONE || lit == 0 {
        return [false; 2];
    }
    let discriminant = &setting.contents.active[sphere].discriminant;
    let values = polynomial(discriminant, places.x, places.y);
    let least = LEAST * values[MIDDLE];
    [values[0] < least, values[NODES - 1] < least]
}

/// Whether the lines of an arc are farther apart than bumps let them: what lies between them would be overlooked
/// by both rules. Counted at the arc, where chords begin, and halfway.
#[inline(never)]
pub(super) fn spans_bumps<S: Simd>(
    simd: S,
    setting: &Setting<'_, '_>,
    arc: &Arc,
    places: &Trace<S>,
) -> bool {
    /// Cells of the noise that the seven lines of an arc may span. Noise has no shorter waves than two cells.
    const MOST_CELLS: f64 = 2.0;
    simd.vectorize(
        #[inline(always)]
        || {
            for (sphere, lit) in [(arc.inner, arc.lit[0]), (arc.outer, arc.lit[1])] {
                if sphere == NONE || lit == 0 {
                    continue;
                }
                let surface = &setting.surfaces[sphere];
                let cells = surface.finish.shading_normal.cells();
                if cells == 0.0 {
                    continue;
                }
                let ball = &setting.contents.active[sphere].ball;
                let start = surface.reference.at(places.y);
                for x in [places.x, start, (places.x + start) * 0.5] {
                    let points = Points::new(simd, ball, ray(simd, setting.cell, x, places.y));
                    let normal = &points.normal;
                    let mut way = 0.0;
                    for node in 1..NODES {
                        let at = |node: usize| {
                            DVec3::new(normal.x[node], normal.y[node], normal.z[node])
                        };
                        way += at(node).distance(at(node - 1));
                    }
                    if way * cells > MOST_CELLS {
                        return true;
                    }
                }
            }
            false
        },
    )
}
