//! The results of a report.

use std::path::Path;

use marbles_core::View;
use marbles_scene::Scene;

use super::measure::{Measurement, Reference};
use super::row::Row;
use crate::base::numbers::counted;

/// All results for a scene.
pub(super) struct Report {
    /// Scene, frame, size and threads, for people.
    pub(super) title: String,
    pub(super) scene: String,
    pub(super) view: View,
    pub(super) threads: usize,
    pub(super) measurement: Measurement,
    pub(super) rows: Vec<Row>,
}

impl Report {
    pub(super) fn reference(&self) -> &Reference {
        &self.measurement.reference
    }
}

/// `ball.ron, frame 7, 600 x 600 pixels, 2 threads`.
pub(super) fn title(path: &Path, view: &View, scene: &Scene, threads: usize) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    let mut title = name.to_string_lossy().into_owned();
    if scene.frames().is_some() {
        title.push_str(&format!(", frame {}", view.frame));
    }
    let View { width, height, .. } = view;
    let threads = counted(threads as u64, "thread");
    title.push_str(&format!(", {width} x {height} pixels, {threads}"));
    title
}
