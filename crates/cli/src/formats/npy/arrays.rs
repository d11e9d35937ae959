//! The arrays of a picture: its light, and additional arrays.

use std::ops::Range;

use marbles_core::{Geometry, Image};

use super::array::{Array, Number};
use crate::base::region::Region;
use crate::formats::center_channels::{CenterChannels, Source};
use crate::formats::encoding::NpyOptions;
use crate::formats::form::Form;

/// The suffix of the name of a file of errors.
pub(super) const ERROR: &str = "_error";

/// The suffix of the file of center values, except for the indices of spheres, which have a file of their own.
pub(super) const CHANNELS: &str = "_channels";
pub(super) const ID: &str = "_id";
pub(super) const COVERAGE_ID: &str = "_coverage_id";

/// The name of the light in an archive.
pub(super) const LIGHT: &str = "light";

/// The arrays of a picture, the light first.
#[derive(Clone, Debug)]
pub(crate) struct Arrays {
    pub(super) region: Region,
    pub(super) all: Vec<Part>,
}

/// An array, and what its numbers are.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// The suffix of the name of its file, or its name in an archive.
    pub(super) name: String,
    pub(super) array: Array,
    contents: Contents,
}

/// The numbers of an array.
#[derive(Clone, Debug)]
enum Contents {
    Light,
    Error,
    /// Numbers for each pixel, of these sources.
    Centers(Vec<Source>),
    /// Indices of spheres.
    Indices(Source),
}

impl Arrays {
    /// The arrays of a picture of this form: red, green and blue, alpha if the picture has it, and on request the
    /// errors and the center values. Gray pictures have three colors as well, so that the shape does not depend on the
    /// scene. Each becomes a file; all center values but indices are in one of them.
    pub(super) fn for_files(form: &Form, options: NpyOptions) -> Self {
        let mut arrays = Self::of_light("", ERROR, form, options);
        let sources = form.centers.iter().flat_map(CenterChannels::list);
        let sources: Vec<Source> = sources.map(|(_, source)| source).collect();
        let is_number = |source: &Source| !source.is_index();
        let centers: Vec<Source> = sources.iter().copied().filter(is_number).collect();
        if !centers.is_empty() {
            let count = Some(centers.len() as u32);
            arrays.add(CHANNELS, count, Contents::Centers(centers));
        }
        for (source, suffix) in [(Source::Id, ID), (Source::CoverageId, COVERAGE_ID)] {
            if sources.contains(&source) {
                arrays.add(suffix, None, Contents::Indices(source));
            }
        }
        arrays
    }

    /// The same arrays with names of their own, for an archive: `light`, `error`, `depth`, `normal` and so on. Those of
    /// one number for each pixel have two axes, like `depth`.
    pub(super) fn for_archive(form: &Form, options: NpyOptions) -> Self {
        let mut arrays = Self::of_light(LIGHT, "error", form, options);
        for (channel, source) in form.centers.iter().flat_map(CenterChannels::list) {
            let name = match channel.split_once('.') {
                None => channel.to_owned(),
                Some((name, "X" | "Y" | "Z" | "R" | "G" | "B")) => name.to_owned(),
                Some((name, other)) => format!("{name}_{other}"),
            };
            if source.is_index() {
                arrays.add(&name, None, Contents::Indices(source));
                continue;
            }
            match arrays.all.last_mut() {
                Some(Part {
                    name: last,
                    array,
                    contents: Contents::Centers(sources),
                }) if *last == name => {
                    sources.push(source);
                    array.channels = Some(sources.len() as u32);
                }
                _ => arrays.add(&name, None, Contents::Centers(vec![source])),
            }
        }
        arrays
    }

    /// The light, and on request the errors, under these names.
    fn of_light(light: &str, error: &str, form: &Form, options: NpyOptions) -> Self {
        let mut arrays = Self {
            region: form.region,
            all: Vec::new(),
        };
        let channels = Some(3 + u32::from(form.alpha));
        arrays.add(light, channels, Contents::Light);
        if options.error {
            arrays.add(error, None, Contents::Error);
        }
        arrays
    }

