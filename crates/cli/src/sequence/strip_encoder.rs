//! What a picture goes through while it is rendered: strips become pieces of a file, and what they
//! achieved is gathered.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use marbles_core::{Image, Sink, Strip, Summary};

use crate::formats::Coder;
use crate::sequence::reorder_buffer::{Belt, Place};

/// A picture that is being rendered.
pub(crate) struct Film<'a> {
    coder: &'a Coder,
    belt: &'a Belt,
    /// The number of the picture's first piece on the belt.
    first: u64,
    gathered: Mutex<Gathered>,
    /// Strips that have not ended.
    left: AtomicU32,
    started: Instant,
    /// How long threads did something else than rendering, in nanoseconds, all together.
    aside: AtomicU64,
    clock: &'a Clock,
    ending: Sender<Ending>,
}

/// Tells how long each picture of a sequence took, though one begins while others end: the sum is
/// the time that went by.
#[derive(Debug)]
pub(crate) struct Clock {
    threads: usize,
    /// When a picture ended last.
    last: Mutex<Option<Instant>>,
}

/// A picture all of whose strips were rendered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ending {
    pub(crate) gathered: Gathered,
    /// What rendering it took.
    pub(crate) time: Duration,
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
    place: Place<'a>,
}

impl Clock {
    /// For pictures on so many threads.
    pub(crate) fn new(threads: usize) -> Self {
        Self {
            threads,
            last: Mutex::default(),
        }
    }

    /// A picture ends that was begun at some time: how long it took, after those that ended before.
    fn stop(&self, started: Instant, aside: Duration) -> Duration {
        let now = Instant::now();
        let last = self.last.lock();
        let last = last.unwrap_or_else(PoisonError::into_inner).replace(now);
        let since = last.map_or(started, |last| last.max(started));
        let each = aside / u32::try_from(self.threads).unwrap_or(u32::MAX);
        now.saturating_duration_since(since).saturating_sub(each)
    }
}

impl<'a> Film<'a> {
    /// A picture whose pieces go to the belt, from the number `first` on; how it ended goes to
    /// `ending`.
    pub(crate) fn new(
        coder: &'a Coder,
        belt: &'a Belt,
        first: u64,
        clock: &'a Clock,
        ending: Sender<Ending>,
    ) -> Self {
        Self {
            coder,
            belt,
            first,
            gathered: Mutex::default(),
            left: AtomicU32::new(coder.pieces()),
            started: Instant::now(),
            aside: AtomicU64::new(0),
            clock,
            ending,
        }
    }

    /// All strips have ended.
    fn end(&self) {
        let gathered = *self.gathered.lock().unwrap_or_else(PoisonError::into_inner);
        let aside = Duration::from_nanos(self.aside.load(Ordering::Relaxed));
        let time = self.clock.stop(self.started, aside);
        // The writer has gone on if it could not write.
        let _ = self.ending.send(Ending { gathered, time });
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
    fn begin(&self, index: u32) -> Option<Box<dyn Strip + '_>> {
        self.apart(|| {
            let (place, mut samples) = self.belt.admit(self.first + u64::from(index))?;
            samples.resize(self.coder.sample_bytes(index), 0);
            Some(Box::new(FilmStrip {
                film: self,
                index,
                samples,
                gathered: Gathered::default(),
                place,
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
            place,
        } = *self;
        film.apart(|| {
            place.put(film.coder.piece(index, samples));
            let whole = film.gathered.lock();
            whole.unwrap_or_else(PoisonError::into_inner).add(&gathered);
        });
        if film.left.fetch_sub(1, Ordering::AcqRel) == 1 {
            film.end();
        }
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
    use std::sync::mpsc::channel;

    use marbles_core::Channels;

    use super::*;
    use crate::base::memory::Form;
    use crate::formats::{Encoding, PngOptions};

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
        let (sender, ending) = channel();
        let clock = Clock::new(1);
        let film = Film::new(&coder, &belt, 0, &clock, sender);
        let [first, second] = [0, 1].map(|index| film.begin(index).unwrap());
        second.end();
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| film.begin(2).is_none());
            let closing = belt.closing();
            drop(first);
            assert!(belt.is_closed());
            std::mem::forget(closing);
            assert!(waiting.join().unwrap());
        });
        assert!(belt.take().is_none());
        assert!(ending.try_recv().is_err());
    }

    #[test]
    fn times_of_pictures_that_overlap_add_up() {
        let clock = Clock::new(2);
        let hour = Duration::from_secs(3600);
        let Some(started) = Instant::now().checked_sub(2 * hour) else {
            return;
        };
        // Two that began together: the second took what was left.
        assert!(clock.stop(started, Duration::ZERO) >= 2 * hour);
        assert!(clock.stop(started + hour, Duration::ZERO) < hour);
        let clock = Clock::new(2);
        let found = clock.stop(started, hour);
        assert!(found >= hour + hour / 2 && found < 2 * hour);
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
