//! The receiver of a picture that is rendered strip by strip.

use crate::picture::geometry::Geometry;
use crate::picture::image::Image;

/// The receiver of a picture, or of a window of one, while it is rendered.
///
/// A strip is a number of whole rows. Several threads work at once, each on a strip of its own. Columns and strips are
/// counted from the first of the window.
///
/// # Example
/// ```
/// use std::ops::ControlFlow;
/// use std::sync::Mutex;
///
/// use marbles_core::{Image, Renderer, Settings, Sink, Strip, View, Window, World};
/// # use marbles_core::glam::{DVec2, DVec3};
/// # use marbles_core::{Camera, Lens};
///
/// /// Adds up the light of all pixels.
/// #[derive(Default)]
/// struct Sum(Mutex<f64>);
///
/// impl Sink for Sum {
///     fn begin(&self, _: u32) -> Option<Box<dyn Strip + '_>> {
///         Some(Box::new(StripOfSum(self)))
///     }
/// }
///
/// struct StripOfSum<'a>(&'a Sum);
///
/// impl Strip for StripOfSum<'_> {
///     fn add(&mut self, _: u32, part: &Image) {
///         let light: f64 = (0..part.height()).flat_map(|row| part.row(row)).sum();
///         *self.0.0.lock().unwrap() += light;
///     }
///
///     fn end(self: Box<Self>) {}
/// }
///
/// # let mut world = World::new();
/// # world.background = DVec3::splat(0.5);
/// # let view = View::new(Camera::default(), Lens::parallel(8.0, DVec2::ZERO), 20, 30);
/// # let renderer = Renderer::new(&world);
/// // 20 × 30 pixels of a gray background.
/// let rendering = renderer.begin(&view, Window::whole(&view), &Settings::default(), 8);
/// let sum = Sum::default();
/// let go_on = |_| ControlFlow::Continue(());
/// rendering.help(&sum, &go_on)?;
/// assert_eq!(sum.0.into_inner()?, 0.5 * 20.0 * 30.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Sink: Sync {
    /// Begins the strip with this index, counted from the top. `None` ends the rendering.
    ///
    /// May wait until the strips above are done, but not for those below.
    fn begin(&self, index: u32) -> Option<Box<dyn Strip + '_>>;
}

/// A strip that is being rendered; dropped before its end if the rendering is cancelled.
///
/// # Example
/// ```
/// # use std::ops::ControlFlow;
/// # use std::sync::Mutex;
/// # use marbles_core::glam::{DVec2, DVec3};
/// # use marbles_core::{Camera, Image, Lens, Renderer, Settings, Sink, Strip, View, Window, World};
/// /// A strip of 20 columns.
/// struct Row(u32);
///
/// impl Strip for Row {
///     fn add(&mut self, col: u32, part: &Image) {
///         assert_eq!(col, self.0);
///         self.0 += part.width();
///     }
///
///     fn end(self: Box<Self>) {
///         assert_eq!(self.0, 20);
///     }
/// }
///
/// # struct Rows;
/// # impl Sink for Rows {
/// #     fn begin(&self, _: u32) -> Option<Box<dyn Strip + '_>> {
/// #         Some(Box::new(Row(0)))
/// #     }
/// # }
/// # let mut world = World::new();
/// # world.background = DVec3::splat(0.5);
/// # let view = View::new(Camera::default(), Lens::parallel(8.0, DVec2::ZERO), 20, 30);
/// # let renderer = Renderer::new(&world);
/// # let rendering = renderer.begin(&view, Window::whole(&view), &Settings::default(), 8);
/// # rendering.help(&Rows, &|_| ControlFlow::Continue(()))?;
/// # assert_eq!(rendering.strips_left(), 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Strip {
    /// Receives the next columns of the strip, from left to right: those of the picture `part`, which begin at `col`.
    fn add(&mut self, col: u32, part: &Image);

    /// Receives the geometry at the centers of the next columns' pixels, if you asked for it, before [`Self::add`]
    /// receives the columns.
    fn add_geometry(&mut self, _col: u32, _part: &Geometry) {}

    /// Ends the strip: all columns were added.
    fn end(self: Box<Self>);
}
