use crate::model::roughness::noise::NoiseCells;
use crate::numeric::lanes::f64x8;
use fearless_simd::dispatch;

use super::*;
use crate::numeric::lanes::tests::levels;

/// The noise at a point in cells, relative to the center of a sphere.
fn surface_noise(seed: u64, sphere: usize, point: DVec3) -> DVec3 {
    let bumps = Bumps {
        key: hash(seed, sphere as u64),
        cells: 1.0,
        amplitude: 0.0,
    };
    let (nearest, offset) = bumps.place(point.to_array());
    let cell = Cell::new(bumps.key, nearest.map(|part| part as i64));
    DVec3::from_array(cell.blend(offset))
}

/// A walk over the surface in small steps, through many cells.
fn walk() -> impl Iterator<Item = DVec3> {
    (0..2000).map(|step| {
        let s = f64::from(step) * 0.01;
        DVec3::new(0.37 + s, -5.1 + 0.7 * s, 2.3 - 0.4 * s)
    })
}

#[test]
fn noise_stays_in_its_range_and_fills_it() {
    let (mut low, mut high) = (DVec3::ONE, -DVec3::ONE);
    for index in 0..20_000 {
        let pixel = PixelKey {
            col: index,
            row: 7,
            frame: -3,
        };
        let draw = pixel_noise(1, 2, pixel);
        (low, high) = (low.min(draw), high.max(draw));
    }
    assert!(low.min_element() >= -1.0 && low.max_element() < -0.999);
    assert!(high.max_element() < 1.0 && high.min_element() > 0.999);
}

#[test]
fn pixel_noise_is_uniform_and_independent() {
    let count = 100_000_u32;
    let draws = (0..count).map(|index| {
        pixel_noise(
            9,
            0,
            PixelKey {
                col: index % 317,
                row: index / 317,
                frame: 1,
            },
        )
    });
    let (mut sum, mut squares, mut products) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    for draw in draws {
        sum += draw;
        squares += draw * draw;
        products += draw * DVec3::new(draw.y, draw.z, draw.x);
    }
    // Five standard deviations of the means of count uniform numbers in [−1, 1).
    let within = 5.0 / f64::from(count).sqrt();
    assert!((sum / f64::from(count)).abs().max_element() < within * (1.0 / 3.0_f64).sqrt());
    assert!((squares / f64::from(count) - 1.0 / 3.0).abs().max_element() < within * 0.3);
    assert!((products / f64::from(count)).abs().max_element() < within / 3.0);
}

#[test]
fn seed_sphere_pixel_and_frame_all_matter() {
    let at =
        |seed, sphere, col, row, frame| pixel_noise(seed, sphere, PixelKey { col, row, frame });
    let base = at(1, 1, 1, 1, 1);
    for other in [
        at(2, 1, 1, 1, 1),
        at(1, 2, 1, 1, 1),
        at(1, 1, 2, 1, 1),
        at(1, 1, 1, 2, 1),
        at(1, 1, 1, 1, 2),
    ] {
        assert_ne!(base, other);
    }
}

#[test]
fn surface_noise_has_continuous_slopes() {
    // Second differences of a function with bounded second derivative shrink with the square
    // of the step; a kink at a cell's face would leave them as large as the step.
    let step = 1e-5;
    let along = DVec3::new(1.0, 0.7, -0.4);
    for point in walk() {
        let at = |steps: f64| surface_noise(3, 4, point + along * (steps * step));
        let second_difference = at(1.0) - 2.0 * at(0.0) + at(-1.0);
        assert!(second_difference.abs().max_element() < 60.0 * step * step);
    }
}

