//! Where light changes abruptly on the retina: outlines, seams, terminators and edges of shadows,
//! as curves in the coordinates of a [`Cell`].
//!
//! Outlines, seams and terminators are conics there, and cross a line in two places at most. An
//! edge of a shadow on a sphere crosses it in four at most.

mod cell;
mod polynomial;
mod quartic;
mod seam;
mod shadow;
mod silhouette;
mod terminator;
mod vectors;

pub(crate) use cell::{Ball, Cell};
pub(crate) use polynomial::{Linear, Quadratic};
pub(crate) use seam::seam;
pub(crate) use shadow::{Arcs, Caster};
pub(crate) use silhouette::silhouette;
pub(crate) use terminator::terminator;
pub(crate) use vectors::Vectors;

#[cfg(test)]
pub(crate) mod tests;
