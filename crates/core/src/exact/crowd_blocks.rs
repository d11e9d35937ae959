//! Spheres that no tile of a block sees, in pictures of very many that nearly coincide.
//!
//! One that covers a block of tiles hides most of the others from all of it. Each tile would have to find that out of
//! every sphere anew. Where a block is covered by none, such as along an outline that they share, its quarters are asked.

use std::sync::{Arc, OnceLock};

use super::budget::MOST_SPHERES;
use super::classify::behind::leave_out_hidden;
use super::classify::magnitude::is_ball_moderate;
use super::context::Context;
use crate::numeric::bits::set_bits;
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
    hidden: Arc<[OnceLock<SphereSet>]>,
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
                hidden: (0..count).map(|_| OnceLock::new()).collect(),
            }
        }))
    }

    /// Leaves out of the spheres that a tile may see those that are hidden from all of a block around it.
    pub(crate) fn leave_out_hidden(
        &self,
        context: &Context<'_>,
        index: &ViewIndex<'_>,
        tile: Tile,
        spheres: &mut Vec<usize>,
    ) {
        for level in &self.0 {
            if spheres.len() <= MOST_SPHERES {
                return;
            }
            let Some(hidden) = level.hidden_around(context, index, tile) else {
                return;
            };
            spheres.retain(|&sphere| !hidden.contains(sphere));
        }
    }
}

impl Level {
    /// The spheres that are hidden from all of the block around a tile.
    fn hidden_around(
        &self,
        context: &Context<'_>,
        index: &ViewIndex<'_>,
        tile: Tile,
    ) -> Option<&SphereSet> {
        let (column, row) = (tile.col / self.side, tile.row / self.side);
        let place = row as usize * self.columns as usize + column as usize;
        let hidden = self.hidden.get(place)?;
        Some(hidden.get_or_init(|| {
            let view = &context.view;
            let (col, row) = (column * self.side, row * self.side);
            let block = Tile {
                col,
                row,
                width: self.side.min(view.width - col),
                height: self.side.min(view.height - row),
            };
            hidden_from(context, index, block)
        }))
    }
}

/// The spheres out of those that the tiles of a block may see that lie behind one that covers it; none if they are a small
/// share, which is not worth its memory.
fn hidden_from(context: &Context<'_>, index: &ViewIndex<'_>, block: Tile) -> SphereSet {
    const LEAST_SHARE: usize = 8;
    let mut hidden = SphereSet::default();
    for row in (block.row..block.row + block.height).step_by(Tile::SIDE as usize) {
        for col in (block.col..block.col + block.width).step_by(Tile::SIDE as usize) {
            let corner = Tile {
                col,
                row,
                width: 1,
                height: 1,
            };
            for ball in index.balls(corner) {
                hidden.insert(ball.index as usize);
            }
        }
    }
    let mut spheres: Vec<usize> = hidden.iter().collect();
    let count = spheres.len();
    let balls = spheres.iter().map(|&sphere| context.scene.ball(sphere));
    let mut balls: Vec<_> = balls.collect();
    if balls.iter().all(is_ball_moderate) {
        leave_out_hidden(&context.cell(block), &mut spheres, &mut balls);
    }
    if (count - spheres.len()) * LEAST_SHARE < count {
        return SphereSet::default();
    }
    for sphere in spheres {
        hidden.remove(sphere);
    }
    hidden
}

/// A set of spheres: a bit each.
#[derive(Debug, Default)]
struct SphereSet {
    words: Vec<u64>,
}

impl SphereSet {
    fn insert(&mut self, sphere: usize) {
        let word = sphere / u64::BITS as usize;
        if word >= self.words.len() {
            self.words.resize(word + 1, 0);
        }
        self.words[word] |= 1 << (sphere % u64::BITS as usize);
    }

    fn remove(&mut self, sphere: usize) {
        self.words[sphere / u64::BITS as usize] &= !(1 << (sphere % u64::BITS as usize));
    }

    fn contains(&self, sphere: usize) -> bool {
        let word = self.words.get(sphere / u64::BITS as usize);
        word.is_some_and(|word| word >> (sphere % u64::BITS as usize) & 1 == 1)
    }

    fn iter(&self) -> impl Iterator<Item = usize> {
        let words = self.words.iter().enumerate();
        words.flat_map(|(word, &bits)| {
            set_bits(bits).map(move |bit| word * u64::BITS as usize + bit)
        })
    }
}
