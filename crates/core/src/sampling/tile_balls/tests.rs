//! Nothing is left out of a row that may be seen there.

use fearless_simd::{Level, dispatch};
use glam::DVec2;

use super::*;
use crate::model::camera::{Camera, Lens};
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::numeric::angle::Angle;
use crate::picture::tile::Tile;
use crate::sampling::rays::{Place, Rays, Spread};
use crate::search::tests::{Random, aspect};

/// A view from anywhere in any direction, and a tile of it that may be cut short.
fn view(random: &mut Random) -> (View, Tile) {
    let mut degrees = |range: f64| Angle::from_degrees(range * (random.number() - 0.5));
    let (azimuth, elevation, roll) = (degrees(720.0), degrees(300.0), degrees(360.0));
    let distance = 6.0 * random.number();
    let camera = Camera::orbit(random.point(), distance, azimuth, elevation, roll);
    let lens = Lens {
        width: 0.1 + 2.0 * random.number(),
        distance: 1.0,
        shift: DVec2::new(random.number() - 0.5, random.number() - 0.5),
        pixel_aspect: aspect(random),
    };
    let view = View {
        camera,
        lens,
        zoom: 1.0,
        width: 40,
        height: 27,
        frame: 1,
    };
    let (col, row) = (
        8 * (5.0 * random.number()) as u32,
        8 * (4.0 * random.number()) as u32,
    );
    let tile = Tile {
        col,
        row,
        width: 8,
        height: 8.min(27 - row),
    };
    (view, tile)
}

/// Balls of all sizes, half of which end at a line's rays, by less or more than a billionth.
#[test]
fn rows_and_columns_without_a_ball_do_not_see_it() {
    let mut random = Random(31);
    for of_columns in [false, true] {
        let (mut seen, mut asked) = (0, 0);
        for round in 0..400 {
            let (seen_now, asked_now) = lines_see(&mut random, [1, 2, 5][round % 3], of_columns);
            (seen, asked) = (seen + seen_now, asked + asked_now);
        }
        assert!(4 * seen < 3 * asked, "{seen} of {asked}");
    }
}

/// In a random tile, eight balls beside rays are in the rows, or in the columns, that see them; those lines and all.
fn lines_see(random: &mut Random, side: u32, of_columns: bool) -> (u32, u32) {
    let (view, tile) = view(random);
    let rays = Rays::new(&view, side);
    let ray_of = |[col, row, cell_col, cell_row]: [u32; 4]| {
        let place = Place {
            col: tile.col + col,
            row: tile.row + row,
            cell_col,
            cell_row,
            spread: Spread::Pixels,
        };
        rays.ray(place, 0)
    };
    let size = [tile.width, tile.height, side, side];
    let mut touched = [(); LANES].map(|()| {
        let place = size.map(|count| (random.number() * f64::from(count)) as u32);
        ray_of(place)
    });
    let axes = view.camera.world_from_camera;
    let along = if of_columns { axes.y_axis } else { axes.x_axis };
    let spheres: Vec<Sphere> = touched
        .iter_mut()
        .map(|ray| {
            let radius = libm::exp10(3.0 * random.number() - 3.0);
            let aside = along.cross(ray.direction);
            let outward = aside.normalize() * (1.0 - 2.0 * random.number().round());
            let off = [0.0, -1e-9, 1e-9, -0.5][(4.0 * random.number()) as usize];
            let touch = ray.at(0.5 + 4.0 * random.number());
            let center = touch + outward * (radius * (1.0 + off));
            Sphere::new(center, radius).unwrap()
        })
        .collect();
    let balls = Ball::all((0..).zip(&spheres), view.camera.position, 0);
    let group: [&Ball; LANES] = std::array::from_fn(|lane| &balls[lane]);
    let bundle = rays.bundle(tile);
    let lines = if of_columns {
        &bundle.columns
    } else {
        &bundle.rows
    };
    let found = dispatch!(Level::new(), simd => {
        BallGroup::new(simd, &group).lines(simd, lines)
    });
    let across = if of_columns { tile.height } else { tile.width };
    let (mut seen, mut asked) = (0, 0);
    for (sphere, found) in spheres.iter().zip(found) {
        (seen, asked) = (seen + found.count_ones(), asked + lines.count);
        for line in (0..lines.count).filter(|line| found >> line & 1 == 0) {
            for cell in 0..side * side * across {
                let (cell, along) = (cell / across, cell % across);
                let [col, row] = if of_columns {
                    [line, along]
                } else {
                    [along, line]
                };
                let ray = ray_of([col, row, cell % side, cell / side]);
                assert!(sphere.hit(&ray).is_none());
            }
        }
        assert_eq!(u32::from(found) >> lines.count, 0);
    }
    (seen, asked)
}
