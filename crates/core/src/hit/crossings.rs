//! The points in which eight rays meet spheres, each coordinate to its own last places.
//!
//! [`components`](super::components) answers for one ray with numbers of twice the precision throughout. Here a distance
//! of common precision takes one Newton step, whose residual alone has twice the precision: with v = f − d t and the
//! numbers of the [module](super),
//!
//! > δ = (v·v − r²) / (2 d·v), p = o + d (t + δ), n = (d δ − v) / r.
//!
//! Lanes that the bounds below do not prove are left to [`Sphere::hit_components`](crate::Sphere).
//!
//! # Accuracy
//! With u the unit roundoff and Sⱼ = |fⱼ| + |dⱼ t|, every vⱼ is a sum of two doubles that is off by 4.1u² Sⱼ, of which the
//! smaller one is below 2.1u Sⱼ. The residual is exact but for 4.1u² Sⱼ · 2|vⱼ|, for the square of the smaller part, which
//! is left out, 4.5u² Sⱼ², and for the rounding of a dozen small terms: together less than 256u² Σ Sⱼ², where it is not
//! above r² / 4 itself. d·v is off by 5.2u Σ |dⱼ| Sⱼ, and δ by that part of itself and 3u. What a Newton step leaves of a
//! quadratic is below A δ² / |d·v| where 8 A |δ| ≤ |d·v|. The sum of all this is the error of t + δ; each number adds what
//! its own few roundings do, noted beside it.

use fearless_simd::Simd;
use glam::DVec3;

use crate::model::sphere::Sphere;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::rounding::{UNIT_ROUNDOFF, two_difference, two_product, two_sum};
use crate::numeric::vectors::Vectors;

/// u².
const SQUARE: f64 = UNIT_ROUNDOFF * UNIT_ROUNDOFF;

/// The relative error of each number before its last rounding, at most: half of what
/// [`Sphere::hit_components`](crate::Sphere) promises, which leaves room for the rounding of the bounds.
const TOLERANCE: f64 = UNIT_ROUNDOFF / 32.0;

/// More than all that underflow takes, as long as lengths are [`MODERATE`]; numbers near it are not proved.
const TINY: f64 = 1e-250;

/// If d·v is less than this part of Σ |dⱼ| Sⱼ, little of it is left by rounding.
const LEAST_ALONG: f64 = 1.0 / (1_u64 << 26) as f64;

/// Sums of squares that neither overflow nor underflow in what follows.
const MODERATE: std::ops::Range<f64> = 1e-100..1e100;

/// Spheres as rays meet them, one in each lane, in lengths that a power of two has scaled.
#[derive(Clone, Copy)]
pub(crate) struct Targets<S: Simd> {
    /// f, the sum of two vectors.
    to_center: [Vectors<S>; 2],
    /// r² and 1 / r, sums of two numbers.
    radius_sq: [f64x8<S>; 2],
    inverse_radius: [f64x8<S>; 2],
}

/// A number in each lane, and where it is proved.
pub(crate) type Proved<S> = (f64x8<S>, mask64x8<S>);

/// The crossings of rays with spheres.
pub(crate) struct Crossings<S: Simd, const FUSED: bool> {
    direction: Vectors<S>,
    /// t and δ.
    distance: [f64x8<S>; 2],
    distance_error: f64x8<S>,
    /// d t, the sum of two vectors.
    way: [Vectors<S>; 2],
    /// f − d (t + δ), likewise, and a bound of its error that leaves room for a division by r.
    inward: [Vectors<S>; 2],
    inward_error: Vectors<S>,
    inverse_radius: [f64x8<S>; 2],
    /// The rays for which the bounds of the distance hold.
    is_sound: mask64x8<S>,
    is_proved: mask64x8<S>,
}

impl<S: Simd> Targets<S> {
    /// The same sphere in all lanes, of rays from one origin; `scale` is a power of two.
    #[inline(always)]
    pub(crate) fn splat<const FUSED: bool>(
        simd: S,
        sphere: &Sphere,
        origin: DVec3,
        scale: f64,
    ) -> Self {
        let (mut high, mut low) = (DVec3::ZERO, DVec3::ZERO);
        for axis in 0..3 {
            let parts = two_difference(sphere.center[axis], origin[axis]);
            (high[axis], low[axis]) = (parts.0 * scale, parts.1 * scale);
        }
        let to_center = [Vectors::splat(simd, high), Vectors::splat(simd, low)];
        Self::with::<FUSED>(simd, to_center, sphere.radius * scale)
    }

