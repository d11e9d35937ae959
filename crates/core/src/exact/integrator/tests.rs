//! The same bits on every processor.

use fearless_simd::Level;
use glam::{DVec2, DVec3};

use super::*;
use crate::exact::budget::MOST;
use crate::model::camera::{Camera, Lens};
use crate::model::color::Color;
use crate::model::light::{Light, LightFalloff, PointLight};
use crate::model::material::{Grain, Highlight, Material, Roughness};
use crate::model::outline::{Outline, OutlineWidth};
use crate::model::sphere::Sphere;
use crate::numeric::angle::Angle;
use crate::numeric::lanes::tests::levels;
use crate::picture::pixel::Evidence;
use crate::search::grid::RayPoints;
use crate::search::tests::Random;
use crate::search::visibility::Visibility;

/// Balls of every finish that intersect and shade each other, on a floor, under so many lights.
fn world(lights: usize) -> World {
    let mut random = Random(1);
    let mut world = World::new();
    let materials = [0, 1, 2].map(|number| {
        world.add_material(Material {
            albedo: Color::new(0.9, 0.3 * f64::from(number), 0.3),
            exponent: [1.0, 2.7, 0.7][number as usize],
            highlight: (number > 0).then_some(Highlight {
                strength: 0.5,
                shininess: 20.0,
            }),
            roughness: (number == 2).then_some(Roughness {
                amplitude: 0.2,
                grain: Grain::Surface(0.5),
                seed: 3,
            }),
            outline: (number == 1).then_some(Outline {
                width: OutlineWidth::Pixels(2.5),
                color: Color::X,
            }),
        })
    });
    for index in 0..40 {
        let center = random.point() + DVec3::Z * 4.0;
        let radius = 0.1 + 0.2 * random.number();
        world.add_sphere(Sphere::new(center, radius).unwrap(), materials[index % 3]);
    }
    // A plain one of many pixels.
    let large = Sphere::new(DVec3::new(0.6, 0.5, 5.5), 1.0).unwrap();
    world.add_sphere(large, materials[0]);
    let floor = Sphere::new(DVec3::new(0.0, -1e4 - 1.0, 4.0), 1e4).unwrap();
    world.add_sphere(floor, materials[0]);
    for number in 0..lights {
        let angle = 2.4 * number as f64;
        let toward = DVec3::new(libm::cos(angle), 0.7, -libm::sin(angle) - 0.3);
        let intensity = Color::new(0.6, 0.5, 0.4) * (2.0 / lights as f64);
        world.lights.extend(Light::directional(toward, intensity));
    }
    world.background = Color::new(0.0, 0.1, 0.2);
    world
}

