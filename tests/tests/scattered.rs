//! Pixels with edges, and bumps far smaller than they are: random samples know them.

use glam::{DVec2, DVec3};
use marbles_core::{
    Color, Evidence, Grain, Highlight, Lens, Light, LightFalloff, Material, Outline, OutlineWidth,
    PointLight, Roughness, Sphere, Status, View, World,
};
use marbles_tests::numbers::Numbers;

use crate::studio::{exact_picture, looking_forward, matte, picture, pixels, single_pixel};

/// Two balls with fine bumps, one of which shades the other.
fn world(random: &mut Numbers, light: Light) -> World {
    let mut world = World::new();
    world.background = Color::new(0.1, 0.3, 0.2);
    world.ambient = Color::splat(0.1);
    let material = world.add_material(Material {
        roughness: Some(Roughness {
            amplitude: random.between(0.2, 0.8),
            grain: Grain::Surface(libm::exp10(random.between(-1.6, -1.2))),
            seed: 3,
        }),
        highlight: Some(Highlight {
            strength: 0.3,
            shininess: 20.0,
        }),
        outline: Some(Outline {
            width: OutlineWidth::Pixels(0.4),
            color: Color::new(0.0, 0.0, 0.3),
        }),
        ..matte(Color::new(0.8, 0.5, 0.6))
    });
    for (center, radius) in [
        (DVec3::new(0.0, 0.0, 40.0), 9.0),
        (DVec3::new(-3.0, 4.0, 28.0), 2.0),
    ] {
        world.add_sphere(Sphere::new(center, radius).unwrap(), material);
    }
    world.lights.push(light);
    world
}

/// Holds pixels against millions of samples, which are a sum that knows nothing of claims.
fn compare(world: &World, view: &View, alpha: bool) {
    const TOLERANCE: f64 = 2e-3;
    // Eight samples and more side by side on each bump.
    const SIDE: u32 = 640;
    // Half of what one straight edge along the grid would cost.
    const DOUBT: f64 = 0.25 * 1.3 / SIDE as f64;
    let image = exact_picture(world, view, TOLERANCE, alpha);
    let mut judged = 0;
    for (col, row) in pixels(&image) {
        assert_eq!(image.status(col, row), Status::Met, "({col}, {row})");
        let is_random = image.evidence(col, row) == Evidence::Estimate
            && image.error(col, row) > 0.2 * TOLERANCE;
        if !is_random || (col * 7 + row * 5) % 13 != 0 {
            continue;
        }
        let truth = picture(world, &single_pixel(view, col, row), SIDE, alpha);
        for (ours, exact) in image.rgba(col, row).into_iter().zip(truth.rgba(0, 0)) {
            let off = (ours - exact).abs();
            let claimed = image.error(col, row);
            assert!(
                off <= claimed + DOUBT,
                "({col}, {row}): {off:e} {claimed:e}"
            );
        }
        judged += 1;
    }
    assert!(judged > 2, "{judged}");
}

#[test]
fn edges_among_fine_bumps_meet_the_tolerance() {
    let sun = || Light::directional(DVec3::new(-1.0, 1.0, -1.0), Color::splat(0.8)).unwrap();
    let place = DVec3::new(-9.0, 12.0, 10.0);
    let lamp = PointLight::new(place, Color::splat(0.8), LightFalloff::None, 1.0).unwrap();
    let random = &mut Numbers(5);
    let view = looking_forward(12, 12, 20.0);
    compare(&world(random, sun()), &view, false);
    compare(&world(random, sun()), &view, true);
    compare(&world(random, lamp.into()), &view, false);
    let parallel = View {
        lens: Lens::parallel(24.0, DVec2::ZERO),
        ..view
    };
    compare(&world(random, sun()), &parallel, false);
}
