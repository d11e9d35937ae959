//! Any number of threads gives the same bits.

use glam::DVec3;
use marbles_core::{
    Angle, Camera, Color, DirectionalLight, Grain, Highlight, Image, Light, Material, Outline,
    OutlineWidth, Roughness, Sky, Sphere, World,
};

use crate::studio::{exact_picture, looking_forward, picture};

/// A world that uses every term of the shading.
fn everything() -> World {
    let mut world = World::new();
    for (index, grain) in [Grain::Surface(0.2), Grain::Pixel].into_iter().enumerate() {
        let material = world.add_material(Material {
            albedo: Color::new(0.9, 0.5, 0.2),
            exponent: 1.7,
            highlight: Some(Highlight {
                strength: 0.4,
                shininess: 33.0,
            }),
            roughness: Some(Roughness {
                amplitude: 0.5,
                grain,
                seed: 7,
            }),
            outline: (index == 1).then_some(Outline {
                width: OutlineWidth::Pixels(3.0),
                color: Color::Y,
            }),
        });
        let side = 2.0 * index as f64 - 1.0;
        for step in 0..4 {
            let center = DVec3::new(0.7 * side, 0.5 * f64::from(step) - 0.7, 4.0 + 0.3 * side);
            world.add_sphere(Sphere::new(center, 0.5).unwrap(), material);
        }
    }
    for toward in [DVec3::new(-1.0, 1.0, -1.0), DVec3::new(2.0, 0.5, -0.3)] {
        let intensity = Color::new(0.5, 0.6, 0.7) * toward.x.abs();
        world.lights.extend(Light::directional(toward, intensity));
    }
    world.ambient = Color::splat(0.03);
    world.background = Color::new(0.0, 0.1, 0.2);
    world
}

/// The same world with a sun in place of one light, and a sky.
fn in_soft_light() -> World {
    let mut world = everything();
    let toward = DVec3::new(-1.0, 1.0, -1.0);
    let sun = DirectionalLight::new(toward, Color::splat(0.5)).unwrap();
    world.lights[0] = sun.with_diameter(0.1).unwrap().into();
    let (blue, grey) = (Color::new(0.1, 0.2, 0.4), Color::splat(0.1));
    world.sky = Some(Sky::in_halves(blue, grey, DVec3::Y).unwrap());
    world
}

fn with_threads(
    world: &World,
    (width, height): (u32, u32),
    threads: usize,
    tolerance: Option<f64>,
) -> Image {
    let mut view = looking_forward(width, height, 90.0);
    let degrees = Angle::from_degrees;
    view.camera = Camera::free(DVec3::ZERO, degrees(3.0), degrees(-2.0), degrees(25.0));
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(|| match tolerance {
        Some(tolerance) => exact_picture(world, &view, tolerance, true),
        None => picture(world, &view, 3, true),
    })
}

#[test]
fn threads_do_not_change_a_bit() {
    for (world, size) in [(everything(), (93, 71)), (in_soft_light(), (43, 31))] {
        for tolerance in [None, Some(1e-2)] {
            let picture = |threads| with_threads(&world, size, threads, tolerance);
            let one = picture(1);
            assert!(one.summary().largest_error > 0.0);
            assert_eq!(one, picture(2));
            assert_eq!(one, picture(7));
        }
    }
}
