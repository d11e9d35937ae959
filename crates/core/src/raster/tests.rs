//! A raster sees what rays see, and is off by no more than it says.

use std::num::NonZeroU32;

use glam::DVec3;

use super::*;
use crate::model::camera::{Camera, Lens};
use crate::model::sphere::Sphere;
use crate::numeric::angle::Angle;
use crate::numeric::lanes::tests::levels;
use crate::picture::pixel::Pixel;
use crate::sampling::Supersampling;
use crate::search::grid::RayPoints;
use crate::search::tests::Random;
use crate::search::visibility::Visibility;

/// Rows of samples of which fewer make up for cells across a light.
const ENOUGH: u64 = 1 << 20;

/// A crowd of balls of several sizes and colors.
fn world(count: usize, lights: usize, random: &mut Random) -> World {
    let mut world = World::new();
    let materials = [0.9, 0.5, 0.2].map(|green| {
        world.add_material(Material {
            albedo: Color::new(0.8, green, 0.6),
            ..Material::MATTE_WHITE
        })
    });
    for number in 0..count {
        let center = random.point() + DVec3::Z * 5.0;
        let radius = 0.05 * libm::exp2(2.0 * random.number());
        world.add_sphere(Sphere::new(center, radius).unwrap(), materials[number % 3]);
    }
    for number in 0..lights {
        let toward = DVec3::new(1.0 - 1.5 * number as f64, 0.7, -0.8);
        let intensity = Color::new(0.6, 0.5, 0.7) / lights as f64;
        world.lights.extend(Light::directional(toward, intensity));
    }
    world.ambient = Color::splat(0.1);
    world.background = Color::new(0.3, 0.1, 0.0);
    world
}

/// 30 × 22 pixels, which tiles do not divide; those of the second kind are not square.
fn view(kind: usize) -> View {
    let lens = Lens::from_field_of_view(Angle::from_degrees(28.0)).unwrap();
    let camera = Camera {
        position: DVec3::new(0.2, -0.1, 0.3),
        ..Camera::default()
    };
    let mut view = View::new(camera, lens, 30, 22);
    if kind == 1 {
        view.lens.pixel_aspect = 1.3;
        view.lens.shift.x = 0.1 * view.lens.width;
    }
    view
}

fn tiles(view: &View) -> Vec<Tile> {
    let corners = |length: u32| (0..length).step_by(Tile::SIDE as usize);
    let (width, height) = (view.width, view.height);
    let tiles = corners(height).flat_map(|row| corners(width).map(move |col| (col, row)));
    let tile = |(col, row)| Tile {
        col,
        row,
        width: Tile::SIDE,
        height: Tile::SIDE,
    };
    tiles.map(tile).collect()
}

/// The pixels of a tile that are in the picture.
fn inside(tile: Tile, view: &View) -> impl Iterator<Item = (usize, (u32, u32))> {
    let (width, height) = (view.width, view.height);
    let pixels = tile.pixels().enumerate();
    pixels.filter(move |(_, (col, row))| *col < width && *row < height)
}

fn sampled(samples: &Supersampling<'_>, tile: Tile, view: &View) -> Vec<Pixel> {
    let tile = Tile {
        width: tile.width.min(view.width - tile.col),
        height: tile.height.min(view.height - tile.row),
        ..tile
    };
    let mut pixels = Vec::new();
    samples.integrate(tile, &mut Default::default(), &mut pixels);
    pixels
}

