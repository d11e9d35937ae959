//! PNG of any kind, as linear light.

use std::any::Any;
use std::ops::Range;

use image::metadata::Orientation;
use png::{BitDepth, ColorType};

use super::curve::Curve;
use super::lines::{Lines, has_alpha, open};
use crate::formats::picture::{NOT_TURNED, ONE_FRAME, Picture, Samples, is_turned, size_of};
use crate::formats::source::Source;

/// The name of the format.
pub(crate) const NAME: &str = "PNG";

/// The codes of a file, and their light.
struct Codes {
    /// Samples of 8 bits, or of 16 bits in big-endian order.
    lines: Lines,
    color_type: ColorType,
    deep: bool,
    /// Half the distance between the codes of the file; more than ½ if it has less than 8 bits.
    half_step: f64,
    /// The function from codes to light.
    curve: Curve,
    /// The light of every code.
    light: Vec<f64>,
    /// The light half a step above every code. It is farther away than the light half a step below.
    light_above: Vec<f64>,
}

/// The picture in a PNG file.
pub(crate) fn begin(source: &Source) -> Result<Picture, String> {
    let reader = open(source)?;
    let (color_type, depth) = reader.output_color_type();
    let deep = depth == BitDepth::Sixteen;
    let info = reader.info();
    let size = size_of(info.width as usize, info.height as usize)?;
    let (curve, warning) = Curve::of(info)?;
    let mut warnings = Vec::from_iter(warning);
    if info.animation_control.is_some_and(|it| it.num_frames > 1) {
        warnings.push(ONE_FRAME);
    }
    let exif = info.exif_metadata.as_deref();
    if exif
        .and_then(Orientation::from_exif_chunk)
        .is_some_and(is_turned)
    {
        warnings.push(NOT_TURNED);
    }
    // The entries of a palette have 8 bit, however short their numbers are.
    let bits = match info.color_type {
        ColorType::Indexed => 8,
        _ => info.bit_depth as u8,
    };

    let grey = color_type.samples() < 3;
    let alpha = has_alpha(color_type);
    let description = format!("PNG, {bits} bit {}, {}", curve.name(), names(grey, alpha));
    let most = most(deep);
    let half_step = 0.5 * most / f64::from((1_u32 << bits) - 1);
    let light = |offset: f64| {
        let codes = 0..=most as u32;
        codes.map(move |code| curve.light((f64::from(code) + offset) / most))
    };
    Ok(Picture {
        size,
        grey,
        alpha,
        format: NAME,
        description,
        warnings,
        row: Box::new(Codes {
            lines: Lines::begin(reader, source)?,
            color_type,
            deep,
            half_step,
            curve,
            light: light(0.0).collect(),
            light_above: light(half_step).collect(),
        }),
    })
}

impl Samples for Codes {
    fn advance(&mut self) -> Result<(), String> {
        self.lines.advance()
    }

    fn differing(&self, other: &dyn Samples) -> Option<Range<u32>> {
        let other = (other as &dyn Any).downcast_ref::<Self>()?;
        let kind = |codes: &Self| (codes.color_type, codes.deep, codes.half_step, codes.curve);
        (kind(self) == kind(other)).then(|| self.lines.differing(&other.lines))
    }

    fn end_of_run(&self, col: u32) -> u32 {
        self.lines.end_of_run(col)
    }

    fn rgba(&self, col: u32) -> [f64; 4] {
        let [red, green, blue, alpha] = self.codes(col);
        let alpha = alpha as f64 / most(self.deep);
        let light = |code: usize| self.light[code] * alpha;
        [light(red), light(green), light(blue), alpha]
    }

    /// Color and alpha are rounded separately; the error is largest if both were rounded down.
    fn rounding(&self, col: u32) -> [f64; 4] {
        let most = most(self.deep);
        let [red, green, blue, alpha] = self.codes(col);
        let alpha_step = if has_alpha(self.color_type) {
            self.half_step / most
        } else {
            0.0
        };
        let alpha = alpha as f64 / most;
        let alpha_above = (alpha + alpha_step).min(1.0);
        let color = |code: usize| self.light_above[code] * alpha_above - self.light[code] * alpha;
        [color(red), color(green), color(blue), alpha_step]
    }

    fn is_full(&self, col: u32) -> [bool; 4] {
        let full = most(self.deep) as usize;
        self.codes(col).map(|code| code == full)
    }
}

impl Codes {
    /// The codes of a pixel. Gray pictures have equal colors, and alpha is full if there is none.
    fn codes(&self, col: u32) -> [usize; 4] {
        let full = most(self.deep) as usize;
        let count = self.color_type.samples();
        let start = col as usize * count;
        let codes = self.lines.row();
        let code = |channel: usize| {
            let index = start + channel;
            if self.deep {
                let (high, low) = (codes[2 * index], codes[2 * index + 1]);
                usize::from(u16::from_be_bytes([high, low]))
            } else {
                usize::from(codes[index])
            }
        };
        match count {
            1 => [code(0), code(0), code(0), full],
            2 => [code(0), code(0), code(0), code(1)],
            3 => [code(0), code(1), code(2), full],
            _ => [code(0), code(1), code(2), code(3)],
        }
    }
}

/// The largest code.
fn most(deep: bool) -> f64 {
    if deep {
        f64::from(u16::MAX)
    } else {
        f64::from(u8::MAX)
    }
}

/// The names of the channels.
fn names(grey: bool, alpha: bool) -> &'static str {
    match (grey, alpha) {
        (true, false) => "gray",
        (true, true) => "gray + alpha",
        (false, false) => "RGB",
        (false, true) => "RGBA",
    }
}

#[cfg(test)]
mod tests;
