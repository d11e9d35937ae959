//! Reads TIFF files of other programs and of marbles as linear light, strip by strip.

use tiff::decoder::DecodingResult;
use tiff::tags::Tag;

use super::decoder::{Alpha, Opened, open};

use crate::base::failure::{lower, reason};
use crate::formats::guard::guarded;
use crate::formats::numbers::{Coding, Meaning, Numbers, RowSource};
use crate::formats::picture::{NOT_TURNED, ONE_PICTURE, Picture};
use crate::formats::png::curve::Curve;
use crate::formats::profile;
use crate::formats::source::Source;

/// The name of the format.
pub(crate) const NAME: &str = "TIFF";

/// A file that is being read.
struct Chunks {
    file: Opened,
    /// The chunks that contain the row, from the left.
    chunks: Vec<DecodingResult>,
    /// The number of the next row.
    next: u32,
}

/// The picture in a file.
pub(crate) fn begin(source: &Source) -> Result<Picture, String> {
    let mut file = open(source.open().map_err(|error| reason(&error))?)?;
    let profile = guarded(|| file.decoder.find_tag(Tag::IccProfile));
    let profile = profile.ok().flatten();
    let profile = profile.and_then(|profile| profile.into_u8_vec().ok());
    let is_linear = profile.as_deref().is_some_and(profile::is_linear);
    let mut warnings = Vec::new();
    let coding = if file.float {
        Coding::Floats { bits: file.bits }
    } else {
        let (curve, warning) = match &profile {
            _ if is_linear => (Curve::Linear, None),
            Some(_) => (Curve::Srgb, Some(Curve::IGNORED_PROFILE)),
            None if file.bits > 8 => (Curve::Srgb, Some(SRGB_ASSUMED)),
            None => (Curve::Srgb, None),
        };
        warnings.extend(warning);
        let most = f64::from(u32::MAX >> (32 - file.bits));
        Coding::Codes { curve, most }
    };
    if file.decoder.more_images() {
        warnings.push(ONE_PICTURE);
    }
    if file.is_turned {
        warnings.push(NOT_TURNED);
    }
    let meaning = Meaning {
        colors: file.colors,
        alpha: file.alpha != Alpha::None,
        is_premultiplied: file.alpha == Alpha::Associated,
        coding,
    };
    let kind = match coding {
        Coding::Codes { curve, .. } => format!("{} bit {}", file.bits, curve.name()),
        _ => format!("{} bit float", file.bits),
    };
    let size = file.size;
    let rows = Chunks {
        file,
        chunks: Vec::new(),
        next: 0,
    };
    Ok(Numbers::picture(
        NAME,
        &kind,
        size,
        meaning,
        warnings,
        Box::new(rows),
    ))
}

/// The warning about integers with more than 8 bits, for which many programs use linear codes.
const SRGB_ASSUMED: &str = "it does not say what its numbers mean: they are read as sRGB codes";

impl RowSource for Chunks {
    fn next(&mut self, row: &mut Vec<f64>) -> Result<(), String> {
        let Opened {
            decoder,
            size,
            colors,
            alpha,
            decoded,
            across,
            chunk,
            ..
        } = &mut self.file;
        let within = self.next % chunk.1;
        if within == 0 {
            let first = self.next / chunk.1 * *across;
            self.chunks.clear();
            for index in first..first + *across {
                let read = guarded(|| decoder.read_chunk(index));
                self.chunks.push(read.map_err(|error| lower(&error))?);
            }
        }
        self.next += 1;
        let used = *colors + usize::from(*alpha != Alpha::None);
        row.clear();
        for (numbers, index) in self.chunks.iter().zip(0..) {
            let columns = chunk.0.min(size.width - index * chunk.0) as usize;
            let start = within as usize * columns * *decoded;
            let places = (0..columns).flat_map(|col| {
                let first = start + col * *decoded;
                first..first + used
            });
            add(row, numbers, places)?;
        }
        Ok(())
    }
}

/// Adds the numbers at these positions.
fn add(
    row: &mut Vec<f64>,
    numbers: &DecodingResult,
    places: impl Iterator<Item = usize>,
) -> Result<(), String> {
    /// Adds all of them, or returns an error.
    fn of<T: Copy>(
        row: &mut Vec<f64>,
        numbers: &[T],
        mut places: impl Iterator<Item = usize>,
        value: impl Fn(T) -> f64,
    ) -> Result<(), String> {
        places.try_for_each(|place| {
            let number = numbers.get(place).ok_or("a strip ends early")?;
            row.push(value(*number));
            Ok(())
        })
    }
    match numbers {
        DecodingResult::U8(numbers) => of(row, numbers, places, f64::from),
        DecodingResult::U16(numbers) => of(row, numbers, places, f64::from),
        DecodingResult::U32(numbers) => of(row, numbers, places, f64::from),
        DecodingResult::F16(numbers) => of(row, numbers, places, |half| half.to_f64()),
        DecodingResult::F32(numbers) => of(row, numbers, places, f64::from),
        DecodingResult::F64(numbers) => of(row, numbers, places, |number| number),
        _ => Err("its numbers are of an unknown kind".to_owned()),
    }
}

#[cfg(test)]
mod tests;
