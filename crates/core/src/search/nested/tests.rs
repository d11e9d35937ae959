//! Spheres taken for nested are nested, and hidden from the eyes that they are said to be hidden from.

use glam::DVec3;

use super::*;
use crate::model::camera::{Camera, Lens};
use crate::numeric::angle::Angle;
use crate::search::tests::Random;

/// Balls of all sizes, most of which lie inside of others, some of these inside of a third.
fn spheres() -> Vec<Sphere> {
    let mut random = Random(5);
    let mut spheres: Vec<Sphere> = Vec::new();
    for index in 0..2000 {
        let (around, radius) = match index % 10 {
            0 => (None, 0.5 + 0.5 * random.number()),
            _ => {
                let place = (random.number() * index as f64) as usize;
                (Some(spheres[place]), 0.02 + 0.9 * random.number())
            }
        };
        let sphere = match around {
            None => Sphere::new(random.point() * 20.0, radius),
            Some(around) => {
                let radius = around.radius() * radius;
                let moved = random.point() * (around.radius() - radius);
                Sphere::new(around.center() + moved, radius)
            }
        };
        spheres.push(sphere.unwrap());
    }
    spheres
}

/// Whether one sphere lies inside of another, with squares of distances in integers of 2⁻⁴⁰.
fn lies_inside(inner: &Sphere, outer: &Sphere) -> bool {
    let whole = |x: f64| (x * 2_f64.powi(40)).round() as i128;
    let offset = (inner.center() - outer.center()).to_array().map(whole);
    let room = whole(outer.radius()) - whole(inner.radius());
    room > 0 && offset.iter().map(|x| x * x).sum::<i128>() <= (room + 2) * (room + 2)
}

#[test]
fn nested_spheres_are_found() {
    let spheres = spheres();
    let nested = Nested::find(&spheres, &Hierarchy::new(&spheres)).unwrap();
    let (mut expected, mut found) = (0, 0);
    for (sphere, &is_nested) in spheres.iter().zip(&nested.is_nested) {
        let is_in = |outer: &&Sphere| *outer != sphere && lies_inside(sphere, outer);
        let lies_inside = spheres.iter().any(|outer| is_in(&outer));
        assert!(lies_inside || !is_nested, "{sphere:?}");
        expected += u32::from(lies_inside);
        found += u32::from(is_nested);
        // Those around them are the outermost.
        let is_known = |outer: &&Sphere| is_in(outer);
        assert!(!is_nested || nested.around.iter().any(|outer| is_known(&outer)));
    }
    assert!(expected > 800, "{expected}");
    assert!(found * 100 >= expected * 95, "{found} of {expected}");
}

#[test]
fn few_nested_spheres_are_not_sought() {
    let mut random = Random(6);
    let apart = (0..2000).map(|_| Sphere::new(random.point(), 0.01).unwrap());
    let mut spheres: Vec<Sphere> = apart.collect();
    spheres.push(Sphere::new(spheres[0].center(), 0.005).unwrap());
    assert!(Nested::find(&spheres, &Hierarchy::new(&spheres)).is_none());
}

#[test]
fn an_eye_inside_sees_them() {
    let spheres = [1.0, 0.5, 0.4, 0.3].map(|radius| Sphere::new(DVec3::ZERO, radius).unwrap());
    let nested = Nested::find(&spheres, &Hierarchy::new(&spheres)).unwrap();
    assert_eq!(nested.is_nested, [false, true, true, true]);
    for (z, distance, is_hidden) in [
        (-2.0, 1.0, true),
        (-1.0, 1.0, false),
        (-0.9, 1.0, false),
        (-2.0, f64::INFINITY, true),
        (-0.9, f64::INFINITY, false),
        (2.0, f64::INFINITY, false),
    ] {
        let view = View {
            camera: Camera::free(DVec3::Z * z, Angle::ZERO, Angle::ZERO, Angle::ZERO),
            lens: Lens {
                width: 2.0,
                distance,
                shift: glam::DVec2::ZERO,
                pixel_aspect: 1.0,
            },
            zoom: 1.0,
            width: 8,
            height: 8,
            frame: 1,
        };
        assert_eq!(nested.are_hidden_from(&view), is_hidden, "{z} {distance}");
    }
}
