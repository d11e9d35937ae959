//! A picture strip by strip, for those that need not have it as a whole.

use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicU32, Ordering};

use super::centers::Centers;
use super::integrator::{Indices, Integrator, Scratch, paint_bands};
use super::renderer::Renderer;
use super::settings::Settings;
use super::sink::{Sink, Strip};
use crate::model::exposure::Exposure;
use crate::picture::band::Band;
use crate::picture::geometry::Geometry;
use crate::picture::image::{Image, Layout};
use crate::picture::pixel::Work;
use crate::picture::progress::{Cancelled, Progress};
use crate::picture::quantities::GeometrySettings;
use crate::picture::tile::Tile;
use crate::picture::window::Window;

/// Columns of a strip that are rendered before they go to the sink: so few that what a thread
/// writes stays near it, however wide a picture is.
const PART_COLUMNS: u32 = 1024;

/// A window of a picture, or of several of one view, that any number of threads render together, strip by
/// strip, so that a picture of any height needs little memory.
///
/// The pixels are those of [`Renderer::render`]. A thread that finds no strip to begin may start
/// on the next picture while other threads end theirs.
///
/// # Example
/// ```
/// # use std::ops::ControlFlow;
/// # use std::sync::Mutex;
/// # use marbles_core::glam::{DVec2, DVec3};
/// # use marbles_core::{Camera, Image, Lens, Renderer, Settings, Sink, Strip, View, Window, World};
/// # /// Adds up the light of all pixels.
/// # #[derive(Default)]
/// # struct Sum(Mutex<f64>);
/// #
/// # impl Sink for Sum {
/// #     fn begin(&self, _: u32) -> Option<Box<dyn Strip + '_>> {
/// #         Some(Box::new(StripOfSum(self)))
/// #     }
/// # }
/// #
/// # struct StripOfSum<'a>(&'a Sum);
/// #
/// # impl Strip for StripOfSum<'_> {
/// #     fn add(&mut self, _: u32, part: &Image) {
/// #         let light: f64 = (0..part.height()).flat_map(|row| part.row(row)).sum();
/// #         *self.0.0.lock().unwrap() += light;
/// #     }
/// #
/// #     fn end(self: Box<Self>) {}
/// # }
/// # let mut world = World::new();
/// # world.background = DVec3::splat(0.5);
/// # let view = View::new(Camera::default(), Lens::parallel(8.0, DVec2::ZERO), 20, 30);
/// # let renderer = Renderer::new(&world);
/// // A picture of 30 rows in strips of 8 rows; `Sum` adds up the light, as in the example of `Sink`.
/// let rendering = renderer.begin(&view, Window::whole(&view), &Settings::default(), 8);
/// assert_eq!(rendering.strips_left(), 4);
/// let sum = Sum::default();
/// let go_on = |_| ControlFlow::Continue(());
/// std::thread::scope(|scope| {
///     for _ in 0..2 {
///         scope.spawn(|| rendering.help(&sum, &go_on));
///     }
/// });
/// assert_eq!(rendering.strips_left(), 0);
/// assert_eq!(sum.0.into_inner()?, 0.5 * 20.0 * 30.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Rendering<'a> {
    /// At least one.
    pictures: Vec<Picture<'a>>,
    /// The rays through the centers of pixels, where somebody asks for what they see; they come with the last
    /// picture.
    centers: Option<Centers<'a>>,
    /// Columns and rows of the whole picture.
    size: (u32, u32),
    window: Window,
    /// Rows of a strip, but the last.
    rows: u32,
    /// The index of the first strip that no thread has begun.
    next: AtomicU32,
}

/// One of the pictures that are rendered together.
struct Picture<'a> {
    integrator: Integrator<'a>,
    /// The whole picture.
    layout: Layout,
}

/// Memory of strips that are no longer needed.
#[derive(Default)]
struct Spent {
    parts: Vec<Image>,
    geometry: Option<Geometry>,
}

impl Renderer<'_> {
    /// Prepares the rendering of a window of a picture in strips of `rows` rows, at least 1. The last strip may have fewer
    /// rows.
    ///
    /// Strips that begin at multiples of [`Rendering::ROW_STEP`], counted from the top of the picture, cost the least.
    /// Works on the threads of the current rayon pool.
    ///
    /// # Panics
    /// When the window is not inside the picture.
    pub fn begin<'a>(
        &'a self,
        exposure: impl Into<Exposure<'a>>,
        window: Window,
        settings: &Settings,
        rows: u32,
    ) -> Rendering<'a> {
        self.begin_with_geometry(exposure, window, settings, rows, None)
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
        rows: u32,
        geometry: Option<&GeometrySettings>,
    ) -> Rendering<'a> {
        Rendering::of_each(&[self], exposure.into(), window, settings, rows, geometry)
    }
}

