//! The spheres that the tiles of a block may see, in pictures of very many that nearly coincide.
//!
//! One that covers a block of tiles hides most of the others from all of it. Each tile would have to find that out of
//! every sphere anew. Where a block is covered by none, such as along a contour that they share, its quarters are asked.

use std::sync::{Arc, OnceLock};

use super::budget::MOST_SPHERES;
use super::classify::behind::leave_out_hidden;
use super::classify::magnitude::is_ball_moderate;
use super::context::Context;
use crate::edges::cell::Ball;
use crate::numeric::bits::set_bits;
use crate::numeric::order::sort_by_number;
use crate::picture::tile::Tile;
use crate::search::view_index::ViewIndex;

/// Pixels on a side of the blocks of each level.
const SIDES: [u32; 3] = [8 * Tile::SIDE, 4 * Tile::SIDE, 2 * Tile::SIDE];

/// The blocks of a picture; copies share what was found out.
#[derive(Clone, Debug)]
pub(crate) struct CrowdBlocks([Level; SIDES.len()]);

/// The blocks with one length of sides.
#[derive(Clone, Debug)]
struct Level {
    side: u32,
    columns: u32,
    seen: Arc<[OnceLock<Seen>]>,
}

/// The spheres that a block may see.
#[derive(Clone, Debug, Default)]
struct Seen {
    /// The spheres, about from front to back, if they are fewer than those of the block around it.
    fewer: Option<Vec<u32>>,
    /// Whether one of them covers it.
    is_covered: bool,
}

/// The spheres that a tile may see.
pub(crate) struct OfTile {
    pub(crate) spheres: Vec<usize>,
    /// Whether they are too many in each of its pixels, as far as larger blocks tell.
    pub(crate) is_hopeless: bool,
}

impl CrowdBlocks {
    /// The blocks of a picture of so many pixels, of which nothing is known yet.
    pub(crate) fn new(width: u32, height: u32) -> Self {
        Self(SIDES.map(|side| {
            let columns = width.div_ceil(side);
            let count = columns as usize * height.div_ceil(side) as usize;
            Level {
                side,
                columns,
                seen: (0..count).map(|_| OnceLock::new()).collect(),
            }
        }))
    }

    /// The spheres that a tile may see, but for those that are hidden from all of a block around it.
    pub(crate) fn of_tile(
        &self,
        context: &Context<'_>,
        index: &ViewIndex<'_>,
        tile: Tile,
    ) -> OfTile {
        /// The number of spheres left in a block, in multiples of a pixel's limit, if those of its tiles are too
        /// many. Half as large a tile sees about a quarter of them.
        const HOPELESS: usize = 8;
        let (mut around, mut is_covered) = (None, false);
        for level in &self.0 {
            if around.is_some_and(|spheres: &[u32]| spheres.len() <= MOST_SPHERES) {
                break;
            }
            if let Some(seen) = level.seen_around(context, index, tile, around) {
                around = seen.fewer.as_deref().or(around);
                is_covered = seen.is_covered;
            }
        }
        let spheres = without_hidden(index, tile, around);
        OfTile {
            is_hopeless: is_covered && spheres.len() > HOPELESS * MOST_SPHERES,
            spheres,
        }
    }
}

/// The spheres that a tile may see, out of those that are left of a block around it.
fn without_hidden(index: &ViewIndex<'_>, tile: Tile, around: Option<&[u32]>) -> Vec<usize> {
    let Some(around) = around else {
        return index.indices(tile);
    };
    if index.sees_more_than(tile, around.len()) {
        return around.iter().map(|&sphere| sphere as usize).collect();
    }
    let mut sorted = around.to_vec();
    sorted.sort_unstable();
    let mut own = index.indices(tile);
    own.retain(|&sphere| sorted.binary_search(&(sphere as u32)).is_ok());
    own
}

