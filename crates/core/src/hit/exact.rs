//! The third floor: every double is an integer times a power of two, so integers decide.

use std::cmp::Ordering;

use glam::DVec3;
use num_bigint::{BigInt, BigUint};
use num_traits::{Signed, ToPrimitive};

use super::outcome::{Components, Hit};
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::numeric::pair::{both, three};

/// Digits that quotients and roots keep: far more than doubles have.
const BITS: u64 = 160;

/// A sphere and a ray in integers, with the numbers of the [module](super).
struct Numbers {
    to_center: [BigInt; 3],
    radius: BigInt,
    /// A.
    direction_sq: BigInt,
    /// B.
    along: BigInt,
    /// K.
    outside: BigInt,
    /// Q.
    discriminant: BigInt,
}

/// The numbers of some spheres, and the exponent of the power of two that their lengths are multiples
/// of.
fn numbers<const COUNT: usize>(
    spheres: [&Sphere; COUNT],
    origin: DVec3,
    direction: &[BigInt],
) -> ([Numbers; COUNT], i32) {
    let mut lengths = origin.to_array().to_vec();
    for sphere in spheres {
        lengths.extend(sphere.center.to_array());
        lengths.push(sphere.radius);
    }
    let (lengths, exponent) = integers(&lengths);
    let (origin, lengths) = lengths.split_at(3);
    let of_sphere = |index: usize| {
        let (center, radius) = (&lengths[4 * index..], lengths[4 * index + 3].clone());
        let to_center = three([0, 1, 2], |axis| &center[axis] - &origin[axis]);
        let direction_sq = dot(direction, direction);
        let along = dot(direction, &to_center);
        let outside = dot(&to_center, &to_center) - &radius * &radius;
        Numbers {
            discriminant: &along * &along - &direction_sq * &outside,
            to_center,
            radius,
            direction_sq,
            along,
            outside,
        }
    };
    (std::array::from_fn(of_sphere), exponent)
}

/// The hit or the miss of any ray with a direction, without rounding before the last step.
pub(super) fn hit(sphere: &Sphere, ray: &Ray) -> Option<Hit> {
    let (direction, direction_exponent) = integers(&ray.direction.to_array());
    let ([numbers], exponent) = numbers([sphere], ray.origin, &direction);
    let Numbers {
        to_center,
        radius,
        direction_sq,
        along,
        outside,
        discriminant,
    } = numbers;
    let inner_side = outside <= BigInt::ZERO;
    if outside >= BigInt::ZERO && along <= BigInt::ZERO {
        return None;
    }
    // Negative is a miss.
    let discriminant = BigUint::try_from(discriminant).ok()?;

    // The root with `shift` binary places.
    let shift = BITS.saturating_sub(discriminant.bits() / 2);
    let root = BigInt::from((discriminant << (2 * shift)).sqrt());
    let backward = along < BigInt::ZERO;
    let far = (along.abs() << shift) + &root;
    let t = if inner_side && !backward {
        quotient(far, &direction_sq << shift)
    } else {
        quotient(outside.abs() << shift, far)
    };
    let length = (&direction_sq * &radius) << shift;
    let component = |axis: usize| {
        let foot = (&along * &direction[axis] - &direction_sq * &to_center[axis]) << shift;
        let half_chord = &root * &direction[axis];
        let from_center = if inner_side {
            foot + half_chord
        } else {
            foot - half_chord
        };
        let (value, exponent) = quotient(from_center, length.clone());
        libm::scalbn(value, exponent)
    };
    Some(Hit {
        t: libm::scalbn(t.0, t.1 + exponent - direction_exponent),
        normal: DVec3::new(component(0), component(1), component(2)),
        inner_side,
    })
}

/// The hit of any ray, its normal along these axes, each number rounded once.
pub(super) fn components(sphere: &Sphere, ray: &Ray, axes: &[DVec3; 3]) -> Option<Components> {
    let Hit { t, inner_side, .. } = hit(sphere, ray)?;
    let (direction, _) = integers(&ray.direction.to_array());
    let ([numbers], exponent) = numbers([sphere], ray.origin, &direction);
    let Numbers {
        to_center,
        radius,
        direction_sq,
        along,
        discriminant,
        ..
    } = numbers;
    let side = if inner_side { 1 } else { -1 };
    let position = |axis: usize| {
        let (mantissa, own) = mantissa_and_exponent(ray.origin[axis]);
        let origin = match mantissa {
            0 => BigInt::ZERO,
            _ => BigInt::from(mantissa) << (own - exponent) as usize,
        };
        let whole = &direction_sq * origin + &along * &direction[axis];
        let rooted = &direction[axis] * side;
        surd(whole, &rooted, &discriminant, &direction_sq, exponent)
    };
    let length = &direction_sq * &radius;
    let normal = |axis: &DVec3| {
        let (axis, exponent) = integers(&axis.to_array());
        let along_axis = dot(&axis, &direction);
        let whole = &along * &along_axis - &direction_sq * dot(&axis, &to_center);
        surd(
            whole,
            &(along_axis * side),
            &discriminant,
            &length,
            exponent,
        )
    };
    Some(Components {
        t,
        position: DVec3::new(position(0), position(1), position(2)),
        normal: DVec3::from_array(three([0, 1, 2], |axis| normal(&axes[axis]))),
    })
}

