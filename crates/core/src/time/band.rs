//! Bands of a picture that are averaged over time.

use crate::picture::band::Band;
use crate::picture::pixel::{Pixel, Work};
use crate::picture::progress::{Cancelled, Progress};
use crate::picture::tile::Tile;

/// Columns that are worked on together: what is seen at a moment may have to be found out for each
/// of these anew. Not tuned: all pixels of a part are kept in memory.
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
pub(super) fn paint_band(
    band: &mut Band<'_>,
    progress: &Progress<'_>,
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
