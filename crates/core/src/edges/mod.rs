//! Curves on the retina across which light changes abruptly: contours, seams, terminators, cutoffs of lamps and edges
//! of shadows, as curves in the coordinates of a [`Cell`].
//!
//! Contours, seams, terminators and cutoffs are conics there, and cross a line in two places at most. An
//! edge of a shadow on a sphere crosses it in four at most.

pub(crate) mod cell;
pub(crate) mod cutoff;
pub(crate) mod seam;
pub(crate) mod shadow;
pub(crate) mod silhouette;
pub(crate) mod terminator;

#[cfg(test)]
pub(crate) mod tests;