/// Rays, one by one, through the same points: what they see is exact, and so are their shadows. Only a sample
/// within rounding of an edge may see something else.
#[test]
fn samples_are_those_of_rays() {
    let mut random = Random(3);
    let (mut compared, mut differ) = (0, 0);
    for (case, side) in [4, 5, 8, 13].into_iter().enumerate() {
        for (shadows, alpha) in [(true, false), (false, true)] {
            let mut world = world(1500, 1 + case % 3, &mut random);
            world.shadows = shadows;
            let view = view(case % 2);
            let visibility = Visibility::new(&world);
            visibility.expect_rows(ENOUGH);
            let index = ViewIndex::new(&visibility, &view, RayPoints::All);
            let raster = Raster::new(&world, &view, &index, alpha).expect("a crowd");
            let sides = NonZeroU32::new(side).unwrap();
            let samples = Supersampling::new(&world, &view, &index, sides, alpha);
            let mut scratch = Scratch::default();
            for tile in tiles(&view) {
                let Some(found) = raster.pixels(tile, side, &mut scratch) else {
                    continue;
                };
                let expected = sampled(&samples, tile, &view);
                for ((place, _), expected) in inside(tile, &view).zip(expected) {
                    let found = &found[place];
                    let off = (found.value - expected.value).abs().max_element();
                    let off = off.max((found.alpha - expected.alpha).abs());
                    let of_sample = 1.0 / f64::from(side * side);
                    assert!(off < 2.5 * of_sample, "{off:e} in {place} of {tile:?}");
                    compared += 1;
                    differ += u32::from(off > 3e-6);
                }
            }
        }
    }
    assert!(compared > 4000, "{compared}");
    assert!(differ * 1000 < compared, "{differ} of {compared}");
}

/// Against sixty-four times sixty-four rays: no pixel is off by more than the standard errors that are claimed of
/// it, and by far less on the average.
#[test]
fn errors_are_what_neighbors_tell() {
    let mut random = Random(5);
    let (mut most, mut sum, mut count) = (0.0_f64, 0.0, 0);
    for case in 0..4 {
        let world = world(1500, 1 + case % 2, &mut random);
        let view = view(0);
        let visibility = Visibility::new(&world);
        visibility.expect_rows(ENOUGH);
        let index = ViewIndex::new(&visibility, &view, RayPoints::All);
        let raster = Raster::new(&world, &view, &index, case == 3).expect("a crowd");
        let fine = NonZeroU32::new(64).unwrap();
        let samples = Supersampling::new(&world, &view, &index, fine, case == 3);
        let mut scratch = Scratch::default();
        for tile in tiles(&view) {
            let Some(found) = raster.pixels(tile, 8, &mut scratch) else {
                continue;
            };
            let expected = sampled(&samples, tile, &view);
            for ((place, _), expected) in inside(tile, &view).zip(expected) {
                let found = &found[place];
                let off = (found.value - expected.value).abs().max_element();
                // What the rays themselves may be off by, of one edge along the grid.
                let ratio = (off - 0.1 * expected.error).max(0.0) / found.error;
                most = most.max(ratio);
                sum += ratio;
                count += 1;
            }
        }
    }
    assert!(count > 1500, "{count}");
    assert!(most < 6.0, "{most}");
    let mean = sum / f64::from(count);
    assert!((0.05..1.0).contains(&mean), "{mean}");
}

