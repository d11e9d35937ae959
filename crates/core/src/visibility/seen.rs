//! What a view sees of a world.

use std::ops::RangeInclusive;

use glam::DVec3;

use super::Visibility;
use super::frustum::{InCamera, Planes};
use crate::Tile;
use crate::sphere::Relative;
use crate::{Hit, Ray, View};

/// Sums of squares that have neither overflowed nor lost digits to underflow.
const TRUSTED_SQUARES: RangeInclusive<f64> = 1e-280..=f64::MAX;

/// A world as one view sees it, ready to be asked tile by tile.
#[derive(Clone, Debug)]
pub(crate) struct Seen<'world> {
    pub(crate) visibility: &'world Visibility<'world>,
    viewpoint: DVec3,
    tile_side: u32,
    planes: Planes,
    /// The spheres in the camera's frame.
    in_camera: Vec<InCamera>,
    /// For every row of tiles the indices of the spheres that may be seen there.
    rows: Vec<Vec<u32>>,
}

/// A sphere that may be seen in a tile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    index: u32,
    /// No point of the sphere is nearer to the viewpoint than this.
    nearest: f64,
    /// The sphere as seen from the viewpoint, which all rays of the camera share.
    relative: Relative,
}

impl<'world> Seen<'world> {
    /// Finds out what a view with tiles of this side may see where.
    pub(crate) fn new(visibility: &'world Visibility<'world>, view: &View, tile_side: u32) -> Self {
        let viewpoint = view.camera.position;
        let planes = Planes::new(view, tile_side);
        let in_camera: Vec<InCamera> = visibility
            .spheres
            .iter()
            .map(|sphere| InCamera::new(sphere.center() - viewpoint, sphere.radius(), view))
            .collect();
        let mut rows = vec![Vec::new(); planes.rows()];
        for (index, sphere) in in_camera.iter().enumerate() {
            if sphere.is_behind()
                || !(0..planes.columns()).any(|column| planes.is_in_column(sphere, column))
            {
                continue;
            }
            for (row, seen) in rows.iter_mut().enumerate() {
                if planes.is_in_row(sphere, row) {
                    seen.push(index as u32);
                }
            }
        }
        Self {
            visibility,
            viewpoint,
            tile_side,
            planes,
            in_camera,
            rows,
        }
    }

    /// The spheres that may be seen in a tile, those that come nearest first.
    pub(crate) fn candidates(&self, tile: Tile) -> Vec<Candidate> {
        let (column, row) = (
            (tile.col / self.tile_side) as usize,
            (tile.row / self.tile_side) as usize,
        );
        let seen = self.rows[row].iter().copied();
        let mut candidates: Vec<Candidate> = seen
            .filter(|&index| {
                self.planes
                    .is_in_column(&self.in_camera[index as usize], column)
            })
            .map(|index| self.candidate(index))
            .collect();
        candidates.sort_by(|a, b| a.nearest.total_cmp(&b.nearest));
        candidates
    }

    /// The indices of the spheres that may be seen in a tile.
    pub(crate) fn indices(&self, tile: Tile) -> Vec<usize> {
        self.candidates(tile)
            .iter()
            .map(|candidate| candidate.index as usize)
            .collect()
    }

    fn candidate(&self, index: u32) -> Candidate {
        /// The distance to the center is off by less, relatively.
        const BELOW: f64 = 1.0 - 8.0 * f64::EPSILON;
        let sphere = &self.visibility.spheres[index as usize];
        let distance_sq = (sphere.center() - self.viewpoint).length_squared();
        let nearest = if TRUSTED_SQUARES.contains(&distance_sq) {
            distance_sq.sqrt() * BELOW - sphere.radius()
        } else {
            // The order tells nothing, and the sphere may not be left out.
            f64::NEG_INFINITY
        };
        Candidate {
            index,
            nearest,
            relative: sphere.relative_to(self.viewpoint),
        }
    }

    /// The first of a tile's candidates in a direction from the viewpoint, by index, and where it
    /// is hit; of coincident surfaces the sphere with the lower index.
    pub(crate) fn nearest(
        &self,
        candidates: &[Candidate],
        direction: DVec3,
    ) -> Option<(usize, Hit)> {
        /// The length of the direction is off by less, relatively.
        const ABOVE: f64 = 1.0 + 8.0 * f64::EPSILON;
        let ray = Ray {
            origin: self.viewpoint,
            direction,
        };
        let direction_sq = direction.length_squared();
        // Otherwise every sphere is asked.
        let length = if TRUSTED_SQUARES.contains(&direction_sq) {
            direction_sq.sqrt() * ABOVE
        } else {
            f64::INFINITY
        };
        let mut nearest: Option<(usize, Hit)> = None;
        for candidate in candidates {
            if nearest
                .as_ref()
                .is_some_and(|(_, hit)| candidate.nearest > hit.t * length)
            {
                break;
            }
            let index = candidate.index as usize;
            let spheres = self.visibility.spheres;
            let Some(hit) =
                spheres[index].hit_from_viewpoint(&candidate.relative, &ray, direction_sq)
            else {
                continue;
            };
            let is_nearer = nearest.as_ref().is_none_or(|(other, other_hit)| {
                match spheres[index].compare(&hit, &spheres[*other], other_hit, &ray) {
                    std::cmp::Ordering::Less => true,
                    std::cmp::Ordering::Equal => index < *other,
                    std::cmp::Ordering::Greater => false,
                }
            });
            if is_nearer {
                nearest = Some((index, hit));
            }
        }
        nearest
    }
}
