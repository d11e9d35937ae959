//! Outlines beside curves: where they begin and end along them, and on which side they are seen.

use fearless_simd::Simd;

use super::circle::Trace;
use super::events::Stretch;
use super::functions::{Function, value};
use super::setting::{Boundary, Curve, Edge, NONE, Setting};
use crate::exact::classify::face::Face;

impl Boundary {
    /// Finds where, in some intervals, outlines begin or end of spheres beside a stretch.
    #[inline(never)]
    pub(super) fn find_outlines<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        stretch: &Stretch<'_>,
        places: &Trace<S>,
        open: u64,
    ) {
        let curve = stretch.curve;
        for position in 0..setting.contents.active.len() {
            // Contours have no outline but their own beside them, and what is light has ends of its own.
            let is_own = curve.own.contains(&position) && curve.edge != Edge::Seam;
            if is_own || !matches!(setting.contents.face(position), Face::Inside(..)) {
                continue;
            }
            let function = Function::Outline(position);
            let values = value(simd, setting, function, places);
            stretch.roots(simd, setting, function, values, open, &mut self.breaks);
        }
    }
}

/// Whether outlines are what is seen of the spheres on either side of a curve, in one of some places.
#[inline(always)]
pub(super) fn outlines<S: Simd>(
    setting: &Setting<'_, '_>,
    curve: &Curve,
    spheres: [usize; 2],
    (places, lane): (&Trace<S>, usize),
) -> [bool; 2] {
    let contents = setting.contents;
    if !contents.has_outlines() {
        return [false; 2];
    }
    match curve.edge {
        Edge::Outline => return [false, true],
        Edge::Terminator(_) | Edge::Cutoff(_) | Edge::Shadow(..) => return [false; 2],
        Edge::Left | Edge::Right | Edge::Limb | Edge::Seam => {}
    }
    let mut outlines = [false; 2];
    for (side, sphere) in spheres.into_iter().enumerate() {
        if sphere == NONE {
            continue;
        }
        let face = contents.face(sphere);
        let is_own_limb = side == 0 && curve.edge == Edge::Limb;
        outlines[side] = match is_own_limb {
            // Inside of a contour there is nothing but the outline, however narrow it is.
            true => !matches!(face, Face::All),
            false => face.is_outline_at(places.x[lane], places.y[lane]),
        };
    }
    outlines
}
