//! Levels of y at which light summed up along lines is singular: what begins with a power that is not whole at
//! a terminator begins there on the reference of the lines, or on no line beyond.
//!
//! Arcs are cut at them, so that what is singular on an arc is so at its ends, where rules are made for it.

use fearless_simd::prelude::*;

use super::arcs::Lanes;
use super::chord::Reference;
use super::events::{Function, INTERVALS, Stretch, value};
use super::setting::{Arc, Boundary, Edge, Setting};
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

    /// Cuts the arcs of a piece at the levels of what is seen beside them.
    #[inline(always)]
    pub(super) fn cut_at_levels<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'_, '_>,
        whole: &Stretch<'_>,
    ) {
        if self.levels.is_empty() {
            return;
        }
        let count = self.lit_arcs.len();
        for index in 0..count {
            let arc = self.lit_arcs[index];
            self.cut(simd, setting, whole, &arc);
        }
        self.lit_arcs.drain(..count);
    }

    /// Appends the parts of an arc between the levels.
    #[inline(never)]
    fn cut<S: Simd>(&mut self, simd: S, setting: &Setting<'_, '_>, whole: &Stretch<'_>, arc: &Arc) {
        simd.vectorize(
            #[inline(always)]
            || {
                self.breaks.clear();
                if setting.is_singular(arc) {
                    let stretch = Stretch {
                        start: arc.start,
                        end: arc.end,
                        ..*whole
                    };
                    let places = stretch.places(simd, setting);
                    if let Edge::Terminator(_) = whole.curve.edge {
                        // It touches the level of its own highest place, which no change of sign tells.
                        let (level, breaks) = (Function::Rise, &mut self.breaks);
                        stretch.roots(simd, setting, level, places.dy, INTERVALS, breaks);
                    }
                    for &(sphere, y) in &self.levels {
                        if sphere == arc.inner || sphere == arc.outer {
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
                    let places = whole.trace(simd, setting, self.steps(first).simd_into(simd));
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
