//! The samples of a PNG: codes with 8 or 16 bits, sRGB or linear, gray if the picture is gray.

use std::ops::Range;

use marbles_core::{Channels, Image};
use png::{BitDepth, ColorType, Info};

use super::curve::Curve;
use crate::base::size::Size;
use crate::formats::encoding::PngOptions;
use crate::formats::form::{Form, color_count};
use marbles_core::srgb;

/// The size of the picture in a file, and the kind of its samples.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct Shape {
    pub(super) size: Size,
    pub(super) color_type: ColorType,
    pub(super) depth: BitDepth,
    /// Whether codes are linear.
    pub(super) is_linear: bool,
}

impl Shape {
    /// The shape of a file for a picture of this form.
    pub(crate) fn of(form: &Form, options: PngOptions) -> Self {
        let grey = form.channels == Channels::Grey && !options.rgb;
        Self {
            size: form.region.size(),
            color_type: match (grey, form.alpha) {
                (true, false) => ColorType::Grayscale,
                (true, true) => ColorType::GrayscaleAlpha,
                (false, false) => ColorType::Rgb,
                (false, true) => ColorType::Rgba,
            },
            depth: if options.deep || options.linear {
                BitDepth::Sixteen
            } else {
                BitDepth::Eight
            },
            is_linear: options.linear,
        }
    }

    /// The shape of a picture whose codes are not light.
    pub(super) fn of_codes(size: Size, color_type: ColorType, depth: BitDepth) -> Self {
        Self {
            size,
            color_type,
            depth,
            is_linear: false,
        }
    }

    /// The shape of a file that is read.
    pub(super) fn of_file(info: &Info<'_>) -> Self {
        Self {
            size: size_of(info),
            color_type: info.color_type,
            depth: info.bit_depth,
            is_linear: matches!(Curve::of(info), Ok((Curve::Linear, _))),
        }
    }

    /// The same kind of samples in a picture of another size.
    pub(crate) fn resized(self, size: Size) -> Self {
        Self { size, ..self }
    }

    /// The size of the picture.
    pub(crate) fn size(self) -> Size {
        self.size
    }

    /// The number of channels: colors, and alpha after them where there is one.
    pub(crate) fn channels(self) -> usize {
        self.color_type.samples()
    }

    /// Bytes of a sample.
    fn sample_bytes(self) -> usize {
        if self.depth == BitDepth::Sixteen {
            2
        } else {
            1
        }
    }

    /// Bytes of a pixel's samples.
    pub(crate) fn pixel_bytes(self) -> usize {
        self.color_type.samples() * self.sample_bytes()
    }

    /// Bytes of a row's samples.
    pub(crate) fn row_bytes(self) -> usize {
        self.size.width as usize * self.pixel_bytes()
    }

    /// The largest size of a file, in bytes.
    pub(super) fn file_bytes(self) -> u64 {
        /// More than the parts before and after the samples.
        const OTHER_PARTS: u64 = 1 << 12;
        // A byte before each row, and five before each block, which has thousands.
        let rows = (self.row_bytes() as u64 + 1) * u64::from(self.size.height);
        rows + rows / 1000 + OTHER_PARTS
    }

    /// The light above which white is no longer the nearest code, although it is the last one.
    fn most_light(self) -> f64 {
        let (curve, most) = match (self.is_linear, self.sample_bytes()) {
            (true, _) => (Curve::Linear, f64::from(u16::MAX)),
            (false, 1) => (Curve::Srgb, f64::from(u8::MAX)),
            (false, _) => (Curve::Srgb, f64::from(u16::MAX)),
        };
        curve.light((most + 0.5) / most)
    }

