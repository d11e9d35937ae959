//! The light of samples that are taken together.

use fearless_simd::Simd;
use glam::DVec3;

use super::groups::Groups;
use super::last_places::Seen;
use super::light::{Light, Looks};
use super::rays::{Place, Rays, Spread};
use super::shadow::{Scale, Shadows};
use super::sums::Sample;
use super::supersampling::{ROWS, Supersampling};
use super::tile_balls::{TileBall, TileBalls};
use super::trace::{RayRow, Tracer};
use crate::model::camera::Projection;
use crate::numeric::bits::set_bits;
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

/// Up to eight places in a tile, of eight samples each.
pub(super) struct Places {
    list: [Place; ROWS],
    count: usize,
    balls: BallsOf,
}

/// The places, as bits, at which a ball of the tile may be seen.
enum BallsOf {
    /// One place in each row of the tile.
    Rows,
    /// All places, of the only pixel.
    Pixel,
    /// Places in a row of the tile, counted from the first: those in each of its columns, as bits.
    Row { row: u32, of_column: [u8; ROWS] },
}

impl Places {
    /// The same cells of each pixel in so many rows.
    pub(super) fn rows(mut place: Place, height: u32) -> Self {
        let mut list = [place; ROWS];
        for of_row in &mut list {
            *of_row = place;
            place.row += 1;
        }
        Self {
            list,
            count: height as usize,
            balls: BallsOf::Rows,
        }
    }

    /// One place, in the only pixel of a tile.
    pub(super) fn one(place: Place) -> Self {
        Self {
            list: [place; ROWS],
            count: 1,
            balls: BallsOf::Pixel,
        }
    }

    /// No places yet, in a row of a tile.
    pub(super) fn in_row(place: Place, row: u32) -> Self {
        Self {
            list: [place; ROWS],
            count: 0,
            balls: BallsOf::Row {
                row,
                of_column: [0; ROWS],
            },
        }
    }

    /// Adds a place in a column of the tile, counted from the first.
    pub(super) fn add(&mut self, place: Place, column: u32) {
        if let BallsOf::Row { of_column, .. } = &mut self.balls {
            of_column[column as usize] |= 1 << self.count;
        }
        self.list[self.count] = place;
        self.count += 1;
    }

    /// Takes all places away.
    pub(super) fn clear(&mut self) {
        self.count = 0;
        if let BallsOf::Row { of_column, .. } = &mut self.balls {
            *of_column = [0; ROWS];
        }
    }

    pub(super) fn as_slice(&self) -> &[Place] {
        &self.list[..self.count]
    }

    pub(super) fn is_full(&self) -> bool {
        self.count == ROWS
    }

    /// The places, as bits, that may see a ball.
    #[inline(always)]
    pub(super) fn of_ball(&self, ball: &TileBall) -> u8 {
        match &self.balls {
            BallsOf::Rows => ball.rows,
            BallsOf::Pixel => u8::MAX,
            BallsOf::Row { row, of_column } => {
                let mut places = 0;
                if ball.rows >> row & 1 == 1 {
                    for column in set_bits(u64::from(ball.columns)) {
                        places |= of_column[column % ROWS];
                    }
                }
                places
            }
        }
    }
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
        let across = rays.across(simd, places.list[0], tracer.tile.width);
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
