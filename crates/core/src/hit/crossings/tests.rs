use fearless_simd::{Level, dispatch};

use super::*;
use crate::hit::exact;
use crate::hit::outcome::Components;
use crate::model::ray::Ray;
use crate::numeric::fused::is_fused;
use crate::numeric::lanes::tests::levels;
use crate::numeric::lanes::{LANES, f64x8, mask64x8};

/// A rotation that is none of the world's axes.
const AXES: [DVec3; 3] = [
    DVec3::new(0.8, 0.0, -0.6),
    DVec3::new(0.36, 0.8, 0.48),
    DVec3::new(0.48, -0.6, 0.64),
];
const WORLD: [DVec3; 3] = [DVec3::X, DVec3::Y, DVec3::Z];
const ORIGIN: DVec3 = DVec3::new(0.3, -0.7, 0.1);
/// Lengths are scaled by this, the world's by its inverse.
const SCALE: f64 = 0.25;

/// The numbers of a lane, and which of them are proved: t, length, position, normals along [`WORLD`] and [`AXES`].
type Lane = ([f64; 11], [bool; 5]);

/// All numbers of crossings near some multiples of a direction.
fn crossings(sphere: &Sphere, direction: DVec3, near: [f64; LANES], fused: bool) -> [Lane; LANES] {
    dispatch!(Level::new(), simd => if fused {
        all::<_, true>(simd, sphere, direction, near)
    } else {
        all::<_, false>(simd, sphere, direction, near)
    })
}

#[inline(always)]
fn all<S: Simd, const FUSED: bool>(
    simd: S,
    sphere: &Sphere,
    direction: DVec3,
    near: [f64; LANES],
) -> [Lane; LANES] {
    let origins = Vectors::splat(simd, ORIGIN);
    let one = Targets::splat::<FUSED>(simd, sphere, ORIGIN, SCALE);
    let each = Targets::seen_from::<FUSED>(simd, sphere, &origins, SCALE);
    // Half the lanes have either.
    let targets = one.or(mask64x8::from_bitmask(simd, 0b0101_1010), &each);
    let directions = Vectors::splat(simd, direction);
    let near = f64x8::from_array(simd, near) * SCALE;
    let inner = mask64x8::splat(simd, sphere.center.distance(ORIGIN) < sphere.radius);
    let crossings = Crossings::<S, FUSED>::new(simd, directions, (near, inner), &targets);
    let multiple = crossings.times(simd, f64x8::splat(simd, 3.0));
    let length = crossings.lengths(simd);
    let position = crossings.positions(&origins, 1.0 / SCALE);
    let (normal, along) = (crossings.normals(), crossings.normals_along(&AXES));
    let masks = [multiple.1, length.1, position.1, normal.1, along.1];
    let masks = masks.map(|mask| mask.to_bitmask());
    std::array::from_fn(|lane| {
        let [p, n, a] = [position.0, normal.0, along.0].map(|vectors| vectors.lane(lane));
        let numbers = [
            multiple.0[lane] / SCALE,
            length.0[lane] / SCALE,
            p.x,
            p.y,
            p.z,
            n.x,
            n.y,
            n.z,
            a.x,
            a.y,
            a.z,
        ];
        (numbers, masks.map(|mask| mask >> lane & 1 == 1))
    })
}

fn components(sphere: &Sphere, direction: DVec3, axes: &[DVec3; 3]) -> Components {
    let ray = Ray {
        origin: ORIGIN,
        direction,
    };
    exact::components(sphere, &ray, axes).unwrap()
}

/// The multiples that the lanes of the samples may begin with: off by up to the error that these claim.
fn near(t: f64) -> [f64; LANES] {
    let error = 512.0 * f64::EPSILON;
    [0.0, 1.0, -1.0, 0.5, -0.5, 1e-3, -1e-3, 0.9].map(|part| t * (1.0 + part * error))
}

/// Balls, floors, tiny and distant spheres, rims, and domes.
fn cases() -> [(Sphere, DVec3); 8] {
    let case =
        |center: DVec3, radius: f64, toward: DVec3| (Sphere::new(center, radius).unwrap(), toward);
    [
        case(DVec3::Z * 5.0, 1.0, DVec3::new(-0.05, 0.15, 1.0)),
        case(DVec3::Y * -1e9, 1e9 - 3.0, DVec3::new(0.1, -0.2, 1.0)),
        case(
            DVec3::new(0.3, -0.7, 2.1),
            1e-3,
            DVec3::new(1e-4, 2e-4, 1.0),
        ),
        case(DVec3::new(0.3, -0.7, 1e3), 0.3, DVec3::new(1e-5, 3e-5, 1.0)),
        case(DVec3::new(2.0, 1.5, 4.0), 2.5, DVec3::new(0.3, 0.5, 1.5)),
        case(
            DVec3::new(1.29, -0.7, 8.1),
            1.0,
            DVec3::new(1e-3, 1e-7, 1.0),
        ),
        case(DVec3::new(0.5, 0.25, 1.0), 4.0, DVec3::new(0.2, 0.1, -1.0)),
        case(DVec3::ZERO, 4e6, DVec3::new(1e-3, 0.1, -1.0)),
    ]
}

