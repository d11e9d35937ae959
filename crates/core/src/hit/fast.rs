//! The first floor: plain doubles, which answer wherever their error bounds decide.

use fearless_simd::{Level, Simd, SimdBase, SimdFrom, dispatch, f64x4};
use glam::DVec3;

use super::double;
use super::outcome::Hit;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::numeric::fused::is_fused;
use crate::numeric::rounding::{UNIT_ROUNDOFF, two_difference, two_product, two_sum};

/// The answer of the first floor.
pub(super) enum Answer {
    Miss,
    Hit(Hit),
    Undecided,
}

/// The decision of the first floor.
pub(super) enum Decision {
    Miss,
    Hit(Certain),
    Undecided,
}

/// Bound of the error of K relative to f·f + r², and of Q relative to A (f·f + r²).
///
/// With u the unit roundoff and every operation below rounded once: f carries a relative error
/// u, so that f·f carries 5u and r² carries u; K is off by at most 5u f·f + u r² + u |K|
/// ≤ 7u (f·f + r²). B is off by 4u |d| |f|, so that B² is off by 9u A f·f; A carries 3u, so that
/// A K is off by 11u A (f·f + r²); the last subtraction adds 2u. Together that is 22u; 24u leaves
/// room for the terms in u² and for the rounding of the bound itself.
const DECISION_BOUND: f64 = 24.0 * UNIT_ROUNDOFF;

/// Bound of the error of the accurate residual, relative to f·f + r².
///
/// Let m = t₀ d and p = m − f. As t₀ lies within a third of the chord of its root (see
/// [`refine`]), |p| ≤ 5/3 r and |m| ≤ |f| + 5/3 r, so that (|m| + |f|)² ≤ 7 (f·f + r²) and
/// |p| (|m| + |f|) ≤ 3.6 (f·f + r²). The parts w of the points p = s + w below are at most
/// 2u (|mᵢ| + |fᵢ|) and off by 3u² (|mᵢ| + |fᵢ|). The residual leaves out w·w ≤ 28u² (f·f + r²),
/// inherits 22u² from the error of w, and its low-order roundings cost 150u² at most; the two
/// high-order ones are relative to the residual itself. 2⁹ u² covers them.
const RESIDUAL_BOUND: f64 = 512.0 * UNIT_ROUNDOFF * UNIT_ROUNDOFF;

/// The numbers of the decision, for the distance and the normal.
pub(super) struct Certain {
    /// A.
    direction_sq: f64,
    /// B.
    along: f64,
    /// K.
    outside: f64,
    /// Q.
    discriminant: f64,
}

/// The numbers that depend on the sphere and the origin of rays alone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Relative {
    /// f.
    to_center: DVec3,
    /// K.
    pub(super) outside: f64,
    /// f·f + r².
    scale: f64,
}

impl Relative {
    /// The sphere as seen from `origin`, in plain doubles.
    #[inline(always)]
    pub(super) fn new(sphere: &Sphere, origin: DVec3) -> Self {
        let to_center = sphere.center - origin;
        let distance_sq = to_center.length_squared();
        let radius_sq = sphere.radius * sphere.radius;
        let (outside, scale) = (distance_sq - radius_sq, distance_sq + radius_sq);
        Self {
            to_center,
            outside,
            scale,
        }
    }

    /// The same with K from twice the precision, for a sphere that many rays will look for.
    pub(super) fn precise(sphere: &Sphere, origin: DVec3) -> Self {
        let plain = Self::new(sphere, origin);
        if are_moderate(1.0, plain.scale) {
            Self {
                outside: double::outside::<false>(sphere, origin),
                ..plain
            }
        } else {
            plain
        }
    }

