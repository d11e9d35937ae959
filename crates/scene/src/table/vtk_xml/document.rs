//! The tags of a VTK XML file: its pieces, and where the numbers of their points stand.

use super::super::error::TableError;
use super::super::kind::{Kind, Number, Order};
use super::bytes::Bytes;
use super::tags::{Tag, TagPlace, Tags};
use crate::text::LocatedFault;

/// The contents of a file, as its tags tell them.
pub(super) struct Document {
    pub(super) encoding: Encoding,
    pub(super) pieces: Vec<Piece>,
    /// The bytes to which arrays refer, where there are some.
    pub(super) appended: Option<Appended>,
    /// Parts that are not read.
    pub(super) left_out: Vec<LocatedFault>,
}

/// The way in which the arrays of a file hold bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Encoding {
    pub(super) order: Order,
    /// The type of the lengths before arrays.
    pub(super) length: Number,
    /// Arrays are blocks compressed by zlib.
    pub(super) is_compressed: bool,
}

/// A part of the points.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) points: u64,
    /// The positions, and the arrays that have a row for each point.
    pub(super) positions: Option<Array>,
    pub(super) arrays: Vec<Array>,
    pub(super) place: TagPlace,
}

/// An array of a piece.
#[derive(Clone, Debug)]
pub(super) struct Array {
    pub(super) name: String,
    /// The type of its numbers.
    pub(super) kind: Kind,
    /// The numbers of a point.
    pub(super) size: u64,
    pub(super) source: Source,
    pub(super) place: TagPlace,
}

/// The place of the numbers of an array.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Source {
    /// Text at this byte of the file.
    Text(u64),
    /// Base64 at this byte of the file.
    Base64(u64),
    /// So many bytes behind the start of those that are appended.
    Appended(u64),
}

/// Bytes behind all tags.
#[derive(Clone, Copy, Debug)]
pub(super) struct Appended {
    pub(super) start: u64,
    pub(super) is_base64: bool,
}

/// The part of a piece to which an array belongs.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Section {
    Points,
    PointData,
}

/// The most parts that are said to be left out.
const MOST_LEFT_OUT: usize = 100;

impl Document {
    /// Reads the tags of a file.
    pub(super) fn read(bytes: &mut Bytes<'_, '_>) -> Result<Self, TableError> {
        let mut tags = Tags::new(bytes);
        let expected = "`<VTKFile type=\"UnstructuredGrid\">` or `<VTKFile type=\"PolyData\">`";
        let root = tags.next()?.ok_or_else(|| tags.fault_at_end(expected))?;
        let is_known = matches!(root.value("type"), Some("UnstructuredGrid" | "PolyData"));
        if root.name != "VTKFile" || !is_known {
            return Err(root.place.expected(expected).into());
        }
        let mut document = Self {
            encoding: Encoding::of(&root)?,
            pieces: Vec::new(),
            appended: None,
            left_out: Vec::new(),
        };
        let mut section = None;
        loop {
            let expected = "`</VTKFile>`";
            let tag = tags.next()?.ok_or_else(|| tags.fault_at_end(expected))?;
            match (&*tag.name, tag.is_end) {
                ("VTKFile", true) => break,
                ("AppendedData", false) => {
                    document.appended = Some(appended(&tag, bytes)?);
                    break;
                }
                ("Piece", false) => document.pieces.push(Piece {
                    points: tag.whole("NumberOfPoints", None)?,
                    positions: None,
                    arrays: Vec::new(),
                    place: tag.place,
                }),
                ("Points", is_end) => {
                    section = (!is_end && !tag.is_empty).then_some(Section::Points);
                }
                ("PointData", is_end) => {
                    section = (!is_end && !tag.is_empty).then_some(Section::PointData);
                }
                ("DataArray" | "Array", false) => document.add_array(&tag, section)?,
                _ => {}
            }
        }
        if document.pieces.is_empty() {
            return Err(root
                .place
                .told("expected `<Piece …>`, found none".to_owned())
                .into());
        }
        Ok(document)
    }

