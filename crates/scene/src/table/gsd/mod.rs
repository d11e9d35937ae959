//! GSD, the trajectories of HOOMD-blue: the particles of each frame, in chunks of numbers.
//!
//! A frame holds what differs from the first one, which holds what differs from the defaults of the schema.
//!
//! # Source
//! "File layer" and "HOOMD schema", the documentation of the package gsd.

mod file;

use std::borrow::Cow;

use glam::{DMat3, DVec3};

use self::file::{Chunk, refused, text};
pub(crate) use self::file::{File, is_like};
use super::array::Part;
use super::atom_style::IMAGES;
use super::binary;
use super::cell::{Cell, ToldCell};
use super::columns::{MOST_COLUMNS, Plan, components};
use super::error::TableError;
use super::input::Input;
use super::kind::{Kind, Number};
use super::request::Request;
use super::rows::Rows;
use crate::text::LocatedFault;

/// The particles that any file may have, and those that it may have for each of its bytes: a header tells how many there are, and
/// positions may be left out.
const FREE_PARTICLES: u64 = 1 << 17;
const MOST_PARTICLES_FOR_A_BYTE: u64 = 4;
/// The longest name of a type, in bytes.
const LONGEST_TYPE: u64 = 1 << 12;

/// The chunks of particles that are no columns.
const NO_COLUMNS: [&str; 3] = ["N", "types", "type_shapes"];
/// The values of particles where neither their frame nor the first one has any.
const DEFAULTS: [(&str, Number, &[f64]); 11] = [
    ("position", Number::F32, &[0.0; 3]),
    ("diameter", Number::F32, &[1.0]),
    ("typeid", Number::U32, &[0.0]),
    ("mass", Number::F32, &[1.0]),
    ("charge", Number::F32, &[0.0]),
    ("body", Number::I32, &[-1.0]),
    ("moment_inertia", Number::F32, &[0.0; 3]),
    ("orientation", Number::F32, &[1.0, 0.0, 0.0, 0.0]),
    ("velocity", Number::F32, &[0.0; 3]),
    ("angmom", Number::F32, &[0.0; 4]),
    ("image", Number::I32, &[0.0; 3]),
];

/// An array with a row for each particle.
struct Array<'f> {
    names: Vec<String>,
    kind: Kind,
    source: Source<'f>,
}

