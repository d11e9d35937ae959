//! Places that fill a pixel and a hemisphere evenly.
//!
//! Points of Sobol's sequence in four dimensions: two for the place in the pixel, two for the direction. Several copies of it,
//! each with its numbers shifted, are independent estimates of an integral.
//!
//! Source: Joe and Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput. 30 (2008),
//! for the numbers of the dimensions.

use std::f64::consts::TAU;

use glam::{Vec2, Vec3};

use crate::model::roughness::PixelKey;
use crate::model::roughness::noise::hash;

/// The most points of a copy: a power of two.
pub(super) const MOST: u32 = 8192;

/// Angles that directions may have around the normal: a power of two.
const ANGLES: usize = 4096;

/// For each dimension but the first the degree of its polynomial, the bits between its first and last coefficient, and its
/// first numbers.
const DIMENSIONS: [(usize, u32, &[u32]); 3] = [(1, 0, &[1]), (2, 1, &[1, 3]), (3, 1, &[1, 3, 1])];

/// The points of a copy, and angles.
#[derive(Debug)]
pub(super) struct Net {
    points: Vec<[u32; 4]>,
    circle: Vec<Vec2>,
}

/// What is exclusive-ored to the numbers of a copy.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shift([u32; 4]);

impl Shift {
    /// Those of the copies of a pixel.
    pub(super) fn all(key: PixelKey, copies: usize) -> Vec<Self> {
        let pixel = hash(key.col.into(), key.row.into());
        let mut shifts = Vec::with_capacity(copies);
        for copy in 0..copies as u64 {
            let (first, second) = (hash(pixel, 2 * copy), hash(pixel, 2 * copy + 1));
            let (third, fourth) = (first >> 32, second >> 32);
            shifts.push(Self([
                first as u32,
                second as u32,
                third as u32,
                fourth as u32,
            ]));
        }
        shifts
    }
}

/// The middle of the places from 0 to 1 that have these bits.
fn unit(bits: u32) -> f64 {
    (f64::from(bits) + 0.5) * 2_f64.powi(-32)
}

impl Net {
    pub(super) fn new() -> Self {
        let mut points = vec![[0; 4]; MOST as usize];
        for bit in 0..MOST.ilog2() as usize {
            let number = |dimension| direction_number(dimension, bit);
            let numbers = [1 << (31 - bit), number(0), number(1), number(2)];
            for (index, point) in points.iter_mut().enumerate() {
                if index >> bit & 1 == 1 {
                    for (part, number) in point.iter_mut().zip(numbers) {
                        *part ^= number;
                    }
                }
            }
        }
        let mut circle = Vec::with_capacity(ANGLES);
        for number in 0..ANGLES {
            let angle = (number as f64 + 0.5) * (TAU / ANGLES as f64);
            circle.push(Vec2::new(libm::cos(angle) as f32, libm::sin(angle) as f32));
        }
        Self { points, circle }
    }

    /// A place in a square.
    pub(super) fn place(&self, number: u32, shift: &Shift) -> [f64; 2] {
        let point = &self.points[number as usize];
        [unit(point[0] ^ shift.0[0]), unit(point[1] ^ shift.0[1])]
    }

    /// A direction of a hemisphere around the third axis, as dense as light on a surface below is: its sine above the surface
    /// comes last.
    #[inline]
    pub(super) fn direction(&self, number: u32, shift: &Shift) -> Vec3 {
        let point = &self.points[number as usize];
        // The first 24 bits: single precision holds them.
        let square = ((point[2] ^ shift.0[2]) >> 8) as i32 as f32;
        let square = (square + 0.5) * (1.0 / 16_777_216.0);
        let angle = (point[3] ^ shift.0[3]) >> (u32::BITS - ANGLES.ilog2());
        let across = self.circle[angle as usize] * square.sqrt();
        across.extend((1.0 - square).sqrt())
    }
}

/// A bit's number in a dimension.
fn direction_number(dimension: usize, bit: usize) -> u32 {
    let (degree, inner, first) = DIMENSIONS[dimension];
    let mut numbers = first.to_vec();
    for place in degree..=bit {
        let last = numbers[place - degree];
        let mut number = last ^ (last << degree);
        for term in 1..degree {
            if inner >> (degree - 1 - term) & 1 == 1 {
                number ^= numbers[place - term] << term;
            }
        }
        numbers.push(number);
    }
    numbers[bit] << (31 - bit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_directions_fill_cells_evenly() {
        let net = Net::new();
        // In pairs of dimensions of which it is known: so many points have one in each of as many rectangles.
        for [one, other] in [[0, 1], [1, 2]] {
            for columns in 0..=6 {
                let mut filled = [0; 64];
                for point in &net.points[..64] {
                    let column = u64::from(point[one]) << columns >> 32;
                    let row = u64::from(point[other]) << (6 - columns) >> 32;
                    filled[(row << columns | column) as usize] += 1;
                }
                let most = if one == 0 { 1 } else { 2 };
                assert!(filled.iter().all(|&count| count <= most), "{one} {columns}");
            }
        }
        // Shifts leave that as it is, and differ.
        let key = PixelKey {
            col: 3,
            row: 5,
            frame: 0,
        };
        let shifts = Shift::all(key, 4);
        let mean = |shift: &Shift| {
            let heights = (0..MOST).map(|number| f64::from(net.direction(number, shift).z));
            heights.sum::<f64>() / f64::from(MOST)
        };
        let means: Vec<f64> = shifts.iter().map(mean).collect();
        // The mean of a cosine among directions as dense as the cosine.
        assert!(means.iter().all(|mean| (mean - 2.0 / 3.0).abs() < 1e-3));
        assert!(means.windows(2).all(|pair| pair[0] != pair[1]));
    }
}
