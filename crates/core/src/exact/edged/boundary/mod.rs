//! The integral over a cell along the edges in it.
//!
//! With F the integral of the light L along lines up to a place, the integral of L over a region is
//! that of F dy around it (Green). So edges are all that is integrated along, between the places where
//! they cross others, and only where they are seen.

mod arcs;
mod breaks;
mod chord;
mod circle;
mod clip;
mod curve;
mod cutoff_beside;
mod cutoffs;
mod dips;
mod events;
mod fractional;
mod functions;
mod hard_arcs;
mod integral;
mod inward;
mod jumps;
mod kinks;
mod levels;
mod lit;
#[cfg(test)]
mod lit_sphere;
mod near_shadow;
mod outlines;
mod piece;
mod plain;
mod power_rules;
mod primitive;
mod quadrature;
mod setting;
mod turns;
mod unseen;

pub(crate) use self::setting::{Boundary, Goal};
