//! The meaning of the numbers in files that store codes or light pixel by pixel.

use super::picture::{Picture, Samples};
use super::png::curve::Curve;
use crate::base::size::Size;

/// The rows of a file, from the top downward.
pub(super) trait RowSource {
    /// Replaces the contents of `row` by the numbers of the next row: all channels of all pixels. There must be a next row.
    fn next(&mut self, row: &mut Vec<f64>) -> Result<(), String>;
}

/// The meaning of the numbers of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meaning {
    /// The number of channels of color, 1 or 3.
    pub(super) colors: usize,
    /// Whether an alpha channel follows them.
    pub(super) alpha: bool,
    /// Whether colors are multiplied by alpha.
    pub(super) is_premultiplied: bool,
    pub(super) coding: Coding,
}

/// The relation between numbers and light.
#[derive(Clone, Copy, Debug)]
pub(super) enum Coding {
    /// Integers. The largest one, `most`, stands for white.
    Codes { curve: Curve, most: f64 },
    /// Floats with this number of bits, which are light.
    Floats { bits: u8 },
    /// The light of a Radiance picture: three numbers with 8 bits that share a power of two.
    SharedExponent,
}

/// A picture that is being read.
pub(super) struct Numbers {
    meaning: Meaning,
    rows: Box<dyn RowSource>,
    row: Vec<f64>,
    /// The light of each code, and that half a step above it. Empty if there are many codes.
    light: Vec<[f64; 2]>,
}

/// The largest code of pictures for which the light of all codes is computed in advance.
const MOST_IN_TABLE: f64 = u16::MAX as f64;

impl Numbers {
    /// The picture of a file in the format `name`; `kind` describes its numbers.
    pub(super) fn picture(
        name: &'static str,
        kind: &str,
        size: Size,
        meaning: Meaning,
        warnings: Vec<&'static str>,
        rows: Box<dyn RowSource>,
    ) -> Picture {
        let names = match (meaning.colors, meaning.alpha) {
            (1, false) => "gray",
            (1, true) => "gray + alpha",
            (_, false) => "RGB",
            (_, true) => "RGBA",
        };
        let light = match meaning.coding {
            Coding::Codes { most, .. } if most <= MOST_IN_TABLE => {
                let codes = 0..=most as u32;
                codes
                    .map(|code| light_of(meaning.coding, code.into()))
                    .collect()
            }
            _ => Vec::new(),
        };
        Picture {
            size,
            grey: meaning.colors == 1,
            alpha: meaning.alpha,
            format: name,
            description: format!("{name}, {kind}, {names}"),
            warnings,
            row: Box::new(Self {
                meaning,
                rows,
                row: Vec::new(),
                light,
            }),
        }
    }

    /// The numbers of a pixel: the same number for all three colors if the picture is gray, and `None` if it has no alpha.
    fn numbers(&self, col: u32) -> ([f64; 3], Option<f64>) {
        let Meaning { colors, alpha, .. } = self.meaning;
        let channels = colors + usize::from(alpha);
        let pixel = &self.row[col as usize * channels..][..channels];
        let color = match colors {
            1 => [pixel[0]; 3],
            _ => [pixel[0], pixel[1], pixel[2]],
        };
        (color, alpha.then(|| pixel[colors]))
    }

    /// The light of a number, and that of a number half a step above it.
    fn light(&self, number: f64) -> [f64; 2] {
        let known = self.light.get(number as usize);
        known
            .copied()
            .unwrap_or_else(|| light_of(self.meaning.coding, number))
    }

    /// Alpha from 0 to 1, and half of its step.
    fn alpha(&self, number: Option<f64>) -> [f64; 2] {
        match (number, self.meaning.coding) {
            (None, _) => [1.0, 0.0],
            (Some(code), Coding::Codes { most, .. }) => [code / most, 0.5 / most],
            (Some(alpha), coding) => [alpha, light_of(coding, alpha)[1] - alpha],
        }
    }