/// A ball that covers the corner of a pixel and none of the samples beside it, nor those of its neighbors along the grid:
/// that across the corner alone tells of it.
#[test]
fn balls_that_reach_across_a_corner_are_claimed() {
    let side = 4;
    let lens = Lens::from_field_of_view(Angle::from_degrees(1.0)).unwrap();
    let view = View::new(Camera::default(), lens, 16, 16);
    let mut world = World::new();
    world.ambient = Color::ONE;
    let white = world.add_material(Material {
        albedo: Color::ONE,
        ..Material::MATTE_WHITE
    });
    // The distance of samples, at the balls; their centers lie 0.6 of it from corners, along both axes.
    let distance = 100.0;
    let pixel = lens.width / 16.0 * distance;
    let step = pixel / f64::from(side);
    for row in (1..16).step_by(2) {
        for col in (1..16).step_by(2) {
            let center = DVec3::new(
                f64::from(col - 8) * pixel - 0.6 * step,
                f64::from(8 - row) * pixel + 0.6 * step,
                distance,
            );
            world.add_sphere(Sphere::new(center, 1.001 * step).unwrap(), white);
        }
    }
    // The part of a disc of radius 1 where x and y are more than 0.6: a sector less two triangles.
    let area = 0.5 * (libm::asin(0.8) - libm::asin(0.6)) - 0.6 * 0.2;
    let area = area / f64::from(side * side);
    let visibility = Visibility::new(&world);
    visibility.expect_rows(ENOUGH);
    let index = ViewIndex::new(&visibility, &view, RayPoints::All);
    let raster = Raster::new(&world, &view, &index, false).expect("a crowd");
    let mut scratch = Scratch::default();
    let mut seen = 0;
    for tile in tiles(&view) {
        let Some(found) = raster.pixels(tile, side, &mut scratch) else {
            continue;
        };
        for (place, (col, row)) in inside(tile, &view) {
            if col % 2 == 1 && row % 2 == 1 {
                assert_eq!(found[place].value, Color::ZERO);
                let claimed = 6.0 * found[place].error;
                assert!(claimed > area, "{claimed:e} of {area:e}");
                seen += 1;
            }
        }
    }
    assert_eq!(seen, 64);
}

/// Black balls that touch, row above row, before white ones: between two rows of samples, which see black, the white
/// shows on both sides of where they touch.
#[test]
fn strips_of_what_is_brighter_are_claimed() {
    let side = 6;
    let lens = Lens::from_field_of_view(Angle::from_degrees(1.0)).unwrap();
    let view = View::new(Camera::default(), lens, 32, 32);
    let mut world = World::new();
    world.ambient = Color::ONE;
    let [black, white] = [0.02, 0.9].map(|albedo| {
        world.add_material(Material {
            albedo: Color::splat(albedo),
            ..Material::MATTE_WHITE
        })
    });
    let pixel = lens.width / 32.0 * 1000.0;
    let radius = 2.3;
    let mut add = |x: f64, y: f64, behind: f64, radius: f64, material| {
        let center = DVec3::new(x - 16.0, 16.0 - y, 0.0) * pixel + DVec3::Z * (1000.0 + behind);
        world.add_sphere(Sphere::new(center, radius * pixel).unwrap(), material);
    };
    for col in 0..7 {
        for row in 0..8 {
            let (x, y) = (5.0 * f64::from(col) + 0.5, 2.0 * radius * f64::from(row));
            add(x, y - 0.1 * f64::from(col), 0.0, radius, black);
        }
    }
    for col in 0..12 {
        for row in 0..12 {
            add(3.0 * f64::from(col), 3.0 * f64::from(row), 10.0, 5.0, white);
        }
    }
    let visibility = Visibility::new(&world);
    visibility.expect_rows(ENOUGH);
    let index = ViewIndex::new(&visibility, &view, RayPoints::All);
    let raster = Raster::new(&world, &view, &index, false).expect("a crowd");
    let fine = NonZeroU32::new(64).unwrap();
    let samples = Supersampling::new(&world, &view, &index, fine, false);
    let (mut scratch, mut most, mut dark) = (Scratch::default(), 0.0_f64, 0);
    for tile in tiles(&view) {
        let found = raster.pixels(tile, side, &mut scratch).expect("a crowd");
        let expected = sampled(&samples, tile, &view);
        for ((place, _), expected) in inside(tile, &view).zip(expected) {
            let found = &found[place];
            let off = (found.value - expected.value).abs().max_element();
            most = most.max((off - 0.1 * expected.error).max(0.0) / found.error);
            dark += u32::from(found.value.x < 0.021 && off > 0.01);
        }
    }
    assert!(dark >= 4, "{dark} strips");
    assert!(most < 7.0, "{most}");
}

