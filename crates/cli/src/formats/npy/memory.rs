//! Arrays in memory, instead of in files.

use super::array::Array;
use super::arrays::Arrays;
use crate::base::memory;

/// An array of a picture in memory; row 0 is the top row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NamedArray {
    /// Its name in an archive.
    pub(crate) name: String,
    pub(crate) array: Array,
    pub(crate) numbers: Numbers,
}

/// The numbers of an array, row by row, those of a pixel one after another.
#[derive(Clone, Debug, PartialEq)]
pub enum Numbers {
    /// Light, errors and coordinates.
    F64(Vec<f64>),
    /// Indices of spheres.
    U32(Vec<u32>),
    /// Statements about pixels.
    Bool(Vec<bool>),
}

impl Arrays {
    /// The arrays without numbers, but with room for them. Refuses more than fits into memory.
    pub(crate) fn begin(&self) -> Result<Vec<NamedArray>, String> {
        let arrays = self.all.iter().map(|part| {
            let count = part.array.size.pixels() as usize * part.array.numbers();
            let numbers = if part.is_evidence() {
                Numbers::Bool(memory::reserve(count)?)
            } else if part.is_index() {
                Numbers::U32(memory::reserve(count)?)
            } else {
                Numbers::F64(memory::reserve(count)?)
            };
            Ok(NamedArray {
                name: part.name.clone(),
                array: part.array,
                numbers,
            })
        });
        arrays.collect()
    }

    /// Adds the samples of the next strip to these arrays.
    pub(crate) fn extend(&self, arrays: &mut [NamedArray], samples: &[u8]) {
        let rows = samples.len() / self.row_bytes();
        let mut rest = samples;
        for array in arrays {
            let (own, others) = rest.split_at(rows * array.array.row_bytes());
            rest = others;
            match &mut array.numbers {
                Numbers::F64(numbers) => {
                    let (own, _) = own.as_chunks();
                    numbers.extend(own.iter().map(|bytes| f64::from_le_bytes(*bytes)));
                }
                Numbers::U32(numbers) => {
                    let (own, _) = own.as_chunks();
                    numbers.extend(own.iter().map(|bytes| u32::from_le_bytes(*bytes)));
                }
                Numbers::Bool(values) => {
                    let (own, _) = own.as_chunks::<4>();
                    values.extend(own.iter().map(|bytes| *bytes != [0; 4]));
                }
            }
        }
    }
}