/// The numbers of an array.
enum Source<'f> {
    Chunk(&'f Chunk),
    /// Every particle has these.
    Constant(Vec<u8>),
    /// The names of types, by the numbers that particles have.
    Types(Vec<Vec<u8>>, Box<Source<'f>>, Kind),
}

/// Reads the next frame, whose number the input has; `None` behind the last one.
pub(crate) fn read(
    input: &mut Input<'_>,
    file: &File,
    request: &Request,
) -> Result<Option<Rows>, TableError> {
    let frame = input.number;
    if frame >= file.frames {
        return Ok(None);
    }
    let count = particles(input, file, frame)?;
    let size = input.size().unwrap_or(0);
    let most = FREE_PARTICLES.max(size.saturating_mul(MOST_PARTICLES_FOR_A_BYTE));
    if count > most {
        return Err(refused(format!(
            "expected at most {most} particles in a file of {size} bytes, found {count}"
        )));
    }
    let arrays = arrays(input, file, frame, count)?;
    let names = arrays.iter().flat_map(|array| array.names.clone());
    let kinds = arrays
        .iter()
        .flat_map(|array| vec![array.kind; array.names.len()]);
    let kinds: Vec<Kind> = kinds.collect();
    let mut plan = binary::plan(names.collect(), &kinds, request).map_err(LocatedFault::of_file)?;
    let cell = cell(input, file, frame)?;
    if plan.images.is_some() {
        plan.images = match &cell {
            Some(Ok(cell)) => Some(cell.edges),
            Some(Err(fault)) => return Err(fault.clone().into()),
            None => return Err(TableError::NoCell("unwrap")),
        };
    }
    let mut rows = rows(input, &arrays, count, &plan)?;
    rows.cell = cell;
    input.number = frame + 1;
    Ok(Some(rows))
}

/// The number of particles of a frame.
fn particles(input: &mut Input<'_>, file: &File, frame: u64) -> Result<u64, TableError> {
    const NAME: &str = "particles/N";
    let chunk = file.chunk(frame, NAME).or_else(|| file.chunk(0, NAME));
    let Some(chunk) = chunk else {
        return Ok(0);
    };
    let bytes = chunk.take(input, (0, 1))?;
    let count = chunk.kind.decode(&bytes).filter(|count| *count >= 0.0);
    let count = count.ok_or_else(|| {
        refused("expected the number of particles in `particles/N`, found none".into())
    });
    Ok(count? as u64)
}

/// The cell of a frame, whose middle is the origin; `None` in a file without a box. In two dimensions it does not repeat
/// along z.
fn cell(input: &mut Input<'_>, file: &File, frame: u64) -> Result<Option<ToldCell>, TableError> {
    const BOX: &str = "configuration/box";
    const DIMENSIONS: &str = "configuration/dimensions";
    let mut numbers = |name: &str, count: u64| -> Result<Option<Vec<f64>>, TableError> {
        let chunk = file.chunk(frame, name).or_else(|| file.chunk(0, name));
        let Some(chunk) = chunk.filter(|chunk| chunk.rows == count && chunk.size == 1) else {
            return Ok(None);
        };
        let bytes = chunk.take(input, (0, count))?;
        let numbers = bytes.chunks((chunk.kind.size() as usize).max(1));
        Ok(numbers.map(|bytes| chunk.kind.decode(bytes)).collect())
    };
    let of_box = numbers(BOX, 6)?;
    let dimensions = numbers(DIMENSIONS, 1)?;
    let Some(&[x, y, z, xy, xz, yz]) = of_box.as_deref() else {
        return Ok(None);
    };
    let is_flat = dimensions.is_some_and(|dimensions| dimensions == [2.0]);
    // The box of a plane may have no height.
    let z = if is_flat && z == 0.0 { 1.0 } else { z };
    let edges = DMat3::from_cols(
        DVec3::new(x, 0.0, 0.0),
        DVec3::new(xy * y, y, 0.0),
        DVec3::new(xz * z, yz * z, z),
    );
    let cell = Cell::new(edges, edges * DVec3::splat(-0.5));
    let cell = cell.map(|cell| cell.periodic_along([true, true, !is_flat]));
    Ok(Some(cell.map_err(|fault| {
        LocatedFault::of_file(format!("{fault} in the chunk `{BOX}`"))
    })))
}

/// The arrays of a frame of so many particles: first the positions and the names of the types.
fn arrays<'f>(
    input: &mut Input<'_>,
    file: &'f File,
    frame: u64,
    count: u64,
) -> Result<Vec<Array<'f>>, TableError> {
    let first = particles(input, file, 0)?;
    // What the frame leaves out is that of the first, if that has as many particles.
    let chunk = |name: &str| {
        let of_first = || file.chunk(0, name).filter(|_| first == count);
        file.chunk(frame, name).or_else(of_first)
    };
    let mut arrays = Vec::new();
    let mut left = MOST_COLUMNS as u64;
    let mut add = |arrays: &mut Vec<Array<'f>>, path: &str, name: &str| -> Result<(), TableError> {
        let Some(array) = array(file, chunk(path), path, name, count)? else {
            return Ok(());
        };
        if let Some(rest) = left.checked_sub(array.names.len() as u64) {
            left = rest;
            arrays.push(array);
        }
        Ok(())
    };
    add(&mut arrays, "particles/position", "position")?;
    add(&mut arrays, "particles/typeid", "typeid")?;
    add(&mut arrays, "particles/diameter", "diameter")?;
    for path in &file.names {
        let of_particles = path.strip_prefix("particles/");
        let is_known =
            ["position", "typeid", "diameter"].contains(&of_particles.unwrap_or_default());
        match of_particles {
            Some(name) if !is_known && !NO_COLUMNS.contains(&name) => add(&mut arrays, path, name)?,
            None if path.starts_with("log/particles/") => add(&mut arrays, path, path)?,
            _ => {}
        }
    }
    let types = chunk("particles/types").or_else(|| file.chunk(0, "particles/types"));
    let names = types_of(input, types)?;
    let numbers = array(
        file,
        chunk("particles/typeid"),
        "particles/typeid",
        "typeid",
        count,
    )?;
    if let Some(numbers) = numbers {
        let width = names.iter().map(Vec::len).max().unwrap_or(0).max(1);
        let types = Array {
            names: vec!["type".to_owned()],
            kind: Kind::Text(width as u64),
            source: Source::Types(names, Box::new(numbers.source), numbers.kind),
        };
        arrays.insert(1.min(arrays.len()), types);
    }
    Ok(arrays)
}

/// The array of this chunk, or of the defaults where there is none; `None` where that is unknown.
fn array<'f>(
    file: &'f File,
    chunk: Option<&'f Chunk>,
    path: &str,
    name: &str,
    count: u64,
) -> Result<Option<Array<'f>>, TableError> {
    if let Some(chunk) = chunk {
        if chunk.rows != count {
            let rows = chunk.rows;
            return Err(refused(format!(
                "expected {count} rows in the chunk `{path}`, found {rows}"
            )));
        }
        if chunk.size > MOST_COLUMNS as u64 {
            return Ok(None);
        }
        return Ok(Some(Array {
            names: names_of(name, chunk.size),
            kind: chunk.kind,
            source: Source::Chunk(chunk),
        }));
    }
    let default = DEFAULTS.iter().find(|default| default.0 == name);
    if let Some((_, number, values)) = default {
        let bytes = |value: &f64| match number {
            Number::U32 => (*value as u32).to_le_bytes(),
            Number::I32 => (*value as i32).to_le_bytes(),
            _ => (*value as f32).to_le_bytes(),
        };
        return Ok(Some(Array {
            names: names_of(name, values.len() as u64),
            kind: Kind::little(*number),
            source: Source::Constant(values.iter().flat_map(bytes).collect()),
        }));
    }
    // Other frames have it: the columns of all frames are the same.
    let size = file.any(path).map(|chunk| chunk.size);
    Ok(size
        .filter(|size| *size <= MOST_COLUMNS as u64)
        .map(|size| Array {
            names: names_of(name, size),
            kind: Kind::little(Number::F64),
            source: Source::Constant(f64::NAN.to_le_bytes().repeat(size as usize)),
        }))
}

