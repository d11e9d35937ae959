//! The light of single points, computed from the model's formula and plain geometry.

use glam::DVec3;
use marbles_core::{Color, Highlight, Image, Light, Material, Sphere, World};

use crate::studio::{looking_forward, picture, pixels, world_of};

const CENTER: DVec3 = DVec3::new(0.2, -0.1, 5.0);
const RADIUS: f64 = 1.1;

/// albedo · (ambient + Σ I (n·l)^exponent) + Σ I strength (n·h)^shininess, over the lights that the point faces.
fn radiance(
    direction: DVec3,
    material: &Material,
    lights: &[(DVec3, Color)],
    ambient: Color,
) -> Color {
    let (a, b) = (direction.length_squared(), direction.dot(CENTER));
    let c = CENTER.length_squared() - RADIUS * RADIUS;
    let point = direction * ((b - (b * b - a * c).sqrt()) / a);
    let normal = (point - CENTER) / RADIUS;
    let viewer = -direction.normalize();
    let highlight = material.highlight.unwrap();
    let (mut diffuse, mut mirrored) = (ambient, Color::ZERO);
    for &(toward, intensity) in lights {
        let toward = toward.normalize();
        let facing = normal.dot(toward);
        if facing > 0.0 {
            diffuse += intensity * facing.powf(material.exponent);
            let half = (toward + viewer).normalize();
            let spot = normal.dot(half).max(0.0).powf(highlight.shininess);
            mirrored += intensity * highlight.strength * spot;
        }
    }
    material.albedo * diffuse + mirrored
}

#[test]
fn every_term_of_the_formula_counts() {
    let lights = [
        (DVec3::new(-1.0, 1.0, -1.0), Color::new(0.9, 0.7, 0.4)),
        (DVec3::new(2.0, 0.3, -0.5), Color::new(0.1, 0.2, 0.5)),
        (DVec3::new(0.0, -1.0, 3.0), Color::ONE),
    ];
    let ambient = Color::new(0.02, 0.03, 0.05);
    for (exponent, shininess) in [(1.0, 1.0), (0.5, 40.0), (3.7, 12.5), (20.0, 300.0)] {
        let material = Material {
            albedo: Color::new(0.8, 0.3, 0.1),
            exponent,
            highlight: Some(Highlight {
                strength: 0.7,
                shininess,
            }),
            roughness: None,
            outline: None,
        };
        let mut world = World::new();
        let id = world.add_material(material);
        world.add_sphere(Sphere::new(CENTER, RADIUS).unwrap(), id);
        let light = |&(toward, intensity)| Light::directional(toward, intensity).unwrap();
        world.lights.extend(lights.iter().map(light));
        world.ambient = ambient;
        let view = looking_forward(40, 40, 80.0);
        let image = picture(&world, &view, 1, true);
        let mut covered = 0;
        for (col, row) in pixels(&image).filter(|&(col, row)| image.rgba(col, row)[3] == 1.0) {
            covered += 1;
            let direction = view
                .ray(view.cell_center(u64::from(col), u64::from(row), 1))
                .direction;
            let expected = radiance(direction, &material, &lights, ambient);
            let [red, green, blue, _] = image.rgba(col, row);
            let error = (Color::new(red, green, blue) - expected)
                .abs()
                .max_element();
            // The slope of x^½ magnifies the rounding of small cosines.
            assert!(error < 1e-7, "pixel ({col}, {row}) is off by {error:e}");
        }
        assert!(covered > 900);
    }
}

fn seen(spheres: &[(f64, Color)], toward: DVec3) -> Image {
    let balls: Vec<_> = spheres
        .iter()
        .map(|&(radius, albedo)| (CENTER, radius, albedo))
        .collect();
    let mut world = world_of(&balls, &[toward, DVec3::new(0.5, 1.0, -2.0)]);
    world.ambient = Color::splat(0.01);
    picture(&world, &looking_forward(60, 60, 120.0), 2, true)
}

/// If surfaces coincide, the sphere that was added first is visible, and they do not block each other's light.
#[test]
fn coincident_spheres_look_like_the_first() {
    let toward = DVec3::new(-1.0, 1.0, -1.0);
    let alone = seen(&[(RADIUS, Color::X), (1e-3, Color::Z)], toward);
    assert_eq!(
        seen(&[(RADIUS, Color::X), (RADIUS, Color::Z)], toward),
        alone
    );
    assert_ne!(
        seen(&[(RADIUS, Color::Z), (RADIUS, Color::X)], toward),
        alone
    );
}

/// The same is true for a shell that is inside another by the last bit of its radius.
#[test]
fn sphere_that_hides_another_by_a_bit_looks_alone() {
    let toward = DVec3::new(-1.0, 1.0, -1.0);
    let smaller = RADIUS - f64::EPSILON;
    let alone = seen(&[(RADIUS, Color::X), (1e-3, Color::Z)], toward);
    assert_eq!(
        seen(&[(RADIUS, Color::X), (smaller, Color::Z)], toward),
        alone
    );
    assert_eq!(
        seen(&[(smaller, Color::Z), (RADIUS, Color::X)], toward),
        alone
    );
}
