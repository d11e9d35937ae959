//! Plain supersampling: the yardstick for everything cleverer.
//!
//! Tiles are small, and their rays go side by side: [`tile_balls`] finds the spheres that matter in a
//! tile, [`trace`] what eight rays see of them ([`parallel`] where a lens is parallel), [`light`] how bright that is ([`outlines`] beside contours), [`centers`] where, and [`shadow`] where
//! it is dark; [`sampler`] calls them in this order. The eight rays are those of eight pixels, or, in crowds, of one pixel
//! ([`blocks`]). All of it decides exactly or leaves the decision to what does, and computes with
//! one rounding an operation, so that a picture is the same to the bit on any processor, and
//! however it is cut into tiles.

mod ball_discs;
mod blocks;
mod bundle;
mod centers;
mod groups;
mod last_places;
mod light;
mod outlines;
mod parallel;
mod places;
mod rays;
mod row_samples;
mod sampler;
mod scattered;
mod shadow;
mod sums;
mod supersampling;
mod tile_balls;
mod trace;

pub(crate) use scattered::Pairs;
pub(crate) use supersampling::{Scratch, Supersampling};
