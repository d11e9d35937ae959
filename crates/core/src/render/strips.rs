//! A picture strip by strip, for those that need not have it as a whole.

use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicU32, Ordering};

use super::centers::Centers;
use super::integrator::{Integrator, Scratch};
use super::renderer::Renderer;
use super::settings::Settings;
use crate::model::exposure::Exposure;
use crate::picture::geometry::{Geometry, GeometrySettings};
use crate::picture::image::{Image, Layout};
use crate::picture::pixel::Work;
use crate::picture::progress::{Cancelled, Progress};
use crate::picture::tile::Tile;
use crate::picture::window::Window;

/// Rows of a band; a strip is a number of bands.
pub const BAND_ROWS: u32 = Tile::SIDE;

/// Columns of a strip that are rendered before they go to the sink: so few that what a thread
/// writes stays near it, however wide a picture is.
const PART_COLUMNS: u32 = 1024;

/// The receiver of a picture, or of a window of one, while it is rendered.
///
/// Strips are rows side by side, from edge to edge. Several threads work at once, each on a strip
/// of its own. Columns and strips are counted from the window's first.
pub trait Sink: Sync {
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

    /// What the rays through the centers of these columns' pixels see, where it was asked for; comes before
    /// the columns are added.
    fn add_geometry(&mut self, _col: u32, _part: &Geometry) {}

    /// All columns were added.
    fn end(self: Box<Self>);
}

/// A window of a picture that any number of threads render together, strip by strip, so that
/// a picture of any height needs little memory.
///
/// The pixels are those of [`Renderer::render`]. A thread that finds no strip to begin may start
/// on the next picture while other threads end theirs.
pub struct Rendering<'a> {
    integrator: Integrator<'a>,
    /// The rays through the centers of pixels, where somebody asks for what they see.
    centers: Option<Centers<'a>>,
    /// The whole picture.
    layout: Layout,
    window: Window,
    /// Rows of a strip, but the last.
    rows: u32,
    /// The index of the first strip that no thread has begun.
    next: AtomicU32,
}

impl Renderer<'_> {
    /// Prepares the rendering of a window of a picture in strips of so many bands of [`BAND_ROWS`]
    /// rows, at least 1; the last one may have fewer rows.
    ///
    /// Works on the threads of the current rayon pool.
    ///
    /// # Panics
    /// When the window is not inside the picture.
    pub fn begin<'a>(
        &'a self,
        exposure: impl Into<Exposure<'a>>,
        window: Window,
        settings: &Settings,
        bands: u32,
    ) -> Rendering<'a> {
        self.begin_with_geometry(exposure, window, settings, bands, None)
    }

    /// Prepares as [`Self::begin`] does; with `geometry` each strip gets what the rays through the centers of
    /// its pixels see, as well.
    ///
    /// With one sample a pixel these are the same rays, which are traced once.
    ///
    /// # Panics
    /// When the window is not inside the picture.
    pub fn begin_with_geometry<'a>(
        &'a self,
        exposure: impl Into<Exposure<'a>>,
        window: Window,
        settings: &Settings,
        bands: u32,
        geometry: Option<&GeometrySettings>,
    ) -> Rendering<'a> {
        let exposure = exposure.into();
        let view = exposure.view();
        let is_inside = |first: u32, length: u32, all: u32| {
            first.checked_add(length).is_some_and(|end| end <= all)
        };
        assert!(
            is_inside(window.col, window.width, view.width)
                && is_inside(window.row, window.height, view.height),
            "{window:?} is outside"
        );
        let integrator = self.integrator(&exposure, settings);
        let (integrator, centers) = match geometry {
            Some(geometry) => Centers::with(self, &exposure, integrator, *geometry),
            None => (integrator, None),
        };
        Rendering {
            integrator,
            centers,
            layout: self.layout(&exposure, settings),
            window,
            rows: bands.max(1).saturating_mul(BAND_ROWS),
            next: AtomicU32::new(0),
        }
    }
}

