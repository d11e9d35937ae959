//! Exact answers about rays and spheres, and hard rays to ask.
//!
//! [`judge`] knows the truth about any ray and sphere, [`families`] draws hard ones; [`forms`] are
//! other ways to compute a hit.

pub mod families;
pub mod forms;
pub mod frames;
pub mod judge;
pub mod tally;
pub mod verdict;
