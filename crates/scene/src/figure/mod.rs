//! Figures of tables: a scene that shows a table of particles, made from the table alone.
//!
//! `contents` gathers what `reader` reads of the table, `colors` chooses a column to color, `spacing` a radius, `angle` the direction of
//! the camera. [`Figure::scene_text`] writes a scene file from what they found, which is then loaded as any other.

mod angle;
mod colors;
mod contents;
mod reader;
mod spacing;
mod text;
mod view;

use std::path::Path;

pub use view::{ViewAngle, ViewAngleError};

use self::contents::Contents;

/// The choices that a figure of a table leaves to its user.
///
/// # Example
/// ```
/// use marbles_scene::Figure;
///
/// # let folder = std::env::temp_dir().join(format!("marbles Figure {}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// # let file = folder.join("water.xyz");
/// // `water.xyz` holds three atoms.
/// # std::fs::write(&file, "3\n\nO 0 0 0.1\nH 0 0.8 -0.5\nH 0 -0.8 -0.5\n")?;
/// let figure = Figure { view: Some("front".parse()?), ..Figure::default() };
/// let text = figure.scene_text(&file, "water.xyz");
/// assert!(text.contains("camera: Frame(azimuth: 0, elevation: 0)"));
/// assert!(text.contains("file: \"water.xyz\""));
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figure {
    /// The direction of the camera; `None` for the one that shows most of a table, or for that of a scene file.
    pub view: Option<ViewAngle>,
    /// The number of frames in which the camera goes around once; `None` for a still, or for the animation of a scene
    /// file.
    pub turntable: Option<u32>,
    /// The width and the height of a figure of a table, in pixels; `None` for a width of 1600 and the height that fits.
    pub size: Option<(u32, u32)>,
}

impl Figure {
    /// The text of a scene that shows the table at `table`, and calls it `name`.
    ///
    /// If the table cannot be read, the text names it all the same: loading the scene then tells what is wrong.
    pub fn scene_text(&self, table: &Path, name: &str) -> String {
        let Self {
            view,
            turntable,
            size,
        } = *self;
        text::scene(&Contents::read(table), name, view, turntable, size)
    }

    /// The values of a scene file that this figure replaces, with their places.
    pub(crate) fn settings(&self) -> Vec<(&'static str, String)> {
        let view = self.view.map(|view| ("camera", text::camera(view)));
        let turntable = self
            .turntable
            .map(|frames| ("animation", text::turntable(frames)));
        view.into_iter().chain(turntable).collect()
    }
}

#[cfg(test)]
mod tests;
