//! Exact intersections of rays and spheres, and difficult rays.
//!
//! [`judge`] computes the exact hit of any ray and sphere, [`families`] makes difficult ones, and [`forms`] are other
//! methods.

pub mod families;
pub mod forms;
pub mod frames;
pub mod judge;
pub mod tally;
pub mod verdict;
