//! The results of a report.

use std::path::Path;

use marbles_core::View;
use marbles_scene::Scene;

use super::measure::{Measurement, Reference};
use super::row::Row;
use crate::base::numbers::counted;

/// All that is known about a scene.
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

#[cfg(test)]
pub(super) mod tests {
    use std::time::Duration;

    use glam::{DVec2, DVec3};
    use marbles_core::{Angle, Camera, Lens};

    use super::*;
    use crate::commands::report::row;
    use crate::formats::tests::{Scene, render};

    /// A report as if it had been measured.
    pub(in crate::commands::report) fn report() -> Report {
        let settings = row::tests::settings();
        let image = render(Scene::Grey, false);
        let known = image.summary().pixels;
        Report {
            title: "ball, red.ron, 23 x 19 pixels, 2 threads".to_owned(),
            scene: "ball, red.ron".to_owned(),
            threads: 2,
            view: View {
                camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
                lens: Lens {
                    width: 0.6,
                    distance: 1.0,
                    shift: DVec2::ZERO,
                },
                zoom: 1.0,
                width: image.width(),
                height: image.height(),
                frame: 1,
            },
            rows: Row::all(&settings),
            measurement: Measurement {
                reference: Reference {
                    tolerance: 1e-9,
                    image,
                    time: Duration::from_secs(3),
                    known,
                },
                settings,
                runs_planned: 5,
            },
        }
    }
}
