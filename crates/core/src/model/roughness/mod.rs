//! Rough surfaces: shading normals that are tilted by noise, or multiplied by random numbers.
//!
//! With the numbers w, in [−1, 1), and the amplitude a, bumps of the surface make the unit normal n
//!
//! > n′ = u / |u|, u = n + a (w − (w·n) n):
//!
//! they tilt it the way that w leans, alike in all directions. As the noise's part is across n, |u| is at least
//! 1, and the angle between n and n′ is at most atan(√3 a). [`Grain::Pixel`] multiplies the components of n by
//! 1 + a w, as the original program did; it leaves a component of 0 as it is.

pub(crate) mod noise;

use fearless_simd::Simd;
use glam::DVec3;

#[cfg(test)]
use self::noise::Cell;
use self::noise::{NoiseCells, hash, spread};
use super::material::{Grain, Roughness};
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{Lanes, f64x8, mask64x8};

/// Cells that a radius may span; of more, doubles could not tell where in a cell a point lies.
const MOST_CELLS: f64 = (1_u64 << 50) as f64;

/// The pixel that the numbers of [`Grain::Pixel`] are drawn for.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub(crate) struct PixelKey {
    pub(crate) col: u32,
    pub(crate) row: u32,
    pub(crate) frame: i64,
}

impl Roughness {
    /// The shading normal, unit, at the point of the sphere with the outward normal `normal`: what that of
    /// lanes is tested against.
    #[cfg(test)]
    pub(crate) fn perturb(
        &self,
        normal: DVec3,
        radius: f64,
        sphere: usize,
        pixel: PixelKey,
    ) -> DVec3 {
        match self.bumps(radius, sphere) {
            Some(bumps) => bumps.perturb_alone(normal),
            None => {
                let scaled = normal * self.pixel_factors(sphere, pixel);
                DVec3::from_array(unit(scaled.to_array()))
            }
        }
    }

    /// The bumps of one sphere, prepared for many normals; `None` where they are attached to the
    /// pixels.
    pub(crate) fn bumps(&self, radius: f64, sphere: usize) -> Option<Bumps> {
        match self.grain {
            Grain::Surface(size) => Some(Bumps {
                key: hash(self.seed, sphere as u64),
                cells: (radius / size).min(MOST_CELLS),
                amplitude: self.amplitude,
            }),
            Grain::Pixel => None,
        }
    }

    /// The factors of [`Grain::Pixel`] for the components of all normals that a pixel sees of a sphere;
    /// [`unit`] makes the products shading normals.
    pub(crate) fn pixel_factors(&self, sphere: usize, pixel: PixelKey) -> DVec3 {
        1.0 + self.amplitude * pixel_noise(self.seed, sphere, pixel)
    }
}

/// Bumps that are attached to the surface of one sphere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bumps {
    /// A hash of the seed and the sphere.
    key: u64,
    /// The number of cells that the radius spans.
    cells: f64,
    amplitude: f64,
}

impl Bumps {
    /// The shading normal, unit, at the point with the outward normal `normal`; the values of cells are kept in `cells`.
    pub(crate) fn perturb(&self, normal: DVec3, cells: &mut NoiseCells) -> DVec3 {
        let normal = normal.to_array();
        let (nearest, offset) = self.place(normal);
        let draw = cells.cell(self.key, nearest).blend(offset);
        DVec3::from_array(unit(self.tilt(normal, draw)))
    }

    /// The same without a table of cells: what those with one are tested against.
    #[cfg(test)]
    pub(crate) fn perturb_alone(&self, normal: DVec3) -> DVec3 {
        let normal = normal.to_array();
        let (nearest, offset) = self.place(normal);
        let draw = Cell::new(self.key, nearest.map(|part| part as i64)).blend(offset);
        DVec3::from_array(unit(self.tilt(normal, draw)))
    }

