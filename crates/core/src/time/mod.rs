//! The average of a pixel over the time that the shutter is open, too.

pub(crate) mod exact;
pub(crate) mod instants;
pub(crate) mod pace;
pub(crate) mod panel;
pub(crate) mod sampled;

use std::ops::ControlFlow;

use crate::picture::image::Band;
use crate::picture::pixel::Cancelled;
use crate::picture::pixel::{Pixel, Work};
use crate::picture::tile::Tile;

/// Columns that are worked on together: what is seen at a moment may have to be found out for each
/// of these anew.
const COLUMNS: u32 = 1024;

/// A rectangle in parts that are worked on together.
fn parts(area: Tile) -> impl Iterator<Item = Tile> {
    let end = area.col + area.width;
    let part = move |col| Tile {
        col,
        width: COLUMNS.min(end - col),
        ..area
    };
    (area.col..end).step_by(COLUMNS as usize).map(part)
}

/// Writes a band, of whose parts `pixels` finds the pixels, tile by tile.
fn paint_band(
    band: &mut Band<'_>,
    progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    mut pixels: impl FnMut(Tile) -> Result<(Vec<Pixel>, Work), Cancelled>,
) -> Result<Work, Cancelled> {
    let mut work = Work::default();
    for part in parts(band.area) {
        let (pixels, cost) = pixels(part)?;
        work += cost;
        let mut pixels = &pixels[..];
        for tile in part.tiles() {
            let (of_tile, rest) = pixels.split_at(tile.count() as usize);
            band.write(tile, of_tile);
            pixels = rest;
            if progress(tile.count()).is_break() {
                return Err(Cancelled);
            }
        }
    }
    Ok(work)
}

#[cfg(test)]
mod tests;
