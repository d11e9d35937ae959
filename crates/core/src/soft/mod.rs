//! Soft light: suns with a disc, and the sky.
//!
//! Seen from a point, a sphere hides a *cap* of directions: all within some angle of an axis. The own surface hides one more,
//! the directions below its tangent plane. Light is an integral over the directions that no cap hides, which is a sum over
//! the arcs of the caps' circles that no other cap covers: exact at a point.
//!
//! | file | contents |
//! |---|---|
//! | `cap.rs`, `circles.rs`, `arcs.rs`, `visible.rs` | caps, the arcs of their circles, the integral over what is visible |
//! | `point.rs`, `sun.rs`, `sky.rs`, `light.rs` | points, and the light at a point |
//! | `candidate.rs`, `seam.rs`, `line.rs`, `heights.rs` | what is seen along a line of the picture, and between which heights that changes smoothly |
//! | `rectangle.rs`, `cell.rs` | a pixel or a part of one, and the average over it |
//! | `piece.rs` | of light that is costly: from few points of each sphere |
//! | `curve.rs`, `edges.rs`, `strips.rs`, `of_sun.rs` | of a sun's light: along lines, on which the places are found where spheres begin to hide it |
//! | `doubt.rs` | changes of light that points of a cell may miss |
//! | `picture.rs` | the averages over pixels, by samples or to a tolerance |

mod arcs;
mod candidate;
mod cap;
mod cell;
mod circles;
mod curve;
mod doubt;
mod edges;
mod heights;
mod light;
mod line;
mod of_sun;
pub(crate) mod picture;
mod piece;
mod point;
mod rectangle;
mod seam;
mod sky;
mod strips;
mod sun;
mod visible;
