//! Occluders whose shadows have the same edge up to rounding: the one nearer to the light casts the same shadow as
//! both.

use glam::DVec3;
use marbles_core::{Color, Light, LightFalloff, PointLight, Sphere, View, World};
use marbles_tests::numbers::Numbers;

use crate::studio::{exact_picture, looking_forward, matte, pixels};

const SCENES: u64 = 24;
const TOLERANCE: f64 = 1e-5;

/// The sphere that all pixels show.
const RECEIVER: (DVec3, f64) = (DVec3::new(0.0, 0.0, 40.0), 8.0);

fn view() -> View {
    looking_forward(12, 12, 48.0)
}

/// A world of the receiver and some occluders outside of the picture.
fn world(casters: &[(DVec3, f64)], light: Light) -> World {
    let mut world = World::new();
    let white = world.add_material(matte(Color::ONE));
    for &(center, radius) in [RECEIVER].iter().chain(casters) {
        world.add_sphere(Sphere::new(center, radius).unwrap(), white);
    }
    world.lights.push(light);
    world
}

/// The number plus some units in the last place.
fn nudged(number: f64, random: &mut Numbers) -> f64 {
    number * (1.0 + f64::EPSILON * random.between(-4.0, 4.0).round())
}

/// Compares the picture with both occluders with the picture with the nearer one, in which nothing coincides.
fn compare(casters: [(DVec3, f64); 2], light: Light, place: &str) -> u32 {
    let both = exact_picture(&world(&casters, light), &view(), TOLERANCE, false);
    let swapped = [casters[1], casters[0]];
    let swapped = exact_picture(&world(&swapped, light), &view(), TOLERANCE, false);
    let nearer = exact_picture(&world(&casters[1..], light), &view(), TOLERANCE, false);
    let mut edges = 0;
    for (col, row) in pixels(&both) {
        for image in [&both, &swapped] {
            let off = (image.rgba(col, row)[0] - nearer.rgba(col, row)[0]).abs();
            let claimed = image.error(col, row) + nearer.error(col, row);
            assert!(off <= claimed, "{place}, {col} {row}: {off:e} {claimed:e}");
            assert!(
                claimed <= 2.0 * TOLERANCE,
                "{place}, {col} {row}: {claimed:e}"
            );
        }
        edges += u32::from(nearer.error(col, row) > 0.0);
    }
    edges
}

#[test]
fn casters_with_one_shadow_shade_as_the_nearer_one() {
    let mut random = Numbers(20);
    let mut edges = 0;
    for scene in 0..SCENES {
        // From above and before the receiver.
        let toward =
            DVec3::new(random.between(-0.4, 0.4), 1.0, random.between(-0.8, -0.5)).normalize();
        let aside = DVec3::new(random.between(-4.0, 4.0), 0.0, 0.0);
        let center = RECEIVER.0 + aside + toward * random.between(20.0, 24.0);
        let radius = random.between(2.0, 5.0);
        for ahead in [0.0, 1e-9, 0.1, 9.0] {
            let far = (center, radius);
            let mut near = |share: f64, moved: DVec3| {
                let moved = moved.to_array().map(|number| nudged(number, &mut random));
                (
                    DVec3::from_array(moved),
                    nudged(radius * share, &mut random),
                )
            };
            let casters = [far, near(1.0, center + toward * ahead)];
            let sun = Light::directional(toward, Color::ONE).unwrap();
            edges += compare(casters, sun, &format!("scene {scene}, sun, {ahead}"));

            let distance = 15.0;
            let place = center + toward * distance;
            let share = 1.0 - 0.5 * ahead / distance;
            let casters = [far, near(share, place + (center - place) * share)];
            let lamp = PointLight::new(place, Color::ONE, LightFalloff::None, 1.0).unwrap();
            edges += compare(
                casters,
                lamp.into(),
                &format!("scene {scene}, lamp, {ahead}"),
            );
        }
    }
    assert!(edges > 1000, "{edges}");
}
