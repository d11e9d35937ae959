//! The scene files of marbles: format, checks, messages, animation.
//!
//! [`Scene::load`] reads a file in RON. A [`Scene`] is a [`World`](marbles_core::World), the same
//! in every frame, and a [`View`](marbles_core::View) for each frame. A file that is refused says
//! in a [`SceneError`] at which line and column, what was expected there and what was found; all
//! the faults that can be told at once are told.
//!
//! [`Scene::load`] reads the tables that the file names, too: `table` knows their formats, `cloud`
//! places what is in them.
//!
//! `file` is the format as structures, `assemble` and `motion` give them their meaning, and
//! `placed` with `fault` is how every value knows its place in the text.

mod assemble;
mod cloud;
mod color;
mod curve;
mod error;
mod explain;
mod fault;
mod file;
mod framing;
mod motion;
mod placed;
mod quantity;
mod raw;
mod report;
mod rig;
mod scene;
mod shutter;
mod suggest;
mod table;
mod token;
mod turntable;

pub use error::{FrameError, FrameFault, SceneError, SceneFault};
pub use scene::{CloudDescription, Description, Progress, Scene};
