//! The encoders of strips: what is rendered becomes pieces of a file, and its results are summed up.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use marbles_core::{Geometry, Image, Sink, Strip};

use super::clock::Clock;
use super::reorder_buffer::{ReorderBuffer, Slot};
use super::results::Results;
use crate::formats::encoder::Encoder;

/// The encoder of a picture, which hands out one for each strip.
pub(super) struct PictureEncoder<'a> {
    encoder: &'a Encoder,
    buffer: &'a ReorderBuffer,
    /// The number of the picture's first piece in the buffer.
    first: u64,
    results: Mutex<Results>,
    /// Strips that have not ended.
    left: AtomicU32,
    started: Instant,
    /// The time that threads spent on something else than rendering, in nanoseconds, all together.
    aside: AtomicU64,
    clock: &'a Clock,
    finished: Sender<Finished>,
}

/// A picture all of whose strips were rendered.
#[derive(Clone, Copy, Debug)]
pub(super) struct Finished {
    pub(super) results: Results,
    /// The time that rendering it took.
    pub(super) time: Duration,
}

/// The encoder of a strip that is being rendered.
struct StripEncoder<'a> {
    picture: &'a PictureEncoder<'a>,
    index: u32,
    samples: Vec<u8>,
    results: Results,
    slot: Slot<'a>,
}

impl<'a> PictureEncoder<'a> {
    /// The encoder of a picture whose pieces go to the buffer, from the number `first` on; its results
    /// go to `finished`.
    pub(super) fn new(
        encoder: &'a Encoder,
        buffer: &'a ReorderBuffer,
        first: u64,
        clock: &'a Clock,
        finished: Sender<Finished>,
    ) -> Self {
        Self {
            encoder,
            buffer,
            first,
            results: Mutex::default(),
            left: AtomicU32::new(encoder.pieces()),
            started: Instant::now(),
            aside: AtomicU64::new(0),
            clock,
            finished,
        }
    }

    /// Ends the picture, all of whose strips have ended.
    fn finish(&self) {
        let results = *self.results.lock().unwrap_or_else(PoisonError::into_inner);
        let aside = Duration::from_nanos(self.aside.load(Ordering::Relaxed));
        let time = self.clock.stop(self.started, aside);
        // The writer has gone on if it could not write.
        let _ = self.finished.send(Finished { results, time });
    }

    /// Does something else than rendering.
    fn apart<T>(&self, work: impl FnOnce() -> T) -> T {
        let started = Instant::now();
        let done = work();
        let nanoseconds = started.elapsed().as_nanos() as u64;
        self.aside.fetch_add(nanoseconds, Ordering::Relaxed);
        done
    }
}

impl Sink for PictureEncoder<'_> {
    fn begin(&self, index: u32) -> Option<Box<dyn Strip + '_>> {
        self.apart(|| {
            Some(Box::new(StripEncoder {
                picture: self,
                index,
                slot: self.buffer.admit(self.first + u64::from(index))?,
                samples: vec![0; self.encoder.sample_bytes(index)],
                results: Results::default(),
            }) as Box<dyn Strip>)
        })
    }
}

impl Strip for StripEncoder<'_> {
    fn add(&mut self, col: u32, part: &Image) {
        let encoder = self.picture.encoder;
        self.picture.apart(|| {
            let rows = 0..part.height();
            let clipped = encoder.encode(&mut self.samples, col, part, rows);
            let window = encoder.form.region.window;
            let first_row = window.row + self.index * encoder.rows();
            let place = (window.col + col, first_row);
            self.results.add(&Results::of(part, place, clipped));
        });
    }

    fn add_geometry(&mut self, col: u32, part: &Geometry) {
        let encoder = self.picture.encoder;
        self.picture
            .apart(|| encoder.encode_geometry(&mut self.samples, col, part));
    }

    fn end(self: Box<Self>) {
        let Self {
            picture,
            index,
            samples,
            results,
            slot,
        } = *self;
        picture.apart(|| {
            slot.put(picture.encoder.piece(index, samples));
            let whole = picture.results.lock();
            whole.unwrap_or_else(PoisonError::into_inner).add(&results);
        });
        if picture.left.fetch_sub(1, Ordering::AcqRel) == 1 {
            picture.finish();
        }
    }
}

#[cfg(test)]
mod tests;
