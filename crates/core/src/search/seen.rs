//! What a view sees of a world.

use std::num::NonZeroU32;
use std::ops::RangeInclusive;
use std::slice;
use std::sync::Arc;

use glam::DVec3;
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;

use super::bins::{Bins, Places};
use super::crowd::{Crowd, rising_bits};
use super::frustum::{Frustum, InCamera, TileRange};
use super::hierarchy::Hierarchy;
use super::{Extent, Points, Visibility};
use crate::hit::ball::Ball;
use crate::hit::fast::Relative;
use crate::hit::outcome::Hit;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::picture::tile::Tile;

/// Sums of squares that have neither overflowed nor lost digits to underflow.
const TRUSTED_SQUARES: RangeInclusive<f64> = 1e-280..=f64::MAX;

/// A world as one view sees it, ready to be asked tile by tile; copies share what was found out.
#[derive(Clone, Debug)]
pub(crate) struct Seen<'world> {
    pub(crate) visibility: &'world Visibility<'world>,
    viewpoint: DVec3,
    tile_side: u32,
    /// Lengths of the balls are those of the world times 2 to the power of minus this.
    length_exponent: i32,
    lists: Arc<Lists>,
}

/// Which spheres may be seen in which tile.
#[derive(Clone, Debug)]
enum Lists {
    /// All that may be seen at all, those that come nearest first, and which of them where.
    Few { balls: Vec<Ball>, bins: Bins },
    /// By blocks of tiles.
    Many(Crowd),
}

/// The balls that may be seen in a tile, those that come nearest first.
#[derive(Clone, Debug)]
pub(crate) struct Balls<'seen> {
    balls: &'seen [Ball],
    places: Listed<'seen>,
}

/// Their places.
#[derive(Clone, Debug)]
enum Listed<'seen> {
    Few(Places<'seen>),
    Many(slice::Iter<'seen, u32>),
}

impl<'seen> Iterator for Balls<'seen> {
    type Item = &'seen Ball;

    #[inline(always)]
    fn next(&mut self) -> Option<&'seen Ball> {
        let place = match &mut self.places {
            Listed::Few(places) => places.next()?,
            Listed::Many(places) => *places.next()?,
        };
        Some(&self.balls[place as usize])
    }
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
        let tiles = (tile_side, Points::All);
        Self::with_hierarchy(visibility, view, tiles, visibility.crowd())
    }

    /// Finds out what a view may see by no other rays than those through the midpoints of a division
    /// of every pixel into `samples` × `samples` cells.
    pub(crate) fn by_samples(
        visibility: &'world Visibility<'world>,
        view: &View,
        tile_side: u32,
        samples: NonZeroU32,
    ) -> Self {
        let tiles = (tile_side, Points::Midpoints(samples));
        Self::with_hierarchy(visibility, view, tiles, visibility.crowd())
    }

    /// Finds it out by a hierarchy of the spheres, or by asking one after the other.
    pub(super) fn with_hierarchy(
        visibility: &'world Visibility<'world>,
        view: &View,
        (tile_side, points): (u32, Points),
        hierarchy: Option<&Hierarchy>,
    ) -> Self {
        let viewpoint = view.camera.position;
        let spheres = visibility.spheres;
        // The power of two and its inverse are doubles; whatever is lost makes odd balls.
        let length_exponent = libm::ilogb(visibility.largest_size(viewpoint)).clamp(-1000, 1000);
        let lists = match hierarchy {
            Some(hierarchy) => {
                let tiles = (tile_side, points);
                let crowd = Crowd::new(spheres, hierarchy, view, length_exponent, tiles);
                Lists::Many(crowd)
            }
            None => Lists::few(spheres, view, length_exponent, tile_side),
        };
        Self {
            visibility,
            viewpoint,
            tile_side,
            length_exponent,
            lists: Arc::new(lists),
        }
    }

    /// The memory that it takes, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        let of_lists = match self.lists.as_ref() {
            Lists::Few { balls, bins } => size_of_val(&balls[..]) + bins.bytes(),
            Lists::Many(crowd) => crowd.bytes(),
        };
        size_of::<Self>() + of_lists
    }

    /// The exponent of the power of two that lengths of the world were divided by.
    pub(crate) fn length_exponent(&self) -> i32 {
        self.length_exponent
    }

    /// The balls that may be seen in a tile, those that come nearest first.
    #[inline]
    pub(crate) fn balls(&self, tile: Tile) -> Balls<'_> {
        let (balls, places): (&[Ball], _) = match self.lists.as_ref() {
            Lists::Few { balls, bins } => {
                let (column, row) = (tile.col / self.tile_side, tile.row / self.tile_side);
                (balls, Listed::Few(bins.at(column, row)))
            }
            Lists::Many(crowd) => {
                let (balls, places) = crowd.balls(tile);
                (balls, Listed::Many(places.iter()))
            }
        };
        Balls { balls, places }
    }

    /// The spheres that may be seen in a tile, those that come nearest first.
    pub(crate) fn candidates(&self, tile: Tile) -> Vec<Candidate> {
        self.balls(tile)
            .map(|ball| self.candidate(ball.index))
            .collect()
    }

    /// The indices of the spheres that may be seen in a tile.
    pub(crate) fn indices(&self, tile: Tile) -> Vec<usize> {
        self.balls(tile).map(|ball| ball.index as usize).collect()
    }

    /// A sphere as a candidate, by its index.
    pub(crate) fn candidate(&self, index: u32) -> Candidate {
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

    /// The first of some candidates in a direction from the viewpoint, by index, and where it
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
                // Rounding may have ordered some others after this one.
                continue;
            }
            let Some(hit) = self.hit(candidate, &ray, direction_sq) else {
                continue;
            };
            let (index, spheres) = (candidate.index as usize, self.visibility.spheres);
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

    /// Where a ray from the viewpoint, with this square of its direction, hits a candidate.
    pub(crate) fn hit(&self, candidate: &Candidate, ray: &Ray, direction_sq: f64) -> Option<Hit> {
        self.visibility.spheres[candidate.index as usize].hit_from_viewpoint(
            &candidate.relative,
            ray,
            direction_sq,
        )
    }
}

