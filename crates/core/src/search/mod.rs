//! The search for the sphere that a ray meets.
//!
//! [`visibility`] holds what depends on the world alone, [`view_index`] what depends on a view too.
//! Both leave out what cannot matter, by bounds that are rounded outward; every decision about what
//! remains is exact for the given doubles.

pub(crate) mod beyond;
mod block_search;
mod blocks;
mod disc_grid;
pub(crate) mod discs;
pub(crate) mod frustum;
pub(crate) mod grid;
pub(crate) mod hierarchy;
pub(crate) mod light_grid;
mod mask;
mod nested;
mod occluders;
pub(crate) mod point_occluders;
mod screen_bounds;
pub(crate) mod shadow_cells;
mod tile_lists;
pub(crate) mod view_index;
pub(crate) mod visibility;

#[cfg(test)]
pub(crate) mod tests;