    /// The tilted normals of eight lanes; [`unit`] makes them shading normals.
    ///
    /// Many lanes of one cell are done at once, few one by one; the values of cells are kept in `cells`.
    /// Lanes that nobody needs should repeat others; NaN costs the time of a cell, too.
    #[inline(always)]
    pub(crate) fn tilt_lanes<S: Simd>(
        &self,
        simd: S,
        normal: [f64x8<S>; 3],
        cells: &mut NoiseCells,
    ) -> [f64x8<S>; 3] {
        /// Lanes that take less time one by one.
        const FEW: u32 = 3;
        let (nearest, offset) = self.place(normal);
        let [x, y, z]: [[f64; 8]; 3] = [nearest[0].into(), nearest[1].into(), nearest[2].into()];
        let [u, v, w]: [[f64; 8]; 3] = [offset[0].into(), offset[1].into(), offset[2].into()];
        let mut draw = normal;
        let mut alone = [[0.0; 8]; 3];
        let mut which_alone = 0;
        let mut pending = 0xff_u64;
        while pending != 0 {
            let lane = pending.trailing_zeros() as usize;
            let is_here = nearest[0].simd_eq(x[lane])
                & nearest[1].simd_eq(y[lane])
                & nearest[2].simd_eq(z[lane]);
            // NaN is not even where it is: without its own bit the loop would not end.
            let here = is_here.to_bitmask() | 1 << lane;
            pending &= !here;
            let cell = cells.cell(self.key, [x[lane], y[lane], z[lane]]);
            if here.count_ones() > FEW {
                let drawn = cell.blend(offset);
                draw = [
                    is_here.select(drawn[0], draw[0]),
                    is_here.select(drawn[1], draw[1]),
                    is_here.select(drawn[2], draw[2]),
                ];
                continue;
            }
            which_alone |= here;
            for lane in set_bits(here) {
                let drawn = cell.blend_one(simd, [u[lane], v[lane], w[lane]]);
                alone[0][lane] = drawn[0];
                alone[1][lane] = drawn[1];
                alone[2][lane] = drawn[2];
            }
        }
        let is_alone = mask64x8::from_bitmask(simd, which_alone);
        draw = [
            is_alone.select(f64x8::from_array(simd, alone[0]), draw[0]),
            is_alone.select(f64x8::from_array(simd, alone[1]), draw[1]),
            is_alone.select(f64x8::from_array(simd, alone[2]), draw[2]),
        ];
        self.tilt(normal, draw)
    }

    /// The number of cells of the noise that the radius spans.
    pub(crate) fn cells(&self) -> f64 {
        self.cells
    }

    /// A bound of the angle between a normal and its shading normal: atan(√3 a).
    pub(crate) fn most_tilt(&self) -> f64 {
        libm::atan(3.0_f64.sqrt() * self.amplitude)
    }

    /// A bound of |∂n′/∂n|: two points of the sphere whose normals enclose the angle δ, in
    /// radians, have shading normals that differ by at most `slope_bound() · δ`.
    ///
    /// Let n move along the sphere with unit speed, and u = n + a t, t = w − p n, p = w·n, with a the
    /// amplitude and w = g(n · cells).
    ///
    /// Along a unit vector f, g changes as f·v does: f·g = Σ (f·v) W, with v the vectors at the lattice
    /// points, whose components are in [−1, 1], and W a product of three B-splines Bⱼ. Along a unit vector
    /// d it changes by Σ (f·v) d·∇W = Σ (f·v) W Σⱼ dⱼ Bⱼ′/Bⱼ. The W are at least 0 and sum to 1, and so do
    /// the B of each axis. Read as probabilities, they make the three ratios ξⱼ = Bⱼ′/Bⱼ independent and of
    /// mean 0, as Σ B′ = 0, and the change is the covariance of f·v and Σ dⱼ ξⱼ. With the offset o from −½
    /// to ½, E ξ² = Σ B′²/B ≤ 2 + 4o²/(¾ − o²) + 2 ≤ 6, so that Σ dⱼ ξⱼ has a variance of at most 6. That
    /// of f·v is at most that of v, E|v|² − |E v|² ≤ 3 − |w|². By Cauchy and Schwarz
    /// |w′| ≤ √6 cells √(3 − |w|²).
    ///
    /// With e = n′, the direction of the move, u′ = (1 − a p) e − a (w·e) n + a (w′ − (w′·n) n). The
    /// first two parts are across each other, and |w·e| ≤ |t|: together they are at most
    /// √((1 + a |p|)² + a²|t|²) ≤ (1 + a |p|) √(1 + a²|t|²) = (1 + a |p|) |u| long. The last is at most
    /// √6 cells a √(3 − p²), and |u| ≥ 1. The direction of u changes by at most |u′|/|u|, so by
    /// 1 + a (|p| + √6 cells √(3 − p²)), which is at most 1 + a √(3 + 18 cells²), again by Cauchy and
    /// Schwarz. Chords are no longer than the paths along the sphere.
    ///
    /// The bound holds for exact arithmetic; rounding adds 2⁻⁵³ times it, and some units in the last
    /// place.
    pub(crate) fn slope_bound(&self) -> f64 {
        1.0 + self.amplitude * (3.0 + 18.0 * self.cells * self.cells).sqrt()
    }

