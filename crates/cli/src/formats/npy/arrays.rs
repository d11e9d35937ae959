//! The arrays of a picture: its light, and additional arrays.

use std::ops::Range;

use marbles_core::{Evidence, Image};

use super::array::{Array, Number};
use crate::base::region::Region;
use crate::formats::center_channels::{CenterChannels, CenterValues, Source};
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
    pub(super) contents: Contents,
}

/// The numbers of an array.
#[derive(Clone, Debug)]
pub(super) enum Contents {
    Light,
    Error,
    /// Whether the error is a bound.
    Evidence,
    /// Numbers for each pixel, of these sources.
    Centers(Vec<Source>),
    /// Indices of spheres.
    Indices(Source),
}

impl Part {
    /// Whether its numbers say of each pixel whether its error is a bound.
    pub(super) fn is_evidence(&self) -> bool {
        matches!(self.contents, Contents::Evidence)
    }

    /// Whether its numbers are indices of spheres.
    pub(super) fn is_index(&self) -> bool {
        matches!(self.contents, Contents::Indices(_))
    }

    /// Whether its numbers are not those of light.
    fn has_centers(&self) -> bool {
        matches!(self.contents, Contents::Centers(_) | Contents::Indices(_))
    }
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
            let name = channel.split_once('.').map_or(channel, |(layer, _)| layer);
            if source.is_index() {
                arrays.add(name, None, Contents::Indices(source));
                continue;
            }
            match arrays.all.last_mut() {
                Some(Part {
                    name: last,
                    array,
                    contents: Contents::Centers(sources),
                }) if last == name => {
                    sources.push(source);
                    array.channels = Some(sources.len() as u32);
                }
                _ => arrays.add(name, None, Contents::Centers(vec![source])),
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
        if options.evidence {
            arrays.add("bound", None, Contents::Evidence);
        }
        arrays
    }

    fn add(&mut self, name: &str, channels: Option<u32>, contents: Contents) {
        let number = match contents {
            Contents::Indices(_) | Contents::Evidence => Number::U32,
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
            if part.has_centers() {
                continue;
            }
            let first = col as usize * array.pixel_bytes();
            let length = image.width() as usize * array.pixel_bytes();
            for (row, numbers) in rows.clone().zip(own.chunks_exact_mut(array.row_bytes())) {
                let numbers = &mut numbers[first..first + length];
                let pixels = numbers.chunks_exact_mut(array.pixel_bytes());
                for (col, pixel) in (0..).zip(pixels) {
                    if part.is_evidence() {
                        let is_bound = image.evidence(col, row) == Evidence::Bound;
                        pixel.copy_from_slice(&u32::from(is_bound).to_le_bytes());
                        continue;
                    }
                    let (numbers, _) = pixel.as_chunks_mut();
                    match part.contents {
                        Contents::Error => numbers[0] = image.error(col, row).to_le_bytes(),
                        _ => {
                            for (number, value) in numbers.iter_mut().zip(image.rgba(col, row)) {
                                *number = value.to_le_bytes();
                            }
                        }
                    }
                }
            }
        }
    }

    /// Copies the center values of rows of pixels to their positions, like [`Self::encode`] for light.
    pub(crate) fn encode_geometry(
        &self,
        samples: &mut [u8],
        col: u32,
        geometry: &impl CenterValues,
    ) {
        let (width, height) = geometry.size();
        let mut rest = samples;
        for part in &self.all {
            let array = part.array;
            let length = array.row_bytes() * height as usize;
            let (own, others) = rest.split_at_mut(length);
            rest = others;
            let first = col as usize * array.pixel_bytes();
            let length = width as usize * array.pixel_bytes();
            for (row, numbers) in (0..).zip(own.chunks_exact_mut(array.row_bytes())) {
                let numbers = &mut numbers[first..first + length];
                match &part.contents {
                    Contents::Indices(source) => put_indices(numbers, *source, geometry, row),
                    Contents::Centers(sources) => encode_centers(sources, numbers, geometry, row),
                    Contents::Light | Contents::Error | Contents::Evidence => {}
                }
            }
        }
    }
}

/// Copies the numbers of a row of pixels to their positions, pixel by pixel.
fn encode_centers(sources: &[Source], numbers: &mut [u8], geometry: &impl CenterValues, row: u32) {
    let (numbers, _) = numbers.as_chunks_mut();
    for (place, source) in sources.iter().enumerate() {
        let mut own = numbers.iter_mut().skip(place).step_by(sources.len());
        geometry.each_number(*source, row, |value| {
            if let Some(number) = own.next() {
                *number = value.to_le_bytes();
            }
        });
    }
}

/// Copies the indices of the spheres of a row of pixels to their positions.
fn put_indices(numbers: &mut [u8], source: Source, geometry: &impl CenterValues, row: u32) {
    let (numbers, _) = numbers.as_chunks_mut();
    let mut numbers = numbers.iter_mut();
    geometry.each_index(source, row, |id| {
        if let Some(number) = numbers.next() {
            *number = id.to_le_bytes();
        }
    });
}
