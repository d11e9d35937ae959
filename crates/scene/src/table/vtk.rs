//! Legacy VTK files: the points of a dataset, and their numbers, text or big-endian.
//!
//! # Source
//! "VTK File Formats", The VTK User's Guide, Kitware.

mod dataset;
mod numbers;
mod sections;

use self::dataset::{Array, Dataset};
use self::sections::Section;
use super::array::Column;
use super::binary;
use super::error::TableError;
use super::input::Input;
use super::kind::Kind;
use super::request::Request;
use super::rows::Rows;
use crate::text::LocatedFault;

pub(crate) const MAGIC: &[u8] = b"# vtk DataFile";

/// Reads the points.
pub(crate) fn read(input: &mut Input<'_>, request: &Request) -> Result<Rows, TableError> {
    let mut data = Dataset::default();
    for _ in 0..2 {
        input.next()?;
    }
    // The line that says that numbers of points or cells follow, until some do.
    let mut announced = None;
    while let Some(line) = input.next()?.map(<[u8]>::to_vec) {
        let number = input.number;
        if !line.trim_ascii().is_empty() {
            announced = None;
        }
        match data.section(input, (number, &line))? {
            Section::Known => {}
            Section::Announcement => announced = Some((number, line)),
            // Spheres need no more than what was read.
            Section::Unknown if !data.names.is_empty() => {
                let told = "not a section of a legacy VTK file: the rest of the file is not read";
                let place = 0..line.len();
                input.leave_out(LocatedFault::in_line(number, &line, place, told.to_owned()));
                break;
            }
            Section::Unknown => {
                let expected = "a section of a legacy VTK file";
                return Err(LocatedFault::expected(number, &line, 0..line.len(), expected).into());
            }
        }
    }
    if let Some((number, line)) = announced {
        let doubt = "the file ends after a header for numbers of points or cells: the numbers may have been cut off";
        input.doubt(LocatedFault::in_line(
            number,
            &line,
            0..line.len(),
            doubt.to_owned(),
        ));
    }
    if data.names.is_empty() {
        return Err(LocatedFault::at_end(input.number + 1, "`POINTS …`").into());
    }
    let declared = |array: &Array| std::iter::repeat_n(array.declared, array.size);
    let kinds: Vec<Kind> = data.arrays.iter().flat_map(declared).collect();
    let plan = binary::plan(data.names, &kinds, request).map_err(LocatedFault::of_file)?;
    let mut uses = &plan.uses[..];
    for array in &mut data.arrays {
        let (own, others) = uses.split_at(array.size);
        if own.iter().all(|uses| uses.slots().is_empty()) {
            array.bytes = Vec::new();
        }
        uses = others;
    }
    let columns: Vec<Column<'_>> = data.arrays.iter().flat_map(Array::columns).collect();
    binary::read_columns(&columns, data.points, &plan)
}