#[test]
fn surface_noise_blends_the_lattice_values() {
    // On a lattice point the splines weigh 1/8, 3/4, 1/8 along each axis.
    let corner = [3, -2, 5_i64];
    let weight = |step: i64| if step == 0 { 0.75 } else { 0.125 };
    let mut expected = DVec3::ZERO;
    for x in -1..=1 {
        for y in -1..=1 {
            for z in -1..=1 {
                let words = [corner[2] + z, corner[1] + y, corner[0] + x];
                let key = words
                    .into_iter()
                    .fold(hash(11, 8), |key, word| hash(key, word as u64));
                expected += weight(x) * weight(y) * weight(z) * DVec3::from_array(spread(key));
            }
        }
    }
    let found = surface_noise(11, 8, DVec3::new(3.0, -2.0, 5.0));
    assert!(
        (found - expected).length() < 1e-15,
        "{found} instead of {expected}"
    );
}

#[test]
fn extreme_scales_make_no_panic_and_no_nan() {
    let rough = |size| Roughness {
        amplitude: 0.99,
        grain: Grain::Surface(size),
        seed: 0,
    };
    let pixel = PixelKey {
        col: 0,
        row: 0,
        frame: 0,
    };
    for (radius, size) in [(1e300, 1e-300), (1e-300, 1e300), (1e17, 1.0), (1.0, 1e-18)] {
        let normal = rough(size).perturb(DVec3::ONE.normalize(), radius, 0, pixel);
        assert!(
            normal.is_finite(),
            "radius {radius}, grain {size}: {normal}"
        );
    }
}

/// Numbers in [−1, 1).
fn uniform() -> impl FnMut() -> f64 {
    let mut count = 0;
    move || {
        count += 1;
        spread(hash(17, count))[0]
    }
}

fn bumps(cells: f64, amplitude: f64) -> Bumps {
    let rough = Roughness {
        amplitude,
        grain: Grain::Surface(1.0),
        seed: 5,
    };
    rough.bumps(cells, 3).unwrap()
}

/// Eights of normals: anywhere, close together, and in steps of about a cell; with NaN among them.
fn eights(cells: f64) -> Vec<[DVec3; 8]> {
    let mut next = uniform();
    let mut eights = Vec::new();
    for round in 0..200 {
        let spread = [2.0, 1e-3, 1.0 / cells.max(1.0)][round % 3];
        let mut vector = || DVec3::new(next(), next(), next());
        let middle = vector();
        let mut eight = [DVec3::ZERO; 8].map(|_| (middle + spread * vector()).normalize());
        if round % 20 == 7 {
            eight[round % 8] = DVec3::NAN;
        }
        eights.push(eight);
    }
    eights.push([
        DVec3::X,
        -DVec3::X,
        DVec3::Y,
        -DVec3::Y,
        DVec3::Z,
        -DVec3::Z,
        DVec3::X,
        DVec3::ONE,
    ]);
    eights
}

