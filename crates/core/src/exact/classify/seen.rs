//! The spheres that up to eight pixels of a row see, in any light.

use std::ops::Range;

use fearless_simd::Simd;

use super::row::{Coverage, Sight, classify_row, sight};
use crate::edges::cell::Ball;
use crate::exact::context::Context;
use crate::exact::crowd::{CrowdWork, FEWEST};
use crate::picture::tile::Tile;

/// The spheres that up to eight pixels of a row see: the same under all lights.
#[derive(Debug, Default)]
pub(crate) struct SeenRow {
    coverages: Vec<Coverage>,
    /// The places among these of spheres that fill pixels, and these pixels bit by bit.
    filled: Vec<(usize, u64)>,
    /// The numbers of pixels with edges, and the places of the spheres that each may see.
    edged: Vec<(usize, Range<usize>)>,
    spheres: Vec<(usize, Ball)>,
    /// The spheres that a pixel may see.
    of_pixel: Vec<(usize, Ball)>,
    /// The work on the tile's crowds that is the same under all lights.
    pub(crate) crowds: CrowdWork,
}

impl SeenRow {
    /// Finds out how the pixels of a row see the `candidates`, whose balls are `balls`.
    #[inline(always)]
    pub(crate) fn see<S: Simd>(
        &mut self,
        simd: S,
        context: &Context<'_>,
        row: Tile,
        (candidates, balls): (&[usize], &[Ball]),
    ) {
        let Self {
            coverages,
            filled,
            edged,
            spheres,
            of_pixel,
            crowds,
        } = self;
        coverages.clear();
        simd.vectorize(
            #[inline(always)]
            || classify_row(simd, context, row, (candidates, balls), coverages),
        );
        if candidates.len() > FEWEST {
            /// Spheres that a row asks whether it sees them in the time of a unit.
            const A_UNIT: usize = 2;
            crowds.spend((candidates.len() / A_UNIT) as u64);
        }
        filled.clear();
        edged.clear();
        spheres.clear();
        for lane in 0..row.width as usize {
            let pixel = Tile {
                col: row.col + lane as u32,
                width: 1,
                ..row
            };
            match sight(context, pixel, lane, coverages, (of_pixel, crowds)) {
                Sight::Nothing => {}
                Sight::Filled(sphere) => {
                    let Some(place) = coverages.iter().position(|one| one.sphere == sphere) else {
                        continue;
                    };
                    match filled.iter_mut().find(|known| known.0 == place) {
                        Some((_, lanes)) => *lanes |= 1 << lane,
                        None => filled.push((place, 1 << lane)),
                    }
                }
                Sight::Edges => {
                    let first = spheres.len();
                    spheres.extend_from_slice(of_pixel);
                    edged.push((lane, first..spheres.len()));
                }
            }
        }
    }

    /// The spheres that fill pixels, and these pixels bit by bit.
    pub(crate) fn filled(&self) -> impl Iterator<Item = (&Coverage, u64)> {
        let filled = self.filled.iter();
        filled.map(|&(place, which)| (&self.coverages[place], which))
    }

    /// The numbers of pixels with edges, and the spheres that each may see.
    pub(crate) fn edged(&self) -> impl Iterator<Item = (usize, &[(usize, Ball)])> {
        let edged = self.edged.iter();
        edged.map(|(lane, places)| (*lane, &self.spheres[places.clone()]))
    }
}
