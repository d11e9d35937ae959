//! PVD, the collections of ParaView: the files of each time, one of them or several parts.
//!
//! # Source
//! "ParaView/Data formats", the wiki of Kitware.

use std::path::{Path, PathBuf};

use super::super::error::TableError;
use super::super::format::Format;
use super::super::input::Input;
use super::super::other_file::{OtherFile, OtherName};
use super::super::other_table::{OtherTable, ReadOther};
use super::super::request::Request;
use super::super::rows::Rows;
use super::bytes::Bytes;
use super::tags::{Tag, TagPlace, Tags};
use crate::text::{LocatedFault, quoted};

const TYPE: &str = "Collection";

/// A collection, whose next frame is the number of lines that were passed.
#[derive(Clone, Debug)]
pub(crate) struct Collection {
    /// The parts of all times, in rising order of these.
    parts: Vec<Part>,
    /// The first part of each time.
    starts: Vec<usize>,
}

/// A file of a time.
#[derive(Clone, Debug)]
struct Part {
    time: f64,
    file: OtherName,
}

impl Collection {
    /// Reads the names of the files, which are relative to `folder`.
    pub(crate) fn new(input: &mut Input<'_>, folder: &Path) -> Result<Self, TableError> {
        let number = input.number;
        let mut bytes = Bytes::new(input)?;
        let mut tags = Tags::new(&mut bytes);
        let expected = "`<VTKFile type=\"Collection\">`";
        let root = tags.next()?.ok_or_else(|| tags.fault_at_end(expected))?;
        if root.name != "VTKFile" || root.value("type") != Some(TYPE) {
            return Err(root.place.expected(expected).into());
        }
        let mut parts = Vec::new();
        loop {
            let expected = "`</VTKFile>`";
            let tag = tags.next()?.ok_or_else(|| tags.fault_at_end(expected))?;
            match (&*tag.name, tag.is_end) {
                ("VTKFile", true) => break,
                ("DataSet", false) => parts.push(Part::new(&tag, folder)?),
                _ => {}
            }
        }
        if parts.is_empty() {
            let message = "expected `<DataSet …>` in this collection, found none";
            return Err(root.place.told(message.to_owned()).into());
        }
        input.number = number;
        parts.sort_by(|one, other| one.time.total_cmp(&other.time));
        let mut starts: Vec<usize> = (0..parts.len()).collect();
        starts.retain(|&start| start == 0 || parts[start].time != parts[start - 1].time);
        Ok(Self { parts, starts })
    }

    /// The number of frames.
    pub(crate) fn frames(&self) -> u64 {
        self.starts.len() as u64
    }

    /// The files of all frames.
    pub(crate) fn files(&self) -> impl Iterator<Item = PathBuf> {
        self.parts.iter().map(|part| part.file.path.clone())
    }

    /// Reads all parts of the frame of the input's number; `None` behind the last one.
    pub(crate) fn read(
        &self,
        input: &mut Input<'_>,
        (others, read_other): (&mut Vec<OtherFile>, ReadOther),
        request: &Request,
    ) -> Result<Option<Rows>, TableError> {
        let frame = input.number as usize;
        let Some(&start) = self.starts.get(frame) else {
            return Ok(None);
        };
        let end = self.starts.get(frame + 1).copied();
        let mut all: Option<Rows> = None;
        for part in &self.parts[start..end.unwrap_or(self.parts.len())] {
            let (rows, other) = part.read(request, read_other)?;
            others.push(other);
            all = Some(match all {
                None => rows,
                Some(mut all) => {
                    if all.columns != rows.columns {
                        let message =
                            "expected the same arrays in all parts of a time, found others";
                        return Err(part.file.refused(LocatedFault::of_file(message).into()));
                    }
                    all.append(rows)?;
                    all
                }
            });
        }
        input.number += 1;
        Ok(all)
    }
}

impl Part {
    fn new(tag: &Tag, folder: &Path) -> Result<Self, LocatedFault> {
        let time = tag.value("timestep").unwrap_or("0").trim().parse();
        let time = time.ok().filter(|time: &f64| time.is_finite());
        let name = tag.value("file").filter(|name| !name.is_empty());
        let name = name.ok_or_else(|| tag.place.expected("the name of a file as `file`"))?;
        let file = OtherName {
            name: name.to_owned(),
            path: folder.join(name),
        };
        Ok(Self {
            time: time.ok_or_else(|| tag.place.expected("a number as `timestep`"))?,
            file: file.at(&tag.place)?,
        })
    }

    /// Reads the points of the file.
    fn read(
        &self,
        request: &Request,
        read_other: ReadOther,
    ) -> Result<(Rows, OtherFile), TableError> {
        let table = read_other(&self.file, request).map_err(|error| self.file.refused(error))?;
        let OtherTable { mut rows, file, .. } = table;
        if !matches!(table.format, Format::VtkXml | Format::Vtk) {
            let found = table.format.name();
            let message = format!("expected a VTU or VTP file in a collection, found {found}");
            return Err(self.file.refused(LocatedFault::of_file(message).into()));
        }
        rows.remarks.file = Some(self.file.path.as_path().into());
        Ok((rows, file))
    }
}

impl OtherName {
    /// The same file, if it is there.
    fn at(self, place: &TagPlace) -> Result<Self, LocatedFault> {
        match self.path.is_file() {
            true => Ok(self),
            false => {
                let name = quoted(&self.name);
                Err(place.told(format!(
                    "expected a file of this collection, found no file {name}"
                )))
            }
        }
    }

    /// Says that something is wrong with this file.
    fn refused(&self, error: TableError) -> TableError {
        TableError::InOther(self.clone(), Box::new(error))
    }
}
