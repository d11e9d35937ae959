//! A scene scaled by a power of two gives the same picture, and a mirrored scene gives the mirror image.

use glam::{DVec2, DVec3};
use marbles_core::{
    Angle, Camera, Color, Grain, Highlight, Lens, Light, Material, Roughness, Sphere, View, World,
};

use crate::studio::{exact_picture, looking_forward, picture, pixels};

/// A transformation of the world that keeps pictures: a factor on all lengths, and a sign for x.
#[derive(Clone, Copy)]
struct Change {
    length: f64,
    x_sign: f64,
}

impl Change {
    fn vector(self, vector: DVec3) -> DVec3 {
        DVec3::new(self.x_sign * vector.x, vector.y, vector.z)
    }

    fn point(self, point: DVec3) -> DVec3 {
        self.vector(point) * self.length
    }
}

/// Touching, intersecting, nested and tiny spheres on a floor, with shadows and highlights.
fn world(change: Change, rough: bool) -> World {
    let mut world = World::new();
    let materials = [None, Some(Grain::Surface(0.31 * change.length))].map(|grain| {
        let roughness = grain.map(|grain| Roughness {
            amplitude: 0.5,
            grain,
            seed: 5,
        });
        world.add_material(Material {
            albedo: Color::new(0.9, 0.7, 0.5),
            exponent: 1.3,
            highlight: Some(Highlight {
                strength: 0.5,
                shininess: 21.5,
            }),
            roughness: roughness.filter(|_| rough),
            outline: None,
        })
    });
    let balls = [
        ((0.0, -1e6 - 1.0, 0.0), 1e6),
        ((0.3, 0.0, 6.0), 1.0),
        ((-1.7, 0.0, 6.0), 1.0),
        ((1.1, 0.6, 5.5), 0.7),
        ((0.3, 0.0, 6.0), 1.0 + 1e-9),
        ((-0.7, -0.9, 4.0), 0.1),
        ((0.9, -0.999, 3.5), 0.001),
    ];
    for (index, ((x, y, z), radius)) in balls.into_iter().enumerate() {
        let center = change.point(DVec3::new(x, y, z));
        world.add_sphere(
            Sphere::new(center, radius * change.length).unwrap(),
            materials[index % 2],
        );
    }
    for (toward, intensity) in [((-1.0, 1.5, -0.7), 0.8), ((2.0, 0.4, -1.0), 0.3)] {
        let toward = change.vector(DVec3::from(toward));
        world.lights.extend(Light::directional(
            toward,
            Color::new(1.0, 0.8, 0.6) * intensity,
        ));
    }
    world.ambient = Color::splat(0.02);
    world
}

fn view(change: Change) -> View {
    let degrees = |angle| Angle::from_degrees(angle);
    let camera = Camera::free(
        change.point(DVec3::new(0.1, 0.4, -0.3)),
        degrees(change.x_sign * 4.0),
        degrees(-3.0),
        degrees(change.x_sign * 11.0),
    );
    let lens = Lens {
        width: 1.5 * change.length,
        distance: 1.1 * change.length,
        shift: DVec2::new(change.x_sign * 0.1, -0.05) * change.length,
        pixel_aspect: 1.0,
    };
    View {
        camera,
        lens,
        ..looking_forward(90, 70, 1.0)
    }
}

const UNCHANGED: Change = Change {
    length: 1.0,
    x_sign: 1.0,
};

#[test]
fn scaling_by_a_power_of_two_changes_no_bit() {
    let original = picture(&world(UNCHANGED, true), &view(UNCHANGED), 2, true);
    for exponent in [-900, -400, -30, -1, 1, 30, 400, 900] {
        let change = Change {
            length: libm::scalbn(1.0, exponent),
            x_sign: 1.0,
        };
        let scaled = picture(&world(change, true), &view(change), 2, true);
        assert!(
            original == scaled,
            "scaling by 2^{exponent} changes the picture"
        );
    }
}

/// Also at a tolerance, as long as numbers are moderate, so that the doubles for edges scale alike.
#[test]
fn scaling_changes_no_bit_of_what_meets_a_tolerance() {
    let render = |change| exact_picture(&world(change, true), &view(change), 1e-4, true);
    let original = render(UNCHANGED);
    for exponent in [-30, -1, 1, 30] {
        let change = Change {
            length: libm::scalbn(1.0, exponent),
            x_sign: 1.0,
        };
        assert!(
            original == render(change),
            "scaling by 2^{exponent} changes the picture"
        );
    }
}

/// Lines run from left to right, or down. So the mirror image is computed in another way, and agrees within both
/// claims.
#[test]
fn mirror_images_agree_within_their_errors() {
    let render = |change| exact_picture(&world(change, false), &view(change), 1e-4, true);
    let original = render(UNCHANGED);
    let mirrored = render(Change {
        length: 1.0,
        x_sign: -1.0,
    });
    for (col, row) in pixels(&original) {
        let other_col = original.width() - 1 - col;
        let claimed = original.error(col, row) + mirrored.error(other_col, row);
        let (one, other) = (original.rgba(col, row), mirrored.rgba(other_col, row));
        for (one, other) in one.into_iter().zip(other) {
            assert!(
                (one - other).abs() <= claimed + 1e-13,
                "pixel ({col}, {row}): {one} and {other}, within {claimed:e}"
            );
        }
    }
}

#[test]
fn mirrored_scene_gives_the_mirror_image() {
    // Noise is not symmetric, so the surfaces are smooth.
    let original = picture(&world(UNCHANGED, false), &view(UNCHANGED), 2, true);
    let change = Change {
        length: 1.0,
        x_sign: -1.0,
    };
    let mirrored = picture(&world(change, false), &view(change), 2, true);
    for (col, row) in pixels(&original) {
        let one = original.rgba(col, row);
        let other = mirrored.rgba(original.width() - 1 - col, row);
        for (one, other) in one.into_iter().zip(other) {
            assert!(
                (one - other).abs() < 1e-14,
                "pixel ({col}, {row}): {one} and {other}"
            );
        }
    }
}
