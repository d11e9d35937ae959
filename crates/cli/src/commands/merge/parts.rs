//! The parts of a picture.

use std::ops::Range;
use std::path::PathBuf;

use blake3::Hash;
use marbles_core::Window;

use crate::base::failure::Failure;
use crate::base::region::shown;
use crate::base::shown::Shown;
use crate::base::size::Size;
use crate::formats::load::contents;
use crate::formats::rows::{Kind, RowReader};

/// The parts of a picture, which cover it.
pub(super) struct Parts {
    parts: Vec<Part>,
    pub(super) whole: Size,
    pub(super) digest: Hash,
    /// The kind of every part; it is the same for all, because their digests are.
    pub(super) kind: Kind,
}

/// A file with a part of the picture.
struct Part {
    path: PathBuf,
    window: Window,
    /// The open file, while its rows are read.
    reader: Option<RowReader>,
}

impl Parts {
    /// Finds the picture that these files are parts of. Refuses files that are not parts of one picture.
    pub(super) fn examine(paths: &[PathBuf]) -> Result<Self, Failure> {
        let mut found: Option<(Hash, Size)> = None;
        let mut parts = Vec::new();
        for path in paths {
            if !path.exists() {
                return Err(Failure::unusable(path, "no such file"));
            }
            let (digest, region) = contents(path).map_err(|why| {
                let expected = "expected a complete picture written by `marbles render`";
                Failure::unusable(path, &format!("{expected}: {why}"))
            })?;
            let other = *found.get_or_insert((digest, region.whole));
            if other != (digest, region.whole) {
                let first = paths[0].shown();
                let message =
                    format!("not made from the same scene, frame and settings as {first}");
                return Err(Failure::unusable(path, &message));
            }
            parts.push(Part {
                path: path.clone(),
                window: region.window,
                reader: None,
            });
        }
        let (digest, whole) = found.ok_or_else(|| Failure::Usage("no parts".to_owned()))?;
        check_cover(&parts, whole)?;
        let kind = |part: &Part| {
            let reader = RowReader::open(&part.path);
            let kind = reader.map(|reader| reader.kind());
            kind.map_err(|why| Failure::unusable(&part.path, &why))
        };
        let mut all = kind(&parts[0])?;
        for part in &parts[1..] {
            all.add(&kind(part)?);
        }
        Ok(Self {
            kind: all,
            parts,
            whole,
            digest,
        })
    }

    /// The samples of the next rows.
    pub(super) fn rows(&mut self, rows: Range<u32>) -> Result<Vec<u8>, Failure> {
        let sample_bytes = self.kind.sample_bytes();
        let row_bytes = sample_bytes.iter().sum::<usize>() * self.whole.width as usize;
        let mut samples = vec![0; row_bytes * rows.len()];
        for (row, samples) in rows.zip(samples.chunks_exact_mut(row_bytes)) {
            let crossed = self.parts.iter_mut();
            for part in crossed.filter(|part| self::rows(part).contains(&row)) {
                let copied = part.copy_row(row, &sample_bytes, samples);
                copied.map_err(|why| {
                    Failure::at(&part.path, &format!("cannot read the part: {why}"))
                })?;
            }
        }
        Ok(samples)
    }
}

impl Part {
    /// Copies a row of the part to its position in a row of the picture.
    fn copy_row(
        &mut self,
        row: u32,
        sample_bytes: &[usize],
        whole: &mut [u8],
    ) -> Result<(), String> {
        let reader = match &mut self.reader {
            Some(reader) => reader,
            None => self.reader.insert(RowReader::open(&self.path)?),
        };
        let Window { col, width, .. } = self.window;
        let mut rest = reader.next_row()?;
        let of_pixel: usize = sample_bytes.iter().sum();
        if rest.len() != of_pixel * width as usize {
            return Err("a row has the wrong length".to_owned());
        }
        let columns = whole.len() / of_pixel;
        let mut start = 0;
        for bytes in sample_bytes {
            let (own, others) = rest.split_at(width as usize * bytes);
            let first = start + col as usize * bytes;
            whole[first..first + own.len()].copy_from_slice(own);
            start += columns * bytes;
            rest = others;
        }
        if row + 1 == rows(self).end {
            self.reader = None;
        }
        Ok(())
    }
}

/// Refuses parts that overlap or leave a gap.
fn check_cover(parts: &[Part], whole: Size) -> Result<(), Failure> {
    for (index, part) in parts.iter().enumerate() {
        if let Some(other) = parts[..index].iter().find(|other| overlap(part, other)) {
            let [one, two] = [part, other].map(|part| shown(&part.window));
            let other = other.path.shown();
            let message = format!("its region {one} overlaps that of {other}, {two}");
            return Err(Failure::unusable(&part.path, &message));
        }
    }
    match gap(parts, whole) {
        None => Ok(()),
        Some((col, row)) => Err(Failure::Usage(format!(
            "the parts leave a gap: none contains the pixel in column {col}, row {row} of the \
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

/// The first pixel that no part contains, if parts do not overlap.
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

#[cfg(test)]
mod tests;
