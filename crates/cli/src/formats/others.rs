//! Pictures of other programs, decoded by the crate `image`: JPEG, GIF, WebP, Radiance, PNM, TGA, BMP and QOI.
//!
//! The decoders return a picture as a whole, so its size is limited.

use std::io::{Read, Seek, SeekFrom};

use image::codecs::bmp::BmpDecoder;
use image::codecs::gif::GifDecoder;
use image::codecs::hdr::HdrDecoder;
use image::codecs::jpeg::JpegDecoder;
use image::codecs::pnm::PnmDecoder;
use image::codecs::qoi::QoiDecoder;
use image::codecs::tga::TgaDecoder;
use image::codecs::webp::WebPDecoder;
use image::{ColorType, ImageDecoder, ImageError, Limits};

use super::guard::guarded;
use super::numbers::{Coding, Meaning, Numbers, RowSource};
use super::picture::{NOT_TURNED, ONE_FRAME, ONE_PICTURE, Picture, is_turned, size_of};
use super::png::curve::Curve;
use super::source::{Input, Source};
use super::{jpeg, profile, webp};
use crate::base::failure::{lower, reason};
use crate::base::memory;
use crate::base::size::LONGEST_SIDE;

/// A format of other programs.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Other {
    Jpeg,
    Gif,
    Webp,
    Radiance,
    Pnm,
    Tga,
    Bmp,
    Qoi,
}

/// The largest number of bytes that the samples of a picture may take, and that its decoder may allocate.
const MOST_BYTES: u64 = 1 << 27;
/// The largest number of bytes of a file. Some decoders read files as a whole.
pub(super) const MOST_FILE_BYTES: u64 = 1 << 26;

// Pillow marks all QOI files as linear.
const SAID_TO_BE_LINEAR: &str =
    "it says that its codes are linear, but some programs say this of sRGB codes";

impl Other {
    /// The name of the format.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Jpeg => "JPEG",
            Self::Gif => "GIF",
            Self::Webp => "WebP",
            Self::Radiance => "Radiance HDR",
            Self::Pnm => "PNM",
            Self::Tga => "TGA",
            Self::Bmp => "BMP",
            Self::Qoi => "QOI",
        }
    }

    /// The largest number of pixels of a picture.
    fn most_pixels(self) -> u64 {
        match self {
            // While the decoder combines colors and alpha, a pixel takes 15 bytes of memory.
            Self::Webp => 12_000_000,
            _ => 1 << 24,
        }
    }

    /// The picture in a file.
    pub(super) fn begin(self, source: &Source) -> Result<Picture, String> {
        let open = || source.open().map_err(|error| reason(&error));
        let mut file = open()?;
        let end = file.seek(SeekFrom::End(0));
        let end = end.and_then(|end| file.rewind().map(|()| end));
        let end = end.map_err(|error| reason(&error))?;
        if end > MOST_FILE_BYTES {
            return Err(format!(
                "the file has {end} bytes, expected at most {MOST_FILE_BYTES}"
            ));
        }
        let srgb = Curve::Srgb;
        guarded(|| match self {
            Self::Jpeg => {
                jpeg::check(&mut open()?)?;
                self.read(Box::new(JpegDecoder::new(file).map_err(words)?), srgb, None)
            }
            Self::Gif => {
                let warning = is_animated_gif(open()?).then_some(ONE_FRAME);
                self.read(
                    Box::new(GifDecoder::new(file).map_err(words)?),
                    srgb,
                    warning,
                )
            }
            Self::Webp => {
                webp::chunks::check_length(&mut open()?, end)?;
                let decoder = WebPDecoder::new(file).map_err(words)?;
                webp::frame::check(&mut open()?, decoder.dimensions())?;
                let warning = decoder.has_animation().then_some(ONE_FRAME);
                self.read(Box::new(decoder), srgb, warning)
            }
            Self::Radiance => {
                self.read(Box::new(HdrDecoder::new(file).map_err(words)?), srgb, None)
            }
            Self::Pnm => {
                let decoder = PnmDecoder::new(&mut file).map_err(words)?;
                let mut picture = self.read(Box::new(decoder), srgb, None)?;
                if begins_pnm(&mut file) {
                    picture.warnings.push(ONE_PICTURE);
                }
                Ok(picture)
            }
            Self::Tga => self.read(Box::new(TgaDecoder::new(file).map_err(words)?), srgb, None),
            Self::Bmp => self.read(Box::new(BmpDecoder::new(file).map_err(words)?), srgb, None),
            Self::Qoi => {
                let curve = curve_of_qoi(&mut open()?);
                let warning = (curve == Curve::Linear).then_some(SAID_TO_BE_LINEAR);
                self.read(
                    Box::new(QoiDecoder::new(file).map_err(words)?),
                    curve,
                    warning,
                )
            }
        })
    }

    /// Decodes a picture whose codes have this curve, unless the file contains a linear profile.
    fn read(
        self,
        mut decoder: Box<dyn ImageDecoder + '_>,
        mut curve: Curve,
        warning: Option<&'static str>,
    ) -> Result<Picture, String> {
        let (width, height) = decoder.dimensions();
        let size = size_of(width as usize, height as usize)?;
        let (pixels, most) = (size.pixels(), self.most_pixels());
        if pixels > most {
            return Err(format!(
                "{width} x {height} pixels are {pixels}, expected at most {most}"
            ));
        }
        let bytes = decoder.total_bytes();
        if bytes > MOST_BYTES {
            return Err(format!(
                "its pixels take {bytes} bytes, expected at most {MOST_BYTES}"
            ));
        }
        let mut limits = Limits::no_limits();
        limits.max_image_width = Some(LONGEST_SIDE);
        limits.max_image_height = Some(LONGEST_SIDE);
        limits.max_alloc = Some(MOST_BYTES);
        decoder.set_limits(limits).map_err(words)?;
        let mut warnings = Vec::from_iter(warning);
        if let Ok(Some(profile)) = decoder.icc_profile() {
            if profile::is_linear(&profile) {
                curve = Curve::Linear;
            } else {
                warnings.push(Curve::IGNORED_PROFILE);
            }
        }
        if decoder.orientation().is_ok_and(is_turned) {
            warnings.push(NOT_TURNED);
        }
        let color_type = decoder.color_type();
        let mut samples = memory::reserve(bytes as usize)?;
        samples.resize(bytes as usize, 0);
        decoder.read_image_boxed(&mut samples).map_err(words)?;

        let depth =
            Depth::of(color_type).ok_or_else(|| format!("its colors are {color_type:?}"))?;
        let (kind, coding) = match depth {
            Depth::Eight | Depth::Sixteen => {
                let bits = 8 * depth.bytes();
                let most = f64::from(u16::MAX >> (16 - bits));
                let kind = format!("{bits} bit {}", curve.name());
                (kind, Coding::Codes { curve, most })
            }
            Depth::Float if self == Self::Radiance => {
                ("shared exponent".to_owned(), Coding::SharedExponent)
            }
            Depth::Float => ("32 bit float".to_owned(), Coding::Floats { bits: 32 }),
        };
        let meaning = Meaning {
            colors: if color_type.has_color() { 3 } else { 1 },
            alpha: color_type.has_alpha(),
            is_premultiplied: false,
            coding,
        };
        let rows = Whole {
            samples,
            row_bytes: bytes as usize / size.height as usize,
            depth,
            next: 0,
        };
        Ok(Numbers::picture(
            self.name(),
            &kind,
            size,
            meaning,
            warnings,
            Box::new(rows),
        ))
    }
}

