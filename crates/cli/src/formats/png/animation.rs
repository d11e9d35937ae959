//! Animated PNG: pictures in one file, which are shown in a loop.
//!
//! The `png` crate cannot write the rows of an animation one by one. So one picture is in memory, both as samples and
//! compressed.
//!
//! Source: "Portable Network Graphics (PNG) Specification (Third Edition)", W3C.

use std::io::{BufWriter, Seek, Write};

use png::{Compression, Writer};

use super::shape::Shape;
use super::write::{CHUNK_BYTES, encoder};
use crate::base::memory;
use crate::files::save::Fault;
use crate::formats::frame_rate;

/// Frames per second if the rate is unknown, as in scene files.
const FRAMES_PER_SECOND: f64 = 24.0;

/// A file that is being written.
pub(crate) struct Animation<W: Write> {
    writer: Writer<BufWriter<W>>,
    /// The samples of one picture.
    samples: Vec<u8>,
}

impl<W: Write + Seek> Animation<W> {
    /// Begins a file with this number of pictures, each of which is shown for `delay`.
    pub(crate) fn begin(
        file: W,
        shape: Shape,
        frames: u32,
        delay: (u16, u16),
    ) -> Result<Self, Fault> {
        const FOR_EVER: u32 = 0;
        let bytes = shape.row_bytes() * shape.size.height as usize;
        let samples = memory::reserve(bytes).map_err(Fault::Encoding)?;
        let file = BufWriter::with_capacity(CHUNK_BYTES, file);
        // Such files are sent about, and small ones are worth some time.
        let mut encoder = encoder(file, shape, Compression::Balanced)?;
        encoder.set_animated(frames, FOR_EVER)?;
        encoder.set_frame_delay(delay.0, delay.1)?;
        encoder.validate_sequence(true);
        let writer = encoder.write_header()?;
        Ok(Self { writer, samples })
    }

    /// Adds rows of the picture, from the top.
    pub(crate) fn add_samples(&mut self, samples: &[u8]) {
        self.samples.extend_from_slice(samples);
    }

    /// Writes the picture when all of its rows have been added.
    pub(crate) fn end_frame(&mut self) -> Result<(), Fault> {
        self.writer.write_image_data(&self.samples)?;
        self.samples.clear();
        Ok(())
    }

    /// Ends the file.
    pub(crate) fn finish(self) -> Result<(), Fault> {
        Ok(self.writer.finish()?)
    }
}

/// The time for which a picture is shown, as a fraction of seconds.
pub(crate) fn delay(frames_per_second: Option<f64>) -> (u16, u16) {
    /// The denominator if the fraction is too large for the format.
    const FINE: u16 = 60_000;
    let rate = frames_per_second.unwrap_or(FRAMES_PER_SECOND);
    let exact = frame_rate::nearest(rate).and_then(|(frames, seconds)| {
        Some((u16::try_from(seconds).ok()?, u16::try_from(frames).ok()?))
    });
    exact.unwrap_or_else(|| {
        // The casts saturate.
        if rate >= 1.0 {
            (((f64::from(FINE) / rate).round() as u16).max(1), FINE)
        } else {
            ((1.0 / rate).round() as u16, 1)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delays_are_what_frames_take() {
        assert_eq!(delay(None), (1, 24));
        assert_eq!(delay(Some(30.0)), (1, 30));
        assert_eq!(delay(Some(12.5)), (2, 25));
        assert_eq!(delay(Some(29.97)), (1001, 30_000));
        assert_eq!(delay(Some(0.25)), (4, 1));
        // What the format has no room for.
        assert_eq!(delay(Some(119.88)), (501, 60_000));
        assert_eq!(delay(Some(1e9)), (1, 60_000));
        assert_eq!(delay(Some(1e-9)), (65_535, 1));
    }
}
