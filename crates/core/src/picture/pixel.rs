//! Pixels, the ways to average them, and what is known of them.

use std::num::NonZeroU32;
use std::ops::AddAssign;

use crate::model::color::Color;

/// The way to average pixels.
///
/// # Example
/// ```
/// # use marbles_core::glam::DVec3;
/// # use marbles_core::{Angle, Camera, Lens, Material, Sphere, View, World, Method, Renderer, Settings};
/// # let mut world = World::new();
/// # let white = world.add_material(Material::default());
/// # world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
/// # let lens = Lens::from_field_of_view(Angle::from_degrees(40.0))?;
/// # let view = View::new(Camera::default(), lens, 16, 16);
/// use std::num::NonZeroU32;
///
/// # world.ambient = DVec3::ONE;
/// // One sample in each of 2 × 2 squares of a pixel: what is seen of a white ball is a multiple of a quarter.
/// let two = NonZeroU32::new(2).expect("2 is not 0");
/// let settings = Settings { method: Method::Samples(two), ..Settings::default() };
/// let image = Renderer::new(&world).render(&view, &settings);
/// let row = image.row(3).iter();
/// assert!(row.map(|light| 4.0 * light).all(|samples| samples == samples.round()));
/// assert_eq!(Method::default(), Method::Tolerance(1e-3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Over the midpoints of an N × N division of every pixel.
    Samples(NonZeroU32),
    /// To a tolerance: every channel of every pixel is to be within this of the exact average.
    Tolerance(f64),
}

/// The tolerance 1e-3.
impl Default for Method {
    fn default() -> Self {
        Self::Tolerance(1e-3)
    }
}

/// The average of a pixel, and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pixel {
    /// Average of the light over the pixel's square; in a world without color all channels are the same.
    pub(crate) value: Color,
    /// Fraction of the pixel's square that spheres cover.
    pub(crate) alpha: f64,
    /// The largest distance of value and alpha from the exact averages, in any channel; infinite
    /// where nothing is known.
    pub(crate) error: f64,
    /// The worth of the error.
    pub(crate) evidence: Evidence,
    /// The end of the work on the pixel.
    pub(crate) status: Status,
}

/// The reason to believe an error.
///
/// # Example
/// ```
/// # use marbles_core::glam::DVec3;
/// # use marbles_core::{Angle, Camera, Lens, Material, Sphere, View, World, Evidence, Renderer, Settings};
/// # let mut world = World::new();
/// # let white = world.add_material(Material::default());
/// # world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
/// # let lens = Lens::from_field_of_view(Angle::from_degrees(40.0))?;
/// # let view = View::new(Camera::default(), lens, 16, 16);
/// let image = Renderer::new(&world).render(&view, &Settings::default());
/// // No sphere is seen in the first pixel: its light is that of the background.
/// assert_eq!(image.evidence(0, 0), Evidence::Bound);
/// assert!(Evidence::Bound > Evidence::Estimate);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Evidence {
    /// It is inferred from rules and samples that agree.
    Estimate,
    /// It is proved.
    Bound,
}

/// The work on pixels, counted.
///
/// # Example
/// ```
/// # use std::num::NonZeroU32;
/// # use marbles_core::glam::DVec3;
/// # use marbles_core::{Angle, Camera, Lens, Material, Sphere, View, World, Method, Renderer, Settings};
/// # let mut world = World::new();
/// # let white = world.add_material(Material::default());
/// # world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
/// # let lens = Lens::from_field_of_view(Angle::from_degrees(1.0))?;
/// # let view = View::new(Camera::default(), lens, 16, 16);
/// // The ball fills the picture of 16 × 16 pixels.
/// let two = NonZeroU32::new(2).expect("2 is not 0");
/// let settings = Settings { method: Method::Samples(two), ..Settings::default() };
/// let image = Renderer::new(&world).render(&view, &settings);
/// assert_eq!(image.work().samples, 4 * 16 * 16);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
#[non_exhaustive]
pub struct Work {
    /// Points at which light, or the normal of a rough surface, was computed.
    pub samples: u64,
    /// Lines in pixels with edges along which light was integrated.
    pub lines: u64,
    /// Tests whether a pixel or a ray may see a sphere, or whether a sphere may keep a light from what a tile, a pixel
    /// or a part of one sees.
    pub candidate_tests: u64,
}

impl AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.samples += other.samples;
        self.lines += other.lines;
        self.candidate_tests += other.candidate_tests;
    }
}

/// The result of the work on a pixel.
///
/// # Example
/// ```
/// # use marbles_core::glam::DVec3;
/// # use marbles_core::{Angle, Camera, Lens, Material, Sphere, View, World, Renderer, Settings, Status};
/// # let mut world = World::new();
/// # let white = world.add_material(Material::default());
/// # world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
/// # let lens = Lens::from_field_of_view(Angle::from_degrees(40.0))?;
/// # let view = View::new(Camera::default(), lens, 16, 16);
/// let image = Renderer::new(&world).render(&view, &Settings::default());
/// assert_eq!(image.status(8, 8), Status::Met);
/// assert!(!image.status(8, 8).is_over_tolerance());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
#[non_exhaustive]
pub enum Status {
    /// No tolerance was asked for; the error is an estimate.
    NoTolerance,
    /// The error is within the tolerance.
    Met,
    /// The tolerance is not met, and most of the error is that of rounding.
    AtRoundoff,
    /// The tolerance is not met: a pixel may only cost so much, or numbers are so extreme that edges are not found in
    /// doubles. If marbles gave up the edges, the value is that of samples, and the error is the contrast of all that
    /// the pixel may show.
    OutOfBudget,
}

impl Status {
    /// Returns whether a tolerance was asked for and not met.
    pub fn is_over_tolerance(self) -> bool {
        match self {
            Self::NoTolerance | Self::Met => false,
            Self::AtRoundoff | Self::OutOfBudget => true,
        }
    }
}