    /// Takes in an array of points.
    fn add_array(&mut self, tag: &Tag, section: Option<Section>) -> Result<(), LocatedFault> {
        let (Some(section), Some(piece)) = (section, self.pieces.last_mut()) else {
            return Ok(());
        };
        let name = tag.value("Name").unwrap_or_default().to_owned();
        let kind = tag.value("type").unwrap_or_default();
        let Some(number) = number(kind) else {
            if tag.name == "Array" || kind == "String" {
                let told = "an array of texts: it is not read".to_owned();
                if self.left_out.len() < MOST_LEFT_OUT {
                    self.left_out.push(tag.place.told(told));
                }
                return Ok(());
            }
            let expected = "a type of numbers such as `Float32`, `Float64` or `Int64`";
            return Err(tag.place.expected(expected));
        };
        let source = match tag.value("format").unwrap_or("ascii") {
            "ascii" => Source::Text(tag.end),
            "binary" => Source::Base64(tag.end),
            "appended" => Source::Appended(tag.whole("offset", None)?),
            _ => {
                let expected = "the format `ascii`, `binary` or `appended`";
                return Err(tag.place.expected(expected));
            }
        };
        let array = Array {
            name,
            kind: Kind::Number(number, self.encoding.order),
            size: tag.whole("NumberOfComponents", Some(1))?,
            source,
            place: tag.place.clone(),
        };
        match section {
            Section::PointData => piece.arrays.push(array),
            Section::Points if array.size == 3 => piece.positions = Some(array),
            Section::Points => return Err(tag.place.expected("points of 3 components")),
        }
        Ok(())
    }
}

impl Encoding {
    fn of(root: &Tag) -> Result<Self, LocatedFault> {
        let order = match root.value("byte_order") {
            None | Some("LittleEndian") => Order::Little,
            Some("BigEndian") => Order::Big,
            Some(_) => {
                let expected = "the byte order `LittleEndian` or `BigEndian`";
                return Err(root.place.expected(expected));
            }
        };
        let length = match root.value("header_type") {
            None | Some("UInt32") => Number::U32,
            Some("UInt64") => Number::U64,
            Some(_) => return Err(root.place.expected("the header type `UInt32` or `UInt64`")),
        };
        let is_compressed = match root.value("compressor") {
            None | Some("") => false,
            Some("vtkZLibDataCompressor") => true,
            Some(_) => {
                let expected = "no compressor, or `vtkZLibDataCompressor` (in ParaView, choose ZLib as Compressor Type \
                     in File > Save Data)";
                return Err(root.place.expected(expected));
            }
        };
        Ok(Self {
            order,
            length,
            is_compressed,
        })
    }
}

/// The bytes behind the mark `_` that follows this tag.
fn appended(tag: &Tag, bytes: &mut Bytes<'_, '_>) -> Result<Appended, TableError> {
    let is_base64 = match tag.value("encoding") {
        Some("base64") => true,
        Some("raw") => false,
        _ => {
            let expected = "the encoding `raw` or `base64`";
            return Err(tag.place.expected(expected).into());
        }
    };
    loop {
        match bytes.ahead()?.first() {
            Some(b'_') => {
                let start = bytes.position() + 1;
                return Ok(Appended { start, is_base64 });
            }
            Some(byte) if byte.is_ascii_whitespace() => bytes.pass(1),
            _ => {
                return Err(tag
                    .place
                    .told("expected `_` behind this tag, found none".to_owned())
                    .into());
            }
        }
    }
}

/// The type of this name.
fn number(name: &str) -> Option<Number> {
    Some(match name {
        "Int8" => Number::I8,
        "UInt8" => Number::U8,
        "Int16" => Number::I16,
        "UInt16" => Number::U16,
        "Int32" => Number::I32,
        "UInt32" => Number::U32,
        "Int64" => Number::I64,
        "UInt64" => Number::U64,
        "Float32" => Number::F32,
        "Float64" => Number::F64,
        _ => return None,
    })
}