    /// Decides whether the ray with this direction meets the sphere, where K is known up to `slack`
    /// more than rounding costs.
    #[inline(always)]
    pub(super) fn decide(&self, direction: DVec3, direction_sq: f64, slack: f64) -> Decision {
        let Self {
            to_center,
            outside,
            scale,
        } = *self;
        let along = direction.dot(to_center);
        let bound = DECISION_BOUND * scale + slack;
        let discriminant = along * along - direction_sq * outside;
        let discriminant_bound = direction_sq * bound;
        let moderate = are_moderate(direction_sq, scale);
        // Most rays miss: what they need comes first.
        if discriminant < -discriminant_bound && outside > bound && moderate {
            return Decision::Miss;
        }
        if !moderate | (outside.abs() <= bound) | (discriminant <= 2.0 * discriminant_bound) {
            return Decision::Undecided;
        }
        // Were the exact B greater than 0 against the computed one, it would be so small that
        // B² < A K: a miss all the same.
        if outside > 0.0 && along <= 0.0 {
            return Decision::Miss;
        }
        Decision::Hit(Certain {
            direction_sq,
            along,
            outside,
            discriminant,
        })
    }
}

/// The hit or the miss, where the bounds decide and prove it.
#[inline(always)]
pub(super) fn hit(sphere: &Sphere, ray: &Ray) -> Answer {
    let relative = Relative::new(sphere, ray.origin);
    hit_relative(sphere, &relative, ray)
}

/// [`hit`] where the sphere is known relative to the ray's origin.
#[inline(always)]
pub(super) fn hit_relative(sphere: &Sphere, relative: &Relative, ray: &Ray) -> Answer {
    let direction_sq = ray.direction.length_squared();
    match relative.decide(ray.direction, direction_sq, 0.0) {
        Decision::Miss => Answer::Miss,
        Decision::Undecided => Answer::Undecided,
        Decision::Hit(certain) => {
            finish(sphere, ray, certain).map_or(Answer::Undecided, Answer::Hit)
        }
    }
}

/// True where two squares lie within 2⁻²⁵⁶ and 2²⁵⁶: then nothing computed from them can overflow,
/// nor lose digits to underflow that the bounds do not cover.
#[inline(always)]
fn are_moderate(a: f64, b: f64) -> bool {
    const LOWEST: u64 = 1023 - 256;
    const RANGE: u64 = 512;
    // The exponents; below the lowest the difference wraps around to a large number.
    let above = |value: f64| (value.to_bits() >> (f64::MANTISSA_DIGITS - 1)).wrapping_sub(LOWEST);
    (above(a) | above(b)) < RANGE
}

/// Distance and normal of a certain hit, `None` where the bounds do not prove their last places.
#[inline(always)]
fn finish(sphere: &Sphere, ray: &Ray, certain: Certain) -> Option<Hit> {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx2) = Level::new().as_avx2() {
        let Certain {
            direction_sq,
            along,
            outside,
            discriminant,
        } = certain;
        return refine_avx2(
            avx2,
            sphere,
            ray,
            direction_sq,
            along,
            outside,
            discriminant,
        );
    }
    refine_portably(sphere, ray, &certain)
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fearless_simd::kernel!(
    #[inline(never)]
    fn refine_avx2(
        avx2: Avx2,
        sphere: &Sphere,
        ray: &Ray,
        direction_sq: f64,
        along: f64,
        outside: f64,
        discriminant: f64,
    ) -> Option<Hit> {
        let certain = Certain {
            direction_sq,
            along,
            outside,
            discriminant,
        };
        refine::<true, _>(avx2, sphere, ray, &certain)
    }
);

#[cold]
fn refine_portably(sphere: &Sphere, ray: &Ray, certain: &Certain) -> Option<Hit> {
    dispatch!(Level::new(), simd => if is_fused(simd) {
        refine::<true, _>(simd, sphere, ray, certain)
    } else {
        refine::<false, _>(simd, sphere, ray, certain)
    })
}

