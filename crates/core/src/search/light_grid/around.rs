//! What may darken a whole sphere, among the spheres in the cells of a light.

use fearless_simd::{Simd, dispatch};
use glam::{DVec2, DVec3};

use super::LightGrid;
use crate::model::sphere::Sphere;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{LANES, f32x8};
use crate::search::discs::{Disc, point_allowance};
use crate::search::occluders::slack;

/// How far a search may reach, in sides of cells: half of one where a sphere is no larger than those of the cells. Not tuned.
const FARTHEST: f64 = 3.0;

/// Spheres with more discs above them are asked about point by point: most of their points find one soon. Not tuned.
const MOST_OVER_SPHERE: usize = 96;

/// The sphere that is asked about; its center may be off by a rounding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asked {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    pub(crate) index: u32,
}

/// A sphere that lies higher than the asked one, and may darken it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Higher {
    /// The way to it from center to center: to the right and up across the light, and toward it.
    pub(crate) way: DVec3,
    pub(crate) radius: f64,
    /// The sphere's index.
    pub(crate) index: u32,
}

/// What was found, and memory to work in.
#[derive(Debug, Default)]
pub(crate) struct Found {
    pub(crate) list: Vec<Higher>,
    masks: Vec<u8>,
}

/// The spheres that a search finds: those that come within a distance of a place across the light, and whose centers lie
/// higher than a height, or their tops.
#[derive(Clone, Copy)]
struct Search {
    at: DVec3,
    reach: f64,
    lowest: f64,
    /// 1 for tops, 0 for centers.
    top: f32,
}

impl LightGrid {
    /// Finds the spheres that lie higher than one of them and may darken it, as far as single precision tells; false if that
    /// is too little, or the search reaches too far.
    pub(crate) fn find(&self, spheres: &[Sphere], asked: &Asked, found: &mut Found) -> bool {
        let at = self.place(asked.center);
        let search = Search {
            at,
            reach: asked.radius,
            lowest: at.z,
            top: 0.0,
        };
        asked.radius >= self.least && self.search(spheres, search, asked.index, found)
    }

    /// Appends the discs of what may keep the light from points of a sphere's outer side that face it, and are known up to
    /// [`point_allowance`]; false, with any discs, if they are not known well, or too many.
    pub(crate) fn discs_before(
        &self,
        spheres: &[Sphere],
        index: usize,
        found: &mut Found,
        discs: &mut Vec<Disc>,
    ) -> bool {
        /// More than the rounding of a sum of squares and of a square.
        const WIDER: f64 = 1.0 + 16.0 * f64::EPSILON;
        let own = &spheres[index];
        let radius = own.radius();
        let around = point_allowance(own) + slack(own.center(), 2.0 * radius) + self.rounding;
        let at = self.place(own.center());
        let search = Search {
            at,
            reach: radius + 2.0 * around,
            lowest: at.z - 2.0 * around,
            top: 1.0,
        };
        found.list.clear();
        if radius < self.least || !self.search(spheres, search, index as u32, found) {
            return false;
        }
        for higher in &found.list {
            let sphere = higher.index;
            let is_alike = higher.way.length_squared() < radius * radius;
            // What coincides with it is settled by n·l as the sphere is.
            if is_alike && spheres[sphere as usize] == *own {
                continue;
            }
            discs.push(Disc {
                center: (at + higher.way + self.low).truncate(),
                radius: (higher.radius + 2.0 * around) * WIDER,
                sphere,
            });
        }
        found.list.len() <= MOST_OVER_SPHERE
    }

    /// Finds spheres but the one with an index; false if it reaches too far.
    fn search(&self, spheres: &[Sphere], search: Search, index: u32, found: &mut Found) -> bool {
        let Search { at, reach, .. } = search;
        let most = 0.5 * self.side;
        if reach > FARTHEST * self.side {
            return false;
        }
        let [columns, rows] = self.cells(at, reach + most);
        let last = self.layer(search.lowest - f64::from(search.top) * most);
        for row in rows.0..=rows.1 {
            for column in columns.0..=columns.1 {
                self.search_cell((column, row), last, (search, index), found);
            }
        }
        for &other in &self.large {
            let sphere = &spheres[other as usize];
            let way = self.place(sphere.center()) - at;
            let is_near = way.truncate().length() < sphere.radius() + reach;
            let top = at.z + way.z + f64::from(search.top) * sphere.radius();
            if is_near && top > search.lowest && other != index {
                found.list.push(Higher {
                    way,
                    radius: sphere.radius(),
                    index: other,
                });
            }
        }
        true
    }

    /// Finds those of a cell.
    fn search_cell(
        &self,
        cell: (usize, usize),
        last: usize,
        (search, index): (Search, u32),
        found: &mut Found,
    ) {
        let (places, corner) = self.cell(cell, last);
        let at = search.at - corner;
        let first = places.blocks().start;
        found.masks.clear();
        found.masks.resize(places.blocks().len(), 0);
        let masks = &mut found.masks;
        let asked = (at.truncate(), search);
        dispatch!(self.level, simd => self.reaching(simd, first, asked, masks));
        for (number, &mask) in masks.iter().enumerate() {
            let block = first + number;
            for lane in set_bits(u64::from(mask) & places.of_block(block)) {
                let other = self.indices[block * LANES + lane];
                if other != index {
                    let [x, y, height, radius] = &self.blocks[block];
                    let center = DVec3::new(x[lane].into(), y[lane].into(), height[lane].into());
                    found.list.push(Higher {
                        way: center - at,
                        radius: radius[lane].into(),
                        index: other,
                    });
                }
            }
        }
    }

    /// For each eight spheres from a block on whether a search finds them, bit by bit.
    #[inline(always)]
    fn reaching<S: Simd>(
        &self,
        simd: S,
        first: usize,
        (at, search): (DVec2, Search),
        masks: &mut [u8],
    ) {
        let at = at.as_vec2();
        let (reach, lowest) = (search.reach as f32, search.lowest as f32);
        for (number, mask) in masks.iter_mut().enumerate() {
            let [x, y, height, radius] = &self.blocks[first + number];
            let aside = f32x8::from_array(simd, *x) - at.x;
            let away = f32x8::from_array(simd, *y) - at.y;
            let radius = f32x8::from_array(simd, *radius);
            let both = radius + reach;
            let is_near = (aside * aside + away * away).simd_lt(both * both);
            let top = f32x8::from_array(simd, *height) + radius * search.top;
            let is_higher = top.simd_gt(f32x8::splat(simd, lowest));
            *mask = (is_higher & is_near).to_bitmask() as u8;
        }
    }
}
