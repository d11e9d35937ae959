//! The light of a sky at a node, and how it changes.

use glam::DVec3;

use super::bodies::Bodies;
use super::point::SurfacePoint;
use super::sky::{ShareSlope, reached};
use super::visible::Hidden;
use crate::model::sky::Sky;
use crate::model::sphere::Sphere;
use crate::numeric::pair::both;
use crate::patches::light::{NodeLight, Slope, height_and_cosine};
use crate::patches::square::point as point_of;

/// The light at the point of a sphere with some normal, which only some bodies hide.
pub(crate) fn light_at_node(
    sky: &Sky,
    (own, normal): (usize, DVec3),
    (bodies, spheres): (&Bodies, &[Sphere]),
    hidden: &mut Hidden,
) -> NodeLight {
    let radius = spheres[own].radius();
    let place = point_of(&spheres[own], normal);
    let point = SurfacePoint {
        position: place,
        normal,
        shading: normal,
        to_eye: normal,
        sphere: own,
    };
    let mut light = NodeLight::default();
    let mut add = |slope: &ShareSlope| {
        let sphere = slope.cap.sphere;
        // A horizon changes nothing: what is there is seen at a right angle from the normal.
        let Some(other) = spheres.get(sphere as usize) else {
            return;
        };
        let (height, _) = height_and_cosine(other, place);
        // The axis turns by the way across it, divided by the distance.
        let turn = radius / (height + other.radius()).max(f64::MIN_POSITIVE);
        let by_axis = both(slope.by_axis, |by_axis| by_axis * -turn);
        let is_known = slope.by_cosine.is_finite()
            && slope.twice_by_cosine.is_finite()
            && by_axis.iter().all(|by_axis| by_axis.is_finite());
        // The node may be the sphere's center, or the sphere may be too small to tell.
        if !is_known {
            return;
        }
        let slope = Slope {
            sphere: Some(sphere),
            height: height as f32,
            by_cosine: slope.by_cosine,
            twice_by_cosine: slope.twice_by_cosine,
        };
        light.add(slope, by_axis, (place, radius), spheres);
    };
    let reached = reached(sky, &point, bodies, hidden, &mut add);
    light.shares = reached.shares;
    for (sum, by_normal) in light.by_normal.iter_mut().zip(reached.by_normal) {
        *sum += by_normal;
    }
    light
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patches::light::{NEAREST, Shares, cosine_by_normal};

    #[test]
    fn light_changes_as_nodes_say() {
        const STEP: f64 = 1e-6;
        let mut state = 17_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 * 2_f64.powi(-52) - 1.0
        };
        let mut spheres = vec![Sphere::new(DVec3::new(0.1, 0.2, 0.3), 0.8).unwrap()];
        while spheres.len() < 40 {
            let center = DVec3::new(next(), next(), next()) * 2.0;
            spheres.push(Sphere::new(center, 0.1 + 0.3 * next().abs()).unwrap());
        }
        let mut bodies = Bodies::default();
        for (number, sphere) in spheres.iter().enumerate().skip(1) {
            bodies.push(sphere, number as u32);
        }
        let skies = [
            Sky::uniform(DVec3::ONE),
            Sky {
                above: DVec3::X,
                ..Sky::uniform(DVec3::ONE)
            },
        ];
        let mut hidden = Hidden::default();
        let (mut compared, mut far) = (0, 0);
        for number in 0..400 {
            let sky = &skies[number % 2];
            let normal = DVec3::new(next(), next(), next()).normalize();
            let mut at =
                |normal: DVec3| light_at_node(sky, (0, normal), (&bodies, &spheres), &mut hidden);
            let place = point_of(&spheres[0], normal);
            let light = at(normal);
            if light.slopes.iter().any(|slope| slope.height < 0.02) {
                continue;
            }
            far += usize::from(light.slopes[NEAREST - 1].sphere.is_some());
            let along = normal.any_orthonormal_vector();
            let mut share = |by: f64| at((normal + along * by).normalize()).shares;
            let difference = (share(STEP) - share(-STEP)) / (2.0 * STEP);
            let mut slope =
                Shares::new(light.by_normal[0].dot(along), light.by_normal[1].dot(along));
            for near in &light.slopes {
                if let Some(sphere) = near.sphere {
                    let cosine = cosine_by_normal(0.8, &spheres[sphere as usize], place);
                    slope += near.by_cosine * cosine.dot(along);
                }
            }
            // A circle that begins to be visible within a step changes by the square root of it.
            let error = (difference - slope).abs().max_element();
            assert!(error < 1e-4, "{number}: {difference} {slope}");
            compared += usize::from(error < 1e-8);
        }
        assert!(compared > 200 && far > 100, "{compared} {far}");
    }
}
