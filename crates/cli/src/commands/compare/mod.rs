//! `marbles compare`: shows by how much and where two pictures differ.
//!
//! The exit code answers the question of a test: is any pixel over the tolerance? If pictures have different sizes, the
//! exit code is 1, as for pictures that differ, because both files and the command line are correct. A file that cannot
//! be read as a picture is refused with 2, like an invalid scene.

mod difference_picture;
mod pair;
mod report;
mod statistics;

use std::path::Path;

use self::difference_picture::DifferencePicture;
use self::pair::Pair;
use self::report::Report;
use self::statistics::Counter;
use super::args::CompareArguments;
use crate::base::failure::Failure;
use crate::base::shown::Shown;
use crate::base::status;
use crate::files::destination::{is_same, prepare};
use crate::files::save::Fault;
use crate::formats::load;
use crate::formats::picture::Picture;
use crate::terminal::console::Console;
use crate::terminal::interrupt;

pub(crate) fn run(arguments: &CompareArguments, console: &Console) -> Result<u8, Failure> {
    let CompareArguments {
        a,
        b,
        tolerance,
        diff,
        ..
    } = arguments;
    if let Some(diff) = diff
        && diff.exists()
        && (is_same(diff, a) || is_same(diff, b))
    {
        let why = "--diff would overwrite one of the compared pictures";
        return Err(Failure::unusable(diff, why));
    }
    let difference_picture = diff.as_deref().map(DifferencePicture::at).transpose()?;
    let mut pair = Pair {
        a: load(a, console)?,
        b: load(b, console)?,
        paths: [a.clone(), b.clone()],
    };
    let [size_a, size_b] = [&pair.a, &pair.b].map(|picture| picture.size);
    if size_a != size_b {
        return Err(Failure::Work(format!(
            "the pictures have different sizes: {} is {} x {}, {} is {} x {}",
            a.shown(),
            size_a.width,
            size_a.height,
            b.shown(),
            size_b.width,
            size_b.height
        )));
    }
    let mut counter = Counter::new(&pair, *tolerance, arguments.worst);
    if let Some(picture) = &difference_picture {
        // What is half written goes where the user ends it.
        interrupt::listen(console);
        prepare(picture.path())?;
        let channels = pair.channels();
        let names = channels.iter().map(|&channel| pair.name(channel));
        let names: Vec<&str> = names.collect();
        let size = pair.size();
        picture.write(size, &names, *tolerance, |values| {
            pair.advance().map_err(Fault::Failed)?;
            counter.add_row(&pair);
            let columns = pair.columns();
            for run in pair.runs(columns.clone()) {
                let differences = pair.differences(run.start);
                for _ in run {
                    values.extend(channels.iter().map(|&channel| differences[channel]));
                }
            }
            Ok(columns)
        })?;
    } else {
        for _ in 0..pair.size().height {
            pair.advance()?;
            counter.add_row(&pair);
        }
    }
    let statistics = counter.finish();
    if !arguments.quiet {
        let report = Report {
            arguments,
            pair: &pair,
            statistics: &statistics,
            difference_picture: difference_picture.as_ref(),
        };
        for line in report.lines() {
            console.result(&line);
        }
    }
    Ok(if statistics.over_tolerance == 0 {
        status::SUCCESS
    } else {
        status::FAILURE
    })
}

/// A picture, and a warning if some of its contents were ignored.
fn load(path: &Path, console: &Console) -> Result<Picture, Failure> {
    let picture = load::picture(path)?;
    picture.warn(path, console);
    Ok(picture)
}
