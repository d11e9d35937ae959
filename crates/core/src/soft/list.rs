//! The spheres that may hide light from a square of a sphere.

use super::bodies::Bodies;
use super::gather::{Neighborhood, gather};
use super::point::Occluders;
use crate::model::sphere::Sphere;
use crate::patches::square::{Square, point};

/// Spheres that may hide light from a square.
#[derive(Clone, Debug, Default)]
pub(crate) struct List {
    pub(crate) bodies: Bodies,
    found: Vec<u32>,
}

impl List {
    /// Makes it that of a square.
    pub(crate) fn fill(&mut self, square: &Square, occluders: &Occluders<'_>) {
        let own = square.sphere as usize;
        let of = neighborhood(square, &occluders.spheres[own]);
        gather(occluders, own, &of, &mut self.found);
        self.bodies.clear();
        for &index in &self.found {
            self.bodies.push(&occluders.spheres[index as usize]);
        }
    }

    /// The share of the light that small ones may darken between the nodes of a square, which is a part of the list's.
    pub(crate) fn missed(&self, square: &Square, occluders: &Occluders<'_>) -> f64 {
        let of = neighborhood(square, &occluders.spheres[square.sphere as usize]);
        let found = self.found.iter();
        let missed = found.map(|&index| missed(&of, &occluders.spheres[index as usize]));
        missed.fold(0.0, f64::max)
    }
}

/// The part of the world that a square is.
fn neighborhood(square: &Square, sphere: &Sphere) -> Neighborhood {
    let (normal, chord) = square.extent();
    Neighborhood {
        middle: point(sphere, normal),
        around: chord * sphere.radius(),
        normal,
        // The angle of a chord, and a little more.
        turn: chord * (1.0 + 0.1 * chord * chord),
    }
}

/// What a small sphere near a square may darken between its nodes.
fn missed(of: &Neighborhood, sphere: &Sphere) -> f64 {
    /// The distance between nodes, in parts of that of corners from the middle, and a little more.
    const SPACING: f64 = 0.75;
    let spacing = SPACING * of.around;
    let to_center = sphere.center() - of.middle;
    let radius = sphere.radius();
    if radius >= spacing || to_center.length() > of.around + radius + spacing {
        return 0.0;
    }
    // The height of the center above the surface.
    let curvature = of.turn / of.around;
    let height = to_center.dot(of.normal) + 0.5 * curvature * to_center.length_squared();
    let height = height.abs().max(radius);
    if height < spacing {
        (radius / height) * (radius / height)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::model::sky::Sky;
    use crate::search::hierarchy::Hierarchy;
    use crate::soft::point::SurfacePoint;
    use crate::soft::sky::{shares, sky_light};
    use crate::soft::visible::Hidden;

    #[test]
    fn the_list_of_a_square_hides_what_all_spheres_hide() {
        let mut state = 11_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 * 2_f64.powi(-52) - 1.0
        };
        let spheres: Vec<Sphere> = (0..600)
            .map(|_| {
                let center = DVec3::new(next(), next(), next());
                Sphere::new(center, 0.02 + 0.08 * next().abs()).unwrap()
            })
            .collect();
        let hierarchy = Hierarchy::new(&spheres);
        let occluders = Occluders {
            spheres: &spheres,
            hierarchy: &hierarchy,
        };
        let sky = Sky::uniform(DVec3::ONE);
        let mut hidden = Hidden::default();
        let mut left_out = 0;
        for number in 0..60 {
            let own = number * 7;
            let toward = DVec3::new(next(), next(), next()).normalize();
            let square = Square::around(own, toward, 1 + (number % 4) as i32);
            let mut list = List::default();
            list.fill(&square, &occluders);
            left_out += spheres.len() - list.found.len();
            for _ in 0..4 {
                let normal = square.normal(DVec2::new(next(), next()) * 0.5 + 0.5);
                let point = SurfacePoint {
                    position: point(&spheres[own], normal),
                    normal,
                    shading: normal,
                    to_eye: normal,
                    sphere: own,
                };
                let by_list = shares(&sky, &point, &list.bodies, &mut hidden).x;
                let by_all = sky_light(&sky, &point, Some(&occluders), &mut hidden).x;
                assert!((by_list - by_all).abs() < 1e-11, "{by_list} {by_all}");
            }
        }
        assert!(left_out > 60 * 200, "{left_out}");
    }
}