    fn add(&mut self, name: &str, channels: Option<u32>, contents: Contents) {
        let number = match contents {
            Contents::Indices(_) => Number::U32,
            Contents::Light | Contents::Error | Contents::Centers(_) => Number::F64,
        };
        self.all.push(Part {
            name: name.to_owned(),
            array: Array {
                size: self.region.size(),
                channels,
                number,
            },
            contents,
        });
    }

    /// Bytes of a row in all arrays together.
    pub(crate) fn row_bytes(&self) -> usize {
        self.all.iter().map(|part| part.array.row_bytes()).sum()
    }

    /// Copies the numbers of rows of an image to their positions in `samples`, starting at the column `col`. The
    /// samples cover the same rows, array by array.
    pub(crate) fn encode(&self, samples: &mut [u8], col: u32, image: &Image, rows: Range<u32>) {
        let mut rest = samples;
        for part in &self.all {
            let array = part.array;
            let (own, others) = rest.split_at_mut(array.row_bytes() * rows.len());
            rest = others;
            let is_error = match part.contents {
                Contents::Light => false,
                Contents::Error => true,
                Contents::Centers(_) | Contents::Indices(_) => continue,
            };
            let first = col as usize * array.pixel_bytes();
            let length = image.width() as usize * array.pixel_bytes();
            for (row, numbers) in rows.clone().zip(own.chunks_exact_mut(array.row_bytes())) {
                let numbers = &mut numbers[first..first + length];
                let pixels = numbers.chunks_exact_mut(array.pixel_bytes());
                for (col, pixel) in (0..).zip(pixels) {
                    let (numbers, _) = pixel.as_chunks_mut();
                    if is_error {
                        numbers[0] = image.error(col, row).to_le_bytes();
                        continue;
                    }
                    for (number, value) in numbers.iter_mut().zip(image.rgba(col, row)) {
                        *number = value.to_le_bytes();
                    }
                }
            }
        }
    }

    /// Copies the center values of rows of pixels to their positions, like [`Self::encode`] for light.
    pub(crate) fn encode_geometry(&self, samples: &mut [u8], col: u32, geometry: &Geometry) {
        let mut rest = samples;
        for part in &self.all {
            let array = part.array;
            let length = array.row_bytes() * geometry.height() as usize;
            let (own, others) = rest.split_at_mut(length);
            rest = others;
            let first = col as usize * array.pixel_bytes();
            let length = geometry.width() as usize * array.pixel_bytes();
            for (row, numbers) in (0..).zip(own.chunks_exact_mut(array.row_bytes())) {
                let numbers = &mut numbers[first..first + length];
                match &part.contents {
                    Contents::Indices(Source::CoverageId) => {
                        let ids = geometry.coverage_ids(row);
                        put_indices(numbers, ids.into_iter().flatten());
                    }
                    Contents::Indices(_) => put_indices(numbers, geometry.ids(row)),
                    Contents::Centers(sources) => encode_centers(sources, numbers, geometry, row),
                    Contents::Light | Contents::Error => {}
                }
            }
        }
    }
}

/// Copies the numbers of a row of pixels to their positions, pixel by pixel.
fn encode_centers(sources: &[Source], numbers: &mut [u8], geometry: &Geometry, row: u32) {
    let (numbers, _) = numbers.as_chunks_mut();
    for (place, source) in sources.iter().enumerate() {
        let own = numbers.iter_mut().skip(place).step_by(sources.len());
        match *source {
            Source::Value(quantity, component) => {
                let values = geometry.values(quantity, component, row);
                for (number, value) in own.zip(values.into_iter().flatten()) {
                    *number = value.to_le_bytes();
                }
            }
            Source::Average(average, component) => {
                let values = geometry.averages(average, component, row);
                for (number, value) in own.zip(values.into_iter().flatten()) {
                    *number = value.to_le_bytes();
                }
            }
            Source::Id | Source::CoverageId | Source::Mask => {
                for (number, id) in own.zip(geometry.ids(row)) {
                    let mask = f64::from(u8::from(id != Geometry::NOTHING));
                    *number = mask.to_le_bytes();
                }
            }
        }
    }
}

/// Copies the indices of spheres to their positions.
fn put_indices(numbers: &mut [u8], ids: impl Iterator<Item = u32>) {
    let (numbers, _) = numbers.as_chunks_mut();
    for (number, id) in numbers.iter_mut().zip(ids) {
        *number = id.to_le_bytes();
    }
}
