//! The spheres that a view may see, tile by tile.

use std::ops::RangeInclusive;
use std::slice;
use std::sync::Arc;

use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;

use super::block_search::BlockSearch;
use super::blocks::Blocks;
use super::frustum::{CameraSphere, Frustum, TileRange};
use super::grid::RayPoints;
use super::hierarchy::Hierarchy;
use super::tile_lists::{Places, TileLists};
use super::visibility::Visibility;
use crate::hit::ball::Ball;
use crate::hit::outcome::Hit;
use crate::model::camera::Projection;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::numeric::bits::{of_rising_bits, rising_bits};
use crate::numeric::pair::both;
use crate::picture::tile::Tile;

/// A world as one view sees it, ready to be asked tile by tile; copies share what was found out.
#[derive(Clone, Debug)]
pub(crate) struct ViewIndex<'world> {
    pub(crate) visibility: Visibility<'world>,
    /// Lengths of the balls are those of the world times 2 to the power of minus this.
    length_exponent: i32,
    lists: Arc<Lists>,
}

/// The spheres that may be seen in each tile.
#[derive(Clone, Debug)]
enum Lists {
    /// All that may be seen at all, those that come nearest first, and the tiles of each.
    Few { balls: Vec<Ball>, lists: TileLists },
    /// By blocks of tiles.
    Many(Blocks),
}

/// The balls that may be seen in a tile, those that come nearest first.
#[derive(Clone, Debug)]
pub(crate) struct Balls<'index> {
    /// Those of all tiles that have their places in common: at least of a block of tiles.
    pub(crate) balls: &'index [Ball],
    pub(crate) places: Listed<'index>,
}

/// Their places.
#[derive(Clone, Debug)]
pub(crate) enum Listed<'index> {
    Few(Places<'index>),
    Many(slice::Iter<'index, u32>),
}

impl Balls<'_> {
    /// Returns whether they are more than so many.
    fn is_more_than(&self, most: usize) -> bool {
        match &self.places {
            Listed::Few(places) => places.are_more_than(most),
            Listed::Many(places) => places.len() > most,
        }
    }
}

impl<'index> Iterator for Balls<'index> {
    type Item = &'index Ball;

    #[inline(always)]
    fn next(&mut self) -> Option<&'index Ball> {
        let place = self.places.next()?;
        Some(&self.balls[place as usize])
    }
}

impl Iterator for Listed<'_> {
    type Item = u32;

    #[inline(always)]
    fn next(&mut self) -> Option<u32> {
        match self {
            Self::Few(places) => places.next(),
            Self::Many(places) => places.next().copied(),
        }
    }
}

impl<'world> ViewIndex<'world> {
    /// The index of a view, for rays that go through such points.
    pub(crate) fn new(visibility: &Visibility<'world>, view: &View, points: RayPoints) -> Self {
        let visibility = visibility.of_view(view);
        Self::with_hierarchy(visibility, view, points, visibility.hierarchy_of_crowd())
    }

    /// The index that a hierarchy of the spheres finds, or that asking one after the other finds.
    pub(super) fn with_hierarchy(
        visibility: &Visibility<'world>,
        view: &View,
        points: RayPoints,
        hierarchy: Option<&Hierarchy>,
    ) -> Self {
        let viewpoint = view.camera.position;
        let spheres = visibility.spheres();
        // The power of two and its inverse are doubles; whatever is lost makes odd balls.
        let length_exponent = libm::ilogb(visibility.largest_size(viewpoint)).clamp(-1000, 1000);
        let lists = match hierarchy {
            // Parallel rays have no blocks yet: all that they may see is listed.
            Some(hierarchy) if !view.lens.is_parallel() => {
                let search = BlockSearch::new(view, points, spheres, hierarchy, length_exponent);
                Lists::Many(Blocks::new(&search))
            }
            _ => Lists::few(visibility, view, length_exponent),
        };
        Self {
            visibility: visibility.clone(),
            length_exponent,
            lists: Arc::new(lists),
        }
    }

