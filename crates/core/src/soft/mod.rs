//! Soft light: suns with a disc, and the sky.
//!
//! Seen from a point, a sphere hides a *cap* of directions: all within some angle of an axis. The own surface hides one more,
//! the directions below its tangent plane. Light is an integral over the directions that no cap hides, which is a sum over
//! the arcs of the caps' circles that no other cap covers: exact at a point.
//!
//! | file | contents |
//! |---|---|
//! | `cap.rs`, `circles.rs`, `arcs.rs`, `lens.rs`, `visible.rs` | caps, the arcs of their circles, the integral over what is visible |
//! | `point.rs`, `sun.rs`, `sky.rs`, `light.rs` | points, and the light at a point |
//! | `candidate.rs`, `seam.rs`, `line.rs`, `heights.rs` | what is seen along a line of the picture, and between which heights that changes smoothly |
//! | `rectangle.rs`, `behind.rs`, `cell.rs` | a pixel or a part of one, the spheres of it that others hide, and the average over it |
//! | `curve.rs`, `rule.rs`, `across.rs`, `strips.rs` | the same along lines, and from lines across it |
//! | `edges.rs`, `of_sun.rs` | a sun's light in a pixel: the places on a line are found where spheres begin to hide it |
//! | `hemisphere.rs`, `gather.rs`, `bodies.rs`, `list.rs`, `node.rs`, `of_sky.rs` | a sky's light in a pixel: from `patches`, whose nodes only some spheres hide light from |
//! | `rays/` | a sky's light in a pixel of a crowd, to loose tolerances |
//! | `doubt.rs` | changes of light that points of a cell may miss |
//! | `scene.rs`, `picture.rs` | the averages over pixels, by samples or to a tolerance |

mod across;
mod arcs;
mod behind;
mod bodies;
mod candidate;
mod cap;
mod cell;
mod circles;
mod curve;
mod doubt;
mod edges;
mod gather;
mod heights;
mod hemisphere;
mod lens;
mod light;
mod line;
mod list;
mod node;
mod of_sky;
mod of_sun;
pub(crate) mod picture;
mod point;
mod rays;
mod rectangle;
mod rule;
pub(crate) mod scene;
mod seam;
mod sky;
mod strips;
mod sun;
mod visible;