/// One step of Newton's from the plain distance, with an accurate residual.
///
/// With the residual R = |t₀ d − f|² − r² and the sign + at the near root, − at the far one,
///
/// > t = t₀ ± R / (2 √Q) ∓ A e² / (2 √Q),
///
/// where e is the error of t₀. With u the unit roundoff, the computed Q exceeds 48u A (f·f + r²)
/// here and the exact one 26u A (f·f + r²), so that the computed √Q is at most 1.36 times the
/// exact one. By that t₀ may be off by 0.18 of the chord 2 √Q / A; the errors of B and of the sum
/// are of the order √u of it. Hence |e| is less than a fifth of the chord, and R / (2 √Q) at least
/// 4/5 of |e|.
///
/// The step δ = R / (2 √Q) is computed; what it misses is
/// - the error of R, at most `RESIDUAL_BOUND` (f·f + r²), over 2 √Q;
/// - |δ| times the relative error of the computed √Q, at most the discriminant's bound over the
///   computed Q, and of five roundings;
/// - A e² / (2 √Q): with |e| ≤ 5/4 · 1.36 |δ| (up to the first item) it is below 2 A δ² / √Q, with
///   the computed Q; four times A δ² / √Q leaves room.
///
/// Each is held below 2⁻⁵⁷ t₀, so that the sum rounds to within one unit in the last place, and
/// below 2⁻⁵⁷ √Q / A ≤ 2⁻⁵⁷ r / |d|, so that the point moves by less than 2⁻⁵⁵ r. The normal's
/// components are then rounded once: it turns by less than (1 + ½) · 2⁻⁵³ radians.
#[inline(always)]
fn refine<const FUSED: bool, S: Simd>(
    simd: S,
    sphere: &Sphere,
    ray: &Ray,
    certain: &Certain,
) -> Option<Hit> {
    const TOLERANCE: f64 = UNIT_ROUNDOFF / 16.0;
    let &Certain {
        direction_sq,
        along,
        outside,
        discriminant,
    } = certain;
    // The plain distance.
    let inner_side = outside < 0.0;
    // f·f + r², up to roundings that the bounds leave room for.
    let scale = outside + 2.0 * sphere.radius * sphere.radius;
    let root = discriminant.sqrt();
    // The step below makes up for what cancels here; a quotient by B ± √Q would keep it waiting.
    let half_chord = if inner_side { root } else { -root };
    let plain_t = (along + half_chord) * (1.0 / direction_sq);

    // The residual. Side by side x, y, z and, for its square, the radius.
    let lanes =
        |vector: DVec3, fourth| f64x4::simd_from(simd, [vector.x, vector.y, vector.z, fourth]);
    let direction = lanes(ray.direction, 0.0);
    let (to_center, to_center_rest) =
        two_difference(lanes(sphere.center, sphere.radius), lanes(ray.origin, 0.0));
    // The point t d − f and its rest, and the sum of its squares less that of the radius.
    let (along, along_rest) = two_product::<FUSED, _>(direction, f64x4::splat(simd, plain_t));
    let (point, point_rest) = two_difference(along, to_center);
    let point_rest = point_rest + (along_rest - to_center_rest);
    let (squares, squares_rest) = two_product::<FUSED, _>(point, point);
    let cross = point * point_rest;
    let rests = squares_rest + (cross + cross);
    let (sum, first) = two_sum(squares[0], squares[1]);
    let (difference, second) = two_difference(squares[2], squares[3]);
    // The two nearly cancel: what this loses is relative to the residual itself.
    let difference = difference + sum;
    let rest = (rests[0] + rests[1]) + (rests[2] - rests[3]);
    let residual = difference + ((first + second) + rest);

    // The step, and whether its last places are proved.
    let step = residual * (-0.5 / half_chord);
    let distance = plain_t * direction_sq;
    let smallest = TOLERANCE * if distance < root { distance } else { root };
    let step_size = step.abs() * direction_sq;
    let squares_bound = scale * direction_sq;
    // The relative error of the step, times the discriminant.
    let step_error = DECISION_BOUND * squares_bound
        + 4.0 * step_size * root
        + 8.0 * UNIT_ROUNDOFF * discriminant;
    let proved = RESIDUAL_BOUND * squares_bound <= smallest * root
        && step_size * step_error <= smallest * discriminant;
    if !proved {
        return None;
    }
    // The normal. The rest stays apart, so that each component is rounded once.
    let point_rest = point_rest + direction * step;
    let inverse_radius = f64x4::splat(simd, 1.0 / sphere.radius);
    let (normal, normal_rest) = two_product::<FUSED, _>(point, inverse_radius);
    let normal = normal + (normal_rest + point_rest * inverse_radius);
    let normal = DVec3::new(normal[0], normal[1], normal[2]);
    Some(Hit {
        t: plain_t + step,
        normal,
        inner_side,
    })
}
