//! A table that is open, whose frames are read one after another.

mod facts;
mod places;

use std::fmt;
use std::path::{Path, PathBuf};

pub(crate) use self::places::FramePlace;
use super::compression::Compression;
use super::error::TableError;
use super::file_state::FileState;
use super::format::Format;
use super::header::Header;
use super::input::Input;
use super::other_file::{OtherFile, OtherName};
use super::other_table::{OtherTable, ReadOther};
use super::request::Request;
use super::rows::Rows;
use super::source::Source;
use super::trajectory::{Trajectory, TrajectoryKind};
use super::vtk_xml::Collection;
use super::{
    delimited, gro, gsd, lammps, lammps_data, mmcif, mol2, npy, npz, pdb, ply, poscar, pqr, sdf,
    vtk, vtk_xml, xyz,
};
use crate::text::LocatedFault;

/// The frames of a table, one after another.
pub(crate) struct Frames<'watch> {
    path: PathBuf,
    format: Format,
    input: Input<'watch>,
    /// The header of the frame before the next one.
    previous: Option<Header>,
    /// The next frame's header, where it was read already.
    next: Option<Header>,
    /// True behind the frame of a format that has one.
    is_at_end: bool,
    /// The array of an NPY file.
    array: Option<npy::Array>,
    /// The index of a GSD file, whose next frame is the number of lines that were passed.
    gsd: Option<gsd::File>,
    /// What was read of a trajectory besides its next frame.
    trajectory: Option<Trajectory>,
    /// The files of a collection.
    collection: Option<Collection>,
    /// The files that were read besides this one.
    others: Vec<OtherFile>,
}

impl fmt::Debug for Frames<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = formatter.debug_struct("Frames");
        shown
            .field("path", &self.path)
            .field("place", &self.place());
        shown.finish_non_exhaustive()
    }
}

impl<'watch> Frames<'watch> {
    /// Opens the table at `path`. `watch` is called with the bytes that were read and those that there are.
    pub(crate) fn open(
        path: &Path,
        watch: &'watch (dyn Fn(u64, u64) + Sync),
    ) -> Result<Self, TableError> {
        Self::new(Source::open(path, watch)?, 0)
    }

    /// The table in `source`, which begins behind so many lines, if it is one of plain text.
    pub(crate) fn new(source: Source<'watch>, lines: u64) -> Result<Self, TableError> {
        let path = &source.path().to_owned();
        let mut input = Input::new(source)?;
        let skipped = match lines {
            0 => 0,
            lines => input.skip_lines(lines)?,
        };
        if skipped < lines {
            let expected = format!("a table behind {lines} lines (`skip_lines: {lines}`)");
            return Err(LocatedFault::at_end(skipped + 1, &expected).into());
        }
        if let Some(outer) = input.source().compression
            && let Some(inner) = Compression::of_bytes(input.head())
        {
            let message = format!(
                "expected a table in this {outer} file, found a {inner} file within it: decompress it once"
            );
            return Err(LocatedFault::of_file(message).into());
        }
        let format = Format::of(path, input.head()).map_err(TableError::UnknownFormat)?;
        if let (false, Some(outer)) = (format.may_be_compressed(), input.source().compression) {
            let name = format.name();
            let message = format!(
                "expected an uncompressed {name} file, found one in a {outer} file: decompress it once"
            );
            return Err(LocatedFault::of_file(message).into());
        }
        if lines > 0 && !matches!(format, Format::Csv | Format::Text) {
            let name = format.name();
            let message = format!("expected a table of plain text for `skip_lines`, found {name}");
            return Err(LocatedFault::of_file(message).into());
        }
        if format == Format::Pqr && Format::by_ending(path) == Some(Format::Pdb) {
            let guess = "its columns are those of a PQR file, not of a PDB file: it is read as PQR";
            input.leave_out(LocatedFault::of_file(guess));
        }
        Ok(Self {
            path: path.to_owned(),
            format,
            input,
            previous: None,
            next: None,
            is_at_end: false,
            array: None,
            gsd: None,
            trajectory: match format {
                Format::Xtc => Some(Trajectory::new(TrajectoryKind::Xtc)),
                Format::Dcd => Some(Trajectory::new(TrajectoryKind::Dcd(None))),
                _ => None,
            },
            collection: None,
            others: Vec::new(),
        })
    }

