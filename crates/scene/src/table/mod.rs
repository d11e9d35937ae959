//! Tables of spheres beside the scene file, in the formats of many programs.
//!
//! Files are read in blocks and never held as a whole: what stays is a sphere for each row and what
//! colors it. `source` and `input` hand out bytes and lines, decompressed and checked. `columns` finds the purpose of
//! each column, `text` and `binary` read rows, and a file for each format reads what stands before them.
//! `frames` reads the frames of a file one after another.

mod array;
mod atom_list;
mod atom_style;
mod binary;
mod bzip2;
mod categories;
mod cell;
mod cif;
mod colormap;
mod columns;
mod compression;
mod contents;
mod crystal;
mod dcd;
mod decoded;
mod delimited;
mod element;
mod elements;
mod error;
mod fields;
mod file_state;
mod foreign;
mod form;
mod format;
mod frame;
mod frames;
mod gro;
mod gsd;
mod guess;
mod gzip;
mod header;
mod input;
mod kind;
mod lammps;
mod lammps_box;
mod lammps_data;
mod memory;
mod mmcif;
mod mol2;
mod npy;
mod npz;
mod number;
mod other_file;
mod other_table;
mod packed;
mod paint;
mod pdb;
mod periodic;
mod ply;
mod poscar;
mod pqr;
mod python;
mod remarks;
mod request;
mod residue;
mod rows;
mod sdf;
mod source;
mod symmetry;
mod text;
mod time;
mod topology;
mod trajectory;
mod unread_arrays;
mod vtk;
mod vtk_xml;
mod xtc;
mod xyz;
mod xz;
mod zstandard;

pub(crate) use categories::Categories;
pub(crate) use cell::Cell;
pub(crate) use colormap::{Colormap, index as color_index};
pub(crate) use columns::{MOST_FILTERS, Test, unit};
pub(crate) use columns::{has_axis, tells_radius};
pub use compression::COMPRESSED_ENDINGS;
pub(crate) use compression::is_compressed;
pub(crate) use contents::Contents;
pub(crate) use element::{Radii, colors as element_colors, of_plain_symbol};
pub(crate) use elements::color_names;
pub(crate) use error::TableError;
pub(crate) use file_state::FileState;
pub(crate) use format::{ENDINGS, Format};
pub(crate) use frames::{FramePlace, Frames};
pub use memory::{TableBytes, Tables};
pub(crate) use other_file::OtherName;
pub(crate) use paint::Paint;
pub(crate) use remarks::Remarks;
pub(crate) use request::{
    Coloring, ColumnRef, Columns, Filter, Missing, Periodic, RadiusLaw, Request, Value, ValueRange,
};
pub(crate) use rows::Rows;
pub(crate) use source::Source;
pub(crate) use time::parse as time;
pub use time::written_time;

#[cfg(test)]
mod tests;