/// The kind of a sample.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Depth {
    Eight,
    Sixteen,
    Float,
}

impl Depth {
    fn of(color_type: ColorType) -> Option<Self> {
        Some(match color_type {
            ColorType::L8 | ColorType::La8 | ColorType::Rgb8 | ColorType::Rgba8 => Self::Eight,
            ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16 => {
                Self::Sixteen
            }
            ColorType::Rgb32F | ColorType::Rgba32F => Self::Float,
            _ => return None,
        })
    }

    /// Bytes of a sample.
    fn bytes(self) -> usize {
        match self {
            Self::Eight => 1,
            Self::Sixteen => 2,
            Self::Float => 4,
        }
    }
}

/// A picture that is decoded as a whole.
struct Whole {
    samples: Vec<u8>,
    row_bytes: usize,
    depth: Depth,
    /// The number of the next row.
    next: usize,
}

impl RowSource for Whole {
    fn next(&mut self, row: &mut Vec<f64>) -> Result<(), String> {
        let samples = &self.samples[self.next * self.row_bytes..][..self.row_bytes];
        self.next += 1;
        row.clear();
        match self.depth {
            Depth::Eight => row.extend(samples.iter().copied().map(f64::from)),
            Depth::Sixteen => {
                let (pairs, _) = samples.as_chunks();
                row.extend(
                    pairs
                        .iter()
                        .map(|&pair| f64::from(u16::from_ne_bytes(pair))),
                );
            }
            Depth::Float => {
                let (words, _) = samples.as_chunks();
                row.extend(
                    words
                        .iter()
                        .map(|&word| f64::from(f32::from_ne_bytes(word))),
                );
            }
        }
        Ok(())
    }
}

/// Returns whether a GIF has a second frame.
fn is_animated_gif(file: Box<dyn Input>) -> bool {
    let mut options = gif::DecodeOptions::new();
    options.skip_frame_decoding(true);
    options.read_info(file).is_ok_and(|mut frames| {
        (0..2).all(|_| frames.next_frame_info().is_ok_and(|frame| frame.is_some()))
    })
}

/// Returns whether the rest of a PNM is one more picture.
fn begins_pnm(rest: &mut Box<dyn Input>) -> bool {
    let bytes = rest.bytes().map_while(Result::ok);
    let mut bytes = bytes.skip_while(u8::is_ascii_whitespace);
    bytes.next() == Some(b'P')
        && bytes
            .next()
            .is_some_and(|kind| (b'1'..=b'7').contains(&kind))
}

/// The curve that the header of a QOI names.
///
/// Source: "The Quite OK Image Format, specification 1.0".
fn curve_of_qoi(file: &mut Box<dyn Input>) -> Curve {
    const LINEAR: u8 = 1;
    let mut header = [0; 14];
    match file.read_exact(&mut header) {
        Ok(()) if header[13] == LINEAR => Curve::Linear,
        _ => Curve::Srgb,
    }
}

/// The message of a decoder, which begins in lower case.
fn words(error: ImageError) -> String {
    lower(&error.to_string())
}

#[cfg(test)]
mod tests;