#[test]
fn lanes_hold_the_bits_of_single_normals() {
    // One table for all spheres and levels: what it remembers must not matter.
    let mut table = NoiseCells::new();
    for cells in [1e-300, 0.01, 1.0, 2.5, 37.0, 1e4, 1e12, 1e16, 1e300] {
        let bumps = bumps(cells, 0.7);
        for level in levels() {
            for eight in eights(cells) {
                let parts = [0, 1, 2].map(|part| eight.map(|normal| normal[part]));
                let lanes: [[f64; 8]; 3] = dispatch!(level, simd => {
                    let parts = parts.map(|part| f64x8::from_array(simd, part));
                    unit(bumps.tilt_lanes(simd, parts, &mut table)).map(Into::into)
                });
                for (lane, normal) in eight.into_iter().enumerate() {
                    let expected = bumps.perturb_alone(normal).to_array();
                    let one = bumps.perturb(normal, &mut table).to_array();
                    assert_eq!(one.map(f64::to_bits), expected.map(f64::to_bits));
                    let found = lanes.map(|part| part[lane]);
                    assert!(
                        found.map(f64::to_bits) == expected.map(f64::to_bits) || normal.is_nan(),
                        "{normal} with {cells:e} cells at {level:?}: {found:?}, not {expected:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn shading_normals_differ_by_no_more_than_the_slope_bound() {
    let mut next = uniform();
    for (cells, amplitude) in [
        (0.1, 0.3),
        (1.0, 0.9),
        (8.0, 0.5),
        (300.0, 0.1),
        (1e5, 0.99),
    ] {
        let bumps = bumps(cells, amplitude);
        let mut largest = 0.0_f64;
        for round in 0..20_000 {
            let mut vector = || DVec3::new(next(), next(), next());
            let normal = vector().normalize();
            // Angles from a thousandth of a cell up to a radian.
            let step = libm::pow(10.0, -f64::from(round % 4)) / cells.max(1.0);
            let other = (normal + vector() * step).normalize();
            let angle = 2.0 * libm::asin((normal - other).length() / 2.0);
            let difference = (bumps.perturb_alone(normal) - bumps.perturb_alone(other)).length();
            assert!(difference <= bumps.slope_bound() * angle * (1.0 + 1e-9));
            largest = largest.max(difference / angle);
        }
        // Not far below the bound; least so where the amplitude nearly 1 could flatten normals.
        assert!(
            largest > 0.05 * bumps.slope_bound(),
            "{cells} cells, amplitude {amplitude}: {largest} of {}",
            bumps.slope_bound()
        );
    }
}

#[test]
fn bumps_are_alike_in_all_directions() {
    let directions = [
        DVec3::X,
        -DVec3::Y,
        DVec3::Z,
        DVec3::new(0.0, 0.6, -0.8),
        DVec3::ONE.normalize(),
        DVec3::new(0.3, -0.9, 0.2).normalize(),
    ];
    let amplitude = 0.5;
    // The variance of a component of noise is a third of the sum of squared weights.
    let of_axis = |at: f64| {
        let offset = at - at.round();
        let weight = |step: f64| 0.5 * (0.5 + step * offset).powi(2);
        weight(1.0).powi(2) + weight(-1.0).powi(2) + (0.75 - offset * offset).powi(2)
    };
    for normal in directions {
        let mut next = uniform();
        let (mut sum, mut expected) = (0.0, 0.0);
        for sphere in 0..4000 {
            let bumps = Bumps {
                key: hash(7, sphere),
                cells: 20.0 + next(),
                amplitude,
            };
            let tilted = bumps.perturb_alone(normal);
            assert!((tilted.length() - 1.0).abs() < 1e-15);
            let tangent = tilted.cross(normal).length() / tilted.dot(normal);
            assert!(tangent > 0.0 && tangent <= amplitude * 3.0_f64.sqrt());
            sum += tangent * tangent;
            // Two components are across the normal.
            let weights = (normal * bumps.cells).to_array().map(of_axis);
            expected += 2.0 / 3.0 * amplitude * amplitude * weights.iter().product::<f64>();
        }
        assert!(
            (sum / expected - 1.0).abs() < 0.06,
            "{normal}: {sum}, not {expected}"
        );
    }
}

/// Second differences on both sides of where cells meet differ by what is said to jump there.
#[test]
fn second_derivatives_jump_as_they_are_said_to() {
    const STEP: f64 = 0.125;
    let mut cells = NoiseCells::new();
    let bumps = Bumps {
        key: hash(3, 5),
        cells: 7.0,
        amplitude: 0.6,
    };
    for start in walk().step_by(20) {
        let normal = start.normalize();
        for (axis, side) in [(0, 1.0), (1, -1.0), (2, 1.0), (0, -1.0)] {
            let mut place = normal * bumps.cells;
            place[axis] = place[axis].round() + 0.5 * side;
            let bend = |side: f64| {
                let at = |steps: f64| {
                    let mut place = place;
                    place[axis] += side * STEP * steps;
                    surface_noise(3, 5, place)
                };
                (at(0.25) + at(2.25) - 2.0 * at(1.25)) / (STEP * STEP)
            };
            let jump = bend(side) - bend(-side);
            let expected = bumps.amplitude * (jump - normal * jump.dot(normal));
            let found = bumps.jump(normal, (axis, side), &mut cells);
            assert!(found.distance(expected) < 1e-9, "{found} {expected}");
        }
    }
}
