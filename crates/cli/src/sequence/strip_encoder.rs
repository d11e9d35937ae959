//! The encoders of strips: rendered strips become pieces of a file, and their results are combined.

use std::mem;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

use marbles_core::{Geometry, Image, Sink, Strip};

use super::clock::Clock;
use super::reorder_buffer::{ReorderBuffer, Slot};
use super::results::Results;
use crate::formats::encoder::Encoder;

/// The encoder of a picture, which provides one encoder for each layer of each strip.
pub(super) struct PictureEncoder<'a> {
    encoder: &'a Encoder,
    buffer: &'a ReorderBuffer,
    /// The number of the picture's first piece in the buffer.
    first: u64,
    results: Mutex<Results>,
    /// The number of strips that have not ended.
    left: AtomicU32,
    started: Instant,
    /// The time that all threads together spent on work other than rendering, in nanoseconds.
    aside: AtomicU64,
    clock: &'a Clock,
    finished: Sender<Finished>,
}

/// A picture whose strips have all been rendered.
#[derive(Clone, Copy, Debug)]
pub(super) struct Finished {
    pub(super) results: Results,
    /// The rendering time.
    pub(super) time: Duration,
}

/// The encoder of one layer of a picture: of the picture itself, or of an additional layer.
pub(super) struct LayerEncoder<'a, 'p> {
    picture: &'p PictureEncoder<'a>,
    layer: usize,
    open: &'p OpenStrip<'a>,
}

/// The strip that a thread renders. The thread begins and ends all of its layers one after the other.
pub(super) type OpenStrip<'a> = Mutex<Weak<SharedStrip<'a>>>;

/// A strip that is being rendered, with all its layers.
pub(super) struct SharedStrip<'a> {
    index: u32,
    state: Mutex<StripState<'a>>,
}

struct StripState<'a> {
    samples: Vec<u8>,
    results: Results,
    slot: Option<Slot<'a>>,
    /// The number of layers that have not ended.
    left: usize,
}

/// The encoder of a layer of an open strip.
struct StripEncoder<'a, 'p> {
    picture: &'p PictureEncoder<'a>,
    layer: usize,
    strip: Arc<SharedStrip<'a>>,
}

impl<'a> PictureEncoder<'a> {
    /// The encoder of a picture. Its pieces go to the buffer, with numbers from `first`; its results go to `finished`.
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

    /// The encoders of the picture's layers for a thread, which renders the strip in `open`.
    pub(super) fn layers<'p>(
        &'p self,
        open: &'p OpenStrip<'a>,
    ) -> impl Iterator<Item = LayerEncoder<'a, 'p>> {
        (0..self.encoder.layers()).map(move |layer| LayerEncoder {
            picture: self,
            layer,
            open,
        })
    }

    /// Begins a strip; `None` if it is not needed.
    fn begin(&self, index: u32) -> Option<SharedStrip<'a>> {
        let slot = self.buffer.admit(self.first + u64::from(index))?;
        let state = StripState {
            samples: vec![0; self.encoder.sample_bytes(index)],
            results: Results::default(),
            slot: Some(slot),
            left: self.encoder.layers(),
        };
        Some(SharedStrip {
            index,
            state: Mutex::new(state),
        })
    }

    /// Ends the picture after all of its strips.
    fn finish(&self) {
        let results = *self.results.lock().unwrap_or_else(PoisonError::into_inner);
        let aside = Duration::from_nanos(self.aside.load(Ordering::Relaxed));
        let time = self.clock.stop(self.started, aside);
        // The writer has gone on if it could not write.
        let _ = self.finished.send(Finished { results, time });
    }

    /// Does work other than rendering, and measures its time.
    fn apart<T>(&self, work: impl FnOnce() -> T) -> T {
        let started = Instant::now();
        let done = work();
        let nanoseconds = started.elapsed().as_nanos() as u64;
        self.aside.fetch_add(nanoseconds, Ordering::Relaxed);
        done
    }
}

impl Sink for LayerEncoder<'_, '_> {
    fn begin(&self, index: u32) -> Option<Box<dyn Strip + '_>> {
        let Self {
            picture,
            layer,
            open,
        } = *self;
        picture.apart(|| {
            let mut open = open.lock().unwrap_or_else(PoisonError::into_inner);
            let strip = match layer {
                0 => Arc::new(picture.begin(index)?),
                _ => open.upgrade()?,
            };
            *open = Arc::downgrade(&strip);
            Some(Box::new(StripEncoder {
                picture,
                layer,
                strip,
            }) as Box<dyn Strip>)
        })
    }
}

impl Strip for StripEncoder<'_, '_> {
    fn add(&mut self, col: u32, part: &Image) {
        let encoder = self.picture.encoder;
        self.picture.apart(|| {
            let mut state = self.strip.lock();
            let rows = 0..part.height();
            let clipped = encoder.encode(self.layer, &mut state.samples, col, part, rows);
            let window = encoder.form.region.window;
            let first_row = window.row + self.strip.index * encoder.rows();
            let place = (window.col + col, first_row);
            state.results.add(&Results::of(part, place, clipped));
        });
    }

    fn add_geometry(&mut self, col: u32, part: &Geometry) {
        let encoder = self.picture.encoder;
        self.picture
            .apart(|| encoder.encode_geometry(&mut self.strip.lock().samples, col, part));
    }

    fn end(self: Box<Self>) {
        let Self { picture, strip, .. } = *self;
        let is_complete = picture.apart(|| {
            let mut state = strip.lock();
            state.left -= 1;
            if state.left > 0 {
                return false;
            }
            let samples = mem::take(&mut state.samples);
            if let Some(slot) = state.slot.take() {
                slot.put(picture.encoder.piece(strip.index, samples));
            }
            let whole = picture.results.lock();
            let mut whole = whole.unwrap_or_else(PoisonError::into_inner);
            whole.add(&state.results);
            true
        });
        if is_complete && picture.left.fetch_sub(1, Ordering::AcqRel) == 1 {
            picture.finish();
        }
    }
}

impl<'a> SharedStrip<'a> {
    fn lock(&self) -> MutexGuard<'_, StripState<'a>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests;
