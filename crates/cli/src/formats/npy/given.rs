//! Arrays that another part of the process gives back, to be written to files.

use marbles_core::Image;

use super::arrays::{Arrays, Contents, LIGHT};
use crate::formats::center_channels::{CenterValues, Source};
use crate::formats::encoding::NpyOptions;
use crate::formats::form::Form;

/// The numbers of an array, row by row, those of a pixel one after another.
#[derive(Clone, Copy, Debug)]
pub enum GivenNumbers<'a> {
    /// Light, errors and coordinates.
    F64(&'a [f64]),
    /// Indices of spheres.
    U32(&'a [u32]),
}

/// The center values of a picture's arrays.
pub(crate) struct GivenCenters<'a> {
    arrays: Arrays,
    /// Of each array, if it was given.
    numbers: Vec<Option<GivenNumbers<'a>>>,
    first_row: u32,
    rows: u32,
}

/// The names of the arrays of light and errors, which have numbers in double precision.
const NAMES: [&str; 2] = [LIGHT, "error"];

/// The picture whose arrays have these names. Refuses arrays that are missing or have another length.
pub(crate) fn image(form: &Form, given: &[(&str, GivenNumbers<'_>)]) -> Result<Image, String> {
    let size = form.region.size();
    let pixels = size.pixels() as usize;
    let lengths = [pixels * (3 + usize::from(form.alpha)), pixels];
    let mut found = [&[][..]; 2];
    for ((name, length), found) in NAMES.into_iter().zip(lengths).zip(&mut found) {
        let array = given.iter().find(|(other, _)| *other == name);
        match array {
            Some((_, GivenNumbers::F64(numbers))) if numbers.len() == length => *found = numbers,
            _ => {
                return Err(format!(
                    "expected an array `{name}` of {length} numbers in double precision"
                ));
            }
        }
    }
    let [light, errors] = found;
    let size = (size.width, size.height);
    Ok(Image::of_numbers(
        size,
        form.channels,
        form.alpha,
        light,
        errors,
    ))
}

impl<'a> GivenCenters<'a> {
    /// The center values of the arrays that were given.
    pub(crate) fn new(form: &Form, given: &[(&str, GivenNumbers<'a>)]) -> Self {
        let options = NpyOptions {
            error: false,
            archive: true,
            evidence: false,
        };
        let arrays = Arrays::for_archive(form, options);
        let pixels = form.region.size().pixels() as usize;
        let numbers = arrays.all.iter().map(|part| {
            let (_, numbers) = given.iter().find(|(name, _)| *name == part.name)?;
            let length = match numbers {
                GivenNumbers::F64(numbers) => numbers.len(),
                GivenNumbers::U32(numbers) => numbers.len(),
            };
            (length == pixels * part.array.numbers()).then_some(*numbers)
        });
        Self {
            numbers: numbers.collect(),
            arrays,
            first_row: 0,
            rows: form.region.window.height,
        }
    }

    /// The same in some rows.
    pub(crate) fn in_rows(self, first_row: u32, rows: u32) -> Self {
        Self {
            first_row,
            rows,
            ..self
        }
    }
}

impl CenterValues for GivenCenters<'_> {
    fn size(&self) -> (u32, u32) {
        (self.arrays.region.window.width, self.rows)
    }

    fn each_number(&self, source: Source, row: u32, take: impl FnMut(f64)) {
        let width = self.arrays.region.window.width as usize;
        let first = (self.first_row + row) as usize * width;
        for (part, numbers) in self.arrays.all.iter().zip(&self.numbers) {
            if let (Contents::Centers(sources), Some(GivenNumbers::F64(numbers))) =
                (&part.contents, numbers)
                && let Some(place) = sources.iter().position(|own| *own == source)
            {
                let stride = sources.len();
                let row = &numbers[first * stride..][..width * stride];
                row.iter()
                    .skip(place)
                    .step_by(stride)
                    .copied()
                    .for_each(take);
                return;
            }
        }
    }

    fn each_index(&self, source: Source, row: u32, take: impl FnMut(u32)) {
        let width = self.arrays.region.window.width as usize;
        let first = (self.first_row + row) as usize * width;
        for (part, numbers) in self.arrays.all.iter().zip(&self.numbers) {
            if let (Contents::Indices(own), Some(GivenNumbers::U32(numbers))) =
                (&part.contents, numbers)
                && *own == source
            {
                numbers[first..][..width].iter().copied().for_each(take);
                return;
            }
        }
    }
}
