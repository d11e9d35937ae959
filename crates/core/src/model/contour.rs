//! The contours of spheres on the retina.

use glam::{DVec2, DVec3};

use super::sphere::Sphere;
use super::view::View;

/// The contour of a sphere in a picture.
///
/// Places are pixel coordinates as [`View::project`] has them: the picture's upper left corner is (0, 0), y grows
/// downward.
///
/// # Example
/// ```
/// use marbles_core::glam::{DVec2, DVec3};
/// use marbles_core::{Camera, Lens, Sphere, View};
///
/// // Parallel rays, 4 pixels in each unit of length.
/// let view = View::new(Camera::default(), Lens::parallel(8.0, DVec2::ZERO), 32, 32);
/// let contour = view.contour(&Sphere::new(DVec3::new(1.0, 0.0, 5.0), 2.0)?);
/// assert_eq!(contour.center, Some(DVec2::new(20.0, 16.0)));
/// assert_eq!(contour.depth, 5.0);
/// assert_eq!(contour.ellipse.map(|ellipse| ellipse.semi_axes), Some([8.0, 8.0]));
/// # Ok::<(), marbles_core::SphereError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Contour {
    /// The image of the sphere's center, which is not the middle of the contour; none if it is not in front of the
    /// viewpoint.
    pub center: Option<DVec2>,
    /// The distance of the center along the axis of view, in scene units.
    pub depth: f64,
    /// The ellipse that the sphere fills, unless others hide it; none where the plane through the viewpoint, across
    /// the axis of view, touches the sphere: then the contour is a parabola or a hyperbola, or there is none. Through a
    /// parallel lens with square pixels it is a circle, of what lies before that plane.
    pub ellipse: Option<Ellipse>,
}

/// An ellipse in a picture.
///
/// # Example
/// ```
/// use marbles_core::Ellipse;
/// use marbles_core::glam::DVec2;
///
/// let ellipse = Ellipse {
///     center: DVec2::new(3.0, 4.0),
///     semi_axes: [2.0, 1.0],
///     along: DVec2::Y,
/// };
/// assert_eq!(ellipse.bounds(), [DVec2::new(2.0, 2.0), DVec2::new(4.0, 6.0)]);
/// assert_eq!(ellipse.angle_degrees(), 90.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// The middle.
    pub center: DVec2,
    /// The longer half axis, and the shorter one, in pixels.
    pub semi_axes: [f64; 2],
    /// The unit vector along the longer one, toward +x, or toward +y if it is upright.
    pub along: DVec2,
}

impl View {
    /// The contour of a sphere.
    ///
    /// # Accuracy
    /// Some units in the last place of the lengths that a coordinate is made of, over the share of the depth by which the
    /// sphere is off the plane through the viewpoint.
    ///
    /// # Source
    /// With the center (x, y, z) from the eye, ρ² = x² + y², the radius r and w = z² − r² > 0, rays at (u, v) on the
    /// retina at distance 1 touch the sphere where (u x + v y + z)² = (u² + v² + 1) (ρ² + w): an ellipse about
    /// (x, y) z / w with the half axes r √(ρ² + w) / w, in the direction of (x, y), and r / √w across it.
    /// Pixels that are not square stretch it along the y axis.
    pub fn contour(&self, sphere: &Sphere) -> Contour {
        let from_eye = sphere.center() - self.camera.position;
        let center = self.camera.world_from_camera.transpose() * from_eye;
        let radius = sphere.radius();
        if self.lens.is_parallel() {
            return self.circle(sphere, center);
        }
        let apart = (center.z - radius) * (center.z + radius);
        let scale = self.lens.distance * self.zoom / self.pixel_size().x;
        let is_ahead = center.z > radius && apart > 0.0;
        let ellipse = is_ahead.then(|| {
            let aside = center.truncate();
            let on_unit = aside * (center.z / apart);
            let long = radius * (aside.length_squared() + apart).sqrt() / apart;
            let short = radius / apart.sqrt();
            let along = aside.try_normalize().unwrap_or(DVec2::X);
            let ellipse = Ellipse {
                center: self.pixel_of(on_unit * self.lens.distance * self.zoom),
                semi_axes: [long * scale, short * scale],
                along: folded(DVec2::new(along.x, -along.y)),
            };
            ellipse.stretched(self.lens.pixel_aspect)
        });
        Contour {
            center: self.project(sphere.center()),
            depth: center.z,
            ellipse: ellipse.filter(Ellipse::is_finite),
        }
    }

