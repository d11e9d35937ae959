//! The places on arcs where light summed up along lines is singular.
//!
//! What begins with a power that is not whole at a terminator begins at a level of y: there the terminator meets the
//! reference of the lines, or no line beyond. The reference also leads to the highest and to the lowest point of an
//! contour. Below the highest one sums have the power 3/2 of the depth, which is that of the root of the discriminant
//! on the reference. The depth goes with the square of the way where the contour turns, or another arc close to it: the
//! power is about the third one of the way, without its sign.
//!
//! Arcs are cut there, so that what is singular on an arc is so at its ends, where rules are made for it, or is not
//! singular on either part.

use fearless_simd::Simd;

use super::arcs::Lanes;
use super::chord::Reference;
use super::circle::Trace;
use super::events::{INTERVALS, Stretch};
use super::functions::{Function, value};
use super::setting::{Arc, Boundary, Edge, Setting};
use crate::numeric::lanes::f64x8;
use crate::numeric::polynomial::Quadratic;

impl Boundary {
    /// Notes the levels of a terminator in the cell: where the reference of its sphere meets it, and where lines
    /// touch it.
    pub(super) fn add_levels(&mut self, sphere: usize, reference: &Reference, conic: &Quadratic) {
        let touched = conic.extremes().map(|(_, y)| y);
        let met = reference.crossings(conic);
        for y in touched.into_iter().chain(met) {
            if y.abs() < 0.5 {
                self.levels.push((sphere, y));
            }
        }
    }

    /// Cuts the arcs of a piece where they turn, and at the levels of what is seen beside them; these are the piece's
    /// eight places.
    #[inline(always)]
    pub(super) fn cut_at_levels<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        whole: &Stretch<'_>,
        places: &Trace<S>,
    ) {
        let rises = places.dy.simd_gt(0.0).to_bitmask();
        let falls = places.dy.simd_lt(0.0).to_bitmask();
        let turns = !whole.curve.is_side() && rises != 0 && falls != 0;
        if self.levels.is_empty() && !turns {
            return;
        }
        let count = self.lit_arcs.len();
        for index in 0..count {
            let arc = self.lit_arcs[index];
            let is_lit = arc.lit != [0; 2];
            self.cut(simd, setting, whole, &arc, turns && is_lit);
        }
        self.lit_arcs.drain(..count);
    }

    /// Appends the parts of an arc, which may turn, between the levels.
    #[inline(never)]
    fn cut<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        whole: &Stretch<'_>,
        arc: &Arc,
        may_turn: bool,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                self.breaks.clear();
                let is_singular = setting.is_singular(arc);
                if is_singular || may_turn {
                    let stretch = Stretch {
                        start: arc.start,
                        end: arc.end,
                        ..*whole
                    };
                    let places = stretch.places(simd, setting);
                    // A terminator or a cutoff touches the level of its own highest place, which no change of sign tells.
                    if may_turn || matches!(whole.curve.edge, Edge::Terminator(_) | Edge::Cutoff(_))
                    {
                        let (level, breaks) = (Function::Rise, &mut self.breaks);
                        stretch.roots(simd, setting, level, places.dy, INTERVALS, breaks);
                    }
                    for &(sphere, y) in &self.levels {
                        if is_singular && (sphere == arc.inner || sphere == arc.outer) {
                            let level = Function::Across(1, y);
                            let values = value(simd, setting, level, &places);
                            let breaks = &mut self.breaks;
                            stretch.roots(simd, setting, level, values, INTERVALS, breaks);
                        }
                    }
                }
                if self.breaks.is_empty() {
                    self.lit_arcs.push(*arc);
                    return;
                }
                self.order_breaks(arc.start, arc.end);
                let steps = self.breaks.len() - 1;
                for first in (0..steps).step_by(Lanes::STEPS) {
                    let places =
                        whole.trace(simd, setting, f64x8::from_array(simd, self.steps(first)));
                    for step in 0..(steps - first).min(Lanes::STEPS) {
                        let lanes = Lanes::of_step(step);
                        self.lit_arcs.push(Arc {
                            start: self.breaks[first + step],
                            end: self.breaks[first + step + 1],
                            y: [places.y[lanes.start], places.y[lanes.end]],
                            ..*arc
                        });
                    }
                }
            },
        )
    }
}
