//! The sRGB transfer curve: codes rounded to the nearest, and back.
//!
//! Source: IEC 61966-2-1. NaN and negative light are black, light above 1 is white.

use std::sync::LazyLock;

/// Mantissa bits, beside the exponent, by which the table of [`Encoder`] is indexed.
///
/// With 7 of them a cell is never wider than the way between two thresholds.
const INDEX_BITS: u32 = 7;
const CELL_SHIFT: u32 = f64::MANTISSA_DIGITS - 1 - INDEX_BITS;

/// Returns the 8 bit code nearest to the sRGB value of linear light.
///
/// # Accuracy
/// The nearest code, except that light within 3 units in the last place of the middle between two
/// codes may go either way; `every_threshold_is_exact_to_a_few_units` settles that in whole
/// numbers.
pub fn encode_8(linear: f64) -> u8 {
    encoder_8().encode(linear)
}

/// Encodes many numbers as [`encode_8`] does.
pub fn encode_all_8(linear: &[f64], codes: &mut [u8]) {
    let encoder = encoder_8();
    for (code, &linear) in codes.iter_mut().zip(linear) {
        *code = encoder.encode(linear);
    }
}

fn encoder_8() -> &'static Encoder {
    static ENCODER: LazyLock<Encoder> = LazyLock::new(Encoder::new);
    &ENCODER
}

/// Returns the 16 bit code nearest to the sRGB value of linear light.
pub fn encode_16(linear: f64) -> u16 {
    // The cast saturates, and takes NaN to 0.
    (encode(linear) * f64::from(u16::MAX) + 0.5) as u16
}

/// The sRGB value of linear light, from 0 to 1 both.
fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    }
}

/// Returns the linear light of an sRGB value from 0 to 1; the curve goes on above 1.
pub fn decode(encoded: f64) -> f64 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        libm::pow((encoded + 0.055) / 1.055, 2.4)
    }
}

/// The linear light in the middle between an 8 bit code and the one before.
///
/// The fractions are those of the curve, in whole numbers: every one costs a single rounding.
fn threshold(code: u8) -> f64 {
    // 0.04045, where the straight part ends, lies between codes 10 and 11.
    const LAST_STRAIGHT: u8 = 10;
    let middle = 2.0 * f64::from(code) - 1.0; // over 510
    if code <= LAST_STRAIGHT {
        10.0 * middle / 65892.0 // middle / 510 / 12.92
    } else {
        libm::pow((20.0 * middle + 561.0) / 10761.0, 2.4) // (middle / 510 + 0.055) / 1.055
    }
}

/// A way from linear light to 8 bit codes with one look into a table and one comparison.
struct Encoder {
    /// The least linear light of every code; code 0 needs none, and nothing reaches code 256.
    thresholds: [f64; 257],
    /// The start of the cell of `thresholds[1]`.
    least: f64,
    /// The code of the least light in every cell of equal exponent and leading mantissa bits,
    /// from the cell of `thresholds[1]` to that of 1.
    codes: Vec<u8>,
}

impl Encoder {
    fn new() -> Self {
        let mut thresholds = [f64::INFINITY; 257];
        thresholds[0] = f64::NEG_INFINITY;
        for code in 1..=u8::MAX {
            thresholds[usize::from(code)] = threshold(code);
        }
        let first_cell = cell(thresholds[1]);
        let codes = (first_cell..=cell(1.0))
            .map(|cell| {
                let least = f64::from_bits(cell << CELL_SHIFT);
                (thresholds.partition_point(|&threshold| threshold <= least) - 1) as u8
            })
            .collect();
        Self {
            thresholds,
            least: f64::from_bits(first_cell << CELL_SHIFT),
            codes,
        }
    }

    #[inline]
    fn encode(&self, linear: f64) -> u8 {
        // Which takes NaN to the least.
        let linear = linear.max(self.least).min(1.0);
        let code = self.codes[(cell(linear) - cell(self.least)) as usize];
        code + u8::from(linear >= self.thresholds[usize::from(code) + 1])
    }
}

/// The number of a positive value's cell; cells are numbered in the order of their values.
fn cell(value: f64) -> u64 {
    value.to_bits() >> CELL_SHIFT
}

#[cfg(test)]
mod tests;
