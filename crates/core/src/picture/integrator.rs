//! The integral of light over a pixel.
//!
//! An [`Integrator`] answers for every pixel of a tile what its value is, how far that may be
//! from the exact area average, and how its work ended.

use std::ops::ControlFlow;

use super::image::Band;
use super::pixel::{Cancelled, Pixel, Work};
use super::tile::Tile;

/// A way to average light over pixels.
pub(crate) trait Integrator: Send + Sync {
    /// Memory to work in, used again for tile after tile.
    type Room: Default;

    /// Appends the tile's pixels to `pixels`, in the order of [`Tile::pixels`]; what they cost.
    fn integrate(&self, tile: Tile, room: &mut Self::Room, pixels: &mut Vec<Pixel>) -> Work;

    /// Writes the tile's pixels into the band of a picture that contains it; what they cost.
    fn paint(&self, tile: Tile, room: &mut Self::Room, band: &mut Band<'_>) -> Work {
        let mut pixels = Vec::with_capacity((tile.width * tile.height) as usize);
        let work = self.integrate(tile, room, &mut pixels);
        band.write(tile, &pixels);
        work
    }

    /// Writes all pixels of a band; what they cost. `progress` is told of pixels that are done, of none
    /// now and then; when it breaks the work ends.
    fn paint_band(
        &self,
        band: &mut Band<'_>,
        room: &mut Self::Room,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Work, Cancelled> {
        let mut work = Work::default();
        for tile in band.area.tiles() {
            work += self.paint(tile, room, band);
            if progress(tile.count()).is_break() {
                return Err(Cancelled);
            }
        }
        Ok(work)
    }
}
