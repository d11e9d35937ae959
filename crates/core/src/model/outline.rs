//! Lines along the contours of spheres.

use glam::DVec3;

use super::camera::Projection;
use super::color::Color;

/// A line along the contour of a sphere, inside of it, as an eye outside of the sphere sees it.
///
/// It is what is seen of the sphere beside a smaller one with the same center, where rays pass that one. It sends its color
/// whatever the light. Where the eye is inside of the sphere, or the plane of a parallel lens cuts it, there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outline {
    /// Its width.
    pub width: OutlineWidth,
    /// The radiance that it sends.
    pub color: Color,
}

/// The width of a [`Outline`], greater than 0. A sphere that is not wider than two of it has one color.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutlineWidth {
    /// In pixels. Perspective stretches spheres that lie away from the axis of view, and widens their outlines alike: the
    /// width counts across the direction to the axis.
    Pixels(f64),
    /// By how much, in scene units, the smaller sphere's radius is smaller.
    Units(f64),
}

/// A view as far as outlines depend on it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OutlineView {
    /// The side of a pixel on the plane at distance 1, or of parallel rays on any plane.
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
