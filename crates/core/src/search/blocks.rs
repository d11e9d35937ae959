//! The spheres that a view of very many may see, block by block.

use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};

use super::block_search::{Block, BlockSearch, TILES};
use super::grid::BLOCK;
use crate::hit::ball::Ball;
use crate::picture::tile::Tile;

/// For every tile the spheres that may be seen in it, those that come nearest first.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    /// Blocks side by side.
    columns: u32,
    blocks: Vec<Block>,
}

impl Blocks {
    /// The lists that a search finds.
    pub(super) fn new(search: &BlockSearch<'_>) -> Self {
        let view = search.view;
        let (columns, rows) = (view.width.div_ceil(BLOCK), view.height.div_ceil(BLOCK));
        let blocks = (0..columns as usize * rows as usize).into_par_iter();
        let blocks = blocks.with_max_len(1).map(|index| {
            let (column, row) = (index % columns as usize, index / columns as usize);
            search.block(column as u32 * BLOCK, row as u32 * BLOCK)
        });
        Self {
            columns,
            blocks: blocks.collect(),
        }
    }

    /// The memory that it takes, in bytes.
    pub(super) fn bytes(&self) -> usize {
        let of_block = |block: &Block| {
            let listed = block.starts.len() + block.places.len();
            size_of_val(&block.balls[..]) + listed * size_of::<u32>() + size_of::<Block>()
        };
        self.blocks.iter().map(of_block).sum()
    }

    /// The balls of a tile's surroundings, and the places of those that may be seen in it, those that
    /// come nearest first.
    #[inline]
    pub(super) fn balls(&self, tile: Tile) -> (&[Ball], &[u32]) {
        let block = &self.blocks[(tile.row / BLOCK * self.columns + tile.col / BLOCK) as usize];
        let (column, row) = (tile.col % BLOCK, tile.row % BLOCK);
        let index = (row / Tile::SIDE * TILES + column / Tile::SIDE) as usize;
        let (start, end) = (block.starts[index], block.starts[index + 1]);
        (&block.balls, &block.places[start as usize..end as usize])
    }
}