impl Level {
    /// The spheres that the block around a tile may see, out of those that a larger block does.
    fn seen_around(
        &self,
        context: &Context<'_>,
        index: &ViewIndex<'_>,
        tile: Tile,
        around: Option<&[u32]>,
    ) -> Option<&Seen> {
        let (column, row) = (tile.col / self.side, tile.row / self.side);
        let place = row as usize * self.columns as usize + column as usize;
        let seen = self.seen.get(place)?;
        Some(seen.get_or_init(|| {
            let view = &context.view;
            let (col, row) = (column * self.side, row * self.side);
            let block = Tile {
                col,
                row,
                width: self.side.min(view.width - col),
                height: self.side.min(view.height - row),
            };
            seen_in(context, index, block, around)
        }))
    }
}

/// The spheres that the tiles of a block may see, without those behind one that covers it; not if most of them are seen in
/// few of its tiles, or hardly any is hidden: that is not worth its time, or its memory.
fn seen_in(
    context: &Context<'_>,
    index: &ViewIndex<'_>,
    block: Tile,
    around: Option<&[u32]>,
) -> Seen {
    /// The share of a block's spheres that a tile sees, at least, and of those that are hidden. Not tuned.
    const OF_TILE: usize = 4;
    const LEAST_HIDDEN: usize = 8;
    let of_tiles = match around {
        Some(_) => None,
        None => Some(of_tiles(index, block)),
    };
    let Some(all) = around.or(of_tiles.as_deref()) else {
        return Seen::default();
    };
    if !index.sees_more_than(block, all.len() / OF_TILE) {
        return Seen::default();
    }
    let mut spheres: Vec<usize> = all.iter().map(|&sphere| sphere as usize).collect();
    let balls = spheres.iter().map(|&sphere| context.scene.ball(sphere));
    let mut balls: Vec<_> = balls.collect();
    let is_covered = balls.iter().all(is_ball_moderate)
        && leave_out_hidden(&context.cell(block), &mut spheres, &mut balls);
    let hidden = all.len() - spheres.len();
    if hidden * LEAST_HIDDEN < all.len() {
        return Seen {
            fewer: None,
            is_covered,
        };
    }
    let mut by_distance: Vec<(f64, usize)> = balls
        .iter()
        .map(Ball::begin)
        .zip(spheres.iter().copied())
        .collect();
    sort_by_number(&mut by_distance);
    let by_distance = by_distance.into_iter();
    Seen {
        fewer: Some(by_distance.map(|(_, sphere)| sphere as u32).collect()),
        is_covered,
    }
}

/// The spheres that the tiles of a block may see, in their order.
fn of_tiles(index: &ViewIndex<'_>, block: Tile) -> Vec<u32> {
    // The tiles of a block have their places in common: a sphere is looked up once.
    let mut places = Vec::new();
    for row in (block.row..block.row + block.height).step_by(Tile::SIDE as usize) {
        for col in (block.col..block.col + block.width).step_by(Tile::SIDE as usize) {
            let corner = Tile {
                col,
                row,
                width: 1,
                height: 1,
            };
            for place in index.balls(corner).places {
                mark(&mut places, place);
            }
        }
    }
    let balls = index.balls(block).balls;
    let mut spheres = Vec::new();
    for place in marked(&places) {
        mark(&mut spheres, balls[place as usize].index);
    }
    marked(&spheres).collect()
}

/// Sets a bit by its number.
fn mark(words: &mut Vec<u64>, number: u32) {
    let word = (number / u64::BITS) as usize;
    if word >= words.len() {
        words.resize(word + 1, 0);
    }
    words[word] |= 1 << (number % u64::BITS);
}

/// The numbers of the bits that are set, in rising order.
fn marked(words: &[u64]) -> impl Iterator<Item = u32> {
    let words = words.iter().zip(0..);
    words.flat_map(|(&bits, word): (&u64, u32)| {
        set_bits(bits).map(move |bit| word * u64::BITS + bit as u32)
    })
}