fn view() -> View {
    View {
        camera: Camera::free(
            DVec3::ZERO,
            Angle::ZERO,
            Angle::ZERO,
            Angle::from_degrees(13.0),
        ),
        lens: Lens {
            width: 2.0,
            distance: 3.0,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0,
        width: 29,
        height: 21,
        frame: 1,
    }
}

fn pixels(world: &World, level: Level, tolerance: f64, side: u32) -> Vec<Pixel> {
    let view = view();
    let visibility = Visibility::new(world);
    let seen = ViewIndex::new(&visibility, &view, RayPoints::All);
    let integrator = Exact {
        level,
        ..Exact::new(world, &view, &seen, tolerance, true)
    };
    let mut found = vec![None; (view.width * view.height) as usize];
    let mut room = GroupScratch::default();
    for row in (0..view.height).step_by(side as usize) {
        for col in (0..view.width).step_by(side as usize) {
            let tile = Tile {
                col,
                row,
                width: side.min(view.width - col),
                height: side.min(view.height - row),
            };
            let mut pixels = Vec::new();
            integrator.integrate(tile, &mut room, &mut pixels);
            for ((col, row), pixel) in tile.pixels().zip(pixels) {
                found[(row * view.width + col) as usize] = Some(pixel);
            }
        }
    }
    found.into_iter().map(Option::unwrap).collect()
}

#[test]
fn processors_and_tiles_do_not_change_a_bit() {
    for (tolerance, lights) in [(1e-2, 2), (1e-4, 2), (1e-2, 1), (1e-4, 1), (1e-3, 9)] {
        let world = world(lights);
        let expected = pixels(&world, Level::new(), tolerance, Tile::SIDE);
        let partly = |pixel: &&Pixel| 0.0 < pixel.alpha && pixel.alpha < 1.0;
        assert!(expected.iter().filter(partly).count() > 30);
        // Some pixels with bumps end at their budget, which must not depend on tiles either.
        let is_over = |pixel: &&Pixel| pixel.status != Status::Met;
        let over = expected.iter().filter(is_over).count();
        assert!(over < 5, "{over} fall back on samples");
        for level in levels() {
            let found = pixels(&world, level, tolerance, Tile::SIDE);
            assert!(expected == found, "{level:?}");
        }
        // Tiles of one, two and four pixels lie in those of eight.
        let sides: &[u32] = if tolerance < 1e-3 { &[1] } else { &[1, 2, 4] };
        for &side in sides {
            let found = pixels(&world, Level::new(), tolerance, side);
            assert!(expected == found, "tiles of {side}");
        }
    }
}

/// The ninth light is alone in its group.
#[test]
fn nine_lights_add_up() {
    let all = world(9);
    let found = pixels(&all, Level::new(), 1e-3, Tile::SIDE);
    let mut sum = vec![Color::ZERO; found.len()];
    let mut errors: Vec<f64> = found.iter().map(|pixel| pixel.error).collect();
    // Outlines are in the part without lights.
    for part in all.light_parts() {
        let alone = pixels(&all.under(part), Level::new(), 1e-3, Tile::SIDE);
        for ((sum, error), pixel) in sum.iter_mut().zip(&mut errors).zip(alone) {
            *sum += pixel.value;
            *error += pixel.error;
        }
    }
    for ((found, sum), error) in found.iter().zip(sum).zip(errors) {
        let off = (found.value - sum).abs().max_element();
        assert!(off <= error, "{off:e} {error:e}");
    }
}

/// Spheres as large as a pixel, some of which hide and shade others: against sixty-four times
/// sixty-four samples of the same pixels.
#[test]
fn crowds_meet_their_tolerance() {
    let mut random = Random(9);
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    let shiny = world.add_material(Material {
        highlight: Some(Highlight {
            strength: 0.3,
            shininess: 8.0,
        }),
        exponent: 2.0,
        ..Material::MATTE_WHITE
    });
    for index in 0..2000 {
        let center = random.point() + DVec3::Z * 4.0;
        let radius = 0.02 + 0.05 * random.number();
        let material = if index % 3 == 0 { shiny } else { white };
        world.add_sphere(Sphere::new(center, radius).unwrap(), material);
    }
    for toward in [DVec3::new(-1.0, 1.0, -1.0), DVec3::new(0.5, 0.7, -0.2)] {
        let intensity = Color::splat(0.5);
        world.lights.extend(Light::directional(toward, intensity));
    }
    world.ambient = Color::splat(0.1);
    world.background = Color::splat(0.2);
    let view = view();
    let visibility = Visibility::new(&world);
    let seen = ViewIndex::new(&visibility, &view, RayPoints::All);
    let samples = NonZeroU32::new(64).unwrap();
    let sampled = Supersampling::new(&world, &view, &seen, samples, false);
    let exact = Exact::new(&world, &view, &seen, 1e-3, false);
    let tile = Tile {
        col: 8,
        row: 8,
        width: 8,
        height: 8,
    };
    let (mut expected, mut found) = (Vec::new(), Vec::new());
    sampled.integrate(tile, &mut Default::default(), &mut expected);
    let work = exact.integrate(tile, &mut Default::default(), &mut found);
    let (mut partly, mut square) = (0, 0.0);
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(found.status, Status::Met);
        let off = (found.value.x - expected.value.x).abs();
        // Edges along the grid cost samples a share of a row of them.
        assert!(off <= found.error + 0.2 * expected.error, "{off:e}");
        square += off * off;
        partly += u32::from(expected.error > 1e-3);
    }
    assert!(partly > 50, "{partly} pixels with edges");
    let mean = (square / found.len() as f64).sqrt();
    assert!(mean < 5e-4, "{mean:e}");
    // About a quarter more than was counted.
    assert!(work.samples < 130_000 && work.lines < 19_500, "{work:?}");
}

