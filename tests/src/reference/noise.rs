//! The noise of rough surfaces, implemented from its description.
//!
//! Every lattice point has three random numbers in [−1, 1), from the hash of the seed, the sphere and the three
//! integers of the point (z, then y, then x). A hash mixes one word into a key by one round of SplitMix64. Quadratic
//! B-splines combine the numbers of the surrounding 27 lattice points.

use glam::DVec3;
use marbles_core::{Grain, Roughness};

/// A shading normal, and the lattice cell of its noise. Within a cell the noise is a polynomial of the position, but
/// not across cells.
pub(crate) struct Bump {
    pub(crate) normal: DVec3,
    pub(crate) cell: [i64; 3],
}

/// The bump at the point of a sphere with the outward normal `normal`. `pixel` consists of the column, the row, and the
/// frame.
pub(crate) fn bump(
    rough: &Roughness,
    sphere: usize,
    radius: f64,
    normal: DVec3,
    (col, row, frame): (u32, u32, i64),
) -> Bump {
    let of_sphere = mix(rough.seed, sphere as u64);
    match rough.grain {
        Grain::Pixel => {
            let place = (u64::from(col) << 32) | u64::from(row);
            let factor = 1.0 + rough.amplitude * numbers(mix(mix(of_sphere, frame as u64), place));
            Bump {
                normal: (normal * factor).normalize(),
                cell: [0; 3],
            }
        }
        Grain::Surface(size) => {
            let (numbers, cell) = blend(of_sphere, normal * (radius / size));
            Bump {
                normal: (normal + rough.amplitude * numbers.reject_from(normal)).normalize(),
                cell,
            }
        }
    }
}

fn blend(key: u64, point: DVec3) -> (DVec3, [i64; 3]) {
    let cell = point.to_array().map(|part| (part + 0.5).floor() as i64);
    let mut sum = DVec3::ZERO;
    for x in -1..=1 {
        for y in -1..=1 {
            for z in -1..=1 {
                let lattice = [cell[0] + x, cell[1] + y, cell[2] + z];
                let weight: f64 = point
                    .to_array()
                    .into_iter()
                    .zip(lattice)
                    .map(|(part, at)| spline(part - at as f64))
                    .product();
                let [x, y, z] = lattice.map(|index| index as u64);
                sum += weight * numbers(mix(mix(mix(key, z), y), x));
            }
        }
    }
    (sum, cell)
}

/// The quadratic B-spline, which is not 0 from −3/2 to 3/2.
fn spline(x: f64) -> f64 {
    let x = x.abs();
    if x <= 0.5 {
        0.75 - x * x
    } else if x < 1.5 {
        0.5 * (1.5 - x).powi(2)
    } else {
        0.0
    }
}

/// Three fields of 21 bits, from the highest bits, as numbers in [−1, 1).
fn numbers(bits: u64) -> DVec3 {
    let field = |shift: u32| ((bits >> shift) % (1 << 21)) as f64 / f64::from(1 << 20) - 1.0;
    DVec3::new(field(43), field(22), field(1))
}

fn mix(key: u64, word: u64) -> u64 {
    const GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;
    let mut state = (key ^ word.wrapping_mul(GAMMA)).wrapping_add(GAMMA);
    for (shift, factor) in [(30, 0xbf58_476d_1ce4_e5b9_u64), (27, 0x94d0_49bb_1331_11eb)] {
        state = (state ^ (state >> shift)).wrapping_mul(factor);
    }
    state ^ (state >> 31)
}