    /// The jump of the second derivative of the tilted normal along a lattice axis where the cell of the point
    /// with this normal meets the next one on a side, 1 or −1, of that axis: a (Δ − (Δ·n) n), with Δ the noise's.
    pub(crate) fn jump(
        &self,
        normal: DVec3,
        (axis, side): (usize, f64),
        cells: &mut NoiseCells,
    ) -> DVec3 {
        let (here, offset) = self.place(normal.to_array());
        let mut there = here;
        there[axis] += side;
        let before = DVec3::from_array(cells.cell(self.key, here).bend(axis, offset));
        let after = DVec3::from_array(cells.cell(self.key, there).bend(axis, offset));
        let jump = after - before;
        self.amplitude * (jump - normal * jump.dot(normal))
    }

    /// The distances of components of normals from the lattice planes next to them, in cells, which end halfway between
    /// planes.
    #[inline(always)]
    pub(crate) fn offset<L: Lanes>(&self, component: L) -> L {
        let place = component * self.cells;
        place - place.nearest_whole()
    }

    pub(crate) fn amplitude(&self) -> f64 {
        self.amplitude
    }

    /// The lattice point next to a point of the surface, and the offset of the point from it: at most ½
    /// along each axis.
    #[inline(always)]
    fn place<L: Lanes>(&self, normal: [L; 3]) -> ([L; 3], [L; 3]) {
        let [x, y, z] = normal;
        let [x, y, z] = [x * self.cells, y * self.cells, z * self.cells];
        let nearest = [x.nearest_whole(), y.nearest_whole(), z.nearest_whole()];
        let offset = [x - nearest[0], y - nearest[1], z - nearest[2]];
        (nearest, offset)
    }

    /// n + a (w − (w·n) n) with the amplitude a and the numbers w of the noise.
    #[inline(always)]
    fn tilt<L: Lanes>(&self, [x, y, z]: [L; 3], draw: [L; 3]) -> [L; 3] {
        let own = (draw[0] * x + draw[1] * y + draw[2] * z) * -self.amplitude + 1.0;
        [
            draw[0] * self.amplitude + x * own,
            draw[1] * self.amplitude + y * own,
            draw[2] * self.amplitude + z * own,
        ]
    }
}

/// The unit vector in the direction of one whose length is neither tiny nor huge.
///
/// (Neither is a normal times numbers above 1 − amplitude > 0, nor one that is tilted.)
#[inline(always)]
pub(crate) fn unit<L: Lanes>(vector: [L; 3]) -> [L; 3] {
    let [x, y, z] = vector;
    let inverse_length = (x * x + y * y + z * z).sqrt().reciprocal();
    [x * inverse_length, y * inverse_length, z * inverse_length]
}

/// Independent numbers in [−1, 1) for a pixel of a frame.
fn pixel_noise(seed: u64, sphere: usize, pixel: PixelKey) -> DVec3 {
    let key = hash(hash(seed, sphere as u64), pixel.frame as u64);
    let bits = hash(key, u64::from(pixel.col) << 32 | u64::from(pixel.row));
    DVec3::from_array(spread(bits))
}

#[cfg(test)]
mod tests;