impl Lists {
    fn few(spheres: &[Sphere], view: &View, length_exponent: i32, tile_side: u32) -> Self {
        let viewpoint = view.camera.position;
        let scale = libm::scalbn(1.0, -length_exponent);
        let frustum = Frustum::new(view, tile_side);
        let visible = |(index, sphere): (usize, &Sphere)| {
            let to_center = (sphere.center() - viewpoint) * scale;
            let radius = sphere.radius() * scale;
            let range = frustum.range(&InCamera::new(to_center, radius, view))?;
            let nearest = rising_bits(Ball::nearest(to_center, radius));
            let index = index as u32;
            Some(Visible {
                nearest,
                index,
                range,
            })
        };
        let spheres_here = spheres.par_iter().enumerate();
        let mut order: Vec<Visible> = spheres_here
            .with_min_len(FEWEST_TO_SHARE)
            .filter_map(visible)
            .collect();
        let key = |visible: &Visible| (visible.nearest, visible.index);
        if order.len() < FEWEST_TO_SHARE {
            order.sort_unstable_by_key(key);
        } else {
            order.par_sort_unstable_by_key(key);
        }
        let here = order
            .iter()
            .map(|visible| (visible.index, &spheres[visible.index as usize]));
        let ranges = || order.iter().map(|visible| visible.range);
        Self::Few {
            balls: Ball::all(here, viewpoint, length_exponent),
            bins: Bins::new(frustum.columns(), frustum.rows(), ranges),
        }
    }
}

/// Threads share the work on no fewer spheres than this.
const FEWEST_TO_SHARE: usize = 4096;

/// A sphere that may be seen.
struct Visible {
    /// Rises with the distance.
    nearest: u64,
    index: u32,
    range: TileRange,
}

impl Visibility<'_> {
    /// The largest finite radius or coordinate of a center as seen from the viewpoint.
    fn largest_size(&self, viewpoint: DVec3) -> f64 {
        let Extent {
            low,
            high,
            largest_radius,
        } = self.extent;
        // Differences round in the order of the numbers: none is larger than that of a bound.
        let farthest = (low - viewpoint).abs().max((high - viewpoint).abs());
        let largest = farthest.max_element().max(largest_radius);
        if largest.is_finite() {
            return largest;
        }
        let size = |sphere: &Sphere| {
            let to_center = (sphere.center() - viewpoint).abs().max_element();
            to_center.max(sphere.radius())
        };
        let sizes = self.spheres.iter().map(size);
        sizes.filter(|size| size.is_finite()).fold(0.0, f64::max)
    }
}
