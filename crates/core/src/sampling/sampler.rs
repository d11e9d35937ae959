//! The light of samples that are taken together.

use fearless_simd::Simd;
use glam::DVec3;

use super::groups::Groups;
use super::last_places::Seen;
use super::light::{Light, Looks};
use super::places::{Places, ROWS};
use super::rays::{Rays, Spread};
use super::shadow::{Scale, Shadows};
use super::sums::Sample;
use super::supersampling::Supersampling;
use super::tile_balls::TileBalls;
use super::trace::{RayRow, Tracer};
use crate::model::camera::Projection;
use crate::numeric::lanes::mask64x8;
use crate::numeric::vectors::Vectors;
use crate::picture::geometry::TileGeometry;
use crate::picture::tile::Tile;
use crate::search::shadow_cells::ShadowCells;

/// The search for what the rays of a tile see, and for its light.
pub(super) struct Sampler<'tile> {
    pub(super) tracer: Tracer<'tile>,
    pub(super) groups: Groups<'tile>,
    pub(super) looks: Looks<'tile>,
    /// The geometry that is seen, if somebody asks.
    geometry: &'tile mut TileGeometry,
    pub(super) shadows: Option<Shadows<'tile>>,
}

impl Supersampling<'_> {
    /// Finds the balls that rays of a tile may meet, with their columns or without.
    #[inline(never)]
    pub(super) fn gather<S: Simd>(
        &self,
        simd: S,
        rays: &Rays,
        (tile, with_columns): (Tile, bool),
        balls: &mut TileBalls,
    ) {
        let mut cells = rays.cells_on_unit();
        if rays.projection() == Projection::Parallel {
            cells *= libm::scalbn(1.0, self.index.length_exponent());
        }
        simd.vectorize(
            #[inline(always)]
            || {
                let of_tile = self.index.balls(tile);
                balls.gather(simd, (cells, with_columns), &rays.bundle(tile), of_tile);
            },
        );
    }

    /// Prepares the search among the balls of a tile, if there is any.
    pub(super) fn sampler<'tile>(
        &'tile self,
        rays: &'tile Rays,
        tile: Tile,
        balls: &'tile TileBalls,
        (cells, geometry): (&'tile mut ShadowCells, &'tile mut TileGeometry),
    ) -> Option<Sampler<'tile>> {
        let first = balls.list.first()?;
        Some(Sampler {
            tracer: Tracer {
                index: &self.index,
                rays,
                balls,
                tile,
                tests: 0,
            },
            groups: Groups::new(first),
            looks: Looks::new(&self.shading),
            geometry,
            shadows: (self.shading.world.shadows && !self.is_dark).then(|| {
                let length = libm::scalbn(1.0, self.index.length_exponent());
                let size = Scale {
                    length,
                    tile_side: rays.tile_side(),
                    projection: rays.projection(),
                    are_samples_dense: rays.are_dense(),
                };
                let viewpoint = self.view.camera.position;
                Shadows::new(&self.index.visibility, viewpoint, size, cells)
            }),
        })
    }

    /// Takes the samples at some places; `nothing` where no sphere is seen.
    ///
    /// Compiled once, and not wherever samples are taken.
    #[inline(never)]
    pub(super) fn sample_places<'tile, S: Simd, const CHANNELS: usize>(
        &'tile self,
        simd: S,
        places: &Places,
        nothing: &Sample<S, CHANNELS>,
        sampler: &mut Sampler<'tile>,
        samples: &mut [Sample<S, CHANNELS>; ROWS],
    ) {
        simd.vectorize(
            #[inline(always)]
            || self.sample_lanes_of_places(simd, places, nothing, sampler, samples),
        );
    }

    #[inline(always)]
    fn sample_lanes_of_places<'tile, S: Simd, const CHANNELS: usize>(
        &'tile self,
        simd: S,
        places: &Places,
        nothing: &Sample<S, CHANNELS>,
        sampler: &mut Sampler<'tile>,
        samples: &mut [Sample<S, CHANNELS>; ROWS],
    ) {
        let Sampler {
            tracer,
            groups,
            looks,
            geometry,
            shadows,
        } = sampler;
        let dark = RayRow::new(simd, Vectors::splat(simd, DVec3::ZERO));
        let mut rows = [dark; ROWS];
        let rays = tracer.rays;
        let across = rays.across(simd, places.first(), tracer.tile.width);
        let is_parallel = rays.projection() == Projection::Parallel;
        if !is_parallel {
            for (row, &place) in rows.iter_mut().zip(places.as_slice()) {
                let directions = match place.spread {
                    Spread::Pixels => rays.directions(across, place),
                    Spread::Block | Spread::Strata => rays.directions_in_pixel(simd, place),
                };
                *row = RayRow::new(simd, directions);
            }
            tracer.search(simd, places, &mut rows);
        }
        for ((&place, row), sample) in places.as_slice().iter().zip(&rows).zip(samples) {
            let sight = if is_parallel {
                tracer.look_along(simd, place, groups)
            } else {
                tracer.look(simd, place, row, groups)
            };
            *sample = *nothing;
            if let Some(centers) = &self.centers {
                let row = &mut geometry.rows[(place.row - tracer.tile.row) as usize % ROWS];
                if sight.covered != 0 {
                    let seen = Seen {
                        sight: &sight,
                        groups,
                        place,
                        across,
                    };
                    centers.record(simd, &seen, tracer, &self.shading, looks, row);
                }
            }
            if sight.covered != 0 && !self.is_dark {
                looks.see(&self.shading, groups);
                let seen = (&sight, &*groups, &mut *looks);
                let light: Light<S, CHANNELS> = self.shading.light(simd, seen, place, shadows);
                let covered = mask64x8::from_bitmask(simd, sight.covered);
                let background = &nothing.light;
                for channel in 0..CHANNELS {
                    sample.light[channel] = covered.select(light[channel], background[channel]);
                }
                sample.covered = sight.covered;
            }
        }
    }
}