/// Spheres, light and dark in turn, under a light.
fn crowd(spheres: impl Iterator<Item = Sphere>, light: Light) -> World {
    let mut world = World::new();
    let materials = [0.9, 0.3].map(|albedo| {
        world.add_material(Material {
            albedo: Color::splat(albedo),
            ..Material::MATTE_WHITE
        })
    });
    for (index, sphere) in spheres.enumerate() {
        world.add_sphere(sphere, materials[index % 2]);
    }
    world.lights.push(light);
    world
}

/// Spheres that cannot be told apart are given up after a share of a pixel's budget: each part would be looked at as
/// well, and pairs of spheres, and of their shadows, cost more than the spheres.
#[test]
fn pixels_of_spheres_that_nearly_coincide_end_soon() {
    let sun = || Light::directional(DVec3::new(-1.0, 1.5, -1.0), Color::ONE).unwrap();
    let lamp = || {
        let position = DVec3::new(-3.0, 4.0, 0.0);
        PointLight::new(position, Color::ONE, LightFalloff::None, 1.0)
            .map(Light::Point)
            .unwrap()
    };
    const COUNT: u64 = 1500;
    for (case, light, spread, step) in [
        ("close", sun(), 1e-3, 0.0),
        ("closer", sun(), 1e-9, 0.0),
        ("under a lamp", lamp(), 1e-3, 0.0),
        ("toward the sun", sun(), 0.0, 2e-3),
    ] {
        let mut random = Random(COUNT);
        let sphere = |index| {
            let moved = random.point() * spread;
            let along = DVec3::new(-1.0, 1.5, -1.0) * (step * index as f64);
            Sphere::new(DVec3::Z * 8.0 + moved + along, 1.2).unwrap()
        };
        let world = crowd((0..COUNT).map(sphere), light);
        let view = View {
            width: 16,
            height: 8,
            ..view()
        };
        let visibility = Visibility::new(&world);
        let seen = ViewIndex::new(&visibility, &view, RayPoints::All);
        let exact = Exact::new(&world, &view, &seen, 1e-3, false);
        let mut room = GroupScratch::default();
        let (mut costliest, mut over) = (0, 0);
        for col in [0, 8] {
            let tile = Tile {
                col,
                row: 0,
                width: 8,
                height: 8,
            };
            let mut pixels = Vec::new();
            exact.integrate(tile, &mut room, &mut pixels);
            for (place, pixel) in pixels.iter().enumerate() {
                costliest = costliest.max(room.cost_of(place));
                over += u32::from(pixel.status != Status::Met);
                // No more than between white and black.
                assert!(pixel.error <= 0.901, "{case}: {pixel:?}");
            }
        }
        assert!(costliest <= MOST / 2, "{case}: {costliest}");
        // Of 128 pixels, most of which see them.
        assert!(over < 100, "{case}: {over}");
    }
}

/// No pixel lies farther from its value than all that its tile may show; one that does is among it, and says so.
#[test]
fn claims_are_no_larger_than_what_a_tile_may_show() {
    let world = world(3);
    let visibility = Visibility::new(&world);
    let view = view();
    let seen = ViewIndex::new(&visibility, &view, RayPoints::All);
    let range = [Color::splat(0.1), Color::new(0.6, 0.5, 0.4)];
    for alpha in [false, true] {
        let exact = Exact::new(&world, &view, &seen, 1e-3, alpha);
        let known = Pixel {
            value: Color::new(7.0, 0.3, -1.0),
            alpha: 0.75,
            error: 17.9,
            evidence: Evidence::Estimate,
            status: Status::OutOfBudget,
        };
        let mut pixel = known;
        exact.limit(&mut pixel, range);
        assert_eq!(pixel.value, Color::new(0.6, 0.3, 0.1));
        assert_eq!(pixel.evidence, Evidence::Bound);
        let of_alpha = if alpha { 0.75 * exact.unit } else { 0.0 };
        let expected = of_alpha.max(0.5);
        assert!((pixel.error - expected).abs() < 1e-8, "{pixel:?}");
        // What is known better stays as it is.
        let better = Pixel {
            error: 0.2,
            ..known
        };
        let mut pixel = better;
        exact.limit(&mut pixel, range);
        assert_eq!((pixel.value, pixel.error), (better.value, 0.2));
        assert_eq!(pixel.evidence, Evidence::Estimate);
    }
}

