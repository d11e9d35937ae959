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
use crate::formats::{animation, frame_rate};

/// The longest time in seconds for which a picture can be shown. The numerator and the denominator have 16 bits.
pub(in crate::formats) const MOST_SECONDS: f64 = u16::MAX as f64;

/// A file that is being written.
pub(crate) struct Animation<W: Write> {
    writer: Writer<BufWriter<W>>,
    /// The samples of one picture.
    samples: Vec<u8>,
}

impl<W: Write + Seek> Animation<W> {
    /// Begins a file with this number of pictures, which are shown at this rate in frames per second.
    pub(crate) fn begin(file: W, shape: Shape, frames: u32, rate: f64) -> Result<Self, Fault> {
        const FOR_EVER: u32 = 0;
        let bytes = shape.row_bytes() * shape.size.height as usize;
        let samples = memory::reserve(bytes).map_err(Fault::Encoding)?;
        let file = BufWriter::with_capacity(CHUNK_BYTES, file);
        // Such files are sent about, and small ones are worth some time.
        let mut encoder = encoder(file, shape, Compression::Balanced)?;
        encoder.set_animated(frames, FOR_EVER)?;
        let (seconds, parts) = delay(rate);
        encoder.set_frame_delay(seconds, parts)?;
        encoder.validate_sequence(true);
        let writer = encoder.write_header()?;
        Ok(Self { writer, samples })
    }
}

impl<W: Write + Seek> animation::Animation for Animation<W> {
    fn add_samples(&mut self, samples: &[u8]) -> Result<(), Fault> {
        self.samples.extend_from_slice(samples);
        Ok(())
    }

    fn end_frame(&mut self) -> Result<(), Fault> {
        self.writer.write_image_data(&self.samples)?;
        self.samples.clear();
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), Fault> {
        Ok(self.writer.finish()?)
    }
}

/// The time for which a picture is shown, as a fraction of seconds.
fn delay(rate: f64) -> (u16, u16) {
    /// The denominator if the fraction is too large for the format.
    const FINE: u16 = 60_000;
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
        assert_eq!(delay(24.0), (1, 24));
        assert_eq!(delay(30.0), (1, 30));
        assert_eq!(delay(12.5), (2, 25));
        assert_eq!(delay(29.97), (1001, 30_000));
        assert_eq!(delay(0.25), (4, 1));
        // What the format has no room for.
        assert_eq!(delay(119.88), (501, 60_000));
        assert_eq!(delay(1e9), (1, 60_000));
        assert_eq!(delay(1e-9), (65_535, 1));
    }
}
