//! Spheres that no tile of a block sees, in pictures of very many that nearly coincide.
//!
//! One that covers a block of tiles hides most of the others from all of it. Each tile would have to find that out of
//! every sphere anew.

use std::sync::{Arc, OnceLock};

use super::classify::behind::leave_out_hidden;
use super::classify::magnitude::is_ball_moderate;
use super::context::Context;
use crate::numeric::bits::set_bits;
use crate::picture::tile::Tile;
use crate::search::view_index::ViewIndex;

/// Pixels on a side of a block.
const SIDE: u32 = 8 * Tile::SIDE;

/// The blocks of a picture; copies share what was found out.
#[derive(Clone, Debug)]
pub(crate) struct CrowdBlocks {
    columns: u32,
    blocks: Arc<[OnceLock<SphereSet>]>,
}

impl CrowdBlocks {
    /// The blocks of a picture of so many pixels, of which nothing is known yet.
    pub(crate) fn new(width: u32, height: u32) -> Self {
        let columns = width.div_ceil(SIDE);
        let count = columns as usize * height.div_ceil(SIDE) as usize;
        Self {
            columns,
            blocks: (0..count).map(|_| OnceLock::new()).collect(),
        }
    }

    /// Leaves out of the spheres that a tile may see those that are hidden from all of its block.
    pub(crate) fn leave_out_hidden(
        &self,
        context: &Context<'_>,
        index: &ViewIndex<'_>,
        tile: Tile,
        spheres: &mut Vec<usize>,
    ) {
        let (column, row) = (tile.col / SIDE, tile.row / SIDE);
        let place = row as usize * self.columns as usize + column as usize;
        let Some(block) = self.blocks.get(place) else {
            return;
        };
        let hidden = block.get_or_init(|| {
            let view = &context.view;
            let (col, row) = (column * SIDE, row * SIDE);
            let block = Tile {
                col,
                row,
                width: SIDE.min(view.width - col),
                height: SIDE.min(view.height - row),
            };
            hidden_from(context, index, block)
        });
        spheres.retain(|&sphere| !hidden.contains(sphere));
    }
}

/// The spheres out of those that the tiles of a block may see that lie behind one that covers it.
fn hidden_from(context: &Context<'_>, index: &ViewIndex<'_>, block: Tile) -> SphereSet {
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
    let balls = spheres.iter().map(|&sphere| context.scene.ball(sphere));
    let mut balls: Vec<_> = balls.collect();
    if balls.iter().all(is_ball_moderate) {
        leave_out_hidden(&context.cell(block), &mut spheres, &mut balls);
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
