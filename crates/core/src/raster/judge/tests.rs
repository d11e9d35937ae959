//! Straight edges in all directions, whose pixels are known in closed form.

use glam::DVec2;

use super::*;
use crate::model::camera::{Camera, Lens};
use crate::model::view::View;
use crate::numeric::angle::Angle;
use crate::picture::image::Channels;
use crate::raster::plane::Plane;

const TILE: Tile = Tile {
    col: 0,
    row: 0,
    width: Tile::SIDE,
    height: Tile::SIDE,
};

/// The samples of a ball that fills the tile, lit where a place, in pixels, lies beyond a line, else in a shadow.
fn lit_beyond(plane: &Plane, side: usize, is_lit: impl Fn(DVec2) -> bool) -> Samples {
    let mut samples = Samples::default();
    samples.reset(plane, 1, &[0.0]);
    samples.balls.fill(0.0);
    for row in 0..plane.count {
        for column in 0..plane.count {
            let sample = DVec2::new(column as f64, row as f64) - 0.5;
            let place = row * plane.stride + column;
            if is_lit(sample / side as f64) {
                samples.light[0][place] = 1.0;
            } else {
                samples.kept[place] = 1.0;
                samples.occluders[place] = 0.5;
            }
        }
    }
    samples
}

/// The part of the unit square where x · normal > level, for a normal with positive parts: the triangle below the level,
/// less those beyond the square.
fn beyond(normal: DVec2, level: f64) -> f64 {
    let below = |level: f64| level.max(0.0).powi(2);
    let corners = below(level) - below(level - normal.x) - below(level - normal.y)
        + below(level - normal.x - normal.y);
    1.0 - corners / (2.0 * normal.x * normal.y)
}

/// Along a diagonal an edge is at the same place between the samples of every row.
#[test]
fn straight_edges_are_within_six_standard_errors() {
    let lens = Lens::from_field_of_view(Angle::from_degrees(1.0)).unwrap();
    let view = View::new(Camera::default(), lens, Tile::SIDE, Tile::SIDE);
    let mut largest = 0.0_f64;
    for side in [8, 12, 16, 24, 32] {
        let plane = Plane::new(&view, TILE, side);
        let side = side as usize;
        // Whole numbers of samples up for some of them along.
        for (x, y) in [(1, 1), (1, 2), (1, 3), (2, 3), (1, 20), (7, 8), (20, 1)] {
            let normal = DVec2::new(f64::from(x), f64::from(y)).normalize();
            for step in 0..12 {
                // Through the middle of the tile, and a little further from sample to sample.
                let level = normal.dot(DVec2::splat(4.1)) + f64::from(step) / (10.0 * side as f64);
                let samples = lit_beyond(&plane, side, |place| normal.dot(place) > level);
                let weights = Weights {
                    side,
                    channels: Channels::Grey,
                    of_spheres: 1.0,
                    of_background: 0.0,
                    brightest: 1.0,
                    of_albedos: 1.0,
                };
                for (number, pixel) in pixels(Level::new(), &samples, &weights).iter().enumerate() {
                    let corner = DVec2::new((number % SIDE) as f64, (number / SIDE) as f64);
                    let expected = beyond(normal, level - normal.dot(corner));
                    let off = (pixel.value.x - expected).abs();
                    let claim = 6.0 * pixel.error + 1e-6;
                    assert!(off <= claim, "{off} of {claim}, {side}, {normal}, {level}");
                    largest = largest.max(off / claim);
                }
            }
        }
    }
    assert!(largest > 0.5, "{largest}");
}