    /// The same of another visibility of the same spheres: what was found out is shared.
    pub(crate) fn of<'other>(&self, visibility: &Visibility<'other>) -> ViewIndex<'other> {
        ViewIndex {
            visibility: visibility.as_in(&self.visibility).clone(),
            length_exponent: self.length_exponent,
            lists: Arc::clone(&self.lists),
        }
    }

    /// True where both share what was found out.
    pub(crate) fn shares_lists(&self, other: &ViewIndex<'_>) -> bool {
        Arc::ptr_eq(&self.lists, &other.lists)
    }

    /// The memory that it takes, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        let of_lists = match self.lists.as_ref() {
            Lists::Few { balls, lists } => size_of_val(&balls[..]) + lists.bytes(),
            Lists::Many(blocks) => blocks.bytes(),
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
            Lists::Few { balls, lists } => {
                let (column, row) = (tile.col / Tile::SIDE, tile.row / Tile::SIDE);
                (balls, Listed::Few(lists.at(column, row)))
            }
            Lists::Many(blocks) => {
                let (balls, places) = blocks.balls(tile);
                (balls, Listed::Many(places.iter()))
            }
        };
        Balls { balls, places }
    }

    /// The number of a view's tiles in which more than so many balls may be seen.
    pub(crate) fn tiles_of_more(&self, view: &View, most: usize) -> u64 {
        let corners = |length: u32| (0..length).step_by(Tile::SIDE as usize);
        let is_more = |&(col, row): &(u32, u32)| {
            let corner = Tile {
                col,
                row,
                width: 1,
                height: 1,
            };
            self.sees_more_than(corner, most)
        };
        let tiles =
            corners(view.height).flat_map(|row| corners(view.width).map(move |col| (col, row)));
        tiles.filter(is_more).count() as u64
    }

    /// Whether a tile, or the one in the first corner of a block, may see more than so many spheres.
    pub(crate) fn sees_more_than(&self, tile: Tile, count: usize) -> bool {
        self.balls(tile).is_more_than(count)
    }

    /// The indices of the spheres that may be seen in a tile.
    pub(crate) fn indices(&self, tile: Tile) -> Vec<usize> {
        self.balls(tile).map(|ball| ball.index as usize).collect()
    }

    /// The first sphere on a ray of the view, of those that may be seen in a tile, by index, and where it
    /// is hit; of coincident surfaces the sphere with the lower index.
    pub(crate) fn nearest(&self, tile: Tile, ray: &Ray) -> Option<(usize, Hit)> {
        /// Sums of squares that have neither overflowed nor lost digits to underflow.
        const TRUSTED_SQUARES: RangeInclusive<f64> = 1e-280..=f64::MAX;
        /// The length of the direction is off by less, relatively.
        const ABOVE: f64 = 1.0 + 8.0 * f64::EPSILON;
        let spheres = self.visibility.spheres();
        let direction_sq = ray.direction.length_squared();
        // Otherwise every sphere is asked.
        let length = if TRUSTED_SQUARES.contains(&direction_sq) {
            direction_sq.sqrt() * ABOVE
        } else {
            f64::INFINITY
        };
        let mut nearest: Option<(usize, Hit)> = None;
        // Rounding may have ordered some others after one that begins too far away.
        let mut farthest = f64::INFINITY;
        for ball in self.balls(tile) {
            if ball.nearest > farthest {
                continue;
            }
            let index = ball.index as usize;
            let Some(hit) = spheres[index].hit_from_viewpoint(ray) else {
                continue;
            };
            let is_nearer = nearest.as_ref().is_none_or(|(other, other_hit)| {
                match spheres[index].compare(&hit, &spheres[*other], other_hit, ray) {
                    std::cmp::Ordering::Less => true,
                    std::cmp::Ordering::Equal => index < *other,
                    std::cmp::Ordering::Greater => false,
                }
            });
            if is_nearer {
                farthest = libm::scalbn(hit.t * length, -self.length_exponent);
                nearest = Some((index, hit));
            }
        }
        nearest
    }
}

impl Lists {
    fn few(visibility: &Visibility<'_>, view: &View, length_exponent: i32) -> Self {
        let spheres = visibility.spheres();
        let viewpoint = view.camera.position;
        let scale = libm::scalbn(1.0, -length_exponent);
        let frustum = Frustum::new(view, scale);
        let projection = view.lens.projection();
        let visible = |(index, sphere): (usize, &Sphere)| {
            if visibility.leaves_out(index) {
                return None;
            }
            let to_center = (sphere.center() - viewpoint) * scale;
            let radius = sphere.radius() * scale;
            let in_camera = CameraSphere::of_view(to_center, radius, view, scale);
            let range = frustum.range(&in_camera)?;
            let nearest = rising_bits(match projection {
                Projection::Central => Ball::nearest(to_center, radius),
                Projection::Parallel => in_camera.begin(),
            });
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
        order.par_sort_unstable_by_key(key);
        // Of equal spheres the first is seen.
        order.dedup_by(|one, first| {
            let [this, other] = both([&one, &first], |visible| &spheres[visible.index as usize]);
            one.nearest == first.nearest && this == other
        });
        let here = order
            .iter()
            .map(|visible| (visible.index, &spheres[visible.index as usize]));
        let ranges = || order.iter().map(|visible| visible.range);
        let mut balls = Ball::all(here, viewpoint, length_exponent);
        if projection == Projection::Parallel {
            for (ball, visible) in balls.iter_mut().zip(&order) {
                ball.nearest = of_rising_bits(visible.nearest);
            }
        }
        Self::Few {
            balls,
            lists: TileLists::new(frustum.columns(), frustum.rows(), ranges),
        }
    }
}

/// Threads share the work on no fewer spheres than this: some 0.1 ms of it. Not tuned.
const FEWEST_TO_SHARE: usize = 4096;

/// A sphere that may be seen.
struct Visible {
    /// Rises with the distance.
    nearest: u64,
    index: u32,
    range: TileRange,
}
