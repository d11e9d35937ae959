//! The third floor: every double is an integer times a power of two, so integers decide.

use std::cmp::Ordering;

use dashu_int::ops::{Abs, BitTest, SquareRoot};
use dashu_int::{IBig, UBig};
use glam::DVec3;

use super::outcome::Hit;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;

/// Digits that quotients and roots keep: far more than doubles have.
const BITS: usize = 160;

/// The hit or the miss of any ray with a direction, without rounding before the last step.
pub(super) fn hit(sphere: &Sphere, ray: &Ray) -> Option<Hit> {
    let (center, origin) = (sphere.center, ray.origin);
    let (scene, scene_exponent) = integers([
        center.x,
        center.y,
        center.z,
        origin.x,
        origin.y,
        origin.z,
        sphere.radius,
    ]);
    let (direction, direction_exponent) = integers(ray.direction.to_array());
    let [
        center_x,
        center_y,
        center_z,
        origin_x,
        origin_y,
        origin_z,
        radius,
    ] = scene;
    let to_center = [
        center_x - origin_x,
        center_y - origin_y,
        center_z - origin_z,
    ];

    let direction_sq = dot(&direction, &direction);
    let along = dot(&direction, &to_center);
    let outside = dot(&to_center, &to_center) - &radius * &radius;
    let discriminant = &along * &along - &direction_sq * &outside;
    let inner_side = outside <= IBig::ZERO;
    if outside >= IBig::ZERO && along <= IBig::ZERO {
        return None;
    }
    // Negative is a miss.
    let discriminant = UBig::try_from(discriminant).ok()?;

    // The root with `shift` binary places.
    let shift = BITS.saturating_sub(discriminant.bit_len() / 2);
    let root = IBig::from((discriminant << (2 * shift)).sqrt());
    let backward = along < IBig::ZERO;
    let far = ((&along).abs() << shift) + &root;
    let t = if inner_side && !backward {
        quotient(far, &direction_sq << shift)
    } else {
        quotient((&outside).abs() << shift, far)
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
    let normal = DVec3::new(component(0), component(1), component(2));
    let t = libm::scalbn(t.0, t.1 + scene_exponent - direction_exponent);
    Some(Hit {
        t,
        normal,
        inner_side,
    })
}

/// The order in which a ray hits two spheres; both must be hit, from inside or outside.
///
/// With the distances (Bᵢ ± √Qᵢ) / A, the far root from inside, the sign of
/// B₁ − B₂ − (±√Q₂ ∓ √Q₁) is found by squaring twice, so that no root remains.
pub(super) fn compare_distances(first: &Sphere, second: &Sphere, ray: &Ray) -> Ordering {
    let (centers, origin) = ([first.center, second.center], ray.origin);
    let coordinates = |vector: DVec3| [vector.x, vector.y, vector.z];
    let [a, b, o] = [centers[0], centers[1], origin].map(coordinates);
    let (scene, _) = integers([
        a[0],
        a[1],
        a[2],
        b[0],
        b[1],
        b[2],
        o[0],
        o[1],
        o[2],
        first.radius,
        second.radius,
    ]);
    let (direction, _) = integers(ray.direction.to_array());
    let direction_sq = dot(&direction, &direction);
    let terms = |center: usize, radius: usize| {
        let to_center = [0, 1, 2].map(|axis| &scene[center + axis] - &scene[6 + axis]);
        let along = dot(&direction, &to_center);
        let outside = dot(&to_center, &to_center) - &scene[radius] * &scene[radius];
        let discriminant = &along * &along - &direction_sq * &outside;
        (along, discriminant, outside <= IBig::ZERO)
    };
    let (first_along, first_q, first_inside) = terms(0, 9);
    let (second_along, second_q, second_inside) = terms(3, 10);

    // The sign of gap − (±√Q₂ ∓ √Q₁), which is that of t₁ − t₂.
    let gap = first_along - second_along;
    let sign_of = |inside: bool| if inside { 1 } else { -1 };
    let (first_sign, second_sign) = (sign_of(first_inside), sign_of(second_inside));
    let roots = match (second_sign, first_sign) {
        (1, -1) => 1,
        (-1, 1) => -1,
        (1, _) => signum(&(&second_q - &first_q)),
        _ => signum(&(&first_q - &second_q)),
    };
    // Both zero roots leave no sign of their own.
    let roots = if first_q == IBig::ZERO && second_q == IBig::ZERO {
        0
    } else {
        roots
    };
    let gap_sign = signum(&gap);
    if gap_sign != roots {
        return gap_sign.cmp(&roots);
    }
    // gap² against Q₁ + Q₂ − 2 (±1)(±1) √(Q₁ Q₂).
    let excess = &gap * &gap - &first_q - &second_q;
    let product = IBig::from(4) * first_q * second_q;
    let same = first_sign == second_sign;
    let excess_sign = signum(&excess);
    let squares = &excess * &excess;
    let larger = match (same, excess_sign) {
        // excess + 2 √(Q₁ Q₂)
        (true, -1) => signum(&(product - squares)),
        (true, _) => {
            if excess_sign == 0 {
                signum(&product)
            } else {
                1
            }
        }
        // excess − 2 √(Q₁ Q₂)
        (false, 1) => signum(&(squares - product)),
        (false, _) => {
            if excess_sign == 0 {
                -signum(&product)
            } else {
                -1
            }
        }
    };
    (gap_sign * larger).cmp(&0)
}

fn signum(value: &IBig) -> i32 {
    match value.cmp(&IBig::ZERO) {
        Ordering::Less => -1,
        Ordering::Equal => 0,
        Ordering::Greater => 1,
    }
}

/// Finite doubles as integers times one common power of two, and its exponent.
fn integers<const COUNT: usize>(values: [f64; COUNT]) -> ([IBig; COUNT], i32) {
    let parts = values.map(mantissa_and_exponent);
    let used = parts.iter().filter(|(mantissa, _)| *mantissa != 0);
    let common = used.map(|&(_, exponent)| exponent).min().unwrap_or(0);
    let integers = parts.map(|(mantissa, exponent)| match mantissa {
        0 => IBig::ZERO,
        _ => IBig::from(mantissa) << (exponent - common) as usize,
    });
    (integers, common)
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
fn quotient(numerator: IBig, denominator: IBig) -> (f64, i32) {
    let places = BITS as i64 + denominator.bit_len() as i64 - numerator.bit_len() as i64;
    let quotient = if places >= 0 {
        (numerator << places as usize) / denominator
    } else {
        numerator / (denominator << -places as usize)
    };
    (quotient.to_f64().value(), -places as i32)
}

fn dot(a: &[IBig; 3], b: &[IBig; 3]) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}
