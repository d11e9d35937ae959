//! One number for every pixel, or one for all.

use std::ops::Range;

use rayon::iter::{IndexedParallelIterator, IntoParallelIterator};

use super::tile::Tile;

/// A number for every pixel of a picture, row by row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Plane<T> {
    /// It is known beforehand to be this one everywhere, and takes no memory.
    Same(T),
    /// Every pixel has its own.
    Each(Vec<T>),
}

impl<T: Copy + Send + Sync> Plane<T> {
    /// The same number everywhere if it is known, else `initial` until one is written; or anything,
    /// in the memory of another plane where that suffices.
    pub(crate) fn new(pixels: usize, same: Option<T>, initial: T, spent: Option<Self>) -> Self {
        match (same, spent) {
            (Some(value), _) => Self::Same(value),
            (None, Some(Self::Each(mut values))) if values.capacity() >= pixels => {
                values.resize(pixels, initial);
                Self::Each(values)
            }
            (None, _) => Self::Each(vec![initial; pixels]),
        }
    }

    /// The number of the pixel with this index.
    pub(crate) fn at(&self, index: usize) -> T {
        match self {
            Self::Same(value) => *value,
            Self::Each(values) => values[index],
        }
    }

    /// The numbers of all pixels, or the one of all.
    pub(crate) fn distinct(&self) -> &[T] {
        match self {
            Self::Same(value) => std::slice::from_ref(value),
            Self::Each(values) => values,
        }
    }

    /// A plane of some pixels, run by run.
    pub(crate) fn cut(&self, runs: &[Range<usize>]) -> Self {
        match self {
            Self::Same(value) => Self::Same(*value),
            Self::Each(values) => {
                let runs = runs.iter().flat_map(|run| &values[run.clone()]);
                Self::Each(runs.copied().collect())
            }
        }
    }

    /// Some pixels of the plane.
    pub(crate) fn band_mut(&mut self, pixels: Range<usize>) -> PlaneBand<'_, T> {
        match self {
            Self::Same(_) => PlaneBand(None),
            Self::Each(values) => PlaneBand(Some(&mut values[pixels])),
        }
    }

    /// The plane cut into this many bands of `pixels` pixels, the last one perhaps smaller.
    pub(crate) fn bands_mut(
        &mut self,
        pixels: usize,
        bands: usize,
    ) -> impl IndexedParallelIterator<Item = PlaneBand<'_, T>> {
        let cut: Vec<PlaneBand<'_, T>> = match self {
            Self::Same(_) => (0..bands).map(|_| PlaneBand(None)).collect(),
            Self::Each(values) => values
                .chunks_mut(pixels)
                .map(|band| PlaneBand(Some(band)))
                .collect(),
        };
        cut.into_par_iter()
    }
}

/// Some pixels of a plane, to be written.
pub(crate) struct PlaneBand<'plane, T>(Option<&'plane mut [T]>);

impl<T: Copy> PlaneBand<'_, T> {
    /// Writes the numbers of some pixels; where all are the same they are known already.
    pub(crate) fn write(&mut self, index: usize, values: &[T]) {
        if let Some(band) = &mut self.0 {
            band[index..index + values.len()].copy_from_slice(values);
        }
    }

    /// Writes the same number for some pixels.
    pub(crate) fn fill(&mut self, index: usize, count: usize, value: T) {
        if let Some(band) = &mut self.0 {
            fill(&mut band[index..index + count], value);
        }
    }
}

/// Fills pixels of a row. Most rows of tiles are whole: a known length takes a few instructions, and no call.
#[inline(always)]
pub(super) fn fill<T: Copy>(values: &mut [T], value: T) {
    match <&mut [T; Tile::SIDE as usize]>::try_from(&mut *values) {
        Ok(whole) => *whole = [value; Tile::SIDE as usize],
        Err(_) => fill_some(values, value),
    }
}

#[cold]
#[inline(never)]
fn fill_some<T: Copy>(values: &mut [T], value: T) {
    values.fill(value);
}
