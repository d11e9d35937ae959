//! Nothing is left out of a row that may be seen there.

use fearless_simd::{Level, dispatch};
use glam::DVec2;

use super::*;
use crate::model::camera::{Camera, Lens};
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::numeric::angle::Angle;
use crate::picture::tile::Tile;
use crate::sampling::rays::{Place, Rays};
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

/// Balls of all sizes, half of which end at a row's rays, by less or more than a billionth.
#[test]
fn rows_without_a_ball_do_not_see_it() {
    let mut random = Random(31);
    let (mut seen, mut asked) = (0, 0);
    for round in 0..400 {
        let (view, tile) = view(&mut random);
        let side = [1, 2, 5][round % 3];
        let rays = Rays::new(&view, side);
        let mut ray_of_any = || {
            let mut below = |count: u32| (random.number() * f64::from(count)) as u32;
            let place = Place {
                col: tile.col,
                row: tile.row + below(tile.height),
                cell_col: below(side),
                cell_row: below(side),
                is_scattered: false,
            };
            rays.ray(place, below(8) as usize)
        };
        let touched: Vec<_> = (0..LANES).map(|_| ray_of_any()).collect();
        let spheres: Vec<Sphere> = touched
            .iter()
            .map(|ray| {
                let radius = libm::exp10(3.0 * random.number() - 3.0);
                let up = view.camera.world_from_camera.x_axis.cross(ray.direction);
                let outward = up.normalize() * (1.0 - 2.0 * random.number().round());
                let off = [0.0, -1e-9, 1e-9, -0.5][(4.0 * random.number()) as usize];
                let touch = ray.at(0.5 + 4.0 * random.number());
                let center = touch + outward * (radius * (1.0 + off));
                Sphere::new(center, radius).unwrap()
            })
            .collect();
        let balls = Ball::all((0..).zip(&spheres), view.camera.position, 0);
        let group: [&Ball; LANES] = std::array::from_fn(|lane| &balls[lane]);
        let bundle = rays.bundle(tile);
        let rows = dispatch!(Level::new(), simd => {
            BallGroup::new(simd, &group).rows(simd, &bundle.rows)
        });
        for (sphere, rows) in spheres.iter().zip(rows) {
            asked += 8 * tile.height;
            seen += 8 * rows.count_ones();
            for row in (0..tile.height).filter(|row| rows >> row & 1 == 0) {
                for (cell_row, cell_col) in (0..side * side).map(|cell| (cell / side, cell % side))
                {
                    for lane in 0..LANES {
                        let place = Place {
                            col: tile.col,
                            row: tile.row + row,
                            cell_col,
                            cell_row,
                            is_scattered: false,
                        };
                        assert!(sphere.hit(&rays.ray(place, lane)).is_none());
                    }
                }
            }
            assert_eq!(u32::from(rows) >> tile.height, 0);
        }
    }
    assert!(4 * seen < 3 * asked, "{seen} of {asked}");
}
