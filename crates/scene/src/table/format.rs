//! The formats of tables, which contents tell, or the endings of names.

use std::path::Path;

use super::compression::COMPRESSED_ENDINGS;
use super::fields::{self, Division};
use super::foreign::{self, Foreign};
use super::form::{self, LineKind};
use super::input::without_return;
use super::number::parse;
use super::{dcd, gsd, lammps_data, mol2, npy, npz, poscar, pqr, sdf, vtk, vtk_xml, xtc};

/// The format of a table.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Format {
    Csv,
    /// Trajectories of CHARMM and NAMD.
    Dcd,
    /// Rows of text whose separators the first line tells.
    Text,
    Gro,
    Gsd,
    Lammps,
    /// What LAMMPS begins with, not what it writes on its way.
    LammpsData,
    MmCif,
    Mol2,
    Npy,
    Npz,
    Pdb,
    Ply,
    Pqr,
    /// The files of several times, in VTK XML.
    Pvd,
    /// Molecules of one file, one of them or several.
    Sdf,
    /// Structures and trajectories of VASP.
    Vasp,
    Vtk,
    VtkXml,
    /// Trajectories of GROMACS.
    Xtc,
    Xyz,
}

/// The endings of names by which formats are told.
pub(crate) const ENDINGS: [(&str, Format); 37] = [
    ("csv", Format::Csv),
    ("tsv", Format::Csv),
    ("txt", Format::Text),
    ("dat", Format::Text),
    ("npy", Format::Npy),
    ("npz", Format::Npz),
    ("ply", Format::Ply),
    ("xyz", Format::Xyz),
    ("extxyz", Format::Xyz),
    ("dump", Format::Lammps),
    ("lammpstrj", Format::Lammps),
    ("gro", Format::Gro),
    ("gsd", Format::Gsd),
    ("pdb", Format::Pdb),
    ("ent", Format::Pdb),
    ("pdbqt", Format::Pdb),
    ("pqr", Format::Pqr),
    ("cif", Format::MmCif),
    ("mmcif", Format::MmCif),
    ("pdbx", Format::MmCif),
    ("mol2", Format::Mol2),
    ("sdf", Format::Sdf),
    ("sd", Format::Sdf),
    ("mol", Format::Sdf),
    ("mdl", Format::Sdf),
    ("data", Format::LammpsData),
    ("lmp", Format::LammpsData),
    ("vtk", Format::Vtk),
    ("poscar", Format::Vasp),
    ("contcar", Format::Vasp),
    ("xdatcar", Format::Vasp),
    ("vasp", Format::Vasp),
    ("vtu", Format::VtkXml),
    ("vtp", Format::VtkXml),
    ("pvd", Format::Pvd),
    ("xtc", Format::Xtc),
    ("dcd", Format::Dcd),
];

