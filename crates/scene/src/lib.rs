//! The scene files of marbles: format, checks, messages, animation.
//!
//! [`Scene::load`] reads a file in RON, and the tables that it names. A [`Scene`] has a [`World`](marbles_core::World) and a
//! [`View`](marbles_core::View) for each frame. The world is the same in every frame, unless tables change over time:
//! [`Scene::world_at`] always has all spheres of a frame. If a file has faults, a [`SceneError`] tells the line and the column
//! of each, what was expected there and what was found.
//!
//! # Example
//! ```
//! use std::path::Path;
//!
//! use marbles_core::{Renderer, Settings};
//! use marbles_scene::Scene;
//!
//! let text = "(image: (width: 32, height: 32), lens: Fov(40), camera: Free(), ambient: 0.5,
//!     spheres: [(center: (0, 0, 5), radius: 1)])";
//! let scene = Scene::parse(text, Path::new("ball.ron"))?;
//! let view = scene.view(1)?;
//! let world = scene.world_at(1)?;
//! let image = Renderer::new(&world).render(scene.exposure(&view), &Settings::default());
//! assert_eq!(image.rgba(16, 16)[0], 0.5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! From the bottom: `text` is how every value knows its place in the file, and how faults are
//! gathered; `values` are the numbers, colors and names; `table` reads tables; `file` is the format
//! as structures. `motion` and `world` give them their meaning, `report` writes the messages.

mod bounds;
mod figure;
mod file;
mod motion;
mod report;
mod scene;
mod table;
mod text;
mod values;
mod world;

pub use figure::{Figure, ViewAngle, ViewAngleError};
pub use motion::{FrameError, FrameFault};
pub use report::{SceneError, SceneFault};
pub use scene::{
    CellDescription, CloudDescription, ColorDescription, ColorMeaning, Description, OrbitCamera,
    OrbitCenter, STANDARD_INPUT, Scene, Setting, SettingError, Unturnable,
};
pub use table::{COMPRESSED_ENDINGS, TableBytes, Tables, written_time};
pub use text::harmless;
pub use world::{ColumnContents, ColumnSummary, Progress, ScaleKind, StepKey};
