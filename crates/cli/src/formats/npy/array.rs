//! The form of an array.

use crate::base::size::Size;

/// The number type of an array, little-endian.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Number {
    F64,
    F32,
    U32,
}

/// An array with one or more numbers for each pixel of a picture; row 0 is the top row.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct Array {
    pub(crate) size: Size,
    /// The length of the last axis; `None` for one number per pixel, without such an axis.
    pub(crate) channels: Option<u32>,
    pub(crate) number: Number,
}

impl Number {
    const ALL: [Self; 3] = [Self::F64, Self::F32, Self::U32];

    /// Its name in NumPy.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::F64 => "<f8",
            Self::F32 => "<f4",
            Self::U32 => "<u4",
        }
    }

    /// The type with this name.
    pub(super) fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|number| number.name() == name)
    }

    /// Bytes of a number.
    fn bytes(self) -> usize {
        match self {
            Self::F64 => 8,
            Self::F32 | Self::U32 => 4,
        }
    }
}

impl Array {
    /// The same kind of array for a picture of another size.
    pub(crate) fn resized(self, size: Size) -> Self {
        Self { size, ..self }
    }

    /// The number of numbers per pixel.
    pub(super) fn numbers(self) -> usize {
        self.channels.unwrap_or(1) as usize
    }

    /// Bytes of a pixel's numbers.
    pub(crate) fn pixel_bytes(self) -> usize {
        self.numbers() * self.number.bytes()
    }

    /// Bytes of a row's numbers.
    pub(crate) fn row_bytes(self) -> usize {
        self.size.width as usize * self.pixel_bytes()
    }

    /// Bytes of all numbers; `None` if the result would overflow.
    pub(super) fn bytes(self) -> Option<u64> {
        (self.pixel_bytes() as u64).checked_mul(self.size.pixels())
    }
}
