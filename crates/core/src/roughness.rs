//! Rough surfaces: normals multiplied by random numbers.

use glam::DVec3;

use crate::{Grain, Roughness};

/// Cells that a radius may span; more could not be counted, nor told apart.
const MOST_CELLS: f64 = (1_u64 << 62) as f64;

/// What the numbers of [`Grain::Pixel`] are drawn for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PixelKey {
    pub(crate) col: u32,
    pub(crate) row: u32,
    pub(crate) frame: i64,
}

impl Roughness {
    /// The perturbed shading normal, unit, at the point of the sphere with the outward normal
    /// `normal`.
    pub(crate) fn perturb(
        &self,
        normal: DVec3,
        radius: f64,
        sphere: usize,
        pixel: PixelKey,
    ) -> DVec3 {
        let draw = match self.grain {
            Grain::Surface(size) => {
                let cells = (radius / size).min(MOST_CELLS);
                surface_noise(self.seed, sphere, normal * cells)
            }
            Grain::Pixel => pixel_noise(self.seed, sphere, pixel),
        };
        // Never zero: each factor lies above 1 − amplitude > 0.
        (normal * (1.0 + self.amplitude * draw)).normalize()
    }
}

/// Independent numbers in [−1, 1) for a pixel of a frame.
fn pixel_noise(seed: u64, sphere: usize, pixel: PixelKey) -> DVec3 {
    let key = hash(hash(seed, sphere as u64), pixel.frame as u64);
    spread(hash(key, u64::from(pixel.col) << 32 | u64::from(pixel.row)))
}

/// Smooth noise in [−1, 1): random values at the points of the unit lattice, blended by
/// quadratic B-splines, so that slopes are continuous and no lattice shows.
///
/// `point` is relative to the sphere's center, in cells.
fn surface_noise(seed: u64, sphere: usize, point: DVec3) -> DVec3 {
    let key = hash(seed, sphere as u64);
    let nearest = (point + 0.5).floor();
    let offset = point - nearest;
    let mut sum = DVec3::ZERO;
    for (z, along_z) in neighbors(nearest.z, offset.z) {
        let key = hash(key, z);
        for (y, along_y) in neighbors(nearest.y, offset.y) {
            let key = hash(key, y);
            for (x, along_x) in neighbors(nearest.x, offset.x) {
                sum += spread(hash(key, x)) * (along_x * along_y * along_z);
            }
        }
    }
    sum
}

/// The three lattice points along an axis around the nearest one, and the weights of their
/// B-splines at an offset from −½ to ½.
fn neighbors(nearest: f64, offset: f64) -> [(u64, f64); 3] {
    let index = nearest as i64;
    let (before, after) = (0.5 - offset, 0.5 + offset);
    [
        (index.wrapping_sub(1) as u64, 0.5 * before * before),
        (index as u64, 0.75 - offset * offset),
        (index.wrapping_add(1) as u64, 0.5 * after * after),
    ]
}

/// Three numbers in [−1, 1) from the bits of one.
fn spread(bits: u64) -> DVec3 {
    const BITS: u32 = 21;
    const UNIT: f64 = 1.0 / (1_u64 << (BITS - 1)) as f64;
    let part = |index: u32| (bits >> (64 - BITS * (index + 1)) & ((1 << BITS) - 1)) as f64;
    DVec3::new(part(0), part(1), part(2)) * UNIT - 1.0
}

/// Mixes a word into a key; every bit of either changes every bit of the result.
///
/// # Source
/// The increment and finalizer of SplitMix64: Steele, Lea, Flood, Fast Splittable Pseudorandom
/// Number Generators, OOPSLA 2014, with the constants of Stafford's variant 13.
fn hash(key: u64, word: u64) -> u64 {
    const GOLDEN_GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;
    let mut z = (key ^ word.wrapping_mul(GOLDEN_GAMMA)).wrapping_add(GOLDEN_GAMMA);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

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
                    expected += weight(x) * weight(y) * weight(z) * spread(key);
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
}