/// The names of a chunk's columns; image flags have the names that they have in dumps.
fn names_of(name: &str, size: u64) -> Vec<String> {
    match (name, size) {
        ("image", 3) => IMAGES.map(String::from).into(),
        _ => components(name, size),
    }
}

/// The names of the types.
fn types_of(input: &mut Input<'_>, chunk: Option<&Chunk>) -> Result<Vec<Vec<u8>>, TableError> {
    let Some(chunk) = chunk else {
        return Ok(vec![b"A".to_vec()]);
    };
    let size = chunk.size;
    if chunk.kind.size() != 1 || size > LONGEST_TYPE {
        return Err(refused(format!(
            "expected names of at most {LONGEST_TYPE} bytes in the chunk `particles/types`, found others"
        )));
    }
    let bytes = chunk.take(input, (0, chunk.rows))?;
    let names = bytes.chunks((size as usize).max(1));
    Ok(names.map(|name| text(name).into_bytes()).collect())
}

/// The rows of a frame.
fn rows(
    input: &mut Input<'_>,
    arrays: &[Array<'_>],
    count: u64,
    plan: &Plan,
) -> Result<Rows, TableError> {
    let mut rows = Rows::new(plan);
    let mut uses = &plan.uses[..];
    let mut used = Vec::new();
    for array in arrays {
        let (own, others) = uses.split_at(array.names.len());
        used.push(own.iter().any(|uses| !uses.slots().is_empty()));
        uses = others;
    }
    let size = |array: &Array<'_>| array.kind.size().saturating_mul(array.names.len() as u64);
    let stride = arrays.iter().zip(&used).filter(|(_, used)| **used);
    let stride = stride
        .map(|(array, _)| size(array))
        .fold(0, u64::saturating_add);
    let most = binary::rows_of_block(stride);
    let mut first = 0;
    while first < count {
        let range = (first, most.min(count - first));
        let mut parts = Vec::new();
        for (array, used) in arrays.iter().zip(&used) {
            parts.push(match used {
                true => array.source.part(input, array.kind, range)?,
                false => Part::unused(array.kind),
            });
        }
        let columns = arrays.iter().zip(&parts).flat_map(|(array, part)| {
            let size = array.names.len() as u64;
            (0..size).map(move |component| part.column(size, component))
        });
        let columns: Vec<_> = columns.collect();
        if first == 0 && plan.filters.is_empty() {
            rows.reserve(count)?;
        }
        binary::append_columns(&mut rows, &columns, range.1, plan)?;
        first += range.1;
    }
    Ok(rows)
}

impl Source<'_> {
    /// So many rows from one on.
    fn part(
        &self,
        input: &mut Input<'_>,
        kind: Kind,
        (first, count): (u64, u64),
    ) -> Result<Part<'_>, TableError> {
        Ok(match self {
            Self::Chunk(chunk) => Part {
                kind,
                bytes: Cow::Owned(chunk.take(input, (first, count))?),
                start: Some(chunk.start + first * chunk.stride()),
                is_constant: false,
            },
            Self::Constant(bytes) => Part {
                kind,
                bytes: Cow::Borrowed(bytes),
                start: None,
                is_constant: true,
            },
            Self::Types(names, numbers, of_numbers) => {
                let numbers = numbers.part(input, *of_numbers, (first, count))?;
                let width = kind.size() as usize;
                let mut bytes = Vec::new();
                for row in 0..count as usize {
                    let number = numbers.number(row);
                    let name = number.and_then(|number| names.get(number as usize));
                    let name = name.ok_or_else(|| {
                        let (row, most) = (first + row as u64 + 1, names.len());
                        let found = number.map_or("none".to_owned(), |number| number.to_string());
                        refused(format!(
                            "expected the number of one of {most} types, from 0, for the particle {row}, found {found}"
                        ))
                    })?;
                    bytes.extend_from_slice(name);
                    bytes.resize((row + 1) * width, 0);
                }
                Part {
                    kind,
                    bytes: Cow::Owned(bytes),
                    start: None,
                    is_constant: false,
                }
            }
        })
    }
}