/// All of a picture, to the bit.
fn bits(raster: &Raster<'_>, view: &View) -> Vec<Option<Vec<[u64; 3]>>> {
    let mut scratch = Scratch::default();
    let pixels = tiles(view).into_iter().map(|tile| {
        let found = raster.pixels(tile, 6, &mut scratch)?;
        let bits = found
            .iter()
            .map(|pixel| [pixel.value.x, pixel.value.z, pixel.error].map(f64::to_bits));
        Some(bits.collect())
    });
    pixels.collect()
}

#[test]
fn the_same_bits_on_every_processor_and_in_every_unit() {
    let world = world(1200, 2, &mut Random(7));
    let view = view(1);
    let visibility = Visibility::new(&world);
    visibility.expect_rows(ENOUGH);
    let index = ViewIndex::new(&visibility, &view, RayPoints::All);
    let mut raster = Raster::new(&world, &view, &index, false).expect("a crowd");
    let first = bits(&raster, &view);
    assert!(first.iter().flatten().count() > 3);
    for level in levels() {
        raster.level = level;
        assert!(bits(&raster, &view) == first, "{level:?}");
    }
    let mut bright = world.clone();
    let factor = libm::exp2(150.0);
    bright.background *= factor;
    bright.ambient *= factor;
    bright.lights.clear();
    for light in &world.lights {
        let toward = light.toward().unwrap();
        let intensity = light.intensity() * factor;
        bright.lights.extend(Light::directional(toward, intensity));
    }
    let visibility = Visibility::new(&bright);
    visibility.expect_rows(ENOUGH);
    let index = ViewIndex::new(&visibility, &view, RayPoints::All);
    let raster = Raster::new(&bright, &view, &index, false).expect("a crowd");
    let dimmed = |bits: u64| (f64::from_bits(bits) / factor).to_bits();
    let same = bits(&raster, &view).into_iter().map(|tile| {
        let pixels = tile?.into_iter();
        Some(pixels.map(|numbers| numbers.map(dimmed)).collect())
    });
    assert!(same.eq(first));
}

/// Balls that single precision cannot tell apart, of different colors: nothing is said of their pixels.
#[test]
fn balls_that_coincide_are_left_to_others() {
    let mut world = World::new();
    let colors = [0.2, 0.9].map(|albedo| {
        world.add_material(Material {
            albedo: Color::splat(albedo),
            ..Material::MATTE_WHITE
        })
    });
    world.ambient = Color::ONE;
    let mut random = Random(11);
    for _ in 0..200 {
        let center = random.point() * 0.7 + DVec3::Z * 5.0;
        for (place, color) in colors.into_iter().enumerate() {
            let radius = 0.1 + 1e-9 * place as f64;
            world.add_sphere(Sphere::new(center, radius).unwrap(), color);
        }
    }
    let view = view(0);
    let visibility = Visibility::new(&world);
    visibility.expect_rows(ENOUGH);
    let index = ViewIndex::new(&visibility, &view, RayPoints::All);
    let raster = Raster::new(&world, &view, &index, false).expect("a crowd");
    let (mut scratch, mut covered) = (Scratch::default(), 0);
    for tile in tiles(&view) {
        for pixel in raster.pixels(tile, 4, &mut scratch).into_iter().flatten() {
            if pixel.alpha > 0.5 {
                assert_eq!(pixel.error, f64::INFINITY);
                covered += 1;
            }
        }
    }
    assert!(covered > 50, "{covered}");
}

