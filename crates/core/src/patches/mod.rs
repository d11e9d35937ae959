//! Light on squares of spheres that does not depend on the view: pixels, threads and frames have it in common.
//!
//! | file | contents |
//! |---|---|
//! | `square.rs` | squares of a sphere's surface, and the nodes that they have in common |
//! | `light.rs` | the light at a node, and how it changes with the spheres that are near |
//! | `model.rs` | the light between nodes |
//! | `patch.rs` | the light on a square, and what it claims |
//! | `known.rs` | what is known of them |

pub(crate) mod known;
pub(crate) mod light;
pub(crate) mod model;
pub(crate) mod patch;
pub(crate) mod square;