    /// Copies the codes of rows of an image, in big-endian order, to their positions in `samples`, which cover the same
    /// rows, starting at the column `col`. Light is multiplied by `gain` first. Returns how many pixels were clipped.
    pub(crate) fn encode(
        self,
        samples: &mut [u8],
        col: u32,
        image: &Image,
        rows: Range<u32>,
        gain: f64,
    ) -> u64 {
        let most_light = self.most_light();
        let mut clipped = 0;
        let colors = match self.color_type {
            ColorType::Grayscale | ColorType::GrayscaleAlpha => 1,
            _ => 3,
        };
        let stored = color_count(image.channels());
        let is_opaque = !image.has_alpha() && colors == stored;
        let is_plain = self.sample_bytes() == 1 && is_opaque && gain == 1.0;
        let is_linear_16 = self.sample_bytes() == 2 && is_opaque && self.is_linear;
        let pixel_bytes = self.pixel_bytes();
        let first = col as usize * pixel_bytes;
        let length = image.width() as usize * pixel_bytes;
        for (samples, row) in samples.chunks_exact_mut(self.row_bytes()).zip(rows) {
            let samples = &mut samples[first..first + length];
            if is_plain {
                let light = image.row(row);
                srgb::encode_all_8(light, samples);
                clipped += count_clipped(light, stored, most_light);
                continue;
            }
            if is_linear_16 {
                let light = image.row(row);
                let (pairs, _) = samples.as_chunks_mut::<2>();
                for (pair, &value) in pairs.iter_mut().zip(light) {
                    *pair = linear_16(gain * value).to_be_bytes();
                }
                clipped += count_clipped(light, stored, most_light / gain);
                continue;
            }
            for (samples, col) in samples.chunks_exact_mut(pixel_bytes).zip(0..) {
                let rgba = image.rgba(col, row);
                let alpha = rgba[3];
                let mut samples = samples.chunks_exact_mut(self.sample_bytes());
                let mut is_clipped = false;
                for (&value, sample) in rgba[..colors].iter().zip(&mut samples) {
                    let value = gain * straight(value, alpha);
                    is_clipped |= value > most_light;
                    put(sample, value, self.is_linear);
                }
                clipped += u64::from(is_clipped);
                // The alpha channel, where there is one.
                if let Some(sample) = samples.next() {
                    put(sample, alpha, true);
                }
            }
        }
        clipped
    }
}

/// The number of pixels, with a number of values each, in which some value is above a limit. In most pictures there are
/// none.
fn count_clipped(light: &[f64], stored: usize, most: f64) -> u64 {
    let highest = light
        .iter()
        .fold(0.0_f64, |highest, &value| highest.max(value));
    if highest <= most {
        return 0;
    }
    let pixels = light.chunks_exact(stored);
    let is_clipped = |pixel: &&[f64]| pixel.iter().any(|&value| value > most);
    pixels.filter(is_clipped).count() as u64
}

/// Writes the code of a value to a sample of one byte or two.
fn put(sample: &mut [u8], value: f64, is_linear: bool) {
    match (sample, is_linear) {
        ([byte], true) => *byte = linear_8(value),
        ([byte], false) => *byte = srgb::encode_8(value),
        (pair, true) => pair.copy_from_slice(&linear_16(value).to_be_bytes()),
        (pair, false) => pair.copy_from_slice(&srgb::encode_16(value).to_be_bytes()),
    }
}

/// The size of a picture.
pub(super) fn size_of(info: &Info<'_>) -> Size {
    let Info { width, height, .. } = *info;
    Size { width, height }
}

/// The light of the covered part of a pixel only: not premultiplied.
fn straight(premultiplied: f64, alpha: f64) -> f64 {
    if alpha > 0.0 {
        premultiplied / alpha
    } else {
        0.0
    }
}

/// The nearest code of a number from 0 to 1; the cast saturates.
fn linear_8(value: f64) -> u8 {
    (value * f64::from(u8::MAX) + 0.5) as u8
}

/// Like [`linear_8`], with 16 bits. The detour through a wider integer lets compilers compute several at a time.
fn linear_16(value: f64) -> u16 {
    let most = f64::from(u16::MAX);
    (value * most + 0.5).clamp(0.0, most) as i32 as u16
}
