//! Rough surfaces: normals multiplied by random numbers.

use glam::DVec3;

use crate::{Grain, Roughness};

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
            Grain::Surface(size) => surface_noise(self.seed, sphere, normal * (radius / size)),
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

/// Smooth noise in [−1, 1): random values at the corners of the unit lattice, blended so that
/// the first two derivatives are continuous across cells.
///
/// `point` is relative to the sphere's center, in cells. Beyond 2^53 cells it has no fraction
/// and the noise is constant on each representable point.
fn surface_noise(seed: u64, sphere: usize, point: DVec3) -> DVec3 {
    let key = hash(seed, sphere as u64);
    let cell = point.floor();
    let blend = (point - cell).map(smooth_step);
    let corners = |axis: f64| [axis as i64, (axis as i64).wrapping_add(1)];
    let [xs, ys, zs] = [corners(cell.x), corners(cell.y), corners(cell.z)];
    let mut sum = DVec3::ZERO;
    for (z, along_z) in zs.into_iter().zip([1.0 - blend.z, blend.z]) {
        let key = hash(key, z as u64);
        for (y, along_y) in ys.into_iter().zip([1.0 - blend.y, blend.y]) {
            let key = hash(key, y as u64);
            for (x, along_x) in xs.into_iter().zip([1.0 - blend.x, blend.x]) {
                sum += spread(hash(key, x as u64)) * (along_x * along_y * along_z);
            }
        }
    }
    sum
}

/// From 0 to 1 with first and second derivatives that vanish at both ends: 6s⁵ − 15s⁴ + 10s³.
///
/// # Source
/// K. Perlin, Improving Noise, SIGGRAPH 2002.
fn smooth_step(s: f64) -> f64 {
    s * s * s * (s * (s * 6.0 - 15.0) + 10.0)
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