    /// The contour of a sphere with this center in the camera's frame, through a parallel lens: a circle, behind
    /// whose plane nothing is seen.
    fn circle(&self, sphere: &Sphere, center: DVec3) -> Contour {
        let radius = sphere.radius();
        let in_plane = if center.z >= 0.0 {
            radius
        } else {
            ((radius + center.z) * (radius - center.z)).max(0.0).sqrt()
        };
        let in_pixels = in_plane * (self.zoom / self.pixel_size().x);
        let ellipse = (in_plane > 0.0).then(|| {
            let circle = Ellipse {
                center: self.pixel_of(center.truncate() * self.zoom),
                semi_axes: [in_pixels; 2],
                along: DVec2::X,
            };
            circle.stretched(self.lens.pixel_aspect)
        });
        Contour {
            center: self.project(sphere.center()),
            depth: center.z,
            ellipse: ellipse.filter(Ellipse::is_finite),
        }
    }

    /// The area of an ellipse that lies within the picture, in pixels.
    pub fn area_of(&self, ellipse: &Ellipse) -> f64 {
        ellipse.area_within(DVec2::new(f64::from(self.width), f64::from(self.height)))
    }
}

impl Ellipse {
    /// Its angle from the x axis toward +y, which is down: more than −90° and at most 90°.
    pub fn angle_degrees(&self) -> f64 {
        libm::atan2(self.along.y, self.along.x).to_degrees()
    }

    /// The corners of the box around it: the upper left one and the lower right one.
    pub fn bounds(&self) -> [DVec2; 2] {
        let [long, short] = self.semi_axes;
        let (x, y) = (self.along.x, self.along.y);
        let half = DVec2::new(
            libm::hypot(long * x, short * y),
            libm::hypot(long * y, short * x),
        );
        [self.center - half, self.center + half]
    }

    /// This with the distances from its middle along the y axis multiplied by a number.
    ///
    /// # Source
    /// The columns of the matrix M are the half axes, times the longer one's inverse. M Mᵀ has the squares of the new half
    /// axes for eigenvalues, whose product is the square of the determinant.
    fn stretched(self, by: f64) -> Self {
        if by == 1.0 {
            return self;
        }
        let [long, short] = self.semi_axes;
        let ratio = short / long;
        let first = DVec2::new(self.along.x, by * self.along.y);
        let second = ratio * DVec2::new(-self.along.y, by * self.along.x);
        let (xx, yy) = (
            first.x * first.x + second.x * second.x,
            first.y * first.y + second.y * second.y,
        );
        let xy = first.x * first.y + second.x * second.y;
        let larger = (0.5 * (xx + yy + libm::hypot(xx - yy, 2.0 * xy))).sqrt();
        let (y, x) = libm::sincos(0.5 * libm::atan2(2.0 * xy, xx - yy));
        Self {
            semi_axes: [long * larger, short * by / larger],
            along: folded(DVec2::new(x, y)),
            ..self
        }
    }

    fn is_finite(&self) -> bool {
        self.center.is_finite() && self.semi_axes.iter().all(|half| half.is_finite())
    }

    /// The area that it has in common with the rectangle from (0, 0) to `size`.
    ///
    /// A map that makes the ellipse the unit disc makes the rectangle a parallelogram.
    fn area_within(&self, size: DVec2) -> f64 {
        let [long, short] = self.semi_axes;
        let corners = [
            DVec2::ZERO,
            DVec2::new(size.x, 0.0),
            size,
            DVec2::new(0.0, size.y),
        ];
        let on_disc = corners.map(|corner| {
            let from_center = corner - self.center;
            DVec2::new(
                from_center.dot(self.along) / long,
                from_center.perp_dot(self.along) / short,
            )
        });
        let sum: f64 = (0..4)
            .map(|index| beside_chord(on_disc[index], on_disc[(index + 1) % 4]))
            .sum();
        sum.abs() * long * short
    }
}

/// A direction or its opposite, whichever leads to the right, or down.
fn folded(direction: DVec2) -> DVec2 {
    if direction.x < 0.0 || direction.x == 0.0 && direction.y < 0.0 {
        -direction
    } else {
        direction
    }
}

/// The area that the unit disc and the triangle from its middle to two points have in common; negative where the way
/// around goes the other way.
fn beside_chord(from: DVec2, to: DVec2) -> f64 {
    let sector = |one: DVec2, other: DVec2| 0.5 * libm::atan2(one.perp_dot(other), one.dot(other));
    let way = to - from;
    // |from + t way|² = 1 in t.
    let (a, b) = (way.length_squared(), from.dot(way));
    let c = from.length_squared() - 1.0;
    let discriminant = b * b - a * c;
    if a == 0.0 || discriminant <= 0.0 {
        return sector(from, to);
    }
    let root = discriminant.sqrt();
    let (enter, leave) = ((-b - root) / a, (-b + root) / a);
    if enter >= 1.0 || leave <= 0.0 {
        return sector(from, to);
    }
    let mut area = 0.0;
    let mut first = from;
    if enter > 0.0 {
        first = from + way * enter;
        area += sector(from, first);
    }
    let mut last = to;
    if leave < 1.0 {
        last = from + way * leave;
        area += sector(last, to);
    }
    area + 0.5 * first.perp_dot(last)
}

#[cfg(test)]
mod tests;
