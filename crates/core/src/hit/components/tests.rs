use glam::DVec3;

use super::*;
use crate::numeric::rounding::UNIT_ROUNDOFF;

/// A rotation that is none of the world's axes.
const AXES: [DVec3; 3] = [
    DVec3::new(0.8, 0.0, -0.6),
    DVec3::new(0.36, 0.8, 0.48),
    DVec3::new(0.48, -0.6, 0.64),
];

/// A sphere, and a ray that meets it where it is told.
fn case(center: DVec3, radius: f64, toward: DVec3) -> (Sphere, Ray) {
    let ray = Ray {
        origin: DVec3::new(0.3, -0.7, 0.1),
        direction: toward,
    };
    (Sphere::new(center, radius).unwrap(), ray)
}

/// Balls, floors, tiny and distant spheres, and one around the origin.
fn cases() -> Vec<(Sphere, Ray)> {
    vec![
        case(DVec3::Z * 5.0, 1.0, DVec3::new(-0.05, 0.15, 1.0)),
        case(DVec3::Y * -1e9, 1e9 - 3.0, DVec3::new(0.1, -0.2, 1.0)),
        case(
            DVec3::new(0.3, -0.7, 2.1),
            1e-3,
            DVec3::new(1e-4, 2e-4, 1.0),
        ),
        case(DVec3::new(0.3, -0.7, 1e3), 1e-2, DVec3::new(1e-6, 0.0, 1.0)),
        case(DVec3::ZERO, 4.0, DVec3::new(0.2, 0.1, -1.0)),
        case(DVec3::ZERO, 4e12, DVec3::new(1e-14, 0.1, -1.0)),
    ]
}

fn numbers(components: &Components) -> [f64; 7] {
    let Components {
        t,
        position: p,
        normal: n,
    } = components;
    [*t, p.x, p.y, p.z, n.x, n.y, n.z]
}

#[test]
fn both_floors_agree_to_the_last_place() {
    for (sphere, ray) in cases() {
        let exact = exact::components(&sphere, &ray, &AXES).unwrap();
        for fused in [true, false] {
            let found = if fused {
                find::<true>(&sphere, &ray, &AXES)
            } else {
                find::<false>(&sphere, &ray, &AXES)
            };
            let found = found.expect("the second floor answers");
            for (found, exact) in numbers(&found).into_iter().zip(numbers(&exact)) {
                let error = (found - exact).abs();
                assert!(
                    error <= 2.0 * UNIT_ROUNDOFF * exact.abs(),
                    "{found} {exact}"
                );
            }
        }
    }
}

#[test]
fn they_are_those_of_the_hit() {
    let world = [DVec3::X, DVec3::Y, DVec3::Z];
    for (sphere, ray) in cases() {
        let (hit, found) = (
            sphere.hit(&ray).unwrap(),
            sphere.hit_components(&ray, &world),
        );
        let found = found.unwrap();
        assert!((found.t - hit.t).abs() <= f64::EPSILON * hit.t);
        assert!((found.normal - hit.normal).length() <= 4.0 * UNIT_ROUNDOFF);
    }
}

#[test]
fn coordinates_that_cancel_are_settled_exactly() {
    // The ray ends on the plane x = 0, from 3 beside it: no number of digits proves that but all.
    let sphere = Sphere::new(DVec3::Z * 5.0, 1.0).unwrap();
    let ray = Ray {
        origin: DVec3::X * 3.0,
        direction: DVec3::new(-3.0, 0.0, 4.0),
    };
    let world = [DVec3::X, DVec3::Y, DVec3::Z];
    let found = sphere.hit_components(&ray, &world).unwrap();
    assert_eq!(found.position, DVec3::Z * 4.0);
    assert_eq!(found.normal, -DVec3::Z);
    assert_eq!(found.t, 1.0);
}

#[test]
fn tangents_and_origins_on_the_surface_have_components() {
    let world = [DVec3::X, DVec3::Y, DVec3::Z];
    let ray = Ray {
        origin: DVec3::ZERO,
        direction: DVec3::Z,
    };
    let tangent = Sphere::new(DVec3::new(0.0, 1.0, 5.0), 1.0).unwrap();
    let found = tangent.hit_components(&ray, &world).unwrap();
    assert_eq!((found.position, found.normal), (5.0 * DVec3::Z, -DVec3::Y));
    let around = Sphere::new(DVec3::Z, 1.0).unwrap();
    let found = around.hit_components(&ray, &world).unwrap();
    assert_eq!((found.position, found.normal), (2.0 * DVec3::Z, DVec3::Z));
    assert!(
        Sphere::new(-2.0 * DVec3::Z, 1.0)
            .unwrap()
            .hit_components(&ray, &world)
            .is_none()
    );
}
