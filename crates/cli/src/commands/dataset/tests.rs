use glam::DVec3;
use marbles_core::{Color, Highlight, LightFalloff, Material, Sphere};

use super::*;

#[test]
fn names_have_three_digits_at_least() {
    let names: Vec<String> = file_names(12, 3).collect();
    assert_eq!([&*names[0], &*names[11]], ["001.png", "012.png"]);
    assert_eq!(file_names(12, 2).last().as_deref(), Some("12.png"));
    assert_eq!(file_names(1000, 3).last().as_deref(), Some("1000.png"));
}

#[test]
fn no_picture_is_clipped_and_none_is_dark() {
    for (intensity, strength, expected) in [
        (1.0, 0.0, 1.0),
        (1.0, 0.25, 0.5),
        (0.2, 0.0, 4.0),
        (5.0, 0.0, 0.125),
    ] {
        let mut world = World::new();
        let material = world.add_material(Material {
            highlight: (strength > 0.0).then_some(Highlight {
                strength,
                shininess: 9.0,
            }),
            ..Material::MATTE_WHITE
        });
        // No sphere has it.
        world.add_material(Material {
            albedo: Color::splat(9.0),
            ..Material::MATTE_WHITE
        });
        world.add_sphere(Sphere::new(DVec3::Z, 0.5).unwrap(), material);
        let mut lights = Vec::new();
        for light in [0.5, 1.0] {
            let color = light * intensity * DVec3::new(0.5, 1.0, 0.25);
            lights.extend(Light::directional(DVec3::X, color));
        }
        assert_eq!(gain(&world, &lights), expected, "{intensity}, {strength}");
    }
}

#[test]
fn near_lights_clip_no_picture() {
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    world.add_sphere(Sphere::new(DVec3::Z * 4.0, 1.0).unwrap(), white);
    // A lamp shade, which light reaches from inside alone.
    world.add_sphere(Sphere::new(DVec3::ZERO, 0.5).unwrap(), white);
    let light = |position: DVec3| {
        let light = PointLight::new(position, DVec3::ONE, LightFalloff::InverseSquare, 1.5);
        Light::from(light.unwrap())
    };
    // The first sphere begins three units from it: a quarter of the light arrives.
    assert_eq!(gain(&world, &[light(DVec3::Z * 1e-3)]), 2.0);
    assert_eq!(gain(&world, &[light(DVec3::ZERO)]), 2.0);
}