impl Rendering<'_> {
    /// The number of strips that no thread has begun.
    pub fn strips_left(&self) -> u32 {
        let next = self.next.load(Ordering::Relaxed);
        self.count().saturating_sub(next)
    }

    /// Renders strips until all are begun; returns what they cost.
    ///
    /// Each goes to `sink` as soon as it is rendered; they are begun from the top downward and end as
    /// they come. `progress` is called with the number of pixels that were just finished, those around
    /// the window among them that are in its tiles: tiles stay where they are and are rendered as
    /// a whole, since it is in a tile that pixels find out what they may see. Where strips begin in
    /// the middle of a band, that is rendered for each of the two. When `progress` breaks or `sink` wants
    /// no more, the work of all threads ends soon.
    ///
    /// # Errors
    /// [`Cancelled`] when the work of this thread has ended so.
    pub fn help(
        &self,
        sink: &dyn Sink,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Work, Cancelled> {
        let work = self.render_strips(sink, progress);
        work.inspect_err(|Cancelled| self.begin_no_more())
    }

    fn begin_no_more(&self) {
        self.next.store(self.count(), Ordering::Relaxed);
    }

    /// The number of all strips.
    fn count(&self) -> u32 {
        self.window.height.div_ceil(self.rows)
    }

    /// The index of a strip that is to be begun, and where it lies.
    fn next(&self) -> Option<(u32, Window)> {
        let index = self.next.fetch_add(1, Ordering::Relaxed);
        if index >= self.count() {
            // However often it is asked, it does not begin anew.
            self.begin_no_more();
            return None;
        }
        let first = index * self.rows;
        let strip = Window {
            row: self.window.row + first,
            height: self.rows.min(self.window.height - first),
            ..self.window
        };
        Some((index, strip))
    }

    /// Renders strips until none is left to begin.
    fn render_strips(&self, sink: &dyn Sink, progress: &Progress<'_>) -> Result<Work, Cancelled> {
        let (picture_width, picture_height) = self.layout.size;
        let columns = whole_tiles(self.window.col, self.window.width, picture_width);
        let mut scratch = Scratch::default();
        let mut spent = (None, None);
        let mut work = Work::default();
        while let Some((index, strip)) = self.next() {
            let rows = whole_tiles(strip.row, strip.height, picture_height);
            let mut sink = sink.begin(index).ok_or(Cancelled)?;
            for col in columns.clone().step_by(PART_COLUMNS as usize) {
                let width = PART_COLUMNS.min(columns.end - col);
                let size = (width, rows.end - rows.start);
                let layout = Layout {
                    size,
                    ..self.layout
                };
                let mut part = Image::new(layout, spent.0);
                let mut geometry = self
                    .centers
                    .as_ref()
                    .map(|centers| Geometry::new(size, &centers.settings, spent.1.take()));
                let first = (col, rows.start);
                let parts = (&mut part, geometry.as_mut());
                work += self.paint(first, parts, &mut scratch, progress)?;
                let inside = strip.col.max(col)..(strip.col + strip.width).min(col + width);
                let in_part = Window {
                    col: inside.start - col,
                    row: strip.row - rows.start,
                    width: inside.end - inside.start,
                    height: strip.height,
                };
                let first = inside.start - strip.col;
                let is_whole = (in_part.width, in_part.height) == size;
                let geometry = geometry.map(|geometry| geometry.cut(in_part));
                if let Some(geometry) = &geometry {
                    sink.add_geometry(first, geometry);
                }
                if is_whole {
                    sink.add(first, &part);
                } else {
                    sink.add(first, &part.cut(in_part));
                }
                spent = (Some(part), geometry);
            }
            sink.end();
        }
        Ok(work)
    }

    /// Writes a part of a picture, whose first pixel is there, band by band; returns what it costs.
    fn paint(
        &self,
        (col, row): (u32, u32),
        (part, mut geometry): (&mut Image, Option<&mut Geometry>),
        scratch: &mut Scratch,
        progress: &Progress<'_>,
    ) -> Result<Work, Cancelled> {
        let mut work = Work::default();
        let height = part.height();
        for first in (0..height).step_by(BAND_ROWS as usize) {
            let rows = first..height.min(first + BAND_ROWS);
            let mut band = part.band_mut((col, row), rows);
            let area = band.area;
            let written = geometry
                .as_deref_mut()
                .map(|geometry| ((col, row), geometry));
            work += self
                .integrator
                .paint_band(&mut band, scratch, progress, written)?;
            if let (Some(centers), Some(geometry)) = (&self.centers, geometry.as_deref_mut()) {
                work += centers.see(area, &mut scratch.sampled, ((col, row), geometry));
            }
        }
        Ok(work)
    }
}

/// The columns or rows of the tiles that some of them are in.
fn whole_tiles(first: u32, length: u32, all: u32) -> Range<u32> {
    let end = (first + length).next_multiple_of(Tile::SIDE);
    first / Tile::SIDE * Tile::SIDE..end.min(all)
}

#[cfg(test)]
mod tests;
