//! `marbles merge`: the picture whose parts were rendered on their own.
//!
//! It is written row by row, while the parts that a row crosses are read row by row, so that
//! pictures may be larger than the memory.

mod source;

use std::ops::Range;
use std::path::{Path, PathBuf};

use blake3::Hash;
use marbles_core::{BAND_ROWS, Window};

use self::source::{Kind, Source};
use crate::base::failure::Failure;
use crate::base::region::{self, Region};
use crate::base::status;
use crate::commands::args::{MergeArguments, Size};
use crate::files::place;
use crate::formats::contents;
use crate::formats::{self, Unwritten};
use crate::sequence::pattern::Format;
use crate::terminal::console::Console;

/// A file with a part of the picture.
struct Part {
    path: PathBuf,
    window: Window,
    /// Open while its rows are read.
    source: Option<Source>,
}

/// The parts of a picture.
struct Parts {
    parts: Vec<Part>,
    whole: Size,
    /// Bytes of a sample, channel by channel where a row holds one after the other.
    samples: Vec<usize>,
    /// Why a part could not be read.
    failure: Option<Failure>,
}

pub(crate) fn run(arguments: &MergeArguments, console: &Console) -> Result<u8, Failure> {
    let path = &arguments.output;
    let refused = |message: &str| Failure::Usage(format!("{}: {message}", path.display()));
    let name = path.file_name().and_then(|name| name.to_str());
    let format = name
        .and_then(Format::of)
        .ok_or_else(|| refused("expected a file name that ends in .png or .exr"))?;
    let (digest, whole, parts) = examine(&arguments.parts)?;
    check_cover(&parts, whole)?;
    // All parts are alike, since their digests are.
    let first = Source::open(&parts[0].path).map_err(|why| unusable(&parts[0].path, &why))?;
    let kind = first.kind().clone();
    let mut parts = Parts {
        parts,
        whole,
        samples: kind.samples(),
        failure: None,
    };
    place::prepare(path)?;
    let written = match (&kind, format) {
        (Kind::Png(info), Format::Png) => {
            formats::write_png_like(path, info, whole, &digest, |write| {
                for first in (0..whole.height).step_by(BAND_ROWS as usize) {
                    let rows = first..whole.height.min(first + BAND_ROWS);
                    if let Err(error) = write(&parts.rows(rows)?) {
                        return Some(Err(error));
                    }
                }
                Some(Ok(()))
            })
        }
        (Kind::Exr(header), Format::Exr) => {
            formats::write_exr_like(path, header, whole, |rows| parts.rows(rows))
        }
        _ => return Err(refused("expected the ending of the parts")),
    };
    match written {
        Ok(()) => {}
        Err(Unwritten::Failed(failure)) => return Err(failure),
        Err(Unwritten::Stopped) => {
            let stopped = || Failure::at(path, "cannot write the file: a part has ended early");
            return Err(parts.failure.take().unwrap_or_else(stopped));
        }
    }
    if !arguments.quiet {
        let pixels = u64::from(whole.width) * u64::from(whole.height);
        let count = arguments.parts.len();
        let noun = if count == 1 { "part" } else { "parts" };
        console.result(&format!(
            "{}: {pixels} pixels from {count} {noun}",
            path.display()
        ));
    }
    Ok(status::SUCCESS)
}

/// What the parts are parts of: its digest and size; and the parts.
fn examine(paths: &[PathBuf]) -> Result<(Hash, Size, Vec<Part>), Failure> {
    let mut found: Option<(Hash, Size)> = None;
    let mut parts = Vec::new();
    for path in paths {
        if !path.exists() {
            return Err(unusable(path, "no such file"));
        }
        let expected = "expected a complete picture that `marbles render` has written";
        let content = contents::content(path).ok_or_else(|| unusable(path, expected))?;
        let (digest, region) = content;
        let region = match region {
            Some(region) => region,
            None => Region::all(source::size(path).map_err(|why| unusable(path, &why))?),
        };
        let other = *found.get_or_insert((digest, region.whole));
        if other != (digest, region.whole) {
            let first = paths[0].display();
            let message = format!("not of the same scene, frame and settings as {first}");
            return Err(unusable(path, &message));
        }
        parts.push(Part {
            path: path.clone(),
            window: region.window,
            source: None,
        });
    }
    let (digest, whole) = found.ok_or_else(|| Failure::Usage("no parts".to_owned()))?;
    Ok((digest, whole, parts))
}

