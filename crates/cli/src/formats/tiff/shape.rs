//! The samples of a TIFF: premultiplied light, in codes with 16 bits or in single precision.

use std::ops::Range;

use glam::DVec3;
use marbles_core::{Channels, Image};
use tiff::encoder::compression::{CompressionAlgorithm, Deflate, DeflateLevel};

use super::decoder::{Alpha, Opened};
use crate::base::size::Size;
use crate::formats::encoding::TiffOptions;
use crate::formats::form::Form;

/// The size of a file's picture, and the kind of its samples.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct Shape {
    pub(super) size: Size,
    /// The number of colors, 1 or 3.
    pub(super) colors: usize,
    pub(super) alpha: bool,
    /// Single precision instead of 16 bits.
    pub(super) float: bool,
}

impl Shape {
    /// The shape of a file for a picture of this form.
    pub(super) fn of(form: &Form, options: TiffOptions) -> Self {
        let grey = form.channels == Channels::Grey && !options.rgb;
        Self {
            size: form.region.size(),
            colors: if grey { 1 } else { 3 },
            alpha: form.alpha,
            float: options.float,
        }
    }

    /// The shape of a file that marbles may have written, or `None` if another program must have written it.
    pub(super) fn of_file(file: &Opened) -> Option<Self> {
        let shape = Self {
            size: file.size,
            colors: file.colors,
            alpha: file.alpha == Alpha::Associated,
            float: file.float,
        };
        let is_known = file.samples == shape.channels()
            && usize::from(file.bits) == 8 * shape.sample_bytes()
            && file.across == 1
            && file.chunk.0 == file.size.width;
        is_known.then_some(shape)
    }

    /// The same kind of samples in a picture of another size.
    pub(crate) fn resized(self, size: Size) -> Self {
        Self { size, ..self }
    }

    /// The number of channels.
    pub(super) fn channels(self) -> usize {
        self.colors + usize::from(self.alpha)
    }

    /// Bytes of a sample.
    pub(super) fn sample_bytes(self) -> usize {
        if self.float { 4 } else { 2 }
    }

    /// Bytes of a pixel's samples.
    pub(crate) fn pixel_bytes(self) -> usize {
        self.channels() * self.sample_bytes()
    }

    /// Bytes of a row's samples.
    pub(crate) fn row_bytes(self) -> usize {
        self.size.width as usize * self.pixel_bytes()
    }

    /// The largest number of bytes that a file may have.
    pub(super) fn file_bytes(self) -> u64 {
        /// The header, the profile, and a table of strips with one row each take less than this.
        const OTHER_PARTS: u64 = 1 << 21;
        let samples = self.row_bytes() as u64 * u64::from(self.size.height);
        // Deflate adds five bytes to every 16 kB that it cannot compress.
        samples + samples / 1000 + OTHER_PARTS
    }

    /// Copies the numbers of rows of an image to their positions in `samples`, which has the same rows, starting at the
    /// column `col`. Returns how many pixels were clipped, or how many finite numbers were too large for a float. Light is
    /// multiplied by `gain` before it is converted to codes.
    pub(super) fn encode(
        self,
        samples: &mut [u8],
        col: u32,
        image: &Image,
        rows: Range<u32>,
        gain: f64,
    ) -> u64 {
        let mut clipped = 0;
        let first = col as usize * self.pixel_bytes();
        let length = image.width() as usize * self.pixel_bytes();
        for (samples, row) in samples.chunks_exact_mut(self.row_bytes()).zip(rows) {
            let pixels = samples[first..first + length].chunks_exact_mut(self.pixel_bytes());
            for (pixel, col) in pixels.zip(0..) {
                let [red, green, blue, alpha] = image.rgba(col, row);
                let color = [red, green, blue];
                if self.float {
                    let values = color[..self.colors].iter().chain([&alpha]);
                    let (numbers, _) = pixel.as_chunks_mut();
                    for (number, &value) in numbers.iter_mut().zip(values) {
                        let (float, is_too_large) = float(value);
                        *number = float.to_ne_bytes();
                        clipped += u64::from(is_too_large);
                    }
                } else {
                    let color = (gain * DVec3::from(color)).to_array();
                    let values = color[..self.colors].iter().chain([&alpha]);
                    let (numbers, _) = pixel.as_chunks_mut();
                    for (number, &value) in numbers.iter_mut().zip(values) {
                        *number = code(value).to_ne_bytes();
                    }
                    let is_clipped = color[..self.colors].iter().any(|&value| value > MOST_LIGHT);
                    clipped += u64::from(is_clipped);
                }
            }
        }
        clipped
    }

    /// The compressed bytes of a strip in a file. Codes are stored as differences to their left neighbors.
    pub(crate) fn compress(self, mut samples: Vec<u8>) -> Vec<u8> {
        if !self.float {
            for row in samples.chunks_exact_mut(self.row_bytes()) {
                let (codes, _) = row.as_chunks_mut::<2>();
                for index in (self.channels()..codes.len()).rev() {
                    let [code, left] = [index, index - self.channels()]
                        .map(|index| u16::from_ne_bytes(codes[index]));
                    codes[index] = code.wrapping_sub(left).to_ne_bytes();
                }
            }
        }
        let mut compressed = Vec::new();
        let mut deflate = Deflate::with_level(DeflateLevel::Fast);
        let written = deflate.write_to(&mut compressed, &samples);
        written.expect("memory takes all bytes");
        compressed
    }
}

/// The largest code.
const MOST: f64 = u16::MAX as f64;

/// The light above which a pixel counts as clipped: half a step above white.
const MOST_LIGHT: f64 = (MOST + 0.5) / MOST;

/// The code nearest to a number from 0 to 1; the cast saturates.
#[inline]
fn code(value: f64) -> u16 {
    (value * MOST + 0.5) as u16
}

/// The float nearest to a number, and whether it is finite and too large for one.
#[inline]
fn float(value: f64) -> (f32, bool) {
    let float = value as f32;
    if float.is_infinite() && value.is_finite() {
        return (f32::MAX.copysign(float), true);
    }
    (float, false)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_the_nearest() {
        for (value, expected) in [
            (0.0, 0),
            (0.49 / MOST, 0),
            (0.51 / MOST, 1),
            (1.0, 65_535),
            (7.0, 65_535),
            (f64::INFINITY, 65_535),
            (f64::NAN, 0),
        ] {
            assert_eq!(code(value), expected, "{value}");
        }
        assert_eq!(float(0.1), (0.1, false));
        assert_eq!(float(1e39), (f32::MAX, true));
        assert_eq!(float(f64::INFINITY), (f32::INFINITY, false));
    }

    #[test]
    fn codes_become_differences_row_by_row() {
        let size = Size {
            width: 2,
            height: 2,
        };
        let shape = Shape {
            size,
            colors: 1,
            alpha: true,
            float: false,
        };
        let codes: [u16; 8] = [5, 100, 7, 90, 1, 2, 0, 2];
        let bytes = |codes: &[u16]| codes.iter().flat_map(|code| code.to_ne_bytes()).collect();
        let differences: Vec<u8> = bytes(&[5, 100, 2, 65_526, 1, 2, 65_535, 0]);
        let mut expected = Vec::new();
        Deflate::with_level(DeflateLevel::Fast)
            .write_to(&mut expected, &differences)
            .unwrap();
        assert_eq!(shape.compress(bytes(&codes)), expected);
    }
}