    /// Takes the atoms of a trajectory from another table.
    pub(crate) fn set_topology(&mut self, topology: OtherName) -> Result<(), TableError> {
        match &mut self.trajectory {
            Some(trajectory) => {
                trajectory.set_topology(topology);
                Ok(())
            }
            None => Err(TableError::NoTrajectory(self.format.name())),
        }
    }

    /// True where the format may have more frames than one.
    pub(crate) fn may_be_several(&self) -> bool {
        matches!(
            self.format,
            Format::Xyz
                | Format::Lammps
                | Format::Gro
                | Format::Gsd
                | Format::Pdb
                | Format::Pqr
                | Format::MmCif
                | Format::Mol2
                | Format::Npy
                | Format::Sdf
                | Format::Vasp
                | Format::Pvd
        ) || self.trajectory.is_some()
    }

    /// Reads the next frame; `None` behind the last one.
    pub(crate) fn read(&mut self, request: &Request) -> Result<Option<Rows>, TableError> {
        let input = &mut self.input;
        if self.is_at_end {
            return Ok(None);
        }
        if let Some(field) = request
            .periodic
            .field()
            .filter(|_| !self.format.may_have_cell())
        {
            return Err(TableError::NoCell(field));
        }
        if let Some(trajectory) = &mut self.trajectory {
            let rows = trajectory.read(input, (&mut self.others, read_other), request)?;
            return match rows {
                Some(rows) => self.finished(rows, request).map(Some),
                None => Ok(None),
            };
        }
        let rows = match self.format {
            Format::Npy => {
                let array = match &self.array {
                    Some(array) => array,
                    None => self.array.insert(npy::Array::new(input)?),
                };
                let rows = npy::read(input, array, request)?;
                if array.tables == 1 {
                    self.is_at_end = true;
                    array.check_end(input)?;
                }
                return Ok(rows);
            }
            Format::Gsd => {
                let file = Self::gsd(&mut self.gsd, input)?;
                match gsd::read(input, file, request)? {
                    Some(rows) => Ok(rows),
                    None => return Ok(None),
                }
            }
            Format::Pvd => {
                self.open_collection()?;
                let (input, others) =
                    (&mut self.input, (&mut self.others, read_other as ReadOther));
                let rows = match &self.collection {
                    Some(collection) => collection.read(input, others, request)?,
                    None => None,
                };
                match rows {
                    Some(rows) => Ok(rows),
                    None => return Ok(None),
                }
            }
            Format::Npz => npz::read(&self.path, request),
            Format::Ply => ply::read(input, request),
            Format::Vtk => vtk::read(input, request),
            Format::VtkXml => vtk_xml::read(input, request),
            _ => {
                let Some(header) = self.header()? else {
                    return Ok(None);
                };
                let rows = header.read(&mut self.input, request);
                self.previous = Some(header);
                rows
            }
        };
        self.is_at_end = !self.may_be_several();
        self.finished(rows?, request).map(Some)
    }

    /// The rows of a frame with what the format says of all, and with the cells that are asked for.
    fn finished(&self, mut rows: Rows, request: &Request) -> Result<Rows, TableError> {
        rows.is_right_handed = self.format.is_right_handed();
        rows.kept.get_or_insert(rows.spheres.len() as u64);
        request.periodic.apply(&mut rows)?;
        Ok(rows)
    }

    /// The files that a collection lists, once something of it was read.
    pub(crate) fn listed_files(&self) -> impl Iterator<Item = PathBuf> {
        self.collection.iter().flat_map(Collection::files)
    }

    /// Takes the files that were read besides this one.
    pub(crate) fn take_others(&mut self) -> Vec<OtherFile> {
        std::mem::take(&mut self.others)
    }

    /// Takes possible faults in the file and what is left out of it, as far as it was read.
    pub(crate) fn take_doubts(&mut self) -> Vec<LocatedFault> {
        self.input.take_doubts()
    }

