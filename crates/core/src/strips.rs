//! A picture strip by strip, for those that need not have it as a whole.

use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use crate::image::Form;
use crate::integration::Integrator;
use crate::render;
use crate::{Cancelled, Exposure, Image, Radiance, Renderer, Settings, Tile, View, Work};

/// Rows of a band; a strip is a number of bands.
pub const BAND_ROWS: u32 = Tile::SIDE;

/// Columns of a strip that are rendered before they go to the sink: so few that what a thread
/// writes stays near it, however wide a picture is.
const PART_COLUMNS: u32 = 1024;

/// A rectangle of a picture's pixels.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Window {
    /// Its first column.
    pub col: u32,
    /// Its first row.
    pub row: u32,
    /// Number of columns, at least 1.
    pub width: u32,
    /// Number of rows, at least 1.
    pub height: u32,
}

impl Window {
    /// The whole of a picture.
    pub fn whole(view: &View) -> Self {
        Self {
            col: 0,
            row: 0,
            width: view.width,
            height: view.height,
        }
    }
}

/// Where a picture, or a window of one, goes while it is rendered.
///
/// Strips are rows side by side, from edge to edge. Several threads work at once, each on a strip
/// of its own. Columns and strips are counted from the window's first.
pub trait Sink: Sync {
    /// How many bands of [`BAND_ROWS`] rows a strip has, at least 1; the last one may have fewer rows.
    fn bands(&self) -> u32;

    /// The strip with this index, counted from the top, is about to be rendered. `None` ends the
    /// rendering.
    ///
    /// May wait until the strips above are done, but not for those below.
    fn begin(&self, index: u32) -> Option<Box<dyn Strip + '_>>;
}

/// A strip that is being rendered; dropped before its end where the rendering is cancelled.
pub trait Strip {
    /// Some columns are rendered, `col` the first of them, from left to right: all of the picture
    /// `part`.
    fn add(&mut self, col: u32, part: &Image);

    /// All columns were added.
    fn end(self: Box<Self>);
}

impl Renderer<'_> {
    /// Renders a window of a picture strip by strip, each of which goes to `sink` as soon as a thread
    /// has rendered it, so that a picture of any height needs little memory; what it cost.
    ///
    /// The pixels are those of [`Self::render`], and so is `progress`, but that it counts all pixels
    /// of the tiles that the window cuts through: tiles stay where they are and are rendered as
    /// a whole, since it is in a tile that pixels find out what they may see. Strips are begun from
    /// the top downward, each by one of the threads of the current rayon pool, and end as they come.
    /// Where they begin in the middle of a band, that is rendered for each of the two.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` broke or `sink` wants no more.
    ///
    /// # Panics
    /// When the window is not inside the picture.
    pub fn render_strips<'motion>(
        &self,
        exposure: impl Into<Exposure<'motion>>,
        window: Window,
        settings: &Settings,
        sink: &dyn Sink,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Work, Cancelled> {
        self.strips(&exposure.into(), window, settings, sink, progress)
    }

    /// What [`Self::render_strips`] does: not generic, so that integrators are compiled here, once.
    fn strips(
        &self,
        exposure: &Exposure<'_>,
        window: Window,
        settings: &Settings,
        sink: &dyn Sink,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Work, Cancelled> {
        let view = exposure.view();
        let is_inside = |first: u32, length: u32, all: u32| {
            first.checked_add(length).is_some_and(|end| end <= all)
        };
        assert!(
            is_inside(window.col, window.width, view.width)
                && is_inside(window.row, window.height, view.height),
            "{window:?} is outside"
        );
        let job = Job {
            window,
            sink,
            progress,
        };
        self.run(exposure, settings, job)
    }
}

/// All strips of a window.
struct Job<'a> {
    window: Window,
    // Not generic, so that integrators are compiled here, once.
    sink: &'a dyn Sink,
    progress: &'a (dyn Fn(u64) -> ControlFlow<()> + Sync),
}

impl render::Job for Job<'_> {
    type Output = Work;

    fn run<C: Radiance, I: Integrator<C>>(
        self,
        form: Form,
        integrator: &I,
    ) -> Result<Work, Cancelled> {
        let strips = Strips {
            job: self,
            form,
            next: AtomicU32::new(0),
            is_cancelled: AtomicBool::new(false),
        };
        let mut sum = Work::default();
        for work in rayon::broadcast(|_| strips.render_some(integrator)) {
            sum += work?;
        }
        Ok(sum)
    }
}

/// What the threads share.
struct Strips<'a> {
    job: Job<'a>,
    form: Form,
    /// The index of the strip that nobody has begun.
    next: AtomicU32,
    is_cancelled: AtomicBool,
}

impl Strips<'_> {
    /// Renders strips that nobody else does until there are no more.
    fn render_some<C: Radiance, I: Integrator<C>>(
        &self,
        integrator: &I,
    ) -> Result<Work, Cancelled> {
        let (picture_width, picture_height) = self.form.size;
        let window = self.job.window;
        let rows = self.job.sink.bands().max(1).saturating_mul(BAND_ROWS);
        let columns = whole_tiles(window.col, window.width, picture_width);
        let mut room = I::Room::default();
        let mut image = None;
        let mut work = Work::default();
        loop {
            let index = self.next.fetch_add(1, Ordering::Relaxed);
            if index >= window.height.div_ceil(rows) || self.is_cancelled.load(Ordering::Relaxed) {
                return Ok(work);
            }
            let strip = Window {
                row: window.row + index * rows,
                height: rows.min(window.height - index * rows),
                ..window
            };
            let rows = whole_tiles(strip.row, strip.height, picture_height);
            let sink = self.job.sink.begin(index);
            let mut sink = sink.ok_or_else(|| self.cancel())?;
            for col in columns.clone().step_by(PART_COLUMNS as usize) {
                let width = PART_COLUMNS.min(columns.end - col);
                let form = Form {
                    size: (width, rows.end - rows.start),
                    ..self.form
                };
                let mut part = Image::new(form, image);
                for first in rows.clone().step_by(BAND_ROWS as usize) {
                    let end = rows.end.min(first + BAND_ROWS);
                    let band = first - rows.start..end - rows.start;
                    let mut band = part.band_mut((col, rows.start), band);
                    let painted = integrator.paint_band(&mut band, &mut room, self.job.progress);
                    work += painted.map_err(|_| self.cancel())?;
                }
                let inside = strip.col.max(col)..(strip.col + strip.width).min(col + width);
                let in_part = Window {
                    col: inside.start - col,
                    row: strip.row - rows.start,
                    width: inside.end - inside.start,
                    height: strip.height,
                };
                let first = inside.start - strip.col;
                if (in_part.width, in_part.height) == (part.width(), part.height()) {
                    sink.add(first, &part);
                } else {
                    sink.add(first, &part.cut(in_part));
                }
                image = Some(part);
            }
            sink.end();
        }
    }

    /// Has the others stop, too.
    fn cancel(&self) -> Cancelled {
        self.is_cancelled.store(true, Ordering::Relaxed);
        Cancelled
    }
}

/// The columns or rows of the tiles that some of them are in.
fn whole_tiles(first: u32, length: u32, all: u32) -> Range<u32> {
    let end = (first + length).next_multiple_of(Tile::SIDE);
    first / Tile::SIDE * Tile::SIDE..end.min(all)
}

#[cfg(test)]
mod tests;