impl<'a> Rendering<'a> {
    /// Prepares the rendering of the same window of several pictures, each for a sink of its own. The renderers must
    /// have the same spheres, as those that [`Renderer::under`] makes of one renderer. The work on what the view sees
    /// is done once for all of them. With `geometry` the last picture gets what the rays through the centers of its
    /// pixels see.
    ///
    /// Each picture is the one that its renderer makes alone.
    ///
    /// # Panics
    /// If there is no renderer, if they do not have the same spheres, or if the window is not inside the picture.
    pub fn of_each(
        renderers: &[&'a Renderer<'_>],
        exposure: Exposure<'a>,
        window: Window,
        settings: &Settings,
        rows: u32,
        geometry: Option<&GeometrySettings>,
    ) -> Self {
        let view = exposure.view();
        let is_inside = |first: u32, length: u32, all: u32| {
            first.checked_add(length).is_some_and(|end| end <= all)
        };
        assert!(
            is_inside(window.col, window.width, view.width)
                && is_inside(window.row, window.height, view.height),
            "{window:?} is outside"
        );
        let (last, others) = renderers.split_last().expect("a renderer at least");
        let mut others = others.iter();
        assert!(
            others.all(|other| other.world.shares_spheres(&last.world)),
            "spheres of other worlds"
        );
        let mut indices = Indices::default();
        let pictures = renderers.iter().map(|renderer| Picture {
            integrator: renderer.integrator_with(&exposure, settings, &mut indices),
            layout: renderer.layout(&exposure, settings),
        });
        let mut pictures: Vec<Picture<'a>> = pictures.collect();
        let mut centers = None;
        if let Some(geometry) = geometry
            && let Some(picture) = pictures.pop()
        {
            let (integrator, found) = Centers::with(last, &exposure, picture.integrator, *geometry);
            centers = found;
            pictures.push(Picture {
                integrator,
                ..picture
            });
        }
        Self {
            pictures,
            centers,
            size: (view.width, view.height),
            window,
            rows: rows.max(1),
            next: AtomicU32::new(0),
        }
    }
}

