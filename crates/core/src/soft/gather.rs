//! The spheres that may hide light from a part of a surface.

use glam::DVec3;

use super::cap::Cap;
use super::hemisphere::{Hemisphere, NARROWEST};
use super::point::Occluders;
use crate::model::sphere::Sphere;
use crate::search::hierarchy::BoxTest;
use crate::search::hierarchy::boxes::Boxes;
use crate::search::hierarchy::is_sphere;
use crate::search::hierarchy::order::WIDTH;

/// A part of a surface: points within a distance of one, whose normals are within an angle of one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Neighborhood {
    pub(crate) middle: DVec3,
    pub(crate) around: f64,
    pub(crate) normal: DVec3,
    pub(crate) turn: f64,
}

/// What rounding may move a point by, in parts of its distance.
const SLACK: f64 = 1e-12;

impl Neighborhood {
    /// True unless a ball is below the horizons of all points.
    fn may_be_above(&self, center: DVec3, radius: f64) -> bool {
        let to_center = center - self.middle;
        let distance = to_center.length();
        let slack = SLACK * (distance + self.middle.abs().max_element());
        to_center.dot(self.normal) + radius + self.around + self.turn * distance + slack > 0.0
    }

    /// The directions from any point toward a ball; none if a point may be inside of it, or almost.
    fn cap_from_any(&self, center: DVec3, radius: f64) -> Option<Cap> {
        let to_center = center - self.middle;
        let reach = radius + self.around + SLACK * self.middle.abs().max_element();
        (to_center.length() > 1.000_001 * reach).then(|| Cap::of_sphere(to_center, reach))
    }

    /// Directions that lie toward a ball from all points; none if they are too few to hide anything, or if a point may be
    /// inside of it.
    fn cap_from_all(&self, center: DVec3, radius: f64) -> Option<Cap> {
        let (to_center, slack) = (
            center - self.middle,
            SLACK * self.middle.abs().max_element(),
        );
        let reach = radius - self.around - slack;
        let distance = to_center.length();
        let is_outside = distance > 1.000_001 * (radius + self.around + slack);
        (reach > NARROWEST * distance && is_outside).then(|| Cap::of_sphere(to_center, reach))
    }

    /// The share of a sky's light that a sphere may darken between points of the surface that tell nothing of it: points some
    /// part of `around` apart.
    pub(crate) fn missed(&self, sphere: &Sphere, spacing: f64) -> f64 {
        let spacing = spacing * self.around;
        let radius = sphere.radius();
        if radius >= spacing {
            return 0.0;
        }
        let to_center = sphere.center() - self.middle;
        // The height of the center above the surface.
        let curvature = self.turn / self.around;
        let height = to_center.dot(self.normal) + 0.5 * curvature * to_center.length_squared();
        let height = height.abs().max(radius);
        let distance = (to_center.length() - self.around).max(height);
        let (size, rise) = (radius / distance, height / distance);
        // What it hides falls with the third power of the distance: so far away points tell.
        let between = (spacing / distance).min(1.0);
        size * size * rise * (between * between * between)
    }
}

/// Finds all spheres that hide light from some point of a part of a sphere, and perhaps others: not those of which it is
/// known that others hide them from all of its points. Those that look largest come first.
pub(crate) fn gather(occluders: &Occluders<'_>, own: usize, of: &Neighborhood) -> Vec<u32> {
    let mut hidden = Hemisphere::new(of.normal, of.turn);
    let mut near: Vec<f64> = Vec::new();
    let hierarchy = occluders.hierarchy;
    // Both closures of the search look at what is hidden.
    let shared = std::cell::RefCell::new((&mut hidden, &mut near));
    hierarchy.any(
        |boxes| test(of, shared.borrow().0, boxes),
        |group| {
            let (hidden, near) = &mut *shared.borrow_mut();
            for &index in hierarchy.indices(group) {
                if !is_sphere(index) || !occluders.may_hide(index as usize, own) {
                    continue;
                }
                let sphere = &occluders.spheres[index as usize];
                let (center, radius) = (sphere.center(), sphere.radius());
                if !of.may_be_above(center, radius) {
                    continue;
                }
                if let Some(narrowest) = of.cap_from_all(center, radius) {
                    hidden.hide(&narrowest);
                }
                near.push(key((center - of.middle).length() / radius, index));
            }
            false
        },
    );
    near.sort_unstable_by(f64::total_cmp);
    let near: Vec<u32> = near.iter().map(|key| key.to_bits() as u32).collect();
    select(occluders.spheres, &near, of)
}

/// Finds those of some spheres of which it is not known that the ones before them hide them from all points of a part of a
/// surface.
pub(crate) fn select(spheres: &[Sphere], among: &[u32], of: &Neighborhood) -> Vec<u32> {
    let mut hidden = Hemisphere::new(of.normal, of.turn);
    let mut found = Vec::with_capacity(among.len());
    for &index in among {
        let sphere = &spheres[index as usize];
        let (center, radius) = (sphere.center(), sphere.radius());
        if !of.may_be_above(center, radius) {
            continue;
        }
        let widest = of.cap_from_any(center, radius);
        if widest.is_some_and(|widest| hidden.is_hidden(&widest)) {
            continue;
        }
        if let Some(narrowest) = of.cap_from_all(center, radius) {
            hidden.hide(&narrowest);
        }
        found.push(index);
    }
    found
}

/// A number whose last bits are an index, and which is ordered by its first bits.
fn key(number: f64, index: u32) -> f64 {
    f64::from_bits(number.to_bits() >> 32 << 32 | u64::from(index))
}

/// The boxes of which something may be seen.
fn test(of: &Neighborhood, hidden: &Hemisphere, boxes: &Boxes) -> BoxTest {
    let mut tested = BoxTest {
        may: 0,
        keys: [0.0; WIDTH],
    };
    for place in 0..WIDTH {
        let corner = |of: &[[f32; WIDTH]; 3]| {
            DVec3::new(
                of[0][place].into(),
                of[1][place].into(),
                of[2][place].into(),
            )
        };
        let (low, high) = (corner(&boxes.low), corner(&boxes.high));
        let (center, radius) = (0.5 * (low + high), 0.5 * (high - low).length());
        tested.keys[place] = (center - of.middle).length() - radius;
        // A box that single precision cannot hold reaches to infinity.
        let may = !radius.is_finite()
            || of.may_be_above(center, radius)
                && of
                    .cap_from_any(center, radius)
                    .is_none_or(|cap| !hidden.is_hidden(&cap));
        tested.may |= u8::from(may) << place;
    }
    tested
}
