//! The only pixel of a view, for tests.

use super::integrator::{Exact, GroupScratch};
use crate::model::view::View;
use crate::model::world::World;
use crate::picture::pixel::Pixel;
use crate::picture::tile::Tile;
use crate::search::grid::RayPoints;
use crate::search::view_index::ViewIndex;
use crate::search::visibility::Visibility;

/// The pixel, to a tolerance, with an alpha channel in place of the background.
pub(super) fn only_pixel(world: &World, view: &View, tolerance: f64) -> Pixel {
    let visibility = Visibility::new(world);
    let seen = ViewIndex::new(&visibility, view, RayPoints::All);
    let exact = Exact::new(world, view, &seen, tolerance, true);
    let tile = Tile {
        col: 0,
        row: 0,
        width: 1,
        height: 1,
    };
    let mut pixels = Vec::new();
    exact.integrate(tile, &mut GroupScratch::default(), &mut pixels);
    pixels[0]
}
