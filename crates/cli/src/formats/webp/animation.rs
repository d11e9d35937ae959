//! Animated WebP: lossless pictures in one file, which are shown in a loop.
//!
//! Source: "WebP Container Specification", Google.

use std::io::{BufWriter, Seek, SeekFrom, Write};

use image::codecs::webp::WebPEncoder;
use image::{ExtendedColorType, ImageError};

use super::chunks::{HEADER_BYTES, bytes_of_24, write_header};
use crate::base::memory;
use crate::base::size::Size;
use crate::files::save::Fault;
use crate::formats::animation::{self, duration};
use crate::formats::png::shape::Shape;

/// The longest side of a picture.
const LONGEST_SIDE: u32 = 1 << 14;
/// Durations count thousandths of a second, and have 24 bits.
const UNITS: f64 = 1000.0;
const LONGEST: u32 = (1 << 24) - 1;
/// The shortest duration. Browsers show a picture with a duration of up to 10 for a tenth of a second.
const SHORTEST: u32 = 11;

/// The rate at which all pictures have the shortest duration.
pub(in crate::formats) const MOST_FRAMES_PER_SECOND: f64 = UNITS / SHORTEST as f64;
/// The longest duration, in seconds.
pub(in crate::formats) const MOST_SECONDS: f64 = LONGEST as f64 / UNITS;

/// The number of bytes that are written together.
const BUFFER_BYTES: usize = 1 << 18;
/// The bytes before the chunk of a still picture: `RIFF`, a length, `WEBP`.
const START_BYTES: usize = 12;
/// The largest length in the header of a file.
const LARGEST_LENGTH: u32 = u32::MAX - 9;

/// A file that is being written.
pub(in crate::formats) struct Animation<W: Write> {
    file: BufWriter<W>,
    size: Size,
    color_type: ExtendedColorType,
    rate: f64,
    is_still: bool,
    /// The samples of one picture.
    samples: Vec<u8>,
    /// The numbers of pictures and of bytes that have been written.
    frames: u32,
    bytes: u64,
}

impl<W: Write + Seek> Animation<W> {
    /// Begins a file with this number of pictures, which are shown at this rate. A single picture is a still.
    pub(in crate::formats) fn begin(
        file: W,
        shape: Shape,
        frames: u32,
        rate: f64,
    ) -> Result<Self, Fault> {
        let size = shape.size();
        if size.width.max(size.height) > LONGEST_SIDE {
            return Err(Fault::Encoding(format!(
                "a WebP has at most {LONGEST_SIDE} columns and rows"
            )));
        }
        let bytes = shape.row_bytes() * size.height as usize;
        let color_type = match shape.channels() {
            1 => ExtendedColorType::L8,
            2 => ExtendedColorType::La8,
            3 => ExtendedColorType::Rgb8,
            _ => ExtendedColorType::Rgba8,
        };
        let mut animation = Self {
            file: BufWriter::with_capacity(BUFFER_BYTES, file),
            size,
            color_type,
            rate,
            is_still: frames == 1,
            samples: memory::reserve(bytes).map_err(Fault::Encoding)?,
            frames: 0,
            bytes: 0,
        };
        if !animation.is_still {
            let has_alpha = shape.channels().is_multiple_of(2);
            animation.write_start(has_alpha)?;
        }
        Ok(animation)
    }

    /// Writes the bytes before the first picture. The length of the file is not known yet.
    fn write_start(&mut self, has_alpha: bool) -> Result<(), Fault> {
        const ANIMATED: u8 = 1 << 1;
        const ALPHA: u8 = 1 << 4;
        let mut start = Vec::new();
        write_header(&mut start, b"RIFF", 0)?;
        start.extend(b"WEBP");
        write_header(&mut start, b"VP8X", 10)?;
        start.extend([ANIMATED | if has_alpha { ALPHA } else { 0 }, 0, 0, 0]);
        start.extend(bytes_of_24(self.size.width - 1));
        start.extend(bytes_of_24(self.size.height - 1));
        write_header(&mut start, b"ANIM", 6)?;
        start.extend([0; 4]); // a background that is never visible
        start.extend([0; 2]); // forever
        self.add(&start)
    }

    /// Writes some bytes, unless the file would become too long.
    fn add(&mut self, bytes: &[u8]) -> Result<(), Fault> {
        let all = self.bytes + bytes.len() as u64;
        length(all)?;
        self.file.write_all(bytes)?;
        self.bytes = all;
        Ok(())
    }
}

/// The length in the header of a file with this number of bytes.
fn length(bytes: u64) -> Result<u32, Fault> {
    let length = u32::try_from(bytes.saturating_sub(HEADER_BYTES));
    let length = length.ok().filter(|length| *length <= LARGEST_LENGTH);
    length.ok_or_else(|| Fault::Encoding("a WebP has at most 4 GiB".to_owned()))
}

impl<W: Write + Seek> animation::Animation for Animation<W> {
    fn add_samples(&mut self, samples: &[u8]) -> Result<(), Fault> {
        self.samples.extend_from_slice(samples);
        Ok(())
    }

    fn end_frame(&mut self) -> Result<(), Fault> {
        let Size { width, height } = self.size;
        let mut still = Vec::new();
        let encoder = WebPEncoder::new_lossless(&mut still);
        let encoded = encoder.encode(&self.samples, width, height, self.color_type);
        encoded.map_err(|error| match error {
            ImageError::IoError(error) => Fault::Io(error),
            other => Fault::Encoding(other.to_string()),
        })?;
        self.samples.clear();
        if self.is_still {
            return self.add(&still);
        }
        /// The picture replaces the previous one, including its transparent pixels, and stays.
        const REPLACES: u8 = 1 << 1;
        let shown = duration(self.frames, self.rate, UNITS, SHORTEST).min(LONGEST);
        // The frame contains the chunk of the still picture.
        let picture = &still[START_BYTES..];
        let mut frame = Vec::new();
        write_header(&mut frame, b"ANMF", 16 + picture.len() as u32)?;
        frame.extend([0; 6]); // in the upper left corner
        for number in [width - 1, height - 1, shown] {
            frame.extend(bytes_of_24(number));
        }
        frame.push(REPLACES);
        self.frames += 1;
        self.add(&frame)?;
        self.add(picture)
    }

    fn finish(mut self: Box<Self>) -> Result<(), Fault> {
        if !self.is_still {
            let length = length(self.bytes)?;
            self.file.seek(SeekFrom::Start(4))?;
            self.file.write_all(&length.to_le_bytes())?;
        }
        Ok(self.file.flush()?)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use marbles_core::Channels;

    use super::animation::Animation as _;
    use super::*;
    use crate::base::region::Region;
    use crate::formats::form::Form;
    use crate::formats::tests::PNG;

    #[test]
    fn a_file_that_becomes_too_long_ends_with_the_frame_that_does_not_fit() {
        let size = Size {
            width: 2,
            height: 1,
        };
        let form = Form {
            region: Region::all(size),
            channels: Channels::Grey,
            alpha: false,
            centers: None,
        };
        let shape = Shape::of(&form, PNG);
        let samples = [0, 255];
        let mut file = Animation::begin(Cursor::new(Vec::new()), shape, 9, 24.0).unwrap();
        file.add_samples(&samples).unwrap();
        file.end_frame().unwrap();
        file.bytes = u64::from(LARGEST_LENGTH) + HEADER_BYTES;
        file.add_samples(&samples).unwrap();
        let Err(Fault::Encoding(reason)) = file.end_frame() else {
            panic!("expected a refusal");
        };
        assert_eq!(reason, "a WebP has at most 4 GiB");
    }
}
