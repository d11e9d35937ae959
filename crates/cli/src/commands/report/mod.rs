//! `marbles report`: measures speed and error, for tolerances and for supersampling.
//!
//! All settings are compared with a reference. The baseline is supersampling: how much longer would it take for the
//! same error? The exit code is that of `render`: 3 if some pixel is over its tolerance, by its own report or by
//! measurement.

mod accuracy;
mod csv;
mod curve;
mod measure;
mod plot;
mod progress;
mod results;
mod row;
mod table;

use marbles_core::{Channels, Renderer, parallel};

use self::measure::Plan;
use self::progress::Progress;
use self::results::{Report, title};
use self::row::Row;
use super::args::ReportArguments;
use super::figures::check_name;
use super::inputs::Inputs;
use super::scene;
use crate::base::failure::Failure;
use crate::base::shown::Shown;
use crate::base::size::Size;
use crate::base::{memory, status, threads};
use crate::files::destination::{is_same, prepare};
use crate::files::save::write_bytes;
use crate::formats::form::color_count;
use crate::terminal::console::Console;
use crate::terminal::interrupt;

pub(crate) fn run(arguments: &ReportArguments, console: &Console) -> Result<u8, Failure> {
    let plot = arguments.plot.as_deref();
    plot.map_or(Ok(()), |plot| check_name("--plot", "plots", plot))?;
    let pool = threads::start(arguments.threads)?;
    parallel::install(&pool, || {
        report(arguments, pool.current_num_threads(), console)
    })
}

/// Measures on the threads of the current pool.
fn report(arguments: &ReportArguments, threads: usize, console: &Console) -> Result<u8, Failure> {
    let scene = scene::load(
        &arguments.scene,
        &arguments.options,
        console,
        arguments.quiet,
    )?;
    let view = scene::view(&scene, &arguments.scene, arguments.frame)?;
    let view = arguments.size.map_or(view, |size| size.resize(view));
    // What cannot be written is refused before the long work.
    let outputs = || arguments.csv.iter().chain(&arguments.plot);
    Inputs::of(&arguments.scene, &scene).refuse(outputs().cloned())?;
    check_files(arguments)?;
    interrupt::listen(console);
    for path in outputs() {
        prepare(path)?;
    }
    let world = scene::world(&scene, arguments.frame)?;
    check_memory(Size::of(&view), Channels::of(&world, false))?;

    let progress = Progress::new(console, arguments.quiet);
    let renderer = Renderer::new(&world);
    let plan = Plan {
        renderer: &renderer,
        exposure: &scene.exposure(&view),
        runs: arguments.runs,
        seconds: arguments.seconds,
        progress: &progress,
    };
    let measured = plan.measure();
    progress.finish();
    let Ok(measurement) = measured else {
        console.warn("interrupted: nothing was written");
        return Ok(status::INTERRUPTED);
    };

    let report = Report {
        title: title(&arguments.scene, &view, &scene, threads),
        scene: arguments.scene.shown(),
        threads,
        view,
        rows: Row::all(&measurement.settings),
        measurement,
    };
    if let Some(path) = &arguments.csv {
        write_bytes(&csv::bytes(&report), path)?;
    }
    if let Some(path) = &arguments.plot {
        write_bytes(plot::draw(&report).as_bytes(), path)?;
    }
    if !arguments.quiet {
        for line in table::lines(&report, console.result_columns()) {
            console.result(&line);
        }
    }
    Ok(conclusion(&report))
}

/// Refuses files that would replace each other.
fn check_files(arguments: &ReportArguments) -> Result<(), Failure> {
    if let (Some(csv), Some(plot)) = (&arguments.csv, &arguments.plot)
        && is_same(csv, plot)
    {
        let why = "--csv and --plot name the same file";
        return Err(Failure::unusable(csv, why));
    }
    Ok(())
}

/// Refuses pictures that do not fit into the memory together.
fn check_memory(size: Size, channels: Channels) -> Result<(), Failure> {
    /// The reference, a possibly better one, and the measured picture.
    const PICTURES: u64 = 3;
    // The channels and the error in double precision, what stands behind it, and the status.
    let pixel_bytes = 8 * (color_count(channels) as u64 + 1) + 2;
    let Size { width, height } = size;
    let pictures = format!("{PICTURES} pictures of {width} x {height} pixels need");
    memory::require(PICTURES * size.pixels() * pixel_bytes, &pictures)
}

/// The exit code of a report.
fn conclusion(report: &Report) -> u8 {
    let settings = &report.measurement.settings;
    if settings.iter().any(|setting| setting.accuracy.missed > 0) {
        status::OVER_TOLERANCE
    } else {
        status::SUCCESS
    }
}

#[cfg(test)]
mod tests;
