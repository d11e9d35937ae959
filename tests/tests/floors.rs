//! Floors that are spheres of huge radius, with balls on them, compared with a renderer that uses numbers of 256 bits.

use glam::DVec3;
use marbles_core::{Angle, Camera, Color, Light, Sphere, View, World};
use num_bigint::BigInt;

use crate::studio::{looking_forward, matte, picture, single_pixel};

/// Binary places of the numbers of the reference.
const PLACES: u32 = 256;

/// A number with [`PLACES`] binary places.
fn fixed(value: f64) -> BigInt {
    // Doubles of this test are multiples of 2^-200: scaled they are whole, and exact.
    let (mantissa, exponent) = libm::frexp(value);
    let mantissa = BigInt::from(libm::scalbn(mantissa, 53) as i64);
    let shift = exponent - 53 + PLACES as i32;
    if shift >= 0 {
        mantissa << shift
    } else {
        mantissa >> -shift
    }
}

fn to_double(value: &BigInt) -> f64 {
    let kept: i128 = (value >> (PLACES - 90)).try_into().unwrap();
    libm::scalbn(kept as f64, -90)
}

type Point = [BigInt; 3];

fn point(vector: DVec3) -> Point {
    vector.to_array().map(fixed)
}

fn minus(a: &Point, b: &Point) -> Point {
    [0, 1, 2].map(|axis| &a[axis] - &b[axis])
}

/// The product with twice the places.
fn dot(a: &Point, b: &Point) -> BigInt {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// The distance to a sphere along a ray from outside, or through it from inside.
fn hit(center: &Point, radius: &BigInt, origin: &Point, direction: &Point) -> Option<BigInt> {
    let to_center = minus(center, origin);
    let direction_sq = dot(direction, direction);
    let along = dot(direction, &to_center);
    let outside = dot(&to_center, &to_center) - radius * radius;
    let zero = BigInt::from(0);
    if outside >= zero && along <= zero {
        return None;
    }
    let discriminant = &along * &along - &direction_sq * &outside;
    if discriminant < zero {
        return None;
    }
    let root = discriminant.sqrt();
    let numerator = if outside > zero {
        along - root
    } else {
        along + root
    };
    Some((numerator << PLACES) / direction_sq)
}

/// Balls on a floor of this radius, and their albedos.
fn balls(floor: f64) -> Vec<(DVec3, f64, f64)> {
    let mut balls = vec![(DVec3::new(0.0, -floor, 0.0), floor, 0.7)];
    for index in 0..12 {
        let radius = [3.0, 5.0, 8.0, 2.0][index % 4];
        let (x, z) = (
            13.0 * (index % 4) as f64 - 21.0,
            30.0 + 17.0 * (index / 4) as f64,
        );
        // √((R + r)² − x² − z²) − R without cancellation.
        let legs = x * x + z * z;
        let sum = ((floor + radius) * (floor + radius) - legs).sqrt() + floor;
        let y = (2.0 * floor * radius + radius * radius - legs) / sum;
        balls.push((DVec3::new(x, y, z), radius, 0.3 + 0.05 * index as f64));
    }
    balls
}

const AMBIENT: f64 = 0.05;
const TOWARD: DVec3 = DVec3::new(-1.0, 0.7, -0.4);

fn world(balls: &[(DVec3, f64, f64)]) -> World {
    let mut world = World::new();
    for &(center, radius, albedo) in balls {
        let material = world.add_material(matte(Color::splat(albedo)));
        world.add_sphere(Sphere::new(center, radius).unwrap(), material);
    }
    world.lights.extend(Light::directional(TOWARD, Color::ONE));
    world.ambient = Color::splat(AMBIENT);
    world
}

/// A camera close above the floor, looking slightly down.
fn view() -> View {
    let camera = Camera::free(
        DVec3::new(0.0, 2.5, 0.0),
        Angle::ZERO,
        Angle::from_degrees(-4.0),
        Angle::ZERO,
    );
    View {
        camera,
        ..looking_forward(200, 120, 150.0)
    }
}

/// Light and coverage for one ray, with exact decisions.
fn reference(balls: &[(Point, BigInt, f64)], origin: &Point, direction: DVec3) -> [f64; 2] {
    let direction = point(direction);
    let hits = balls
        .iter()
        .enumerate()
        .filter_map(|(index, (center, radius, _))| {
            hit(center, radius, origin, &direction).map(|t| (t, index))
        });
    let Some((t, nearest)) = hits.min() else {
        return [0.0, 0.0];
    };
    let (center, radius, albedo) = &balls[nearest];
    let surface = [0, 1, 2].map(|axis| &origin[axis] + ((&t * &direction[axis]) >> PLACES));
    let toward = TOWARD.normalize();
    let from_center = minus(&surface, center);
    let facing = (0..3)
        .map(|axis| to_double(&((&from_center[axis] << PLACES) / radius)))
        .zip(toward.to_array())
        .map(|(normal, toward)| normal * toward)
        .sum::<f64>();
    let toward = point(toward);
    let blocked = balls
        .iter()
        .enumerate()
        .any(|(index, (center, radius, _))| {
            index != nearest && hit(center, radius, &surface, &toward).is_some()
        });
    let lit = if blocked { 0.0 } else { facing.max(0.0) };
    [albedo * (AMBIENT + lit), 1.0]
}

/// A few hundred pixels spread over the picture: horizon, contacts, shadows, floor and balls.
#[test]
fn huge_floors_are_right_in_every_pixel() {
    const SAMPLES: u32 = 3;
    for floor in [1e6, 1e9, 1e12] {
        let balls = balls(floor);
        let (world, view) = (world(&balls), view());
        let exact: Vec<(Point, BigInt, f64)> = balls
            .iter()
            .map(|&(center, radius, albedo)| (point(center), fixed(radius), albedo))
            .collect();
        let origin = point(view.camera.position);
        let mut seen = [0; 3];
        for index in 0..300 {
            let (col, row) = (7 + 61 * index % 193, 5 + 37 * index % 113);
            let mut expected = [0.0, 0.0];
            let cells = |pixel: u32| {
                let first = u64::from(pixel * SAMPLES);
                first..first + u64::from(SAMPLES)
            };
            for cell_row in cells(row) {
                for cell_col in cells(col) {
                    let ray = view.ray(view.cell_center(cell_col, cell_row, SAMPLES));
                    let [light, covered] = reference(&exact, &origin, ray.direction);
                    expected[0] += light / f64::from(SAMPLES * SAMPLES);
                    expected[1] += covered / f64::from(SAMPLES * SAMPLES);
                }
            }
            let whole = picture(&world, &single_pixel(&view, col, row), SAMPLES, true);
            let [light, _, _, alpha] = whole.rgba(0, 0);
            assert!(
                (light - expected[0]).abs() < 1e-9 && (alpha - expected[1]).abs() < 1e-9,
                "floor {floor:e}, pixel ({col}, {row}): {light}, {alpha} instead of {expected:?}"
            );
            seen[(2.0 * alpha) as usize] += 1;
        }
        assert!(seen[0] > 20 && seen[2] > 100, "{seen:?}");
    }
}
