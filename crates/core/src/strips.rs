//! A picture strip by strip, for those that need not have it as a whole.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use crate::image::Form;
use crate::integration::Integrator;
use crate::render::{self, paint};
use crate::{Cancelled, Image, Radiance, Renderer, Settings, Tile, View, Work};

/// Rows of a band; a strip is a number of bands.
pub const BAND_ROWS: u32 = Tile::SIDE;

/// Columns of a strip that are rendered before they go to the sink: so few that what a thread
/// writes stays near it, however wide a picture is.
const PART_COLUMNS: u32 = 1024;

/// Where a picture goes while it is rendered.
///
/// Strips are rows side by side, from edge to edge. Several threads work at once, each on a strip
/// of its own.
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
    /// Renders strip by strip, each of which goes to `sink` as soon as a thread has rendered it, so
    /// that a picture of any height needs little memory; what it cost.
    ///
    /// The pixels are those of [`Self::render`], and so is `progress`. Strips are begun from the top
    /// downward, each by one of the threads of the current rayon pool, and end as they come.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` broke or `sink` wants no more.
    pub fn render_strips(
        &self,
        view: &View,
        settings: &Settings,
        sink: &dyn Sink,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Work, Cancelled> {
        self.run(view, settings, Job { sink, progress })
    }
}

/// All strips of a picture.
struct Job<'a> {
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
        let (width, height) = self.form.size;
        let rows = self.job.sink.bands().max(1).saturating_mul(BAND_ROWS);
        let mut room = I::Room::default();
        let mut image = None;
        let mut work = Work::default();
        loop {
            let index = self.next.fetch_add(1, Ordering::Relaxed);
            if index >= height.div_ceil(rows) || self.is_cancelled.load(Ordering::Relaxed) {
                return Ok(work);
            }
            let row = index * rows;
            let rows = rows.min(height - row);
            let strip = self.job.sink.begin(index);
            let mut strip = strip.ok_or_else(|| self.cancel())?;
            for col in (0..width).step_by(PART_COLUMNS as usize) {
                let form = Form {
                    size: (PART_COLUMNS.min(width - col), rows),
                    ..self.form
                };
                let mut part = Image::new(form, image);
                for first in (0..rows).step_by(BAND_ROWS as usize) {
                    let rows = first..rows.min(first + BAND_ROWS);
                    let mut band = part.band_mut((col, row), rows);
                    let painted = paint(&mut band, integrator, &mut room, self.job.progress);
                    work += painted.map_err(|_| self.cancel())?;
                }
                strip.add(col, &part);
                image = Some(part);
            }
            strip.end();
        }
    }

    /// Has the others stop, too.
    fn cancel(&self) -> Cancelled {
        self.is_cancelled.store(true, Ordering::Relaxed);
        Cancelled
    }
}

#[cfg(test)]
mod tests;