    /// The same sphere in all lanes, of rays from these origins.
    #[inline(always)]
    pub(crate) fn seen_from<const FUSED: bool>(
        simd: S,
        sphere: &Sphere,
        origins: &Vectors<S>,
        scale: f64,
    ) -> Self {
        let center = Vectors::splat(simd, sphere.center);
        let (x, low_x) = two_difference(center.x, origins.x);
        let (y, low_y) = two_difference(center.y, origins.y);
        let (z, low_z) = two_difference(center.z, origins.z);
        let lengths = f64x8::splat(simd, scale);
        let high = Vectors::from_array([x, y, z]).times(lengths);
        let low = Vectors::from_array([low_x, low_y, low_z]).times(lengths);
        Self::with::<FUSED>(simd, [high, low], sphere.radius * scale)
    }

    #[inline(always)]
    fn with<const FUSED: bool>(simd: S, to_center: [Vectors<S>; 2], radius: f64) -> Self {
        let square = two_product::<FUSED, f64>(radius, radius);
        let inverse = 1.0 / radius;
        let (one, rest) = two_product::<FUSED, f64>(inverse, radius);
        let inverse_low = ((1.0 - one) - rest) * inverse;
        let splat = |number| f64x8::splat(simd, number);
        Self {
            to_center,
            radius_sq: [splat(square.0), splat(square.1)],
            inverse_radius: [splat(inverse), splat(inverse_low)],
        }
    }

    /// The distances, from the others at which the same rays cross the same spheres.
    #[inline(always)]
    pub(crate) fn other_side(&self, direction: &Vectors<S>, t: f64x8<S>) -> f64x8<S> {
        // Both add up to 2 B / A.
        let middle = direction.dot(&self.to_center[0]) / direction.length_squared();
        middle + middle - t
    }

    /// `self` where the mask holds, else `other`.
    #[inline(always)]
    pub(crate) fn or(&self, mask: mask64x8<S>, other: &Self) -> Self {
        let ([high, low], [other_high, other_low]) = (&self.to_center, &other.to_center);
        Self {
            to_center: [high.or(mask, other_high), low.or(mask, other_low)],
            radius_sq: select(mask, self.radius_sq, other.radius_sq),
            inverse_radius: select(mask, self.inverse_radius, other.inverse_radius),
        }
    }
}

#[inline(always)]
fn select<S: Simd>(
    mask: mask64x8<S>,
    [a, b]: [f64x8<S>; 2],
    [other_a, other_b]: [f64x8<S>; 2],
) -> [f64x8<S>; 2] {
    [mask.select(a, other_a), mask.select(b, other_b)]
}

