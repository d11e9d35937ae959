//! What may keep a light from one sphere.

use glam::{DVec2, DVec3};

use super::Visibility;
use super::casters::slack;

/// A sphere as the light sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disc {
    /// Across the light.
    pub(crate) center: DVec2,
    /// Larger by more than what rounding moves it and the points that it may darken.
    pub(crate) radius: f64,
    /// The sphere's index.
    pub(crate) sphere: u32,
}

/// Discs of all spheres that may darken one, or none where they are too many to be remembered.
pub(super) type Remembered = Option<Box<[Disc]>>;

/// In worlds with more spheres nothing is remembered: most of them are a pixel or less.
pub(super) const MOST_REMEMBERING: usize = 1 << 17;

/// More discs than this are looked up for every patch of a surface.
const MOST_REMEMBERED: usize = 64;

impl Visibility<'_> {
    /// How far points of a sphere may be off where its discs are asked for.
    pub(crate) fn point_allowance(&self, sphere: usize) -> f64 {
        /// Far more than points are off, unless the viewpoint is farther away than anything is
        /// to be seen.
        const ALLOWANCE: f64 = 1e-9;
        ALLOWANCE * self.spheres[sphere].radius()
    }

    /// What may keep the light with this index from the outer side of a sphere, if it is little.
    pub(crate) fn discs(&self, light: usize, sphere: usize) -> Option<&[Disc]> {
        let remember = || {
            let own = &self.spheres[sphere];
            let mut discs = Vec::new();
            self.discs_near(light, sphere, &[own.center()], own.radius(), &mut discs);
            (discs.len() <= MOST_REMEMBERED).then(|| discs.into_boxed_slice())
        };
        let remembered = self.discs[light].get(sphere)?;
        remembered.get_or_init(remember).as_deref()
    }

    /// Whether [`Visibility::discs`] were asked for before.
    pub(crate) fn knows_discs(&self, light: usize, sphere: usize) -> bool {
        let remembered = self.discs[light].get(sphere);
        remembered.is_some_and(|remembered| remembered.get().is_some())
    }

    /// Appends what may keep the light with this index from points of a sphere that lie within
    /// `around` of the box of `points`, seen along the light.
    pub(crate) fn discs_near(
        &self,
        light: usize,
        sphere: usize,
        points: &[DVec3],
        around: f64,
        discs: &mut Vec<Disc>,
    ) {
        /// More than the rounding of a sum of squares and of a square.
        const WIDER: f64 = 1.0 + 16.0 * f64::EPSILON;
        let own = &self.spheres[sphere];
        let casters = &self.casters[light];
        let error = self.point_allowance(sphere) + slack(own.center(), 2.0 * own.radius());
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &point in points {
            let place = casters.project(point);
            (low, high) = (low.min(place), high.max(place));
        }
        let mut indices = Vec::new();
        // From the lowest point that may be lit.
        let bottom = casters.height(own.center()) - own.radius() - error;
        casters.within(points, around + error, bottom, &mut indices);
        discs.extend(indices.into_iter().filter_map(|index| {
            let caster = &self.spheres[index];
            if index == sphere || caster == own {
                return None;
            }
            let radius = caster.radius() + slack(caster.center(), caster.radius()) + error;
            let center = casters.project(caster.center());
            let is_beyond = center.distance(center.clamp(low, high)) > (radius + around) * WIDER;
            let is_below = casters.height(caster.center()) + radius < bottom;
            (!is_beyond && !is_below).then_some(Disc {
                center,
                radius: radius * WIDER,
                sphere: index as u32,
            })
        }));
    }

    /// The axes of the plane across a light.
    pub(crate) fn axes(&self, light: usize) -> (DVec3, DVec3) {
        self.casters[light].axes()
    }
}
