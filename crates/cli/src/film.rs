//! What a picture goes through while it is rendered: strips become pieces of a file, and what they
//! achieved is gathered.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use marbles_core::{Image, Sink, Strip, Summary};

use crate::belt::{Belt, Closing};
use crate::output::Coder;

/// A picture that is being rendered.
pub(crate) struct Film<'a> {
    coder: &'a Coder,
    belt: &'a Belt,
    /// The number of the picture's first piece on the belt.
    first: u64,
    gathered: Mutex<Gathered>,
    /// How long threads did something else than rendering, in nanoseconds, all together.
    aside: AtomicU64,
}

/// What a picture, or a part of one, achieved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Gathered {
    /// `None` where there is no pixel yet.
    pub(crate) summary: Option<Summary>,
    /// Of the pixels that did not meet the tolerance.
    pub(crate) worst: Option<Worst>,
    /// How many finite numbers were too large for the file's.
    pub(crate) clipped: u64,
}

/// The pixel with the largest error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Worst {
    pub(crate) col: u32,
    pub(crate) row: u32,
    pub(crate) error: f64,
}

/// A strip that is being rendered.
struct FilmStrip<'a> {
    film: &'a Film<'a>,
    index: u32,
    samples: Vec<u8>,
    gathered: Gathered,
    /// Without this strip nobody need wait for those below.
    closing: Closing<'a>,
}

impl<'a> Film<'a> {
    pub(crate) fn new(coder: &'a Coder, belt: &'a Belt, first: u64) -> Self {
        Self {
            coder,
            belt,
            first,
            gathered: Mutex::default(),
            aside: AtomicU64::new(0),
        }
    }

    /// What the whole achieved, and how long each of so many threads did something else than
    /// rendering, on average.
    pub(crate) fn finish(self, threads: usize) -> (Gathered, Duration) {
        let gathered = self.gathered.into_inner();
        let aside = self.aside.into_inner() / threads as u64;
        let gathered = gathered.unwrap_or_else(PoisonError::into_inner);
        (gathered, Duration::from_nanos(aside))
    }

    /// Does what is no rendering.
    fn apart<T>(&self, work: impl FnOnce() -> T) -> T {
        let started = Instant::now();
        let done = work();
        let nanoseconds = started.elapsed().as_nanos() as u64;
        self.aside.fetch_add(nanoseconds, Ordering::Relaxed);
        done
    }
}

impl Sink for Film<'_> {
    fn bands(&self) -> u32 {
        self.coder.bands()
    }

    fn begin(&self, index: u32) -> Option<Box<dyn Strip + '_>> {
        self.apart(|| {
            let mut samples = self.belt.admit(self.first + u64::from(index))?;
            samples.resize(self.coder.sample_bytes(index), 0);
            Some(Box::new(FilmStrip {
                film: self,
                index,
                samples,
                gathered: Gathered::default(),
                closing: self.belt.closing(),
            }) as Box<dyn Strip>)
        })
    }
}

impl Strip for FilmStrip<'_> {
    fn add(&mut self, col: u32, part: &Image) {
        let coder = self.film.coder;
        self.film.apart(|| {
            let rows = 0..part.height();
            let clipped = coder.encode(&mut self.samples, col, part, rows);
            let (first_col, first_row) = coder.origin();
            let place = (first_col + col, first_row + self.index * coder.rows());
            self.gathered.add(&Gathered::of(part, place, clipped));
        });
    }

    fn end(self: Box<Self>) {
        let Self {
            film,
            index,
            samples,
            gathered,
            closing,
        } = *self;
        film.apart(|| {
            let piece = film.coder.piece(index, samples);
            film.belt.put(film.first + u64::from(index), piece);
            closing.keep_open();
            let whole = film.gathered.lock();
            whole.unwrap_or_else(PoisonError::into_inner).add(&gathered);
        });
    }
}

impl Gathered {
    /// What the part of a picture achieved whose first pixel is (`col`, `row`).
    fn of(part: &Image, (col, row): (u32, u32), clipped: u64) -> Self {
        let summary = part.summary();
        let mut worst = None;
        if summary.over_tolerance > 0 {
            let pixels = (0..part.height()).flat_map(|r| (0..part.width()).map(move |c| (c, r)));
            let missed = pixels.filter(|&(c, r)| part.status(c, r).is_over_tolerance());
            worst = missed.fold(None, |worst, (c, r)| {
                let error = part.error(c, r);
                let (col, row) = (col + c, row + r);
                Worst::of(worst, Some(Worst { col, row, error }))
            });
        }
        Self {
            summary: Some(summary),
            worst,
            clipped,
        }
    }

    fn add(&mut self, other: &Self) {
        self.summary = match (self.summary, &other.summary) {
            (Some(one), Some(other)) => Some(one.and(other)),
            (one, other) => one.or(*other),
        };
        self.worst = Worst::of(self.worst, other.worst);
        self.clipped += other.clipped;
    }
}

impl Worst {
    /// The worse of two; of equals the one that is further down, or else to the right.
    fn of(one: Option<Self>, other: Option<Self>) -> Option<Self> {
        let (Some(first), Some(second)) = (one, other) else {
            return one.or(other);
        };
        let place = |pixel: &Self| (pixel.row, pixel.col);
        let order = first.error.total_cmp(&second.error);
        let order = order.then_with(|| place(&first).cmp(&place(&second)));
        if order.is_gt() { one } else { other }
    }
}

#[cfg(test)]
mod tests {
    use marbles_core::Channels;

    use super::*;
    use crate::memory::Form;
    use crate::output::{Encoding, PngOptions};

    #[test]
    fn a_strip_that_is_given_up_leaves_nobody_waiting() {
        let form = Form {
            width: 3,
            height: 90,
            channels: Channels::Grey,
            alpha: false,
            part: None,
        };
        let (deep, rgb) = (false, false);
        let coder = Coder::new(Encoding::Png(PngOptions { deep, rgb }), form);
        let belt = Belt::new(2);
        let film = Film::new(&coder, &belt, 0);
        let [first, second] = [0, 1].map(|index| film.begin(index).unwrap());
        second.end();
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| film.begin(2).is_none());
            drop(first);
            assert!(waiting.join().unwrap());
        });
        assert!(belt.take().is_none());
    }

    #[test]
    fn the_worst_pixel_does_not_depend_on_the_order_of_strips() {
        let pixel = |col, row, error| Gathered {
            worst: Some(Worst { col, row, error }),
            clipped: 1,
            ..Gathered::default()
        };
        let parts = [
            pixel(9, 0, 2e-3),
            pixel(3, 4, 5e-3),
            pixel(1, 5, 5e-3),
            Gathered::default(),
            pixel(0, 5, 5e-3),
        ];
        for first in 0..parts.len() {
            let mut sum = Gathered::default();
            for step in 0..parts.len() {
                sum.add(&parts[(first + 2 * step) % parts.len()]);
            }
            assert_eq!(
                sum,
                Gathered {
                    clipped: 4,
                    ..parts[2]
                }
            );
        }
    }
}
