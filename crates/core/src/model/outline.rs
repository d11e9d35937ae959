//! Lines along the contours of spheres.

use glam::DVec3;

use super::camera::Projection;
use super::color::Color;

/// A line along the contour of a sphere, inside of it, as an eye outside of the sphere sees it.
///
/// A ray sees the outline if it meets the sphere but passes a smaller sphere with the same center. The outline has its
/// color whatever the light. A sphere has no outline if the eye is inside of it, or if the plane of a parallel lens
/// cuts it.
///
/// # Example
/// ```
/// # use marbles_core::glam::{DVec2, DVec3};
/// # use marbles_core::{Camera, Color, Lens, Material, Outline, OutlineWidth, Renderer, Settings};
/// # use marbles_core::{Sphere, View, World};
/// let blue = Color::new(0.0, 0.0, 1.0);
/// // As wide as the ball's radius: all of the ball has the color.
/// let outline = Outline { width: OutlineWidth::Units(1.0), color: blue };
/// let mut world = World::new();
/// let lined = world.add_material(Material { outline: Some(outline), ..Material::default() });
/// world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, lined);
/// # let view = View::new(Camera::default(), Lens::parallel(4.0, DVec2::ZERO), 16, 16);
/// let image = Renderer::new(&world).render(&view, &Settings::default());
/// let [red, green, blue, _] = image.rgba(8, 8);
/// assert!(red == 0.0 && green == 0.0 && (blue - 1.0).abs() < 1e-15);
/// # Ok::<(), marbles_core::SphereError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outline {
    /// Its width.
    pub width: OutlineWidth,
    /// The radiance that it sends.
    pub color: Color,
}

/// The width of an [`Outline`], greater than 0. A sphere that is not wider than twice this width has the color of the
/// outline all over.
///
/// # Example
/// ```
/// use std::f64::consts::PI;
///
/// # use marbles_core::glam::{DVec2, DVec3};
/// # use marbles_core::{Camera, Color, Lens, Material, Outline, OutlineWidth, Renderer, Settings};
/// # use marbles_core::{Sphere, View, World};
/// // The radius of the ball is 8 pixels. Two pixels are half a unit of length here.
/// # let mut areas = Vec::new();
/// for width in [OutlineWidth::Pixels(2.0), OutlineWidth::Units(0.5)] {
///     let outline = Some(Outline { width, color: Color::ONE });
/// #     let mut world = World::new();
/// #     let lined = world.add_material(Material { outline, ..Material::default() });
/// #     world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 2.0)?, lined);
/// #     let view = View::new(Camera::default(), Lens::parallel(6.0, DVec2::ZERO), 24, 24);
///     // … (the world has no light, so that the outline alone is bright)
///     let image = Renderer::new(&world).render(&view, &Settings::default());
///     let area: f64 = (0..24).flat_map(|row| image.row(row)).sum();
///     assert!((area - PI * (8.0 * 8.0 - 6.0 * 6.0)).abs() < 24.0 * 24.0 * 1e-3);
/// #     areas.push(area);
/// }
/// # assert!((areas[0] - areas[1]).abs() < 1e-9);
/// # Ok::<(), marbles_core::SphereError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutlineWidth {
    /// In pixels. Perspective stretches spheres that lie away from the axis of view, and widens their outlines alike: the
    /// width counts across the direction to the axis. If pixels are not square, the unit is the side of a square with the
    /// area of a pixel: outlines have the same width in all directions on the retina.
    Pixels(f64),
    /// In scene units: the difference between the radii of the sphere and the smaller one.
    Units(f64),
}

/// A view as far as outlines depend on it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OutlineView {
    /// The side of a square with the area of a pixel on the plane at distance 1, or of parallel rays on any plane.
    pub(crate) pixel: f64,
    pub(crate) projection: Projection,
}

impl OutlineWidth {
    /// The radius of the smaller sphere inside of one that the eye is outside of. Its center is in the camera's frame.
    ///
    /// # Formula
    /// With the distance d of the center, the contour is seen at an angle from it whose tangent is r / √(d² − r²). A
    /// length s across the way there and across the direction to the axis spans s / c_z of the plane at distance 1.
    pub(crate) fn inner_radius(self, view: OutlineView, center: DVec3, radius: f64) -> f64 {
        let inner = match (self, view.projection) {
            (Self::Units(width), _) => radius - width,
            (Self::Pixels(width), Projection::Parallel) => radius - width * view.pixel,
            (Self::Pixels(width), Projection::Central) => {
                let distance = center.length();
                let outside = (distance - radius) * (distance + radius);
                let width = width * view.pixel * center.z.max(0.0) / distance;
                let tangent = radius / outside.sqrt() - width;
                distance * tangent / (1.0 + tangent * tangent).sqrt()
            }
        };
        // Where the eye is as good as on the sphere, it is not a number.
        if inner.is_nan() {
            return radius;
        }
        inner.clamp(0.0, radius)
    }
}

#[cfg(test)]
mod tests;