impl<S: Simd, const FUSED: bool> Crossings<S, FUSED> {
    /// The crossings of rays from the targets' origin with these directions, which lie near the distances `t`, on the
    /// inner sides where the mask holds.
    #[inline(always)]
    pub(crate) fn new(
        simd: S,
        direction: Vectors<S>,
        (t, inner): (f64x8<S>, mask64x8<S>),
        targets: &Targets<S>,
    ) -> Self {
        let [center, center_low] = &targets.to_center;
        let (way_x, way_low_x) = two_product::<FUSED, _>(direction.x, t);
        let (way_y, way_low_y) = two_product::<FUSED, _>(direction.y, t);
        let (way_z, way_low_z) = two_product::<FUSED, _>(direction.z, t);
        let way = Vectors::from_array([way_x, way_y, way_z]);
        let way_low = Vectors::from_array([way_low_x, way_low_y, way_low_z]);
        let (high_x, rest_x) = two_difference(center.x, way.x);
        let (high_y, rest_y) = two_difference(center.y, way.y);
        let (high_z, rest_z) = two_difference(center.z, way.z);
        let high = Vectors::from_array([high_x, high_y, high_z]);
        let rest = Vectors::from_array([rest_x, rest_y, rest_z]);
        let low = rest.plus(center_low).minus(&way_low);
        let sizes = center.sizes().plus(&way.sizes());

        let (square_x, error_x) = two_product::<FUSED, _>(high.x, high.x);
        let (square_y, error_y) = two_product::<FUSED, _>(high.y, high.y);
        let (square_z, error_z) = two_product::<FUSED, _>(high.z, high.z);
        let [radius_sq, radius_sq_low] = targets.radius_sq;
        let (sum, first) = two_sum(square_x, square_y);
        let (sum, second) = two_sum(sum, square_z);
        let (difference, third) = two_difference(sum, radius_sq);
        let mixed = high.dot(&low);
        let small = (error_x + error_y) + (error_z - radius_sq_low) + (first + second + third);
        let residual = difference + (small + (mixed + mixed));

        let size_sq = sizes.length_squared();
        let directions = direction.sizes();
        let along = direction.dot(&high);
        let inverse = 1.0 / along;
        let step = residual * inverse * 0.5;
        // Rays leave through inner sides. Where this is negative, the other side is nearer.
        let along = inner.select(along * -1.0, along);
        let inverse = inverse.abs();
        let direction_sq = direction.length_squared();
        let bend = direction_sq * step.abs();
        let spread = directions.dot(&sizes);
        let step_error = step.abs() * (spread * inverse + 1.0) * (6.0 * UNIT_ROUNDOFF);
        let distance_error =
            inverse * (bend * step.abs() * 1.1 + size_sq * (136.0 * SQUARE)) + step_error + TINY;
        let is_sound = t.simd_gt(f64x8::splat(simd, 0.0))
            & along.simd_gt(spread * LEAST_ALONG)
            & along.simd_ge(bend * 8.0)
            & residual.abs().simd_le(radius_sq * 0.25)
            & direction_sq.simd_gt(f64x8::splat(simd, MODERATE.start))
            & size_sq.simd_gt(f64x8::splat(simd, MODERATE.start))
            & size_sq.simd_lt(f64x8::splat(simd, MODERATE.end));

        let shift = direction.times(step);
        let shifts = shift.sizes();
        let moved = directions.times(distance_error);
        // With the roundings of the sum and of the division: 23u² Sⱼ and 6u |dⱼ δ|.
        let inward_error = sum_of(
            simd,
            &moved,
            (&sizes, 32.0 * SQUARE),
            (&shifts, 8.0 * UNIT_ROUNDOFF),
        );
        // Multiples of t + δ add at most 12u² t and 4u |δ|.
        let multiple_error =
            distance_error + t * (16.0 * SQUARE) + step.abs() * (4.0 * UNIT_ROUNDOFF);
        let is_proved = is_sound & multiple_error.simd_le(t * TOLERANCE);
        Self {
            direction,
            distance: [t, step],
            distance_error,
            way: [way, way_low],
            inward: [high, low.minus(&shift)],
            inward_error,
            inverse_radius: targets.inverse_radius,
            is_sound,
            is_proved,
        }
    }

    /// The distances, times these numbers.
    #[inline(always)]
    pub(crate) fn times(&self, simd: S, factor: f64x8<S>) -> Proved<S> {
        let [t, step] = self.distance;
        let (product, rest) = two_product::<FUSED, _>(t, factor);
        let multiple = product + (rest + step * factor);
        let is_large = multiple.abs().simd_gt(f64x8::splat(simd, TINY));
        (multiple, self.is_proved & is_large)
    }

    /// The distances in lengths instead of multiples of the direction.
    #[inline(always)]
    pub(crate) fn lengths(&self, simd: S) -> Proved<S> {
        let Vectors { x, y, z } = self.direction;
        let (square_x, error_x) = two_product::<FUSED, _>(x, x);
        let (square_y, error_y) = two_product::<FUSED, _>(y, y);
        let (square_z, error_z) = two_product::<FUSED, _>(z, z);
        let (sum, first) = two_sum(square_x, square_y);
        let (sum, second) = two_sum(sum, square_z);
        let small = first + second + (error_x + error_y + error_z);
        let root = sum.sqrt();
        let (root_sq, error) = two_product::<FUSED, _>(root, root);
        let root_low = ((sum - root_sq) - error + small) * (0.5 / root);
        let [t, step] = self.distance;
        let (product, rest) = two_product::<FUSED, _>(t, root);
        let length = product + (rest + (t * root_low + step * root));
        let is_large = length.simd_gt(f64x8::splat(simd, TINY));
        (length, self.is_proved & is_large)
    }