/// (a + b √q) / c · 2ᵉ for q ≥ 0 and c > 0, rounded once after a relative error of 2⁻¹⁵⁷ at most.
///
/// Computed, if the terms would cancel, by way of (a² − b² q) / (a − b √q).
fn surd(a: BigInt, b: &BigInt, q: &BigInt, c: &BigInt, exponent: i32) -> f64 {
    let Ok(under_root) = BigUint::try_from(q.clone()) else {
        return f64::NAN;
    };
    let shift = BITS.saturating_sub(under_root.bits() / 2);
    let root = BigInt::from((under_root << (2 * shift)).sqrt()) * b;
    let shifted = &a << shift;
    let (mut numerator, mut denominator) = if signum(&a) * signum(b) >= 0 {
        (shifted + root, c << shift)
    } else {
        let squares = &a * &a - b * b * q;
        (squares << shift, (shifted - root) * c)
    };
    if denominator < BigInt::ZERO {
        (numerator, denominator) = (-numerator, -denominator);
    }
    let (value, own) = quotient(numerator, denominator);
    libm::scalbn(value, own + exponent)
}

/// The order in which a ray hits two spheres; both must be hit, from inside or outside.
///
/// With the distances (Bᵢ ± √Qᵢ) / A, the far root from inside, the sign of
/// B₁ − B₂ − (±√Q₂ ∓ √Q₁) is found by squaring twice, so that no root remains.
pub(super) fn compare_distances(first: &Sphere, second: &Sphere, ray: &Ray) -> Ordering {
    let (direction, _) = integers(&ray.direction.to_array());
    let ([first, second], _) = numbers([first, second], ray.origin, &direction);
    let [first_inside, second_inside] =
        both([&first, &second], |ball| ball.outside <= BigInt::ZERO);
    let (first_q, second_q) = (first.discriminant, second.discriminant);

    // The sign of ±√Q₂ ∓ √Q₁; both zero roots leave no sign of their own.
    let roots = match (second_inside, first_inside) {
        _ if first_q == BigInt::ZERO && second_q == BigInt::ZERO => 0,
        (true, false) => 1,
        (false, true) => -1,
        (true, true) => signum(&(&second_q - &first_q)),
        (false, false) => signum(&(&first_q - &second_q)),
    };
    // The sign of gap − (±√Q₂ ∓ √Q₁) is that of t₁ − t₂.
    let gap = first.along - second.along;
    let gap_sign = signum(&gap);
    if gap_sign != roots {
        return gap_sign.cmp(&roots);
    }
    // The sign of gap² − Q₁ − Q₂ ± 2 √(Q₁ Q₂), where the squares of both decide.
    let excess = &gap * &gap - &first_q - &second_q;
    let product = BigInt::from(4) * first_q * second_q;
    let squares = &excess * &excess;
    let is_sum = first_inside == second_inside;
    let larger = match (is_sum, signum(&excess)) {
        (true, -1) => signum(&(product - squares)),
        (true, 0) => signum(&product),
        (true, _) => 1,
        (false, 1) => signum(&(squares - product)),
        (false, 0) => -signum(&product),
        (false, _) => -1,
    };
    (gap_sign * larger).cmp(&0)
}

fn signum(value: &BigInt) -> i32 {
    match value.cmp(&BigInt::ZERO) {
        Ordering::Less => -1,
        Ordering::Equal => 0,
        Ordering::Greater => 1,
    }
}

/// Finite doubles as integers times one common power of two, and its exponent.
fn integers(values: &[f64]) -> (Vec<BigInt>, i32) {
    let parts = values.iter().map(|&value| mantissa_and_exponent(value));
    let used = parts.clone().filter(|(mantissa, _)| *mantissa != 0);
    let common = used.map(|(_, exponent)| exponent).min().unwrap_or(0);
    let integer = |(mantissa, exponent)| match mantissa {
        0 => BigInt::ZERO,
        _ => BigInt::from(mantissa) << (exponent - common) as usize,
    };
    (parts.map(integer).collect(), common)
}

/// A finite double as an integer times a power of two.
fn mantissa_and_exponent(value: f64) -> (i64, i32) {
    const MANTISSA_BITS: i32 = f64::MANTISSA_DIGITS as i32 - 1;
    const BIAS: i32 = f64::MAX_EXP - 1;
    let bits = value.to_bits();
    let stored = (bits >> MANTISSA_BITS & 0x7ff) as i32;
    let fraction = (bits & ((1 << MANTISSA_BITS) - 1)) as i64;
    let (mantissa, exponent) = if stored == 0 {
        (fraction, 1)
    } else {
        (fraction | 1 << MANTISSA_BITS, stored)
    };
    let signed = if value.is_sign_negative() {
        -mantissa
    } else {
        mantissa
    };
    (signed, exponent - BIAS - MANTISSA_BITS)
}

/// The quotient by a number greater than 0, as a double times a power of two; rounded once,
/// after a relative error of 2⁻¹⁵⁹ at most.
fn quotient(numerator: BigInt, denominator: BigInt) -> (f64, i32) {
    let places = BITS as i64 + denominator.bits() as i64 - numerator.bits() as i64;
    let quotient = if places >= 0 {
        (numerator << places as usize) / denominator
    } else {
        numerator / (denominator << -places as usize)
    };
    (quotient.to_f64().unwrap_or(f64::NAN), -places as i32)
}

fn dot(a: &[BigInt], b: &[BigInt]) -> BigInt {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}