/// Tiles with a ball that is too large, too small, or around the eye, and worlds with what a raster does not know.
#[test]
fn what_it_does_not_know_is_left_to_others() {
    let view = view(0);
    let is_known = |change: &dyn Fn(&mut World)| {
        let mut world = world(1500, 1, &mut Random(13));
        change(&mut world);
        let visibility = Visibility::new(&world);
        visibility.expect_rows(ENOUGH);
        let index = ViewIndex::new(&visibility, &view, RayPoints::All);
        let raster = Raster::new(&world, &view, &index, false)?;
        let middle = tiles(&view)[5];
        raster.pixels(middle, 4, &mut Scratch::default())
    };
    let add = |world: &mut World, center: DVec3, radius: f64| {
        let material = world.add_material(Material::MATTE_WHITE);
        world.add_sphere(Sphere::new(center, radius).unwrap(), material);
    };
    assert!(is_known(&|_| ()).is_some());
    assert!(is_known(&|world| add(world, DVec3::Z * 4.0, 2e-3)).is_none());
    let below = DVec3::new(0.0, -1e4 - 1.2, 5.0);
    assert!(is_known(&|world| add(world, below, 1e4)).is_none());
    assert!(is_known(&|world| add(world, view.camera.position, 20.0)).is_none());
    let add_lamp = |world: &mut World| {
        let falloff = crate::model::light::LightFalloff::None;
        let lamp = crate::model::light::PointLight::new(DVec3::Y, Color::ONE, falloff, 1.0);
        world.lights.extend(lamp.map(Light::Point));
    };
    assert!(is_known(&add_lamp).is_none());
    let add_highlight = |world: &mut World| {
        world.add_material(Material {
            highlight: Some(Default::default()),
            ..Material::MATTE_WHITE
        });
    };
    assert!(is_known(&add_highlight).is_none());
}

/// Balls lit from the side, each in the shadow of one that leaves a ring: between its shadow and where a ball turns
/// away from the light a strip is lit that no sample sees.
#[test]
fn light_between_a_shadow_and_where_a_ball_turns_away_is_claimed() {
    let side = 4;
    let lens = Lens::from_field_of_view(Angle::from_degrees(0.1)).unwrap();
    let view = View::new(Camera::default(), lens, 32, 32);
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    let sun = Light::directional(DVec3::X, Color::ONE).unwrap();
    world.lights.push(sun);
    let distance = 1e5;
    let pixel = lens.width / 32.0 * distance;
    let mut add = |x: f64, y: f64, ahead: f64, radius: f64| {
        let center = DVec3::new(x - 16.0, 16.0 - y, -ahead) * pixel + DVec3::Z * distance;
        world.add_sphere(Sphere::new(center, radius * pixel).unwrap(), white);
    };
    for number in 0..16 {
        let (left, top) = (8.0 * f64::from(number % 4), 8.0 * f64::from(number / 4));
        // Its middle lies a bit to the right of a column of samples: the strip ends before the next one. Light of
        // cosines up to 0.06 passes the other ball. No ball of a row lies in the shadow of one of another tile.
        let (x, y, ahead) = (left + 4.0 + 0.51 / f64::from(side), top + 2.0, 10.0 * left);
        add(x, y, ahead, 4.0);
        add(x + 1e3, y, ahead, 4.0 * libm::sqrt(1.0 - 0.06 * 0.06));
        // What makes a crowd of the tile.
        for place in 0..18 {
            add(left + 0.44 * f64::from(place), top + 7.4, ahead + 8.0, 0.26);
        }
    }
    let visibility = Visibility::new(&world);
    visibility.expect_rows(ENOUGH);
    let index = ViewIndex::new(&visibility, &view, RayPoints::All);
    let raster = Raster::new(&world, &view, &index, false).expect("a crowd");
    let fine = NonZeroU32::new(64).unwrap();
    let samples = Supersampling::new(&world, &view, &index, fine, false);
    let (mut scratch, mut most, mut dark) = (Scratch::default(), 0.0_f64, 0);
    for tile in tiles(&view) {
        let Some(found) = raster.pixels(tile, side, &mut scratch) else {
            continue;
        };
        let expected = sampled(&samples, tile, &view);
        for ((place, _), expected) in inside(tile, &view).zip(expected) {
            let off = (found[place].value - expected.value).abs().max_element();
            most = most.max(off / found[place].error);
            dark += u32::from(found[place].value == Color::ZERO && off > 0.005);
        }
    }
    assert!(dark >= 16, "{dark} strips");
    assert!(most < 6.0, "{most}");
}
