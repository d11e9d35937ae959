//! The rows of a picture file, one after the other.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use exr::block::UncompressedBlock;
use exr::block::chunk::Chunk;
use exr::block::reader::{AllChunksReader, ChunksReader};
use exr::meta::header::Header;
use png::{Decoder, Info, Limits, Reader};

use crate::base::failure::lower;
use crate::commands::args::Size;
use crate::sequence::pattern::Format;

/// A file that is being read.
pub(super) struct Source {
    kind: Kind,
    rows: Rows,
}

/// What the samples of a file are.
#[derive(Clone)]
pub(super) enum Kind {
    Png(Box<Info<'static>>),
    Exr(Box<Header>),
}

enum Rows {
    Png(Box<Reader<BufReader<File>>>),
    Exr {
        chunks: Box<AllChunksReader<BufReader<File>>>,
        /// Samples of rows, and how many bytes of them were handed out.
        block: Vec<u8>,
        used: usize,
    },
}

impl Kind {
    /// Bytes of a sample: of a whole pixel in a PNG, and channel by channel in an EXR, whose rows
    /// hold one after the other.
    pub(super) fn samples(&self) -> Vec<usize> {
        match self {
            Self::Png(info) => vec![info.bytes_per_pixel()],
            Self::Exr(header) => {
                let channels = header.channels.list.iter();
                channels
                    .map(|channel| channel.sample_type.bytes_per_sample())
                    .collect()
            }
        }
    }
}

/// The size of a whole picture.
pub(super) fn size(path: &Path) -> Result<Size, String> {
    let source = Source::open(path)?;
    let side = |side: usize| u32::try_from(side).map_err(|error| error.to_string());
    Ok(match source.kind {
        Kind::Png(info) => Size {
            width: info.width,
            height: info.height,
        },
        Kind::Exr(header) => Size {
            width: side(header.layer_size.width())?,
            height: side(header.layer_size.height())?,
        },
    })
}

impl Source {
    /// Begins to read the file at `path`.
    pub(super) fn open(path: &Path) -> Result<Self, String> {
        let name = path.file_name().and_then(|name| name.to_str());
        let file = File::open(path).map_err(|error| lower(&error.to_string()))?;
        let file = BufReader::new(file);
        match name.and_then(Format::of) {
            Some(Format::Png) => Self::png(file).map_err(|error| lower(&error.to_string())),
            Some(Format::Exr) => Self::exr(file).map_err(|error| lower(&error.to_string())),
            Some(Format::Apng) | None => {
                Err("expected a file name that ends in .png or .exr".to_owned())
            }
        }
    }

    fn png(file: BufReader<File>) -> Result<Self, png::DecodingError> {
        let limits = Limits { bytes: usize::MAX };
        let reader = Decoder::new_with_limits(file, limits).read_info()?;
        Ok(Self {
            kind: Kind::Png(Box::new(reader.info().clone())),
            rows: Rows::Png(Box::new(reader)),
        })
    }

    fn exr(file: BufReader<File>) -> Result<Self, exr::error::Error> {
        let reader = exr::block::read(file, false)?;
        let chunks = reader.all_chunks(false)?;
        Ok(Self {
            kind: Kind::Exr(Box::new(chunks.meta_data().headers[0].clone())),
            rows: Rows::Exr {
                chunks: Box::new(chunks),
                block: Vec::new(),
                used: 0,
            },
        })
    }

    pub(super) fn kind(&self) -> &Kind {
        &self.kind
    }

    /// The samples of the next row.
    pub(super) fn next_row(&mut self) -> Result<&[u8], String> {
        const EARLY: &str = "it ends early";
        match (&mut self.rows, &self.kind) {
            (
                Rows::Exr {
                    chunks,
                    block,
                    used,
                },
                Kind::Exr(header),
            ) => {
                if *used == block.len() {
                    let chunk = chunks.next().ok_or(EARLY)?;
                    let chunk: Chunk = chunk.map_err(|error| error.to_string())?;
                    let meta = chunks.meta_data();
                    let decoded = UncompressedBlock::decompress_chunk(chunk, meta, false);
                    *block = decoded.map_err(|error| error.to_string())?.data;
                    *used = 0;
                }
                let length = header.layer_size.width() * header.channels.bytes_per_pixel;
                let row = block.get(*used..*used + length).ok_or(EARLY)?;
                *used += length;
                Ok(row)
            }
            (Rows::Png(reader), _) => {
                let row = reader.next_row().map_err(|error| error.to_string())?;
                Ok(row.ok_or(EARLY)?.data())
            }
            (Rows::Exr { .. }, Kind::Png(_)) => Err(EARLY.to_owned()),
        }
    }
}
