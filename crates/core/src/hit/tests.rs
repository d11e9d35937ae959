use super::*;
use crate::hit::outcome::Hit;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::model::sphere::SphereError;
use glam::DVec3;
use std::cmp::Ordering;

fn unit_sphere_at(x: f64, y: f64, z: f64) -> Sphere {
    Sphere::new(DVec3::new(x, y, z), 1.0).unwrap()
}

fn forward_from(origin: DVec3) -> Ray {
    Ray {
        origin,
        direction: DVec3::Z,
    }
}

#[test]
fn refuses_what_is_no_sphere() {
    assert_eq!(Sphere::new(DVec3::ZERO, 0.0), Err(SphereError::Radius(0.0)));
    assert_eq!(
        Sphere::new(DVec3::ZERO, -1.0),
        Err(SphereError::Radius(-1.0))
    );
    assert!(Sphere::new(DVec3::ZERO, f64::NAN).is_err());
    assert!(Sphere::new(DVec3::new(0.0, f64::INFINITY, 0.0), 1.0).is_err());
}

#[test]
fn the_nearer_crossing_is_hit() {
    let hit = unit_sphere_at(0.0, 0.0, 5.0)
        .hit(&forward_from(DVec3::ZERO))
        .unwrap();
    assert_eq!(
        hit,
        Hit {
            t: 4.0,
            normal: -DVec3::Z,
            inner_side: false
        }
    );
}

#[test]
fn t_counts_multiples_of_the_direction() {
    let ray = Ray {
        origin: DVec3::ZERO,
        direction: DVec3::Z * 8.0,
    };
    assert_eq!(unit_sphere_at(0.0, 0.0, 5.0).hit(&ray).unwrap().t, 0.5);
}

#[test]
fn tangent_ray_hits() {
    let hit = unit_sphere_at(0.0, 1.0, 5.0)
        .hit(&forward_from(DVec3::ZERO))
        .unwrap();
    assert_eq!(
        hit,
        Hit {
            t: 5.0,
            normal: -DVec3::Y,
            inner_side: false
        }
    );
}

#[test]
fn sphere_behind_is_missed() {
    assert!(
        unit_sphere_at(0.0, 0.0, -5.0)
            .hit(&forward_from(DVec3::ZERO))
            .is_none()
    );
}

#[test]
fn from_inside_the_far_side_is_hit() {
    let hit = unit_sphere_at(0.0, 0.0, 0.5)
        .hit(&forward_from(DVec3::ZERO))
        .unwrap();
    assert_eq!(
        hit,
        Hit {
            t: 1.5,
            normal: DVec3::Z,
            inner_side: true
        }
    );
}

#[test]
fn origin_on_the_surface_hits_only_across() {
    let across = unit_sphere_at(0.0, 0.0, 1.0)
        .hit(&forward_from(DVec3::ZERO))
        .unwrap();
    assert_eq!(
        across,
        Hit {
            t: 2.0,
            normal: DVec3::Z,
            inner_side: true
        }
    );
    assert!(
        unit_sphere_at(0.0, 0.0, -1.0)
            .hit(&forward_from(DVec3::ZERO))
            .is_none()
    );
}

/// The order of two spheres along a ray, by the exact comparison and with the spheres exchanged.
fn order(first: &Sphere, second: &Sphere, ray: &Ray) -> std::cmp::Ordering {
    let order = exact::compare_distances(first, second, ray);
    assert_eq!(
        exact::compare_distances(second, first, ray),
        order.reverse()
    );
    order
}

