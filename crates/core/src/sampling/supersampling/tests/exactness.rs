//! Rays side by side see what single rays see, exactly; on any processor, in any tile.

use fearless_simd::Level;
use glam::{DVec2, DVec3};

use super::super::*;
use super::shading::shade;
use crate::hit::nearest::nearest;
use crate::model::camera::{Camera, Lens};
use crate::model::light::Light;
use crate::model::material::Material;
use crate::model::sphere::Sphere;
use crate::numeric::angle::Angle;
use crate::numeric::lanes::tests::levels;
use crate::search::grid::RayPoints;
use crate::search::tests::Random;
use crate::search::view_index::ViewIndex;
use crate::search::visibility::Visibility;

/// Spheres of which each glows in a color of its own.
fn glowing(balls: &[(DVec3, f64)]) -> World {
    let mut world = World::new();
    for (index, &(center, radius)) in balls.iter().enumerate() {
        let material = world.add_material(Material {
            albedo: Color::new(1.0 + index as f64, 0.5, 0.25),
            ..Material::MATTE_WHITE
        });
        world.add_sphere(Sphere::new(center, radius).unwrap(), material);
    }
    world.ambient = Color::ONE;
    world
}

/// A view of `width` by `height` pixels of size 1, from a place, along z unless turned.
fn view_from(position: DVec3, size: (u32, u32), distance: f64, turn: f64) -> View {
    let degrees = Angle::from_degrees;
    View {
        camera: Camera::free(position, degrees(turn), degrees(-0.5 * turn), degrees(turn)),
        lens: Lens {
            width: f64::from(size.0),
            distance,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0,
        width: size.0,
        height: size.1,
        frame: 1,
    }
}

/// The tiles of a picture with this side at most.
fn tiles(view: &View, side: u32) -> impl Iterator<Item = Tile> {
    let rows = (0..view.height).step_by(side as usize);
    rows.flat_map(move |row| {
        (0..view.width).step_by(side as usize).map(move |col| Tile {
            col,
            row,
            width: side.min(view.width - col),
            height: side.min(view.height - row),
        })
    })
}

/// All pixels by what a processor of this level does, in tiles of this side.
fn pixels(world: &World, view: &View, samples: u32, level: Level, side: u32) -> Vec<Pixel> {
    let visibility = Visibility::new(world);
    let index = ViewIndex::new(&visibility, view, RayPoints::All);
    let samples = NonZeroU32::new(samples).unwrap();
    let integrator = Supersampling {
        level,
        ..Supersampling::new(world, view, &index, samples, false)
    };
    let mut found = vec![None; (view.width * view.height) as usize];
    let mut scratch = Scratch::default();
    for tile in tiles(view, side) {
        let mut pixels = Vec::new();
        integrator.integrate(tile, &mut scratch, &mut pixels);
        for ((col, row), pixel) in tile.pixels().zip(pixels) {
            found[(row * view.width + col) as usize] = Some(pixel);
        }
    }
    found.into_iter().map(Option::unwrap).collect()
}

/// Every sample shows the sphere that exact arithmetic says; how many samples show any.
fn shows_the_nearest(balls: &[(DVec3, f64)], view: &View) -> usize {
    let world = glowing(balls);
    let mut covered = 0;
    let found = pixels(&world, view, 1, Level::new(), Tile::SIDE);
    for (index, pixel) in found.iter().enumerate() {
        let (col, row) = (index as u32 % view.width, index as u32 / view.width);
        let ray = view.ray(view.cell_center(u64::from(col), u64::from(row), 1));
        let expected = nearest(world.spheres(), &ray).map(|(index, _)| index);
        let value = expected.map_or(Color::ZERO, |index| world.material(index).albedo);
        assert_eq!(pixel.value, value, "pixel ({col}, {row}), {expected:?}");
        covered += usize::from(expected.is_some());
    }
    covered
}

fn cloud(random: &mut Random, count: usize, radius: f64) -> Vec<(DVec3, f64)> {
    (0..count)
        .map(|_| (random.point(), radius * (0.2 + random.number())))
        .collect()
}

/// Rays of one tile that are nearly opposite: the cone around them would be almost a line.
#[test]
fn lenses_that_see_half_of_the_world() {
    let mut random = Random(17);
    for step in 0..40 {
        let balls = cloud(&mut random, 30, 0.3);
        let mut view = view_from(DVec3::ZERO, (11, 1), [0.1, 1e-3][step % 2], 0.0);
        let shift = DVec2::X * (random.number() - 0.5);
        view.lens.shift = shift * [0.0, 1.0, 4.0][step % 3];
        shows_the_nearest(&balls, &view);
    }
}

#[test]
fn random_clouds_from_outside_and_from_inside() {
    let mut random = Random(11);
    for step in 0..60 {
        let count = [1, 3, 30, 300][step % 4];
        let balls = cloud(&mut random, count, [0.7, 0.5, 0.3, 0.1][step % 4]);
        let outside = view_from(DVec3::new(0.1, 0.2, -3.0), (43, 37), 40.0, 0.0);
        let inside = view_from(balls[0].0 + 0.1 * balls[0].1, (43, 37), 15.0, 77.0);
        assert!(shows_the_nearest(&balls, &outside) > 0);
        assert!(shows_the_nearest(&balls, &inside) > 0);
    }
}

#[test]
fn coincident_nested_and_touching_spheres() {
    let mut random = Random(12);
    for _ in 0..20 {
        let (center, radius) = (random.point(), 0.5 + random.number());
        let other = random.point().normalize();
        let mut balls = vec![(center, radius); 3];
        for step in 0..6 {
            balls.push((center, radius * (1.0 + f64::from(step) * 1e-16)));
            balls.push((center, radius * (1.0 - 1e-9 * f64::from(step))));
            balls.push((center + other * 1e-12 * f64::from(step), radius));
        }
        balls.push((center + 1.5 * radius * other, 0.5 * radius));
        let view = view_from(DVec3::new(0.0, 0.0, -6.0), (33, 31), 50.0, 1.0);
        shows_the_nearest(&balls, &view);
        // From inside of all of them.
        shows_the_nearest(&balls, &view_from(center, (33, 31), 20.0, 50.0));
    }
}

#[test]
fn floors_and_spheres_across_the_plane_of_the_eye() {
    let mut random = Random(13);
    for radius in [1e2, 1e6, 1e12] {
        let mut balls = vec![(DVec3::new(0.0, -radius - 1.0, 0.0), radius)];
        for _ in 0..40 {
            let place = random.point() * DVec3::new(6.0, 0.0, 6.0);
            balls.push((place - DVec3::Y * 0.8, 0.2));
            balls.push((random.point() * 4.0, 0.4));
        }
        for turn in [0.0, 30.0, 200.0] {
            let eye = view_from(DVec3::ZERO, (61, 45), 25.0, turn);
            assert!(shows_the_nearest(&balls, &eye) > 0);
            // Exactly on the floor, and below it.
            let on_it = view_from(DVec3::NEG_Y, (61, 45), 25.0, turn);
            shows_the_nearest(&balls, &on_it);
            let below = view_from(DVec3::new(0.3, -1.5, 0.1), (61, 45), 25.0, turn);
            assert_eq!(shows_the_nearest(&balls, &below), 61 * 45);
        }
    }
}

#[test]
fn extreme_magnitudes() {
    let mut random = Random(14);
    for scale in [1e-300, 1e-200, 1e-60, 1e60, 1e150, 1e200, 1e300] {
        let mut balls = cloud(&mut random, 20, 0.4);
        for ball in &mut balls {
            *ball = (ball.0 * scale, ball.1 * scale);
        }
        let mut view = view_from(DVec3::new(0.1, 0.2, -3.0) * scale, (33, 31), 30.0, 0.0);
        assert!(shows_the_nearest(&balls, &view) > 0);
        view.lens.width *= scale;
        view.lens.distance *= scale;
        assert!(shows_the_nearest(&balls, &view) > 0);
    }
    // All of them in one picture.
    let decades: Vec<_> = (0..60)
        .map(|step| {
            let size = libm::exp10(f64::from(step) * 10.0 - 300.0);
            (random.point() * 3.0 * size, size)
        })
        .collect();
    for scale in [1e-200, 1.0, 1e200] {
        let position = DVec3::new(0.1, 0.2, -3.0) * scale;
        shows_the_nearest(&decades, &view_from(position, (33, 31), 30.0, 0.0));
    }
}

/// Rays with whole numbers as directions, and spheres of whole numbers that they touch.
#[test]
fn tangent_rays() {
    let mut random = Random(15);
    let mut whole = |range: f64| (range * (random.number() * 2.0 - 1.0)).round();
    let view = view_from(DVec3::ZERO, (9, 9), 4.0, 0.0);
    let mut touched = 0;
    for _ in 0..4_000_000 {
        let direction = DVec3::new(whole(4.0), whole(4.0), 4.0);
        let center = DVec3::new(whole(30.0), whole(30.0), whole(30.0));
        let radius = whole(20.0).abs() + 1.0;
        let outside = center.length_squared() - radius * radius;
        let along = center.dot(direction);
        let discriminant = along * along - direction.length_squared() * outside;
        if discriminant != 0.0 || outside <= 0.0 || along <= 0.0 {
            continue;
        }
        touched += 1;
        for radius in [radius.next_down(), radius, radius.next_up()] {
            shows_the_nearest(&[(center, radius)], &view);
        }
        let (col, row) = ((direction.x + 4.0) as usize, (4.0 - direction.y) as usize);
        let world = glowing(&[(center, radius)]);
        let found = pixels(&world, &view, 1, Level::new(), Tile::SIDE);
        assert_eq!(found[9 * row + col].alpha, 1.0);
        if touched == 40 {
            return;
        }
    }
    panic!("only {touched} tangent rays");
}

/// Spheres that rays touch as nearly as doubles can say, where plain doubles get it wrong.
#[test]
fn rays_that_nearly_touch() {
    let mut random = Random(18);
    let view = view_from(DVec3::splat(0.1), (8, 8), 9.0, 10.0);
    let (mut hits, mut misses) = (0, 0);
    for step in 0..400 {
        let (col, row) = (step % 8, step / 8 % 8);
        let ray = view.ray(view.cell_center(col, row, 1));
        let aside = random.point().cross(ray.direction).normalize();
        let distance = libm::exp10(4.0 * random.number());
        let size = libm::exp10(-3.0 * random.number()) * distance;
        let center = ray.at(distance) + aside * size;
        let from_eye = center - ray.origin;
        let across = ray.direction.cross(from_eye).length() / ray.direction.length();
        for ulps in -2..=2 {
            let radius = across * (1.0 + f64::from(ulps) * f64::EPSILON);
            shows_the_nearest(&[(center, radius)], &view);
            let is_hit = Sphere::new(center, radius).unwrap().hit(&ray).is_some();
            (hits, misses) = (hits + u32::from(is_hit), misses + u32::from(!is_hit));
        }
    }
    assert!(hits > 400 && misses > 400, "{hits} hits, {misses} misses");
}

/// A world with every kind of material, lights and shadows.
fn lit_world(random: &mut Random, count: usize, shadows: bool) -> World {
    let mut world = World::new();
    let materials: Vec<_> = (0..5)
        .map(|number| {
            world.add_material(Material {
                albedo: Color::new(0.9, 0.2 * f64::from(number), 0.3),
                exponent: [1.0, 2.0, 0.7, 1.0, 63.0][number as usize],
                highlight: (number > 1).then_some(crate::Highlight {
                    strength: 0.5,
                    shininess: [20.0, 33.3, 1.0][number as usize % 3],
                }),
                roughness: (number == 3).then_some(crate::Roughness {
                    amplitude: 0.3,
                    grain: crate::Grain::Surface(0.1),
                    seed: 3,
                }),
                outline: None,
            })
        })
        .collect();
    for (index, (center, radius)) in cloud(random, count, 0.3).into_iter().enumerate() {
        let material = materials[index % materials.len()];
        world.add_sphere(Sphere::new(center, radius).unwrap(), material);
    }
    world.add_sphere(
        Sphere::new(DVec3::new(0.0, -1e5 - 1.0, 0.0), 1e5).unwrap(),
        materials[0],
    );
    for toward in [random.point(), DVec3::Y, random.point()] {
        let intensity = Color::new(0.6, 0.5, 0.4);
        world.lights.extend(Light::directional(toward, intensity));
    }
    world.ambient = Color::splat(0.1);
    world.background = Color::new(0.0, 0.1, 0.2);
    world.shadows = shadows;
    world
}

/// Light is that of single rays but for rounding, the points in shadow are the same.
#[test]
fn light_is_that_of_single_rays() {
    let mut random = Random(16);
    for step in 0..30 {
        let world = lit_world(&mut random, [4, 40, 400][step % 3], step % 2 == 0);
        let view = view_from(DVec3::new(0.1, 0.2, -2.0), (41, 35), 30.0, 0.0);
        let visibility = Visibility::new(&world);
        let found = pixels(&world, &view, 1, Level::new(), Tile::SIDE);
        for (index, pixel) in found.iter().enumerate() {
            let (col, row) = (index as u32 % view.width, index as u32 / view.width);
            let ray = view.ray(view.cell_center(u64::from(col), u64::from(row), 1));
            let key = PixelKey { col, row, frame: 1 };
            let expected = match nearest(world.spheres(), &ray) {
                Some((sphere, hit)) => shade(&world, &visibility, &ray, sphere, &hit, key),
                None => world.background,
            };
            let apart = (pixel.value - expected).abs().max_element();
            assert!(
                apart < 1e-9,
                "scene {step}, pixel ({col}, {row}): {} instead of {expected}",
                pixel.value
            );
        }
    }
}

/// The samples of a pixel are the same if they are taken together, also where rows of them do not fill the lanes.
#[test]
fn samples_of_one_pixel_are_those_of_many() {
    let mut random = Random(18);
    for step in 0..6 {
        let world = lit_world(&mut random, [400, 3000][step % 2], step % 3 > 0);
        let mut view = view_from(DVec3::new(0.1, 0.2, -2.0), (29, 21), 20.0, 5.0);
        view.lens.shift = DVec2::new(3.0, -1.5) * (step % 2) as f64;
        view.lens.pixel_aspect = [1.0, 0.7][step % 2];
        if step == 5 {
            view.lens = Lens::parallel(4.0, DVec2::ZERO);
        }
        let visibility = Visibility::new(&world);
        let index = ViewIndex::new(&visibility, &view, RayPoints::All);
        for samples in [4, 5, 6, 8] {
            let of_crowds = |crowd| {
                let samples = NonZeroU32::new(samples).unwrap();
                let integrator = Supersampling {
                    crowd,
                    ..Supersampling::new(&world, &view, &index, samples, step % 2 == 0)
                };
                let mut pixels = Vec::new();
                let mut scratch = Scratch::default();
                for tile in tiles(&view, Tile::SIDE) {
                    integrator.integrate(tile, &mut scratch, &mut pixels);
                }
                pixels
            };
            assert!(of_crowds(1) == of_crowds(usize::MAX), "{step}: {samples}");
        }
    }
}

#[test]
fn processors_and_tiles_do_not_change_a_bit() {
    let mut random = Random(17);
    for step in 0..8 {
        let world = lit_world(&mut random, [4, 40, 400, 3000][step % 4], step % 2 == 0);
        let view = view_from(DVec3::new(0.1, 0.2, -2.0), (29, 21), 20.0, 5.0);
        for samples in [1, 3, 4] {
            let expected = pixels(&world, &view, samples, Level::new(), Tile::SIDE);
            for level in levels() {
                let found = pixels(&world, &view, samples, level, Tile::SIDE);
                assert!(expected == found, "{level:?}");
            }
            // Tiles of one, two and four pixels lie in those of eight.
            for side in [1, 2, 4] {
                let found = pixels(&world, &view, samples, Level::new(), side);
                assert!(expected == found, "tiles of {side}");
            }
        }
    }
}