fn unusable(path: &Path, reason: &str) -> Failure {
    Failure::Usage(format!("{}: {reason}", path.display()))
}

/// Refuses parts that overlap or leave something out.
fn check_cover(parts: &[Part], whole: Size) -> Result<(), Failure> {
    for (index, part) in parts.iter().enumerate() {
        if let Some(other) = parts[..index].iter().find(|other| overlap(part, other)) {
            let [one, two] = [part, other].map(|part| region::shown(&part.window));
            let other = other.path.display();
            let message = format!("its region {one} overlaps that of {other}, {two}");
            return Err(unusable(&part.path, &message));
        }
    }
    match gap(parts, whole) {
        None => Ok(()),
        Some((col, row)) => Err(Failure::Usage(format!(
            "the parts leave a gap: none has the pixel in column {col}, row {row} of the \
             {} x {} pixels",
            whole.width, whole.height
        ))),
    }
}

fn overlap(one: &Part, other: &Part) -> bool {
    let meet = |one: Range<u32>, other: Range<u32>| one.start < other.end && other.start < one.end;
    meet(columns(one), columns(other)) && meet(rows(one), rows(other))
}

fn columns(part: &Part) -> Range<u32> {
    part.window.col..part.window.col + part.window.width
}

fn rows(part: &Part) -> Range<u32> {
    part.window.row..part.window.row + part.window.height
}

/// The first pixel that no part has, of parts that do not overlap.
fn gap(parts: &[Part], whole: Size) -> Option<(u32, u32)> {
    // A gap begins at the top, or where a part ends.
    let mut tops: Vec<u32> = parts.iter().map(|part| rows(part).end).collect();
    tops.push(0);
    tops.retain(|&row| row < whole.height);
    tops.sort_unstable();
    tops.dedup();
    tops.into_iter().find_map(|row| {
        let crossed = parts.iter().filter(|part| rows(part).contains(&row));
        let mut crossed: Vec<Range<u32>> = crossed.map(columns).collect();
        crossed.sort_unstable_by_key(|columns| columns.start);
        let mut col = 0;
        for columns in crossed {
            if columns.start > col {
                break;
            }
            col = columns.end;
        }
        (col < whole.width).then_some((col, row))
    })
}

impl Parts {
    /// The samples of some rows, which have to follow those before; `None` where a part cannot be
    /// read.
    fn rows(&mut self, rows: Range<u32>) -> Option<Vec<u8>> {
        let row_bytes = self.samples.iter().sum::<usize>() * self.whole.width as usize;
        let mut samples = vec![0; row_bytes * rows.len()];
        for (row, samples) in rows.zip(samples.chunks_exact_mut(row_bytes)) {
            for part in &mut self.parts {
                if !self::rows(part).contains(&row) {
                    continue;
                }
                if let Err(why) = part.copy_row(row, &self.samples, samples) {
                    let why = format!("cannot read the part: {why}");
                    self.failure = Some(Failure::at(&part.path, &why));
                    return None;
                }
            }
        }
        Some(samples)
    }
}

impl Part {
    /// Puts a row of the part where it belongs in a row of the picture.
    fn copy_row(&mut self, row: u32, samples: &[usize], whole: &mut [u8]) -> Result<(), String> {
        let source = match &mut self.source {
            Some(source) => source,
            None => self.source.insert(Source::open(&self.path)?),
        };
        let Window { col, width, .. } = self.window;
        let mut rest = source.next_row()?;
        let of_pixel: usize = samples.iter().sum();
        if rest.len() != of_pixel * width as usize {
            return Err("a row has another length than it should".to_owned());
        }
        let columns = whole.len() / of_pixel;
        let mut start = 0;
        for bytes in samples {
            let (own, others) = rest.split_at(width as usize * bytes);
            let first = start + col as usize * bytes;
            whole[first..first + own.len()].copy_from_slice(own);
            start += columns * bytes;
            rest = others;
        }
        if row + 1 == rows(self).end {
            self.source = None;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