#[test]
fn numbers_are_right_to_the_last_place_wherever_a_lane_begins() {
    for (sphere, direction) in cases() {
        let [world, turned] = [&WORLD, &AXES].map(|axes| components(&sphere, direction, axes));
        // The length is one multiple of the components, and 3 t another.
        let way = world.position - ORIGIN;
        let exact = [3.0 * world.t, way.length()];
        for fused in [true, false] {
            for (found, proved) in crossings(&sphere, direction, near(world.t), fused) {
                assert_eq!(proved, [true; 5], "{sphere:?} {direction}");
                let close = |found: f64, exact: f64, places: f64| {
                    let error = (found - exact).abs() / exact.abs();
                    assert!(
                        error <= places * UNIT_ROUNDOFF,
                        "{found:e} {exact:e} {sphere:?}"
                    );
                };
                close(found[0], exact[0], 3.0);
                close(found[1], exact[1], 8.0 * ORIGIN.length().max(1.0));
                let vectors = [world.position, world.normal, turned.normal];
                for (found, exact) in found[2..].chunks(3).zip(vectors) {
                    for (found, exact) in found.iter().zip(exact.to_array()) {
                        close(*found, exact, 2.0);
                    }
                }
            }
        }
    }
}

#[test]
fn every_processor_finds_the_same_bits() {
    for (sphere, direction) in cases() {
        let t = components(&sphere, direction, &WORLD).t;
        let found = levels().into_iter().map(|level| {
            dispatch!(level, simd => if is_fused(simd) {
                all::<_, true>(simd, &sphere, direction, near(t))
            } else {
                all::<_, false>(simd, &sphere, direction, near(t))
            })
        });
        let found: Vec<[Lane; LANES]> = found.collect();
        assert!(found.iter().all(|lanes| *lanes == found[0]));
        let [fused, split] =
            [true, false].map(|fused| crossings(&sphere, direction, near(t), fused));
        assert_eq!(fused, split);
    }
}

#[test]
fn the_other_side_is_found_from_this() {
    let dome = Sphere::new(DVec3::new(0.5, 0.25, 1.0), 4.0).unwrap();
    let direction = DVec3::new(0.2, 0.1, -1.0);
    let behind = components(&dome, -direction, &WORLD).t;
    let ahead = components(&dome, direction, &WORLD).t;
    let found: [f64; LANES] = dispatch!(Level::new(), simd => {
        let targets = Targets::splat::<false>(simd, &dome, ORIGIN, SCALE);
        let direction = Vectors::splat(simd, direction);
        let t = f64x8::splat(simd, -behind * SCALE);
        targets.other_side(&direction, t).into()
    });
    assert!(
        (found[0] / SCALE - ahead).abs() < 1e-14 * ahead,
        "{found:?} {ahead}"
    );
}

#[test]
fn what_is_not_certain_is_not_proved() {
    let ball = Sphere::new(DVec3::new(0.3, -0.7, 5.1), 1.0).unwrap();
    let ahead = DVec3::new(1e-3, 2e-3, 1.0);
    let none = |sphere: &Sphere, direction: DVec3, t: f64| {
        for fused in [true, false] {
            for (found, proved) in crossings(sphere, direction, [t; LANES], fused) {
                assert_eq!(proved, [false; 5], "{found:?} {t}");
            }
        }
    };
    // Too far from a root; in the middle; at the far root; nowhere.
    for t in [3.9, 5.0, 6.0, f64::NAN, f64::INFINITY, 0.0] {
        none(&ball, ahead, t);
    }
    // A ray that touches the ball, but for a part of 1e-12.
    let aside = (1.0 - 1e-12) / (25.0_f64 - 1.0).sqrt();
    none(&ball, DVec3::new(0.0, aside, 1.0), 4.8);
    // Sizes beyond all measure.
    let vast = Sphere::new(DVec3::Z * 5e60, 1e60).unwrap();
    none(&vast, ahead, components(&vast, ahead, &WORLD).t);
}

#[test]
fn coordinates_that_cancel_are_left_to_others() {
    // The ray ends on the plane x = 0, from 3 beside it.
    let direction = DVec3::new(-0.3, 0.7, 3.9);
    let sphere = Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0).unwrap();
    for (found, proved) in crossings(&sphere, direction, [1.0; LANES], true) {
        assert_eq!(proved, [true, true, false, false, true], "{found:?}");
    }
}