#[test]
fn shells_that_differ_in_the_last_bit_are_told_apart() {
    let oblique = DVec3::new(0.13, -0.05, 1.0);
    let sphere = |radius| Sphere::new(DVec3::new(0.5, -0.1, 5.0), radius).unwrap();
    let larger = sphere(1.0 + f64::EPSILON);
    for origin in [DVec3::ZERO, DVec3::new(0.5, -0.1, 4.9)] {
        let ray = Ray {
            origin,
            direction: oblique,
        };
        let outside = origin == DVec3::ZERO;
        let expected = if outside {
            Ordering::Greater
        } else {
            Ordering::Less
        };
        assert_eq!(order(&sphere(1.0), &larger, &ray), expected);
        assert_eq!(order(&sphere(1.0), &sphere(1.0), &ray), Ordering::Equal);
        let [hit, larger_hit] = [sphere(1.0), larger].map(|sphere| sphere.hit(&ray).unwrap());
        assert_eq!(
            larger.compare(&larger_hit, &sphere(1.0), &hit, &ray),
            expected.reverse()
        );
        assert_eq!(
            sphere(1.0).compare(&hit, &larger, &larger_hit, &ray),
            expected
        );
    }
}

#[test]
fn order_of_distances_is_that_of_clearly_different_ones() {
    let mut state = 7_u64;
    let mut uniform = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut compared = 0;
    for _ in 0..20_000 {
        let mut sphere = || {
            let center = DVec3::new(uniform() - 0.5, uniform() - 0.5, uniform() * 2.0);
            Sphere::new(center, 0.1 + 1.2 * uniform()).unwrap()
        };
        let spheres = [sphere(), sphere()];
        let ray = forward_from(DVec3::new(0.2 * uniform(), 0.2 * uniform(), 0.0));
        let [Some(first), Some(second)] = spheres.map(|sphere| sphere.hit(&ray)) else {
            continue;
        };
        compared += u32::from(first.inner_side != second.inner_side);
        assert_eq!(
            Some(order(&spheres[0], &spheres[1], &ray)),
            first.t.partial_cmp(&second.t)
        );
    }
    assert!(compared > 1000, "{compared}");
}

#[test]
fn mirrored_spheres_are_equally_far() {
    let ray = forward_from(DVec3::ZERO);
    let (left, right) = (
        unit_sphere_at(-0.3, 0.1, 5.0),
        unit_sphere_at(0.3, 0.1, 5.0),
    );
    assert_eq!(order(&left, &right, &ray), Ordering::Equal);
    // A tangent one in the same plane: both discriminants matter, one is 0.
    assert_eq!(
        order(
            &unit_sphere_at(1.0, 0.0, 4.0),
            &unit_sphere_at(0.0, 0.0, 5.0),
            &ray
        ),
        Ordering::Equal
    );
    assert_eq!(
        order(
            &unit_sphere_at(1.0, 0.0, 4.0),
            &unit_sphere_at(0.0, 1.0, 4.0),
            &ray
        ),
        Ordering::Equal
    );
}

#[test]
fn decisions_are_those_of_hits() {
    for (x, y, z) in [
        (0.0, 0.0, 5.0),
        (0.0, 1.0, 5.0),
        (0.0, 1.0 + f64::EPSILON, 5.0),
        (0.0, 0.0, -5.0),
    ] {
        let (sphere, ray) = (unit_sphere_at(x, y, z), forward_from(DVec3::ZERO));
        let hit = sphere.hit(&ray);
        assert_eq!(sphere.is_met(&ray, 0.0), hit.is_some());
        assert_eq!(sphere.hit_from_viewpoint(&ray), hit);
    }
}

#[test]
fn origin_that_may_lie_on_the_surface_counts_as_lying_on_it() {
    let sphere = unit_sphere_at(0.0, 0.0, 5.0);
    for offset in [-1e-15, 0.0, 1e-15] {
        let leaving = forward_from(DVec3::new(0.0, 0.0, 6.0 + offset));
        let entering = forward_from(DVec3::new(0.0, 0.0, 4.0 + offset));
        assert!(!sphere.is_met(&leaving, 2e-15));
        assert!(sphere.is_met(&entering, 2e-15));
        // Known exactly, a ray from inside meets the far side.
        assert_eq!(sphere.is_met(&leaving, 0.0), offset < 0.0);
    }
}

#[test]
fn least_sphere_around_the_farthest_viewpoint_makes_no_panic() {
    let place = DVec3::splat(1e308);
    let sphere = Sphere::new(place, f64::from_bits(1)).unwrap();
    assert!(sphere.hit(&forward_from(place)).is_some());
    assert!(sphere.is_met(&forward_from(place), 0.0));
}