    /// Doubts the last of several frames where nothing ends its last line, as it does those of the others.
    pub(crate) fn doubt_open_end(&mut self) {
        let input = &mut self.input;
        if input.is_open_at_end()
            && matches!(
                self.format,
                Format::Xyz | Format::Lammps | Format::Gro | Format::Mol2 | Format::Vasp
            )
        {
            let doubt = "the file ends within this line: its last number may have been cut off";
            input.doubt_line(doubt);
        }
    }

    /// The state of the file when it was opened.
    pub(crate) fn state(&self) -> FileState {
        self.input.source().state
    }

    /// Reads what is left of a compressed file for its checksums, and refuses a file that changed meanwhile.
    pub(crate) fn finish(&mut self) -> Result<(), TableError> {
        self.input.finish()?;
        self.check_unchanged()
    }

    /// Refuses a file that is not the one any more that was opened.
    pub(crate) fn check_unchanged(&self) -> Result<(), TableError> {
        match self.input.source().is_unchanged() {
            Ok(true) => Ok(()),
            Ok(false) | Err(_) => Err(TableError::Changed),
        }
    }

    /// The bytes of all blocks that were handed out.
    #[cfg(test)]
    pub(crate) fn handed_out(&self) -> u64 {
        self.input.handed_out()
    }

    /// Refuses more frames than a compressed file may hold.
    pub(crate) fn check_count(&self, count: usize) -> Result<(), TableError> {
        Ok(self.input.check_count(count as u64, "frames")?)
    }

    /// Reads the list of a collection's files once.
    fn open_collection(&mut self) -> Result<(), TableError> {
        if self.format == Format::Pvd && self.collection.is_none() {
            let folder = self.path.parent().unwrap_or(Path::new(""));
            self.collection = Some(Collection::new(&mut self.input, folder)?);
        }
        Ok(())
    }

    /// The index of a GSD file, which is read once.
    fn gsd<'a>(
        index: &'a mut Option<gsd::File>,
        input: &mut Input<'_>,
    ) -> Result<&'a gsd::File, TableError> {
        Ok(match index {
            Some(file) => file,
            None => index.insert(gsd::File::new(input)?),
        })
    }

    /// The next frame's header.
    fn header(&mut self) -> Result<Option<Header>, TableError> {
        if let Some(header) = self.next.take() {
            return Ok(Some(header));
        }
        let input = &mut self.input;
        match self.format {
            Format::Csv => delimited::header(input, true).map(Some),
            Format::Text => delimited::header(input, false).map(Some),
            Format::Xyz => xyz::header(input, self.previous.as_ref()),
            Format::Lammps => lammps::header(input),
            Format::LammpsData => lammps_data::header(input).map(Some),
            Format::Mol2 => mol2::header(input),
            Format::Sdf => sdf::header(input),
            Format::Gro => gro::header(input),
            Format::Pdb => pdb::header(input, self.previous.as_ref()),
            Format::Pqr => pqr::header(input),
            Format::MmCif => mmcif::header(input, self.previous.as_ref()),
            Format::Vasp => poscar::header(input, self.previous.as_ref()),
            Format::Npy
            | Format::Npz
            | Format::Ply
            | Format::Vtk
            | Format::VtkXml
            | Format::Pvd
            | Format::Xtc
            | Format::Dcd
            | Format::Gsd => Ok(None),
        }
    }
}

/// Reads the first frame of another table, which must not be a list of others: it could list itself.
fn read_other(named: &OtherName, request: &Request) -> Result<OtherTable, TableError> {
    let mut frames = Frames::open(&named.path, &|_, _| {})?;
    let format = frames.format;
    if format == Format::Pvd {
        let message = "expected a table in a single file, found PVD, which lists files";
        return Err(LocatedFault::of_file(message).into());
    }
    let rows = frames.read(request)?;
    let rows = rows.ok_or_else(|| LocatedFault::of_file("expected a frame, found none"))?;
    frames.finish()?;
    Ok(OtherTable {
        rows,
        format,
        angstrom: frames.angstrom(),
        file: OtherFile {
            path: named.path.clone(),
            state: frames.state(),
            doubts: frames.take_doubts(),
        },
    })
}
