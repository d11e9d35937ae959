//! The errors of a picture as a whole.

use super::pixel::Evidence;

/// The errors of a picture as a whole.
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
/// world.ambient = DVec3::splat(0.5);
/// let summary = Renderer::new(&world).render(&view, &Settings::default()).summary();
/// assert_eq!(summary.pixels, 16 * 16);
/// assert_eq!(summary.over_tolerance, 0);
/// assert!(summary.largest_error <= 1e-3);
/// let both = summary.and(&summary);
/// assert_eq!(both.pixels, 2 * summary.pixels);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Number of pixels.
    pub pixels: u64,
    /// The largest error that any pixel claims.
    pub largest_error: f64,
    /// Number of pixels whose errors are bounds.
    pub bounds: u64,
    /// Number of pixels that did not meet the tolerance; 0 if there was none.
    pub over_tolerance: u64,
}

impl Summary {
    /// [`Evidence::Bound`] if all errors are bounds.
    pub fn evidence(&self) -> Evidence {
        if self.bounds == self.pixels {
            Evidence::Bound
        } else {
            Evidence::Estimate
        }
    }

    /// The summary of two pictures, or parts of one, together.
    #[must_use]
    pub fn and(self, other: &Self) -> Self {
        Self {
            pixels: self.pixels + other.pixels,
            largest_error: self.largest_error.max(other.largest_error),
            bounds: self.bounds + other.bounds,
            over_tolerance: self.over_tolerance + other.over_tolerance,
        }
    }
}
