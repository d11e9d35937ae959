//! Pixels of crowds meet their tolerance by samples, whatever tile they are asked for in.

use glam::DVec3;

use super::*;
use crate::exact::integrator::Exact;
use crate::model::camera::{Camera, Lens};
use crate::model::color::Color;
use crate::model::light::Light;
use crate::model::material::Material;
use crate::model::sphere::Sphere;
use crate::numeric::angle::Angle;
use crate::search::grid::RayPoints;
use crate::search::tests::Random;
use crate::search::visibility::Visibility;

/// Balls of about a pixel, most of which others hide or shade.
fn crowd() -> World {
    let mut random = Random(19);
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    for _ in 0..20_000 {
        let center = random.point() + DVec3::Z * 5.0;
        world.add_sphere(Sphere::new(center, 0.03).unwrap(), white);
    }
    let toward = DVec3::new(-1.0, 1.0, -1.0);
    world.lights.extend(Light::directional(toward, Color::ONE));
    world
}

fn tiles(view: &View, side: u32) -> Vec<Tile> {
    let corners = |length: u32| (0..length).step_by(side as usize);
    let rows = corners(view.height).map(|row| (row, side.min(view.height - row)));
    let columns = corners(view.width).map(|col| (col, side.min(view.width - col)));
    let columns: Vec<(u32, u32)> = columns.collect();
    let tiles = rows.flat_map(|(row, height)| {
        let columns = columns.iter();
        columns.map(move |&(col, width)| Tile {
            col,
            row,
            width,
            height,
        })
    });
    tiles.collect()
}

/// All pixels in the order of rows, by tiles with so many pixels on a side, and the number of samples.
fn picture(exact: &Exact<'_>, view: &View, side: u32) -> (Vec<Pixel>, u64) {
    let mut pixels = vec![exact.empty_pixel(); (view.width * view.height) as usize];
    let (mut scratch, mut samples) = (Default::default(), 0);
    for tile in tiles(view, side) {
        let mut found = Vec::new();
        samples += exact.integrate(tile, &mut scratch, &mut found).samples;
        for ((col, row), pixel) in tile.pixels().zip(found) {
            pixels[(row * view.width + col) as usize] = pixel;
        }
    }
    (pixels, samples)
}

#[test]
fn crowds_meet_loose_tolerances_by_samples() {
    let world = crowd();
    let lens = Lens::from_field_of_view(Angle::from_degrees(24.0)).unwrap();
    let view = View::new(Camera::default(), lens, 44, 30);
    let visibility = Visibility::new(&world);
    let index = ViewIndex::new(&visibility, &view, RayPoints::All);
    let exact = |tolerance| Exact::new(&world, &view, &index, tolerance, false);
    let loose = exact(0.1);
    let (found, samples) = picture(&loose, &view, Tile::SIDE);
    let crowd = loose.crowd.as_ref().expect("a crowd");
    let side = crowd.side.get().copied().flatten().expect("samples pay");
    // Most pixels are sampled, and few are integrated besides.
    let all = u64::from(view.width * view.height * side * side);
    assert!(
        (all * 9 / 10..all * 3 / 2).contains(&samples),
        "{samples} of {all}"
    );
    let (expected, _) = picture(&exact(1e-4), &view, Tile::SIDE);
    let mut largest = 0.0_f64;
    for (place, (found, expected)) in found.iter().zip(&expected).enumerate() {
        assert_eq!(found.status, Status::Met);
        let off = (found.value - expected.value).abs().max_element() - expected.error;
        assert!(off <= found.error, "{off:e} in {place}");
        largest = largest.max(off);
    }
    assert!(largest > 1e-3, "{largest:e}");
    for side in [1, 4] {
        assert!(picture(&loose, &view, side).0 == found, "tiles of {side}");
    }
    assert!(exact(0.9e-2).crowd.is_none());
}