    /// The light of a pixel's colors, and the light half a step above, both premultiplied.
    fn colors(&self, col: u32) -> [[f64; 2]; 3] {
        let (color, alpha) = self.numbers(col);
        let [alpha, step] = self.alpha(alpha);
        let above = (alpha + step).min(1.0_f64.max(alpha));
        color.map(|number| {
            let is_linear = match self.meaning.coding {
                Coding::Codes { curve, .. } => curve == Curve::Linear,
                Coding::Floats { .. } | Coding::SharedExponent => true,
            };
            if !self.meaning.is_premultiplied {
                let [light, light_above] = self.light(number);
                [light * alpha, light_above * above]
            } else if is_linear || alpha == 0.0 {
                self.light(number)
            } else {
                // The file multiplies codes, not light, by alpha.
                let [light, light_above] = light_of(self.meaning.coding, number / alpha);
                [light * alpha, light_above * above]
            }
        })
    }
}

/// The light of a number, and that of a number half a step above it.
fn light_of(coding: Coding, number: f64) -> [f64; 2] {
    match coding {
        Coding::Codes { curve, most } => {
            [0.0, 0.5].map(|offset| curve.light((number + offset) / most))
        }
        Coding::Floats { bits } => [number, number + 0.5 * step(number, bits)],
        Coding::SharedExponent => [number, number],
    }
}

/// The distance from a float with this number of bits to the next larger one.
fn step(number: f64, bits: u8) -> f64 {
    /// Bits of the mantissa of a half.
    const HALF_DIGITS: i32 = 10;
    /// The exponent of the smallest half that is not subnormal.
    const LEAST_HALF_EXPONENT: i32 = -14;
    let size = number.abs();
    if !size.is_finite() {
        return 0.0;
    }
    match bits {
        16 => {
            let exponent = libm::ilogb(size).max(LEAST_HALF_EXPONENT);
            libm::ldexp(1.0, exponent - HALF_DIGITS)
        }
        32 => {
            let float = size as f32;
            f64::from(float.next_up()) - f64::from(float)
        }
        // Doubles store the computed values without rounding.
        _ => 0.0,
    }
}

/// The step of a pixel of a Radiance picture: 1/256 of the power of two above its largest color.
fn shared_step(color: [f64; 3]) -> f64 {
    const DIGITS: i32 = 8;
    let largest = color.into_iter().fold(0.0, f64::max);
    if largest > 0.0 && largest.is_finite() {
        libm::ldexp(1.0, libm::ilogb(largest) + 1 - DIGITS)
    } else {
        0.0
    }
}

impl Samples for Numbers {
    fn advance(&mut self) -> Result<(), String> {
        self.rows.next(&mut self.row)
    }

    fn rgba(&self, col: u32) -> [f64; 4] {
        let [red, green, blue] = self.colors(col).map(|[light, _]| light);
        let [alpha, _] = self.alpha(self.numbers(col).1);
        [red, green, blue, alpha]
    }

    fn rounding(&self, col: u32) -> [f64; 4] {
        let (color, alpha) = self.numbers(col);
        let [_, step] = self.alpha(alpha);
        let [red, green, blue] = match self.meaning.coding {
            // Many programs truncate instead of rounding.
            Coding::SharedExponent => [shared_step(color); 3],
            _ => self.colors(col).map(|[light, above]| above - light),
        };
        [red, green, blue, step]
    }

    fn is_full(&self, col: u32) -> [bool; 4] {
        /// The largest half.
        const LARGEST_HALF: f64 = 65504.0;
        let most = match self.meaning.coding {
            Coding::Codes { most, .. } => most,
            Coding::Floats { bits: 16 } => LARGEST_HALF,
            Coding::Floats { bits: 32 } => f32::MAX.into(),
            Coding::Floats { .. } | Coding::SharedExponent => f64::MAX,
        };
        let ([red, green, blue], alpha) = self.numbers(col);
        [red, green, blue, alpha.unwrap_or(most)].map(|number| number == most)
    }
}
