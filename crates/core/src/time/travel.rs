//! The travel of spheres across the pictures of a moving camera.

use glam::{DVec2, DVec3};

use crate::model::exposure::HALVES;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::search::frustum::CLEAR;

/// Moments of half of the time, from its start to its end: a jump between the halves moves nothing.
pub(super) const HALF_MOMENTS: usize = HALVES[0].len();

/// A sphere in the views of a camera that moves for half of the time.
pub(super) struct MovingSphere<'a> {
    pub(super) sphere: &'a Sphere,
    /// True with a highlight.
    pub(super) is_shiny: bool,
    pub(super) views: &'a [View; HALF_MOMENTS],
}

impl MovingSphere<'_> {
    /// True where the sphere stays behind the eye, or beyond one side of the picture, at all moments.
    pub(super) fn is_outside(&self) -> bool {
        let views = self.views.iter();
        views.fold(!0, |all, view| all & self.half_space_tests(view)) != 0
    }

    /// The planes that all of the sphere is on the outer side of, as bits: the eye's, and those through
    /// it and the four sides of the picture.
    fn half_space_tests(&self, view: &View) -> u8 {
        let (center, radius) = (self.center(view), self.sphere.radius());
        let scale = 1.0 / view.magnification();
        // The sides of a parallel lens's picture are seen at the same places from anywhere.
        let is_parallel = view.lens.is_parallel();
        let distance = if is_parallel { 1.0 } else { center.z };
        let size = DVec2::new(f64::from(view.width), f64::from(view.height)) * view.pixel_size();
        let high = (view.lens.shift + 0.5 * size) * scale;
        let low = (view.lens.shift - 0.5 * size) * scale;
        let sides = [
            (center.x - high.x * distance, high.x),
            (low.x * distance - center.x, low.x),
            (center.y - high.y * distance, high.y),
            (low.y * distance - center.y, low.y),
        ];
        let mut bits = u8::from(center.z < -radius);
        for (side, (beyond, slope)) in sides.into_iter().enumerate() {
            let slope = if is_parallel { 0.0 } else { slope };
            let is_outside = beyond > radius * (1.0 + slope * slope).sqrt();
            bits |= u8::from(is_outside) << (side + 1);
        }
        bits
    }

    /// The box around the silhouette in the picture of a view: the upper left and the lower right corner,
    /// in pixels; none where the sphere may be seen anywhere.
    pub(super) fn silhouette_box(&self, view: &View) -> Option<(DVec2, DVec2)> {
        let (center, radius) = (self.center(view), self.sphere.radius());
        let is_parallel = view.lens.is_parallel();
        let product = (center.z - radius) * (center.z + radius);
        let half = |along: f64| radius * (along * along + product).sqrt();
        let halves = DVec2::new(half(center.x), half(center.y));
        let middle = center.truncate() * center.z;
        let scale = view.magnification();
        let half_size = 0.5 * DVec2::new(f64::from(view.width), f64::from(view.height));
        let in_pixels = |slopes: DVec2| {
            let on_retina = slopes * scale - view.lens.shift;
            half_size + DVec2::new(on_retina.x, -on_retina.y) / view.pixel_size()
        };
        let [one, other] = if is_parallel {
            [
                center.truncate() - radius,
                center.truncate() + DVec2::splat(radius),
            ]
        } else {
            [(middle - halves) / product, (middle + halves) / product]
        };
        let (one, other) = (in_pixels(one), in_pixels(other));
        let is_clear = is_parallel || center.z > CLEAR * radius;
        let is_known = is_clear && one.is_finite() && other.is_finite();
        is_known.then(|| (one.min(other), one.max(other)))
    }

    /// Returns whether the plane in which parallel rays begin cuts the sphere at a place that changes: the cut is no part of
    /// the sphere.
    fn is_cut_in_motion(&self) -> bool {
        /// More than rounding, of the center's distance and the radius.
        const STILL: f64 = 1e-12;
        let [first, ..] = self.views;
        if !first.lens.is_parallel() {
            return false;
        }
        let radius = self.sphere.radius();
        let centers = self.views.each_ref().map(|view| self.center(view));
        let slack = STILL * (centers[0].length() + radius);
        let moves = centers
            .iter()
            .any(|center| (center.z - centers[0].z).abs() > slack);
        let [low, high] = centers
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], center| {
                [low.min(center.z), high.max(center.z)]
            });
        moves && low < radius && high > -radius
    }

    /// The center of the sphere in the camera's frame.
    fn center(&self, view: &View) -> DVec3 {
        let from_eye = self.sphere.center() - view.camera.position;
        view.camera.world_from_camera.transpose() * from_eye
    }

    /// The way in pixels, in half of the time, of that point of the sphere that a cell around `middle`
    /// with this side sees, or that comes nearest to it; nothing where it does not come near.
    ///
    /// A highlight is a mirror image of a light that is far away: it moves as something does that lies
    /// up to half of the radius behind the surface, farther where the surface turns away.
    pub(super) fn travel(&self, view: &View, middle: DVec2, side: f64) -> Option<f64> {
        let (point, image, is_hit) = self.point_and_image(view, middle)?;
        if self.is_cut_in_motion() {
            return Some(f64::INFINITY);
        }
        let mut longest: f64 = 0.0;
        for point in [Some(point), image].into_iter().flatten() {
            let mut before = None;
            for view in self.views {
                let Some(place) = view.project(point) else {
                    return Some(f64::INFINITY);
                };
                let step = before.map_or(0.0, |before: DVec2| (place - before).length());
                longest = longest.max(step);
                before = Some(place);
            }
        }
        let travel = longest * (HALF_MOMENTS - 1) as f64;
        if !is_hit {
            /// More than half the diagonal of a square, as a part of its side.
            const HALF_DIAGONAL: f64 = 0.71;
            // The point is nearest in the world. Pixels that are not square have other distances.
            let pixel = view.pixel_size();
            let least = pixel.min_element() / pixel.max_element();
            let away = (view.project(point)? - middle).length() * least;
            if away > HALF_DIAGONAL * side + travel + 1.0 {
                return None;
            }
        }
        Some(travel)
    }

    /// The point of the sphere that a place in pixels sees, or that comes nearest to it, the mirror image
    /// of a light there, and whether the point is the place's own; nothing behind the eye.
    fn point_and_image(&self, view: &View, place: DVec2) -> Option<(DVec3, Option<DVec3>, bool)> {
        let half_size = 0.5 * DVec2::new(f64::from(view.width), f64::from(view.height));
        let from_middle = (place - half_size) * view.pixel_size();
        let on_retina = DVec2::new(from_middle.x, -from_middle.y) + view.lens.shift;
        let Ray { origin, direction } = view.ray(on_retina);
        let direction = direction.normalize();
        let (center, radius) = (self.sphere.center(), self.sphere.radius());
        let from_center = origin - center;
        let nearest = -from_center.dot(direction);
        let aside = from_center + direction * nearest;
        let distance = aside.length();
        let is_hit = distance <= radius;
        let half = ((radius - distance) * (radius + distance)).max(0.0).sqrt();
        let point = if is_hit {
            let t = if nearest > half {
                nearest - half
            } else {
                nearest + half
            };
            if t <= 0.0 {
                return None;
            }
            origin + direction * t
        } else if nearest > 0.0 {
            center + aside * (radius / distance)
        } else {
            return None;
        };
        /// The least cosine of the angle at which a surface is seen: nearer to its silhouette images are
        /// lines.
        const LEAST_COSINE: f64 = 0.1;
        let depth = 0.5 * radius * radius / half.max(LEAST_COSINE * radius);
        let image = self.is_shiny.then(|| point + direction * depth);
        Some((point, image, is_hit))
    }
}