    /// The points in the world, where a length of 1 is `length` long, a power of two.
    #[inline(always)]
    pub(crate) fn positions(&self, origin: &Vectors<S>, length: f64) -> (Vectors<S>, mask64x8<S>) {
        let (x, proved_x) = self.coordinate(0, origin.x, length);
        let (y, proved_y) = self.coordinate(1, origin.y, length);
        let (z, proved_z) = self.coordinate(2, origin.z, length);
        let proved = self.is_sound & proved_x & proved_y & proved_z;
        (Vectors::from_array([x, y, z]), proved)
    }

    /// A coordinate of the points, from that of the origin.
    #[inline(always)]
    fn coordinate(&self, axis: usize, origin: f64x8<S>, length: f64) -> Proved<S> {
        let [way, way_low] = &self.way;
        let (direction, way) = (self.direction.along(axis), way.along(axis) * length);
        let (sum, rest) = two_sum(origin, way);
        let shift = direction * self.distance[1] * length;
        let coordinate = sum + (rest + way_low.along(axis) * length + shift);
        // The small parts and their sums are off by less than 2u² of the large ones, and 2u of the shift.
        let error = direction.abs() * self.distance_error * length
            + (way.abs() + origin.abs()) * (8.0 * SQUARE)
            + shift.abs() * (4.0 * UNIT_ROUNDOFF)
            + TINY;
        (coordinate, error.simd_le(coordinate.abs() * TOLERANCE))
    }

    /// The unit outward normals.
    #[inline(always)]
    pub(crate) fn normals(&self) -> (Vectors<S>, mask64x8<S>) {
        let [high, low] = &self.inward;
        let error = &self.inward_error;
        let (x, proved_x) = self.outward(high.x, low.x, error.x);
        let (y, proved_y) = self.outward(high.y, low.y, error.y);
        let (z, proved_z) = self.outward(high.z, low.z, error.z);
        let proved = self.is_sound & proved_x & proved_y & proved_z;
        (Vectors::from_array([x, y, z]), proved)
    }

    /// The components of the unit outward normals along these unit vectors.
    #[inline(always)]
    pub(crate) fn normals_along(&self, axes: &[DVec3; 3]) -> (Vectors<S>, mask64x8<S>) {
        let (x, proved_x) = self.normal_along(axes[0]);
        let (y, proved_y) = self.normal_along(axes[1]);
        let (z, proved_z) = self.normal_along(axes[2]);
        let proved = self.is_sound & proved_x & proved_y & proved_z;
        (Vectors::from_array([x, y, z]), proved)
    }

    #[inline(always)]
    fn normal_along(&self, axis: DVec3) -> Proved<S> {
        let [high, low] = &self.inward;
        let simd = high.x.simd();
        let axes = Vectors::splat(simd, axis);
        let (part_x, error_x) = two_product::<FUSED, _>(high.x, axes.x);
        let (part_y, error_y) = two_product::<FUSED, _>(high.y, axes.y);
        let (part_z, error_z) = two_product::<FUSED, _>(high.z, axes.z);
        let (sum, first) = two_sum(part_x, part_y);
        let (sum, second) = two_sum(sum, part_z);
        let small = first + second + (error_x + error_y + error_z) + low.dot_one(axis);
        // The sums and products add less than three times as much as the components have.
        let error = self.inward_error.dot_one(axis.abs()) * 4.0;
        self.outward(sum, small, error)
    }

    /// Minus a length over the radius, from two parts and a bound of their error.
    #[inline(always)]
    fn outward(&self, high: f64x8<S>, low: f64x8<S>, error: f64x8<S>) -> Proved<S> {
        let [inverse, inverse_low] = self.inverse_radius;
        let (product, rest) = two_product::<FUSED, _>(high, inverse);
        let number = product * -1.0 - (rest + (high * inverse_low + low * inverse));
        let is_proved = (error * inverse + TINY).simd_le(number.abs() * TOLERANCE);
        (number, is_proved)
    }
}

/// A vector and multiples of two others.
#[inline(always)]
fn sum_of<S: Simd>(
    simd: S,
    vector: &Vectors<S>,
    (one, factor): (&Vectors<S>, f64),
    (other, other_factor): (&Vectors<S>, f64),
) -> Vectors<S> {
    let one = one.times(f64x8::splat(simd, factor));
    let other = other.times(f64x8::splat(simd, other_factor));
    vector.plus(&one).plus(&other)
}

#[cfg(test)]
mod tests;
