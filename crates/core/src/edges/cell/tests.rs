//! Cells against rays that are computed one by one.

use super::*;
use crate::edges::tests::{any_cell, at, ball, coordinate, magnitude, ray, value};
use crate::search::tests::Random;

#[test]
fn products_are_those_of_the_ray() {
    let mut random = Random(1);
    for _ in 0..2000 {
        let cell = any_cell(&mut random);
        let vector = random.point() * magnitude(&mut random, 1e-3, 1e3);
        let (x, y) = (coordinate(&mut random), coordinate(&mut random));
        let d = ray(&cell, x, y);
        let close = 1e-14 * (1.0 + cell.middle.length() + cell.size[0] + cell.size[1]);
        let scale = close * vector.length();
        assert!((at(&cell.dot(vector), x, y) - d.dot(vector)).abs() < scale);
        let cross = d.cross(vector);
        for (axis, part) in cell.cross(vector).iter().enumerate() {
            assert!((at(part, x, y) - cross[axis]).abs() < scale);
        }
        let (square, terms) = value(&cell.ray_sq(), x, y);
        assert!((square - d.length_squared()).abs() < 1e-14 * terms);
    }
}

#[test]
fn parts_see_the_rays_of_the_whole() {
    let mut random = Random(3);
    for _ in 0..500 {
        let cell = any_cell(&mut random);
        let mut range = || {
            let (one, other) = (coordinate(&mut random), coordinate(&mut random));
            [one.min(other), one.max(other)]
        };
        let (xs, ys) = (range(), range());
        let part = cell.part(xs, ys);
        for (x, y) in [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.2, 0.4)] {
            let inside = |range: [f64; 2], at: f64| range[0] + (at + 0.5) * (range[1] - range[0]);
            let whole = ray(&cell, inside(xs, x), inside(ys, y));
            let off = (ray(&part, x, y) - whole).length();
            assert!(
                off < 1e-14 * (1.0 + whole.length()),
                "{cell:?} {xs:?} {ys:?}"
            );
        }
    }
}

#[test]
fn balls_are_apart_beyond_the_root_of_two_radii() {
    let at_distance = |distance: f64| ball(DVec3::Z * distance, 1.0);
    assert!(at_distance(1.5).is_apart());
    assert!(!at_distance(1.4).is_apart() && !at_distance(0.5).is_apart());
}