impl Rendering<'_> {
    /// The number of rows that are rendered together, in squares of as many columns.
    ///
    /// A strip that begins or ends between two multiples of it, counted from the top of the picture, costs as much as one
    /// that contains all rows from multiple to multiple.
    pub const ROW_STEP: u32 = Tile::SIDE;

    /// The number of strips that no thread has begun.
    pub fn strips_left(&self) -> u32 {
        let next = self.next.load(Ordering::Relaxed);
        self.count().saturating_sub(next)
    }

    /// Renders strips until all are begun; returns what they cost.
    ///
    /// Strips begin from the top downward and end in any order; each goes to `sink` as soon as it is rendered. `progress` is
    /// called with the number of pixels that were just finished. Pixels around the window count if they are in its tiles:
    /// a tile is rendered as a whole, because what its pixels may see is found for all of them. Rows around a strip that
    /// begins between two multiples of [`Self::ROW_STEP`] are rendered for each of both strips. If `progress` breaks, or if
    /// `sink` wants no more, the work of all threads ends soon.
    ///
    /// # Errors
    /// [`Cancelled`] when the work of this thread has ended so.
    ///
    /// # Panics
    /// Where several pictures are rendered together.
    pub fn help(
        &self,
        sink: &dyn Sink,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Work, Cancelled> {
        self.help_each(&[sink], progress)
    }

    /// Renders strips of all pictures, as [`Self::help`] does, to a sink for each of them. What one sink does not want
    /// others still get, until no sink wants more.
    ///
    /// # Errors
    /// [`Cancelled`] when the work of this thread has ended so.
    ///
    /// # Panics
    /// When there are not as many sinks as pictures.
    pub fn help_each(
        &self,
        sinks: &[&dyn Sink],
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Work, Cancelled> {
        assert_eq!(sinks.len(), self.pictures.len(), "a sink for each picture");
        let work = self.render_strips(sinks, progress);
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
    fn render_strips(
        &self,
        sinks: &[&dyn Sink],
        progress: &Progress<'_>,
    ) -> Result<Work, Cancelled> {
        let (picture_width, picture_height) = self.size;
        let columns = whole_tiles(self.window.col, self.window.width, picture_width);
        let mut scratch = Scratch::default();
        let mut spent = Spent::default();
        let mut work = Work::default();
        while let Some((index, strip)) = self.next() {
            let rows = whole_tiles(strip.row, strip.height, picture_height);
            let strips = sinks.iter().map(|sink| sink.begin(index));
            let mut strips: Vec<Option<Box<dyn Strip + '_>>> = strips.collect();
            if strips.iter().all(Option::is_none) {
                return Err(Cancelled);
            }
            for col in columns.clone().step_by(PART_COLUMNS as usize) {
                let width = PART_COLUMNS.min(columns.end - col);
                let area = Window {
                    col,
                    row: rows.start,
                    width,
                    height: rows.end - rows.start,
                };
                let (parts, geometry, cost) = self.parts(area, spent, &mut scratch, progress)?;
                work += cost;
                let inside = strip.col.max(col)..(strip.col + strip.width).min(col + width);
                let in_part = Window {
                    col: inside.start - col,
                    row: strip.row - rows.start,
                    width: inside.end - inside.start,
                    height: strip.height,
                };
                let first = inside.start - strip.col;
                let is_whole = (in_part.width, in_part.height) == (area.width, area.height);
                let geometry = geometry.map(|geometry| geometry.cut(in_part));
                if let (Some(geometry), Some(Some(last))) = (&geometry, strips.last_mut()) {
                    last.add_geometry(first, geometry);
                }
                for (strip, part) in strips.iter_mut().zip(&parts) {
                    let Some(strip) = strip else { continue };
                    if is_whole {
                        strip.add(first, part);
                    } else {
                        strip.add(first, &part.cut(in_part));
                    }
                }
                spent = Spent { parts, geometry };
            }
            for strip in strips.into_iter().flatten() {
                strip.end();
            }
        }
        Ok(work)
    }

    /// The parts of all pictures in an area of whole tiles, in memory that is no longer needed, what the centers of
    /// its pixels see, and what they cost.
    fn parts(
        &self,
        area: Window,
        spent: Spent,
        scratch: &mut Scratch,
        progress: &Progress<'_>,
    ) -> Result<(Vec<Image>, Option<Geometry>, Work), Cancelled> {
        let size = (area.width, area.height);
        let mut memory = spent.parts.into_iter();
        let parts = self.pictures.iter().map(|picture| {
            let layout = Layout {
                size,
                ..picture.layout
            };
            Image::new(layout, memory.next())
        });
        let mut parts: Vec<Image> = parts.collect();
        let centers = self.centers.as_ref();
        let mut geometry =
            centers.map(|centers| Geometry::new(size, &centers.settings, spent.geometry));
        let first = (area.col, area.row);
        let written = (&mut parts[..], geometry.as_mut());
        let work = self.paint(first, written, scratch, progress)?;
        Ok((parts, geometry, work))
    }

    /// Writes a part of each picture, whose first pixel is there, band by band; returns what it costs.
    fn paint(
        &self,
        (col, row): (u32, u32),
        (parts, mut geometry): (&mut [Image], Option<&mut Geometry>),
        scratch: &mut Scratch,
        progress: &Progress<'_>,
    ) -> Result<Work, Cancelled> {
        let mut work = Work::default();
        let height = parts[0].height();
        for first in (0..height).step_by(Tile::SIDE as usize) {
            let rows = first..height.min(first + Tile::SIDE);
            let bands = parts.iter_mut();
            let bands = bands.map(|part| part.band_mut((col, row), rows.clone()));
            let mut bands: Vec<Band<'_>> = bands.collect();
            let area = bands[0].area;
            let written = geometry
                .as_deref_mut()
                .map(|geometry| ((col, row), geometry));
            let pictures = self.pictures.iter().map(|picture| &picture.integrator);
            let pictures = pictures.zip(&mut bands).collect();
            work += paint_bands(pictures, scratch, progress, written)?;
            if let (Some(centers), Some(geometry)) = (&self.centers, geometry.as_deref_mut()) {
                work += centers.see(area, scratch, ((col, row), geometry));
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
