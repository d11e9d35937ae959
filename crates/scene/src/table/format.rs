//! The formats of tables, which contents tell, or the endings of names.

use std::path::Path;

use super::compression::Compression;
use super::fields::{self, Division};
use super::input::without_return;
use super::number::parse;
use super::{npy, npz, pqr, vtk};

/// The format of a table.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Format {
    Csv,
    /// Rows of text whose separators the first line tells.
    Text,
    Gro,
    Lammps,
    MmCif,
    Npy,
    Npz,
    Pdb,
    Ply,
    Pqr,
    Vtk,
    Xyz,
}

/// The endings of names by which formats are told.
pub(crate) const ENDINGS: [(&str, Format); 19] = [
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
    ("pdb", Format::Pdb),
    ("ent", Format::Pdb),
    ("pdbqt", Format::Pdb),
    ("pqr", Format::Pqr),
    ("cif", Format::MmCif),
    ("mmcif", Format::MmCif),
    ("vtk", Format::Vtk),
];

/// Formats that are not read, and what to do instead.
const REMEDIES: [(&[&str], &str); 6] = [
    (
        &["xtc", "trr", "dcd", "nc", "ncdf", "tng", "h5md", "traj"],
        "save the trajectory as extended XYZ, PDB or a LAMMPS dump, with MDAnalysis, MDTraj or ASE",
    ),
    (
        &["vtu", "vtp", "vti", "vts", "pvd", "pvtu", "pvtp", "vtm"],
        "save the data as CSV or as legacy VTK, in ParaView by File > Save Data",
    ),
    (
        &[
            "h5", "hdf5", "hdf", "parquet", "feather", "pkl", "mat", "fits",
        ],
        "save the columns as NPY, NPZ or CSV",
    ),
    (&["xlsx", "xls", "ods"], "save the sheet as CSV"),
    (
        &["las", "laz", "pcd", "e57", "obj", "stl", "gltf", "glb"],
        "save the points as PLY or CSV",
    ),
    (
        &[
            "mol2", "sdf", "mol", "cml", "psf", "prmtop", "top", "tpr", "data", "lmp",
        ],
        "save the atoms as XYZ or PDB, with Open Babel, ASE or MDAnalysis",
    ),
];

impl Format {
    /// The format of the table at `path` that begins so; `None` where nothing tells it.
    pub(crate) fn of(path: &Path, head: &[u8]) -> Option<Self> {
        let magic = |magic: &[u8]| head.starts_with(magic);
        if magic(npy::MAGIC) {
            return Some(Self::Npy);
        }
        if magic(npz::MAGIC) {
            return Some(Self::Npz);
        }
        if magic(b"ply\n") || magic(b"ply\r\n") {
            return Some(Self::Ply);
        }
        if magic(vtk::MAGIC) {
            return Some(Self::Vtk);
        }
        if magic(b"ITEM:") {
            return Some(Self::Lammps);
        }
        let ending = ending(path);
        let known = ENDINGS.iter().find(|known| known.0 == ending);
        let by_name = known.map(|known| match known.1 {
            // Clouds of points call tables without a count so.
            Format::Xyz if begins_with_numbers(head) => Format::Text,
            format => format,
        });
        // What others call a dump may be a table of any kind.
        by_name
            .filter(|format| *format != Self::Lammps || head.is_empty())
            .or_else(|| by_contents(head))
    }

    /// Says whether tables of this format have right-handed axes, as those of other programs do. The numbers of plain
    /// tables are the scene's own, whose axes are left-handed.
    pub(crate) fn is_right_handed(self) -> bool {
        match self {
            Self::Csv | Self::Text | Self::Npy | Self::Npz => false,
            Self::Gro
            | Self::Lammps
            | Self::MmCif
            | Self::Pdb
            | Self::Ply
            | Self::Pqr
            | Self::Vtk
            | Self::Xyz => true,
        }
    }

    /// What to do with a file of this name that is no table.
    pub(crate) fn remedy(path: &Path) -> Option<&'static str> {
        let ending = ending(path);
        let of = REMEDIES
            .iter()
            .find(|(endings, _)| endings.contains(&&*ending));
        of.map(|(_, remedy)| *remedy)
    }
}

/// The ending of a name, in lower case, without that of its compression.
fn ending(path: &Path) -> String {
    let of = |path: &Path| {
        let ending = path.extension().and_then(|ending| ending.to_str());
        ending.unwrap_or_default().to_ascii_lowercase()
    };
    match of(path) {
        ending if Compression::ENDINGS.contains(&&*ending) => {
            of(Path::new(path.file_stem().unwrap_or_default()))
        }
        ending => ending,
    }
}

/// Says whether the first line has several numbers and nothing else.
fn begins_with_numbers(head: &[u8]) -> bool {
    let line = head.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let fields = fields::all(without_return(line), &Division::Words);
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
        return Some(match pqr::is_named(head) {
            true => Format::Pqr,
            false => Format::Pdb,
        });
    }
    if first.starts_with(b"data_") {
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
    // Something of it has to be numbers.
    let is_table = [first, second, third]
        .iter()
        .any(|line| line.iter().any(u8::is_ascii_digit));
    is_table.then_some(Format::Text)
}
