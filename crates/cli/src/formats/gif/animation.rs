//! Writes GIF files. All pictures share one palette, so that parts that do not move keep their colors. Until the palette is
//! known, the pictures are kept in a temporary file.
//!
//! Source: "Graphics Interchange Format, Version 89a", CompuServe.

use std::io::{BufReader, BufWriter, Read, Seek, Write};

use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};

use super::dither::Dither;
use super::histogram::{Color, Histogram};
use super::palette::choose;
use crate::base::memory;
use crate::base::size::Size;
use crate::files::save::Fault;
use crate::files::temporary::TemporaryFile;
use crate::formats::animation::{self, duration};
use crate::formats::png::shape::Shape;

/// The number of colors.
const COLORS: usize = 256;
/// Durations count hundredths of a second.
const UNITS: f64 = 100.0;
/// The shortest duration. Browsers show a picture with a duration of 0 or 1 for a tenth of a second.
const SHORTEST: u32 = 2;
/// The smallest alpha of a pixel that is not transparent.
const HALF: u8 = 128;

/// The rate at which all pictures have the shortest duration.
pub(in crate::formats) const MOST_FRAMES_PER_SECOND: f64 = UNITS / SHORTEST as f64;
/// The longest duration, in seconds.
pub(in crate::formats) const MOST_SECONDS: f64 = u16::MAX as f64 / UNITS;

/// The number of bytes that are read or written together.
const BUFFER_BYTES: usize = 1 << 18;

/// A file that is being written.
pub(in crate::formats) struct Animation<W: Write> {
    file: W,
    /// The samples of all pictures.
    pictures: BufWriter<TemporaryFile>,
    shape: Shape,
    rate: f64,
    histogram: Histogram,
    frames: u32,
}

impl<W: Write> Animation<W> {
    /// Begins a file with pictures that are shown at this rate. They are kept in `pictures` until the palette is known.
    pub(in crate::formats) fn begin(
        file: W,
        pictures: TemporaryFile,
        shape: Shape,
        rate: f64,
    ) -> Result<Self, Fault> {
        let Size { width, height } = shape.size();
        if u16::try_from(width.max(height)).is_err() {
            return Err(Fault::Encoding(format!(
                "a GIF has at most {} columns and rows",
                u16::MAX
            )));
        }
        Ok(Self {
            file,
            pictures: BufWriter::with_capacity(BUFFER_BYTES, pictures),
            shape,
            rate,
            histogram: Histogram::new(colors(shape)),
            frames: 0,
        })
    }
}

/// The number of colors for pixels that are not transparent.
fn colors(shape: Shape) -> usize {
    if has_alpha(shape) { COLORS - 1 } else { COLORS }
}

fn has_alpha(shape: Shape) -> bool {
    shape.channels().is_multiple_of(2)
}

/// The color of a pixel, or `None` if it is transparent.
fn color(pixel: &[u8]) -> Option<Color> {
    match *pixel {
        [grey] => Some([grey; 3]),
        [grey, alpha] => (alpha >= HALF).then_some([grey; 3]),
        [red, green, blue] => Some([red, green, blue]),
        [red, green, blue, alpha, ..] => (alpha >= HALF).then_some([red, green, blue]),
        [] => None,
    }
}

impl<W: Write> animation::Animation for Animation<W> {
    fn add_samples(&mut self, samples: &[u8]) -> Result<(), Fault> {
        self.pictures.write_all(samples)?;
        // Many neighbors are equal.
        let mut run: Option<(Color, u64)> = None;
        for color in samples
            .chunks_exact(self.shape.channels())
            .filter_map(color)
        {
            match &mut run {
                Some((last, count)) if *last == color => *count += 1,
                _ => {
                    if let Some((color, count)) = run.replace((color, 1)) {
                        self.histogram.add(color, count);
                    }
                }
            }
        }
        if let Some((color, count)) = run {
            self.histogram.add(color, count);
        }
        Ok(())
    }

    fn end_frame(&mut self) -> Result<(), Fault> {
        self.frames += 1;
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), Fault> {
        let Self {
            file,
            pictures,
            shape,
            rate,
            histogram,
            frames,
        } = *self;
        let Size { width, height } = shape.size();
        let palette = choose(&histogram, colors(shape));
        let transparent = has_alpha(shape).then_some(palette.len() as u8);
        let mut table = palette.concat();
        if transparent.is_some() {
            table.extend([0; 3]);
        }
        let mut dither = Dither::new(&palette);

        let mut file = BufWriter::with_capacity(BUFFER_BYTES, file);
        let mut encoder = Encoder::new(&mut file, width as u16, height as u16, &table)?;
        if frames > 1 {
            encoder.set_repeat(Repeat::Infinite)?;
        }
        let mut pictures = pictures.into_inner().map_err(|error| error.into_error())?;
        pictures.rewind()?;
        let mut pictures = BufReader::with_capacity(BUFFER_BYTES, pictures);
        let mut row = memory::reserve(shape.row_bytes()).map_err(Fault::Encoding)?;
        row.resize(shape.row_bytes(), 0);
        for index in 0..frames {
            let pixels = width as usize * height as usize;
            let mut indices = memory::reserve(pixels).map_err(Fault::Encoding)?;
            for place in 0..height as usize {
                pictures.read_exact(&mut row)?;
                let pixels = row.chunks_exact(shape.channels()).enumerate();
                indices.extend(
                    pixels.map(|(col, pixel)| match (color(pixel), transparent) {
                        (None, Some(transparent)) => transparent,
                        (color, _) => dither.index(color.unwrap_or_default(), col, place),
                    }),
                );
            }
            let shown = match frames {
                1 => 0,
                _ => duration(index, rate, UNITS, SHORTEST),
            };
            encoder.write_frame(&Frame {
                delay: u16::try_from(shown).unwrap_or(u16::MAX),
                // Transparent pixels must not show the previous picture.
                dispose: match transparent {
                    Some(_) => DisposalMethod::Background,
                    None => DisposalMethod::Keep,
                },
                transparent,
                width: width as u16,
                height: height as u16,
                buffer: indices.into(),
                ..Frame::default()
            })?;
        }
        encoder.into_inner()?.flush()?;
        Ok(())
    }
}

impl From<EncodingError> for Fault {
    fn from(error: EncodingError) -> Self {
        match error {
            EncodingError::Io(error) => Self::Io(error),
            other => Self::Encoding(other.to_string()),
        }
    }
}
