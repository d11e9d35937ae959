//! Points are in the dark for cells if they are for asking every sphere.

use super::*;
use crate::model::color::Color;
use crate::model::light::Light;
use crate::model::material::Material;
use crate::model::sphere::Sphere;
use crate::model::world::World;
use crate::search::tests::Random;

fn world(spheres: &[(DVec3, f64)], lights: &[DVec3]) -> World {
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    for &(center, radius) in spheres {
        world.add_sphere(Sphere::new(center, radius).unwrap(), white);
    }
    for &toward in lights {
        world.lights.extend(Light::directional(toward, Color::ONE));
    }
    world
}

/// Lights from the axes, from nearly there, and from anywhere.
fn lights(random: &mut Random) -> Vec<DVec3> {
    let axis = DVec3::AXES[(random.number() * 3.0) as usize];
    vec![random.point(), axis, -axis + random.point() * 1e-9]
}

/// The answer of cells for a point, which agrees with that of all spheres.
fn agrees(visibility: &Visibility<'_>, cells: &mut ShadowCells, asked: &SurfacePoint) -> bool {
    let mut dark = false;
    for light in 0..3 {
        let to_light = Ray {
            origin: asked.point,
            direction: visibility.light(light).occluders().toward(),
        };
        let hides = |index| visibility.hides(index, &to_light, asked.error, asked.sphere);
        let expected = (0..visibility.spheres().len()).any(hides);
        let found = cells.is_blocked(visibility, light, asked);
        assert_eq!(found, expected, "light {light}, {asked:?}");
        dark |= found;
    }
    dark
}

/// A point of a sphere, sometimes beside one that coincides with it or touches it there.
fn point(random: &mut Random, spheres: &[(DVec3, f64)], side: f64) -> SurfacePoint {
    let sphere = (random.number() * spheres.len() as f64) as usize;
    let (center, radius) = spheres[sphere];
    let point = center + random.point().normalize() * radius;
    let error = 1e-15 * (point.abs().element_sum() + radius);
    let error = [error, 1e-6 * side][(random.number() * 1.2) as usize];
    SurfacePoint {
        point,
        error,
        sphere,
        center,
        side,
    }
}

/// Spheres of very different sizes, some alike, under cells of all sizes.
#[test]
fn no_occluder_is_left_out() {
    let mut random = Random(51);
    let (mut dark, mut asked, mut listed) = (0, 0, 0);
    for round in 0..60 {
        let octaves = [0.0, 3.0, 30.0][round % 3];
        let mut spheres: Vec<(DVec3, f64)> = (0..1 << (round % 10))
            .map(|_| {
                let radius = 0.1 * libm::exp2(octaves * (random.number() - 0.5));
                (random.point(), radius)
            })
            .collect();
        let (center, radius) = spheres[0];
        spheres.extend([(center, radius), (center + random.point() * radius, radius)]);
        if round % 4 == 0 {
            spheres.push((random.point().normalize() * 1e6, 1e6));
            spheres.push((random.point() * 1e9, 1e-3));
        }
        let world = world(&spheres, &lights(&mut random));
        let visibility = Visibility::new(&world);
        if round / 10 % 2 == 1 {
            visibility.expect_rows(u64::MAX);
            listed += usize::from(visibility.light(0).grid().is_some());
        }
        let mut cells = ShadowCells::default();
        for _ in 0..150 {
            let side = libm::exp2(14.0 * random.number() - 10.0);
            let asked = point(&mut random, &spheres, side);
            dark += usize::from(agrees(&visibility, &mut cells, &asked));
        }
        asked += 150;
    }
    assert!(
        dark > asked / 4 && dark < asked * 9 / 10,
        "{dark} of {asked}"
    );
    assert!(listed > 2, "{listed}");
}

/// So many spheres that cells are divided, columns are left out, and points are looked up alone.
#[test]
fn crowds_are_divided() {
    let mut random = Random(52);
    let (mut dark, mut asked, mut crowded) = (0, 0, 0);
    for radius in [0.02, 0.002, 1e-4] {
        let spheres: Vec<(DVec3, f64)> = (0..20_000)
            .map(|number| {
                // One half is in one place.
                let place = random.point();
                let scale = if number % 2 == 0 { 1.0 } else { 1e-3 };
                (place * scale, radius * scale)
            })
            .collect();
        let world = world(&spheres, &lights(&mut random));
        let visibility = Visibility::new(&world);
        let mut cells = ShadowCells::default();
        for side in [0.01, 0.3, 5.0] {
            for _ in 0..100 {
                let asked = point(&mut random, &spheres, side);
                dark += usize::from(agrees(&visibility, &mut cells, &asked));
            }
            asked += 100;
        }
        let known = cells.slots.iter().flatten();
        crowded += known.filter(|cell| cell.is_crowded).count();
    }
    assert!(
        dark > asked / 8 && dark < asked * 9 / 10,
        "{dark} of {asked}"
    );
    assert!(crowded > 100, "{crowded}");
}

/// Points farther away than cells can be told apart, or worlds so large or small that squares are lost.
#[test]
fn what_cells_cannot_hold_is_asked_alone() {
    let mut random = Random(53);
    for scale in [1e-40, 1e-20, 1e20, 1e40] {
        let spheres: Vec<(DVec3, f64)> = (0..20)
            .map(|_| (random.point() * scale, 0.3 * random.number() * scale))
            .collect();
        let world = world(&spheres, &lights(&mut random));
        let visibility = Visibility::new(&world);
        let mut cells = ShadowCells::default();
        for side in [
            0.0,
            1e-300,
            1e-16 * scale,
            scale,
            1e300,
            f64::INFINITY,
            f64::NAN,
        ] {
            for _ in 0..20 {
                let mut asked = point(&mut random, &spheres, scale);
                asked.side = side;
                agrees(&visibility, &mut cells, &asked);
            }
        }
    }
}

/// Counted work and memory: points that lie together look up few cells, and those that are known are bounded.
#[test]
fn cells_are_shared() {
    let mut random = Random(54);
    let spheres: Vec<(DVec3, f64)> = (0..30_000).map(|_| (random.point(), 0.01)).collect();
    let world = world(&spheres, &lights(&mut random));
    let visibility = Visibility::new(&world);
    let mut cells = ShadowCells::default();
    let corner = DVec3::splat(0.9);
    for (sphere, &(center, radius)) in spheres.iter().enumerate() {
        if (center - corner).abs().max_element() < 0.1 {
            let asked = SurfacePoint {
                point: center + radius * world.lights[1].toward().unwrap(),
                error: 1e-15,
                sphere,
                center,
                side: 0.1,
            };
            agrees(&visibility, &mut cells, &asked);
        }
    }
    let known = cells.slots.iter().flatten().count();
    assert!(known < 300, "{known}");
    assert!(cells.places < MOST_PLACES);
}
