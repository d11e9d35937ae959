//! The spheres that may hide light from a square of a sphere.

use super::bodies::Bodies;
use super::gather::{Neighborhood, gather, select};
use super::point::Occluders;
use crate::model::sphere::Sphere;
use crate::patches::square::{Square, point};

/// The spheres that may hide light from a square, found among all.
pub(crate) fn gathered(square: &Square, occluders: &Occluders<'_>) -> Vec<u32> {
    let own = square.sphere as usize;
    let of = neighborhood(square, &occluders.spheres[own]);
    gather(occluders, own, &of)
}

/// Those that may hide light from a square, of those that may hide it from a square around it.
pub(crate) fn of_part(list: &[u32], square: &Square, occluders: &Occluders<'_>) -> Vec<u32> {
    let of = neighborhood(square, &occluders.spheres[square.sphere as usize]);
    select(occluders.spheres, list, &of)
}

/// Puts the spheres of a list side by side.
pub(crate) fn arrange(list: &[u32], occluders: &Occluders<'_>, bodies: &mut Bodies) {
    bodies.clear();
    for &index in list {
        bodies.push(&occluders.spheres[index as usize], index);
    }
}

/// The share of the light that small ones may darken between the nodes of a square.
pub(crate) fn missed(list: &[u32], square: &Square, occluders: &Occluders<'_>) -> f64 {
    /// The distance between nodes, in parts of that of corners from the middle, and a little more.
    const SPACING: f64 = 0.75;
    let of = neighborhood(square, &occluders.spheres[square.sphere as usize]);
    let mut missed: f64 = 0.0;
    for &index in list {
        missed = missed.max(of.missed(&occluders.spheres[index as usize], SPACING));
    }
    missed
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

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::model::sky::Sky;
    use crate::search::hierarchy::Hierarchy;
    use crate::soft::point::SurfacePoint;
    use crate::soft::sky::{reached, sky_light};
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
            let list = gathered(&square, &occluders);
            let mut bodies = Bodies::default();
            arrange(&list, &occluders, &mut bodies);
            left_out += spheres.len() - list.len();
            let others: Vec<u32> = (0..600).filter(|&index| index as usize != own).collect();
            let mut all = Bodies::default();
            arrange(&others, &occluders, &mut all);
            for _ in 0..4 {
                let normal = square.normal(DVec2::new(next(), next()) * 0.5 + 0.5);
                let point = SurfacePoint {
                    position: point(&spheres[own], normal),
                    normal,
                    shading: normal,
                    to_eye: normal,
                    sphere: own,
                };
                let by_list = reached(&sky, &point, &bodies, &mut hidden, &mut |_| {})
                    .shares
                    .x;
                let by_all = reached(&sky, &point, &all, &mut hidden, &mut |_| {})
                    .shares
                    .x;
                assert!((by_list - by_all).abs() < 1e-11, "{by_list} {by_all}");
                let at_point = sky_light(&sky, &point, Some(&occluders), &mut hidden).x;
                assert!((at_point - by_all).abs() < 1e-11, "{at_point} {by_all}");
            }
        }
        assert!(left_out > 60 * 200, "{left_out}");
    }
}