impl Format {
    /// The format of the table at `path` that begins so.
    ///
    /// # Errors
    /// Returns what the file is instead; `None` where nothing tells it.
    pub(crate) fn of(path: &Path, head: &[u8]) -> Result<Self, Option<&'static Foreign>> {
        if let Some(format) = by_magic(head) {
            return Ok(format);
        }
        if let Some(foreign) = foreign::by_contents(head) {
            return Err(Some(foreign));
        }
        let ending = ending(path);
        let known = ENDINGS.iter().find(|known| known.0 == ending);
        let by_name = known.map(|known| match known.1 {
            // Clouds of points call tables without a count so.
            Format::Xyz if begins_with_numbers(head) => Format::Text,
            // What has charges and radii is called so, too.
            Format::Pdb if pqr::is_like(head) => Format::Pqr,
            format => format,
        });
        // What others call a dump, or data, may be a table of any kind.
        let by_name = by_name.filter(|format| match format {
            Self::Lammps => head.is_empty(),
            Self::LammpsData => head.is_empty() || !is_like_a_table(head),
            Self::Sdf => by_contents(head) != Some(Self::Xyz),
            _ => true,
        });
        if let Some(format) = by_name {
            return Ok(format);
        }
        let by_contents = by_contents(head);
        // Any file has lines that could be those of a table, but not every one is one.
        match (foreign::by_ending(&ending), by_contents) {
            (Some(foreign), None) => Err(Some(foreign)),
            (Some(foreign), Some(Self::Text))
                if path.extension().is_none() || !is_like_a_table(head) =>
            {
                Err(Some(foreign))
            }
            (_, found) => found.ok_or(None),
        }
    }

    /// Says whether a file that begins so, with a title or with the marks of a format, is surely no text of another kind:
    /// titles may be anything.
    pub(crate) fn is_certain(path: &Path, head: &[u8]) -> bool {
        let is_titled = |format: Self| matches!(format, Self::Gro | Self::Vasp);
        by_magic(head).is_some()
            || Self::by_ending(path).is_some_and(is_titled)
            || by_contents(head).is_some_and(is_titled)
    }

    /// The format that the ending of a name tells.
    pub(crate) fn by_ending(path: &Path) -> Option<Self> {
        let ending = ending(path);
        let mut known = ENDINGS.iter();
        known.find(|known| known.0 == ending).map(|known| known.1)
    }

    /// Says whether tables of this format have right-handed axes, as those of other programs do. The numbers of plain
    /// tables are the scene's own, whose axes are left-handed.
    pub(crate) fn is_right_handed(self) -> bool {
        match self {
            Self::Csv | Self::Text | Self::Npy | Self::Npz => false,
            Self::Dcd
            | Self::Gro
            | Self::Gsd
            | Self::Lammps
            | Self::LammpsData
            | Self::MmCif
            | Self::Mol2
            | Self::Pdb
            | Self::Ply
            | Self::Pqr
            | Self::Pvd
            | Self::Sdf
            | Self::Vasp
            | Self::Vtk
            | Self::VtkXml
            | Self::Xtc
            | Self::Xyz => true,
        }
    }

    /// Says whether a table of this format may tell a cell.
    pub(crate) fn may_have_cell(self) -> bool {
        match self {
            Self::Csv
            | Self::Text
            | Self::Mol2
            | Self::Npy
            | Self::Npz
            | Self::Ply
            | Self::Pvd
            | Self::Sdf
            | Self::Vtk
            | Self::VtkXml => false,
            Self::Dcd
            | Self::Gro
            | Self::Gsd
            | Self::Lammps
            | Self::LammpsData
            | Self::MmCif
            | Self::Pdb
            | Self::Pqr
            | Self::Vasp
            | Self::Xtc
            | Self::Xyz => true,
        }
    }

    /// Says whether files of this format may be compressed as a whole: of others the bytes are not read in their order.
    pub(crate) fn may_be_compressed(self) -> bool {
        !matches!(self, Self::Npz | Self::Gsd | Self::Xtc | Self::Dcd)
    }

    /// The certain kind of a file, by its first bytes or the ending of its name: a table, or a file of another kind.
    pub(crate) fn evident(path: &Path, head: &[u8]) -> Option<Result<Self, &'static Foreign>> {
        let ending = ending(path);
        let known = ENDINGS.iter().find(|known| known.0 == ending);
        let is_sure = |format: &Self| *format != Self::Text || is_like_a_table(head);
        let by_contents = || by_contents(head).filter(is_sure);
        let foreign = || foreign::by_contents(head);
        let format = by_magic(head)
            .or(known.map(|known| known.1).filter(|_| foreign().is_none()))
            .or_else(by_contents);
        let foreign = || foreign().or_else(|| foreign::by_ending(&ending));
        format.map(Ok).or_else(|| foreign().map(Err))
    }

    /// The name of the format.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Csv => "CSV",
            Self::Dcd => "DCD",
            Self::Text => "text",
            Self::Gro => "GRO",
            Self::Gsd => "GSD",
            Self::Lammps => "a dump of LAMMPS",
            Self::LammpsData => "a data file of LAMMPS",
            Self::MmCif => "mmCIF",
            Self::Mol2 => "MOL2",
            Self::Npy => "NPY",
            Self::Npz => "NPZ",
            Self::Pdb => "PDB",
            Self::Ply => "PLY",
            Self::Pqr => "PQR",
            Self::Pvd => "PVD",
            Self::Sdf => "SDF",
            Self::Vasp => "a structure of VASP",
            Self::Vtk => "legacy VTK",
            Self::VtkXml => "VTK XML",
            Self::Xtc => "XTC",
            Self::Xyz => "XYZ",
        }
    }
}