/// In a picture of crowds that nearly coincide, the work on a tile ends soon after its share.
#[test]
fn pictures_of_crowds_end() {
    const COUNT: u64 = 1500;
    for (case, spread, step) in [
        ("close", 1e-3, 0.0),
        ("closer", 1e-9, 0.0),
        ("toward the sun", 0.0, 2e-3),
    ] {
        let mut random = Random(COUNT);
        let toward = DVec3::new(-1.0, 1.5, -1.0);
        let sphere = |index| {
            let moved = random.point() * spread + toward * (step * index as f64);
            Sphere::new(DVec3::Z * 8.0 + moved, 2.0).unwrap()
        };
        let world = crowd(
            (0..COUNT).map(sphere),
            Light::directional(toward, Color::ONE).unwrap(),
        );
        let view = View {
            width: 600,
            height: 400,
            ..view()
        };
        let visibility = Visibility::new(&world);
        let seen = ViewIndex::new(&visibility, &view, RayPoints::All);
        let exact = Exact::new(&world, &view, &seen, 1e-3, false);
        let of_tile = exact.groups[0].of_crowds.of(COUNT as usize);
        // About 3000 of 3750 tiles see them.
        assert!((60_000..400_000).contains(&of_tile), "{case}: {of_tile}");
        let mut room = GroupScratch::default();
        let mut most = 0;
        for row in (96..304).step_by(16) {
            let tile = Tile {
                col: 304,
                row,
                width: 8,
                height: 8,
            };
            let mut pixels = Vec::new();
            exact.integrate(tile, &mut room, &mut pixels);
            most = most.max(room.exact.lit[0].crowds.spent());
            for pixel in pixels {
                // No more than between white and black, no less than a mixture of both may be off.
                assert!(pixel.error <= 0.901, "{case}: {pixel:?}");
                assert!(
                    pixel.status == Status::Met || pixel.error > 1e-3,
                    "{case}: {pixel:?}"
                );
            }
        }
        // A tile ends with what it has begun.
        assert!(most <= of_tile + 300_000, "{case}: {most} of {of_tile}");
    }
}

/// Nested spheres change no bit of a picture, nor what it costs, where the eye is outside of those around them.
#[test]
fn nested_spheres_change_nothing() {
    let mut random = Random(7);
    let outer: Vec<Sphere> = (0..30)
        .map(|_| Sphere::new(random.point() + DVec3::Z * 4.0, 0.2 + 0.2 * random.number()))
        .collect::<Result<_, _>>()
        .unwrap();
    let inner: Vec<Sphere> = (0..600)
        .map(|index| {
            let around = &outer[index % outer.len()];
            let radius = around.radius() * (0.1 + 0.5 * random.number());
            let moved = random.point() * (0.5 * (around.radius() - radius));
            Sphere::new(around.center() + moved, radius)
        })
        .collect::<Result<_, _>>()
        .unwrap();
    for position in [DVec3::new(-3.0, 4.0, 0.0), outer[3].center()] {
        let light = Light::directional(DVec3::new(-1.0, 1.5, -1.0), Color::splat(0.5)).unwrap();
        let mut alone = crowd(outer.iter().copied(), light);
        let mut with_nested = crowd(outer.iter().chain(&inner).copied(), light);
        for world in [&mut alone, &mut with_nested] {
            let lamp = PointLight::new(position, Color::splat(0.3), LightFalloff::None, 1.0);
            world.lights.extend(lamp.map(Light::Point));
        }
        let [expected, found] =
            [&alone, &with_nested].map(|world| pixels(world, Level::new(), 1e-3, Tile::SIDE));
        assert!(expected == found, "a lamp at {position}");
    }
}
