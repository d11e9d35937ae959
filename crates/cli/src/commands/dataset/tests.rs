use glam::DVec3;
use marbles_core::{Color, DirectionalLight, Highlight, Material, Sphere};

use super::*;

#[test]
fn names_have_three_digits_at_least() {
    let names: Vec<String> = file_names(12).collect();
    assert_eq!([&*names[0], &*names[11]], ["001.png", "012.png"]);
    assert_eq!(file_names(1000).last().as_deref(), Some("1000.png"));
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
            lights.extend(DirectionalLight::new(DVec3::X, color));
        }
        assert_eq!(gain(&world, &lights), expected, "{intensity}, {strength}");
    }
}
