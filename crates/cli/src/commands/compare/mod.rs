//! `marbles compare`: how far two pictures differ, and where.
//!
//! The exit code answers the question of a test: is any pixel over the tolerance? Pictures of
//! different sizes fail like pictures that differ (1), since both are good files and the command
//! line asks for nothing odd; what cannot be read as a picture is refused (2), as an invalid scene
//! is.

mod difference_picture;
mod report;
mod statistics;

use std::fs;
use std::path::{Path, PathBuf};

use self::difference_picture::DifferencePicture;
use self::report::Report;
use self::statistics::Statistics;
use crate::base::failure::Failure;
use crate::base::status;
use crate::commands::args::CompareArguments;
use crate::files::place;
use crate::formats::picture::Picture;
use crate::terminal::console::Console;

pub(crate) fn run(arguments: &CompareArguments, console: &Console) -> Result<u8, Failure> {
    let CompareArguments {
        a, b, tolerance, ..
    } = arguments;
    let difference_picture = arguments
        .diff
        .as_deref()
        .map(|path| {
            refuse_overwriting(path, [a, b])?;
            DifferencePicture::at(path)
        })
        .transpose()?;
    let pair = Pair {
        a: load(a, console)?,
        b: load(b, console)?,
    };
    if (pair.a.width, pair.a.height) != (pair.b.width, pair.b.height) {
        return Err(Failure::Work(format!(
            "the pictures have different sizes: {} is {} x {}, {} is {} x {}",
            a.display(),
            pair.a.width,
            pair.a.height,
            b.display(),
            pair.b.width,
            pair.b.height
        )));
    }
    if let Some(picture) = &difference_picture {
        place::prepare(picture.path())?;
    }

    let statistics = Statistics::of(&pair, *tolerance, arguments.worst);
    if let Some(picture) = &difference_picture {
        picture.write(&pair, &statistics, *tolerance)?;
    }
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

/// Two pictures of the same size.
struct Pair {
    a: Picture,
    b: Picture,
}

/// The names of the four values of a pixel.
const CHANNELS: [&str; 4] = ["R", "G", "B", "A"];

impl Pair {
    /// Which of red, green, blue and alpha are compared: one of the colors where both pictures are
    /// grey, alpha where one has it.
    fn channels(&self) -> &'static [usize] {
        let grey = self.a.grey && self.b.grey;
        match (grey, self.a.alpha || self.b.alpha) {
            (true, false) => &[0],
            (true, true) => &[0, 3],
            (false, false) => &[0, 1, 2],
            (false, true) => &[0, 1, 2, 3],
        }
    }

    /// The name of a channel that is compared.
    fn name(&self, channel: usize) -> &'static str {
        if channel == 0 && self.a.grey && self.b.grey {
            "Y"
        } else {
            CHANNELS[channel]
        }
    }

    /// The absolute differences of all four values, infinite where one is no finite number.
    fn differences(&self, col: u32, row: u32) -> [f64; 4] {
        let (a, b) = (self.a.rgba(col, row), self.b.rgba(col, row));
        [0, 1, 2, 3].map(|channel| {
            let difference = (a[channel] - b[channel]).abs();
            if difference.is_finite() {
                difference
            } else {
                f64::INFINITY
            }
        })
    }

    /// The largest differences that the rounding of both files accounts for.
    fn rounding(&self, col: u32, row: u32) -> [f64; 4] {
        let (a, b) = (self.a.rounding(col, row), self.b.rounding(col, row));
        [0, 1, 2, 3].map(|channel| a[channel] + b[channel])
    }

    /// Where one of the files holds the largest number it can, and the other a larger one.
    fn is_clipped(&self, col: u32, row: u32) -> [bool; 4] {
        let (a, b) = (self.a.rgba(col, row), self.b.rgba(col, row));
        let (full_a, full_b) = (self.a.is_full(col, row), self.b.is_full(col, row));
        [0, 1, 2, 3].map(|channel| {
            let (a, b) = (a[channel], b[channel]);
            full_a[channel] && a < b || full_b[channel] && b < a
        })
    }

    /// Row by row, the places of all pixels.
    fn pixels(&self) -> impl Iterator<Item = (u32, u32)> {
        let width = self.a.width;
        (0..self.a.height).flat_map(move |row| (0..width).map(move |col| (col, row)))
    }
}

/// A picture, with a warning where it was not understood in full.
fn load(path: &Path, console: &Console) -> Result<Picture, Failure> {
    let picture = Picture::load(path)?;
    for remark in &picture.remarks {
        console.warn(&format!("{}: {remark}", path.display()));
    }
    Ok(picture)
}

/// The picture of the differences must not take the place of a picture that is compared.
fn refuse_overwriting<'a>(
    path: &Path,
    inputs: impl IntoIterator<Item = &'a PathBuf>,
) -> Result<(), Failure> {
    let Ok(place) = fs::canonicalize(path) else {
        // Nothing is there that could be overwritten.
        return Ok(());
    };
    for input in inputs {
        if fs::canonicalize(input).is_ok_and(|input| input == place) {
            return Err(Failure::Usage(format!(
                "{}: --diff would overwrite a picture that is compared",
                path.display()
            )));
        }
    }
    Ok(())
}
