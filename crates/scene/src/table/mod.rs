//! Tables of spheres beside the scene file: CSV, NPY, PLY, XYZ.
//!
//! Files are read in blocks and never held as a whole: what stays is a sphere for each row and what
//! colors it. `columns` finds the purpose of each column, `text` and `binary` read rows, and a file
//! for each format reads what stands before them.

mod binary;
mod colormap;
mod columns;
mod csv;
mod element;
mod error;
mod format;
mod lines;
mod npy;
mod paint;
mod ply;
mod python;
mod request;
mod rows;
mod source;
mod text;
mod xyz;

pub(crate) use colormap::{Colormap, index as color_index};
pub(crate) use element::{Radii, colors as element_colors};
pub(crate) use error::TableError;
pub(crate) use format::{ENDINGS, read};
pub(crate) use paint::Paint;
pub(crate) use request::{Coloring, Request};
pub(crate) use rows::Rows;

#[cfg(test)]
mod tests;
