//! Cells against rays that are computed one by one.

use super::*;
use crate::edges::tests::{any_cell, at, ball, coordinate, direction, magnitude, ray, value};
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
fn transposed_cells_see_the_same_rays_with_their_coordinates_exchanged() {
    let mut random = Random(2);
    for _ in 0..500 {
        let cell = any_cell(&mut random);
        let (x, y) = (coordinate(&mut random), coordinate(&mut random));
        assert_eq!(ray(&cell.transposed(), y, x), ray(&cell, x, y));
        assert_eq!(cell.transposed().transposed(), cell);
        assert_eq!(cell.transposed().ray_sq(), cell.ray_sq().transposed());
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
fn points_on_a_ray_are_placed_where_it_passes() {
    let mut random = Random(4);
    for _ in 0..2000 {
        let cell = any_cell(&mut random);
        let (x, y) = (coordinate(&mut random), coordinate(&mut random));
        let d = ray(&cell, x, y);
        let (found_x, found_y) = cell.place(d * magnitude(&mut random, 1e-3, 1e6));
        let close = 1e-15 * (1.0 + d.length());
        assert!((found_x - x).abs() * cell.size[0] < close);
        assert!((found_y - y).abs() * cell.size[1] < close);
    }
}

/// Of a thousand points of the sphere's lit side none is nearer to the caster's axis.
#[test]
fn under_a_caster_is_the_point_nearest_its_axis() {
    let mut random = Random(5);
    let mut crossed = 0;
    for _ in 0..100 {
        let sphere = ball(random.point() * 10.0, magnitude(&mut random, 0.1, 10.0));
        let toward = direction(&mut random);
        let (right, up) = toward.any_orthonormal_pair();
        let aside = right * random.point().x * 2.0 + up * random.point().y * 2.0;
        let caster = Caster {
            center: sphere.center + (toward * 3.0 + aside) * sphere.radius,
            radius: sphere.radius * random.number(),
            right,
            up,
        };
        let found = sphere.under(&caster, toward);
        let normal = (found - sphere.center) / sphere.radius;
        assert!((normal.length() - 1.0).abs() < 1e-12);
        assert!(normal.dot(toward) > -1e-7, "lit by the light");
        let nearest = caster.project(found).length();
        crossed += u32::from(nearest < 1e-9 * sphere.radius);
        for _ in 0..1000 {
            let mut normal = direction(&mut random);
            normal *= normal.dot(toward).signum();
            let other = sphere.center + normal * sphere.radius;
            assert!(caster.project(other).length() >= nearest - 1e-9 * sphere.radius);
        }
    }
    assert!((5..95).contains(&crossed), "{crossed} axes meet the sphere");
}

#[test]
fn balls_are_apart_beyond_the_root_of_two_radii() {
    let at_distance = |distance: f64| ball(DVec3::Z * distance, 1.0);
    assert!(at_distance(1.5).is_apart());
    assert!(!at_distance(1.4).is_apart() && !at_distance(0.5).is_apart());
}
