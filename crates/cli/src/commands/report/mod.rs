//! `marbles report`: speed against error, of tolerances and of supersampling.
//!
//! All settings are held against a reference, and supersampling is the yardstick: how much longer
//! would it take to the same error? The exit code is that of `render`: 1 where some pixel does not
//! meet its tolerance, by its own word or by measurement.

mod accuracy;
mod csv;
mod curve;
mod measure;
mod plot;
mod progress;
mod row;
mod table;

use std::fs;
use std::path::Path;

use marbles_core::{Renderer, View};
use marbles_scene::Scene;

use self::measure::{Measurement, Plan, Reference};
use self::plot::PlotFile;
use self::progress::Progress;
use self::row::Row;
use crate::base::failure::Failure;
use crate::base::memory::{self, Form};
use crate::base::status;
use crate::base::threads;
use crate::commands::args::ReportArguments;
use crate::commands::frame;
use crate::commands::scene;
use crate::files::place;
use crate::formats;
use crate::terminal::console::Console;
use crate::terminal::interrupt;

pub(crate) fn run(arguments: &ReportArguments, console: &Console) -> Result<u8, Failure> {
    let plot = arguments.plot.as_deref().map(PlotFile::at).transpose()?;
    let scene = scene::load(&arguments.scene, console, arguments.quiet)?;
    let view = frame::view(&scene, arguments.frame)?;
    let view = frame::resized(view, arguments.size);
    // What cannot be written is refused before the long work.
    check_files(arguments)?;
    let pool = threads::start(arguments.threads)?;
    interrupt::listen(console.farewell());
    for path in arguments.csv.iter().chain(&arguments.plot) {
        place::prepare(path)?;
    }
    memory::check_pictures(&Form::of(&view, scene.world(), false), PICTURES)?;

    let progress = Progress::new(console, arguments.quiet);
    let renderer = Renderer::new(scene.world());
    let plan = Plan {
        renderer: &renderer,
        exposure: &scene.exposure(&view),
        runs: arguments.runs,
        seconds: arguments.seconds,
        progress: &progress,
    };
    let measured = pool.install(|| plan.measure());
    progress.finish();
    let Ok(measurement) = measured else {
        console.warn("interrupted: nothing was written");
        return Ok(status::INTERRUPTED);
    };

    let report = Report {
        title: title(&arguments.scene, &view, &scene, pool.current_num_threads()),
        scene: arguments.scene.display().to_string(),
        threads: pool.current_num_threads(),
        view,
        rows: Row::all(&measurement.settings),
        measurement,
    };
    if let Some(path) = &arguments.csv {
        formats::write_bytes(&csv::bytes(&report), path)?;
    }
    if let Some(plot) = &plot {
        plot.write(&report)?;
    }
    if !arguments.quiet {
        for line in table::lines(&report) {
            console.result(&line);
        }
    }
    Ok(conclusion(&report))
}

/// Pictures in memory at a time: the reference, another one in its place, and what is measured.
const PICTURES: u64 = 3;

/// All that is known about a scene.
struct Report {
    /// Scene, frame, size and threads, for people.
    title: String,
    scene: String,
    view: View,
    threads: usize,
    measurement: Measurement,
    rows: Vec<Row>,
}

impl Report {
    fn reference(&self) -> &Reference {
        &self.measurement.reference
    }
}

/// Refuses files that would take the place of the scene or of each other.
fn check_files(arguments: &ReportArguments) -> Result<(), Failure> {
    let place = |path: &Path| fs::canonicalize(path).ok();
    let same = |one: &Path, other: &Path| {
        one == other || place(one).is_some_and(|one| place(other) == Some(one))
    };
    let ReportArguments {
        scene, csv, plot, ..
    } = arguments;
    for (option, path) in [("--csv", csv), ("--plot", plot)] {
        if let Some(path) = path
            && same(path, scene)
        {
            return Err(Failure::Usage(format!(
                "{}: {option} would overwrite the scene",
                path.display()
            )));
        }
    }
    match (csv, plot) {
        (Some(csv), Some(plot)) if same(csv, plot) => Err(Failure::Usage(format!(
            "{}: --csv and --plot name the same file",
            csv.display()
        ))),
        _ => Ok(()),
    }
}

/// `ball.ron, frame 7, 600 x 600 pixels, 2 threads`.
fn title(path: &Path, view: &View, scene: &Scene, threads: usize) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    let mut title = name.to_string_lossy().into_owned();
    if scene.frames().is_some() {
        title.push_str(&format!(", frame {}", view.frame));
    }
    let plural = if threads == 1 { "" } else { "s" };
    let View { width, height, .. } = view;
    title.push_str(&format!(
        ", {width} x {height} pixels, {threads} thread{plural}"
    ));
    title
}

/// The exit code of a report.
fn conclusion(report: &Report) -> u8 {
    let settings = &report.measurement.settings;
    if settings.iter().any(|setting| setting.accuracy.missed > 0) {
        status::FAILURE
    } else {
        status::SUCCESS
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use glam::{DVec2, DVec3};
    use marbles_core::{Angle, Camera, Lens};

    use super::*;
    use crate::formats::tests::{Scene, render};

    /// A report as if it had been measured.
    pub(super) fn report() -> Report {
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

    #[test]
    fn a_pixel_that_misses_its_tolerance_decides_the_exit_code() {
        let mut report = report();
        assert_eq!(conclusion(&report), status::SUCCESS);
        report.measurement.settings[1].accuracy.missed = 1;
        assert_eq!(conclusion(&report), status::FAILURE);
    }
}