/// The format of a file that begins with the marks of one.
fn by_magic(head: &[u8]) -> Option<Format> {
    let magic = |magic: &[u8]| head.starts_with(magic);
    if magic(npy::MAGIC) {
        return Some(Format::Npy);
    }
    if magic(npz::MAGIC) && !foreign::is_sheet(head) {
        return Some(Format::Npz);
    }
    if magic(b"ply\n") || magic(b"ply\r\n") {
        return Some(Format::Ply);
    }
    if magic(vtk::MAGIC) {
        return Some(Format::Vtk);
    }
    if gsd::is_like(head) {
        return Some(Format::Gsd);
    }
    if xtc::is_like(head) {
        return Some(Format::Xtc);
    }
    if dcd::is_like(head) {
        return Some(Format::Dcd);
    }
    if vtk_xml::is_like(head) {
        return Some(Format::VtkXml);
    }
    if vtk_xml::is_collection(head) {
        return Some(Format::Pvd);
    }
    if magic(b"ITEM:") {
        return Some(Format::Lammps);
    }
    if mol2::is_like(head) {
        return Some(Format::Mol2);
    }
    if sdf::is_like(head) {
        return Some(Format::Sdf);
    }
    lammps_data::is_like(head).then_some(Format::LammpsData)
}

/// The ending of a name, in lower case, without that of its compression; the name itself where it has none.
fn ending(path: &Path) -> String {
    let of = |path: &Path| {
        let ending = path.extension().or(path.file_name());
        let ending = ending.and_then(|ending| ending.to_str());
        ending.unwrap_or_default().to_ascii_lowercase()
    };
    match of(path) {
        ending if COMPRESSED_ENDINGS.contains(&&*ending) => {
            of(Path::new(path.file_stem().unwrap_or_default()))
        }
        ending => ending,
    }
}

/// Says whether the first line has several numbers and nothing else.
fn begins_with_numbers(head: &[u8]) -> bool {
    let line = head.split(|&byte| byte == b'\n').next().unwrap_or_default();
    is_of_numbers(line)
}

/// Says whether a text of which the name says something else is a table: it begins with numbers, or with as many names
/// as the next line has fields, most of them numbers.
fn is_like_a_table(head: &[u8]) -> bool {
    let lines = head.split(|&byte| byte == b'\n').map(without_return);
    let mut lines = lines.filter(|line| form::of_table(line) == LineKind::Row);
    let first = lines.next().unwrap_or_default();
    let counts = |line: &[u8]| {
        let fields = split(line);
        let numbers = fields.iter().filter(|field| parse(field, false).is_some());
        (numbers.count(), fields.len())
    };
    let (names, (numbers, fields)) = (counts(first).1, lines.next().map_or((0, 0), counts));
    is_of_numbers(first) || numbers >= 3 && names == fields
}

/// The fields of a line between commas, semicolons or spaces.
fn split(line: &[u8]) -> Vec<&[u8]> {
    let separator = line.iter().copied().find(|byte| b",;".contains(byte));
    let division = separator.map_or(Division::Words, Division::Between);
    fields::all(line, &division)
}

fn is_of_numbers(line: &[u8]) -> bool {
    let fields = split(without_return(line));
    fields.len() >= 3 && fields.iter().all(|field| parse(field, false).is_some())
}

/// The format of a text that begins so.
fn by_contents(head: &[u8]) -> Option<Format> {
    const RECORDS: [&[u8]; 9] = [
        b"HEADER", b"TITLE ", b"COMPND", b"REMARK", b"CRYST1", b"MODEL ", b"ATOM  ", b"HETATM",
        b"EXPDTA",
    ];
    if head.is_empty()
        || head.contains(&0)
        || str::from_utf8(&head[..head.len().min(4096)])
            .is_err_and(|error| error.error_len().is_some())
    {
        return None;
    }
    let mut lines = head.split(|&byte| byte == b'\n').map(without_return);
    let mut next = || lines.next().unwrap_or_default();
    let [first, second, third] = [next(), next(), next()];
    if RECORDS.iter().any(|record| first.starts_with(record)) {
        return Some(match pqr::is_named(head) || pqr::is_like(head) {
            true => Format::Pqr,
            false => Format::Pdb,
        });
    }
    if foreign::is_cif(head) {
        return Some(Format::MmCif);
    }
    let is_count = |line: &[u8]| {
        let line = line.trim_ascii();
        !line.is_empty() && line.iter().all(u8::is_ascii_digit)
    };
    let words = fields::all(third, &Division::Words);
    if is_count(first) && words.len() >= 4 {
        return Some(Format::Xyz);
    }
    if is_count(second) && !is_count(first) && third.len() >= 44 {
        return Some(Format::Gro);
    }
    if poscar::is_like(head) {
        return Some(Format::Vasp);
    }
    // Something of it has to be numbers.
    let is_table = [first, second, third]
        .iter()
        .any(|line| line.iter().any(u8::is_ascii_digit));
    is_table.then_some(Format::Text)
}
