//! Lines of a cell at which something is known to happen.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::cell::Workspace;
use crate::edges::cell::Cell;
use crate::edges::shadow::Arcs;
use crate::exact::classify::contents::Reach;
use crate::exact::scene::InCamera;

/// A line at which something is known to happen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Break {
    pub(crate) y: f64,
    /// Whether a curve touches the line there.
    pub(crate) is_extreme: bool,
}

impl Workspace {
    /// Finds lines at which edges enter or leave the cell by its sides, or turn back.
    #[inline(always)]
    pub(crate) fn find_breaks<S: Simd>(&mut self, simd: S, scene: &InCamera<'_>, cell: &Cell) {
        let Self {
            contents,
            breaks,
            scratch,
            ..
        } = self;
        breaks.clear();
        let mut note = |y: f64, is_extreme: bool| {
            if y > -0.5 && y < 0.5 {
                breaks.push(Break { y, is_extreme });
            }
        };
        let sides: f64x8<S> = [-0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5].simd_into(simd);
        for (_, conic) in &contents.conics {
            let crossings = conic.transposed().crossings(sides);
            for lane in 0..2 {
                note(crossings.rising[lane], false);
                note(crossings.falling[lane], false);
            }
            for (x, y) in conic.extremes() {
                if x > -0.5 && x < 0.5 {
                    note(y, true);
                }
            }
        }
        let lights = scene.lights.len();
        let across = cell.transposed();
        for (position, active) in contents.active.iter().enumerate() {
            let mut arcs = None;
            for light in 0..lights {
                let Reach::Past(casters) = &contents.reach[position * lights + light] else {
                    continue;
                };
                for caster in &contents.occluders[casters.clone()] {
                    let arcs = match arcs {
                        Some(ref arcs) => arcs,
                        None => arcs.insert(Arcs::new(simd, &across, &active.ball, sides)),
                    };
                    for places in arcs
                        .crossings(simd, &across, caster, scratch)
                        .iter()
                        .flatten()
                    {
                        note(places[0], false);
                        note(places[1], false);
                    }
                    // The middle of the shadow, should it be smaller than the distance of lines.
                    let toward = scene.lights[light].toward;
                    let (x, y) = cell.place(active.ball.under(caster, toward));
                    if x > -0.5 && x < 0.5 {
                        note(y, false);
                    }
                }
            }
        }
        breaks.sort_unstable_by(|a, b| a.y.total_cmp(&b.y));
    }
}
