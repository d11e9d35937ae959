//! The scene files of marbles: format, checks, messages, animation.
//!
//! [`Scene::load`] reads a file in RON. A [`Scene`] is a [`World`](marbles_core::World), the same
//! in every frame, and a [`View`](marbles_core::View) for each frame. A file that is refused says
//! in a [`SceneError`] at which line and column, what was expected there and what was found; all
//! the faults that can be told at once are told.
//!
//! [`Scene::load`] reads the tables that the file names, too.
//!
//! From the bottom: `text` is how every value knows its place in the file, and how faults are
//! gathered; `values` are the numbers, colors and names; `table` reads tables; `file` is the format
//! as structures. `motion` and `world` give them their meaning, `report` writes the messages.

mod bounds;
mod file;
mod motion;
mod report;
mod scene;
mod table;
mod text;
mod values;
mod world;

pub use motion::{FrameError, FrameFault};
pub use report::{SceneError, SceneFault};
pub use scene::{CloudDescription, ColorDescription, ColorMeaning, Description, Scene, Setting};
pub use table::written_time;
pub use text::harmless;
pub use world::{ColumnContents, ColumnSummary, Progress, ScaleKind, StepKey};
