//! The visible area of each sphere in a picture.

use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};

use super::renderer::Renderer;
use crate::exact::areas::{Areas, Scratch, VisibleArea};
use crate::model::view::View;
use crate::picture::pixel::Method;
use crate::picture::progress::{Cancelled, Progress};
use crate::picture::tile::Tile;
use crate::search::view_index::ViewIndex;

impl Renderer<'_> {
    /// Measures the area in which a view sees each sphere, in pixels, in the order of the world's spheres. `tolerance`
    /// is the error that you accept in each pixel, all its spheres together; if a pixel does not meet it, the errors of
    /// its spheres are larger.
    ///
    /// Works on the threads of the current rayon pool. The areas do not depend on their number.
    ///
    /// `progress` is called as that of [`Self::render_with_progress`] is.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` broke.
    pub fn visible_areas(
        &self,
        view: &View,
        tolerance: f64,
        progress: &Progress<'_>,
    ) -> Result<Vec<VisibleArea>, Cancelled> {
        let index = ViewIndex::new(&self.visibility, view, Method::Tolerance(tolerance).into());
        let areas = Areas::new(&self.world, &self.visibility, view, index, tolerance);
        let bands = (0..view.height)
            .into_par_iter()
            .step_by(Tile::SIDE as usize);
        let of_bands = bands.map(|row| {
            let band = Tile {
                col: 0,
                row,
                width: view.width,
                height: Tile::SIDE.min(view.height - row),
            };
            let mut scratch = Scratch::default();
            let mut found = Vec::new();
            for tile in band.tiles() {
                areas.add_tile(tile, &mut scratch, &mut found);
                if progress(tile.count()).is_break() {
                    return Err(Cancelled);
                }
            }
            Ok(found)
        });
        // One after the other: sums do not depend on who finds what first.
        let of_bands: Result<Vec<_>, Cancelled> = of_bands.collect();
        let mut sums = vec![VisibleArea::default(); self.world.spheres().len()];
        for (sphere, found) in of_bands?.into_iter().flatten() {
            sums[sphere].area += found.area;
            sums[sphere].error += found.error;
        }
        Ok(sums)
    }
}

#[cfg(test)]
mod tests;
