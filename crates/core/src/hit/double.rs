//! The second floor: numbers of twice the precision, with bounds of their errors too.

use fearless_simd::{Level, dispatch};
use glam::DVec3;

use super::outcome::Hit;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::fused::is_fused;
use crate::numeric::pair::three;
use crate::numeric::rounding::{UNIT_ROUNDOFF, two_difference};

/// Bound of the errors of K relative to f·f + r², of Q relative to A (f·f + r²), and of B and
/// |d × f| relative to |d| |f|.
///
/// From the relative errors of [`DoubleDouble`], with u the unit roundoff and f exact: K is off
/// by at most 14u² (f·f + r²) and B by 11u² |d| |f|. Each component of d × f is off by
/// 8u² (|dⱼ fₖ| + |dₖ fⱼ|), so that the vector is off by 11.4u² |d| |f| and its square by 34u² A f·f;
/// A r² carries 16u²; with the last subtraction Q is off by at most 37u² A (f·f + r²).
pub(super) const BOUND: f64 = 64.0 * UNIT_ROUNDOFF * UNIT_ROUNDOFF;

/// The largest error of distance and normal before their last rounding: 2⁻⁵⁷, of t and of the radius.
pub(super) const TOLERANCE: f64 = UNIT_ROUNDOFF / 16.0;

/// The hit or the miss, `None` where the bounds do not decide or do not prove the last places.
///
/// Neither may be far from 1 in size, see [`Scaled`](super::scaled::Scaled).
pub(super) fn hit(sphere: &Sphere, ray: &Ray) -> Option<Option<Hit>> {
    dispatch!(Level::new(), simd => if is_fused(simd) {
        decide::<true>(sphere, ray)
    } else {
        decide::<false>(sphere, ray)
    })
}

/// K of a sphere of moderate size as seen from `origin`, rounded once.
#[inline(always)]
pub(super) fn outside<const FUSED: bool>(sphere: &Sphere, origin: DVec3) -> f64 {
    let to_center = to_center::<FUSED>(sphere, origin);
    (dot(to_center, to_center) - DoubleDouble::product(sphere.radius, sphere.radius)).high
}

/// A vector of such numbers.
pub(super) type Vector<const FUSED: bool> = [DoubleDouble<FUSED>; 3];

/// The crossing of a ray and a sphere, with the numbers of the [module](super).
pub(super) struct Crossing<const FUSED: bool> {
    pub(super) directions: Vector<FUSED>,
    /// f.
    pub(super) to_center: Vector<FUSED>,
    /// d × f.
    pub(super) across: Vector<FUSED>,
    /// A.
    pub(super) direction_sq: DoubleDouble<FUSED>,
    /// B.
    along: DoubleDouble<FUSED>,
    /// K.
    outside: DoubleDouble<FUSED>,
    /// f·f + r².
    scale: f64,
    distance_sq: f64,
    pub(super) inner_side: bool,
    /// √Q.
    pub(super) root: DoubleDouble<FUSED>,
    /// Bound of its error.
    pub(super) root_error: f64,
}

impl<const FUSED: bool> Crossing<FUSED> {
    /// The crossing or the miss, `None` where the bounds do not decide.
    #[inline(always)]
    pub(super) fn new(sphere: &Sphere, ray: &Ray) -> Option<Option<Self>> {
        // A, B and K.
        let to_center = to_center::<FUSED>(sphere, ray.origin);
        let directions = three(ray.direction.to_array(), DoubleDouble::<FUSED>::from);
        let direction_sq = dot(directions, directions);
        let along = dot(directions, to_center);
        let distance_sq = dot(to_center, to_center);
        let radius_sq = DoubleDouble::product(sphere.radius, sphere.radius);
        let outside = distance_sq - radius_sq;
        let scale = distance_sq.high + radius_sq.high;

        // The decisions, as on the first floor.
        if outside.high.abs() <= BOUND * scale {
            return None;
        }
        let inner_side = outside.high < 0.0;
        if !inner_side && along.high <= 0.0 {
            return Some(None);
        }
        let across = cross(directions, to_center);
        let discriminant = direction_sq * radius_sq - dot(across, across);
        let discriminant_bound = BOUND * scale * direction_sq.high;
        if discriminant.high < -discriminant_bound {
            return Some(None);
        }
        if discriminant.high <= 2.0 * discriminant_bound {
            return None;
        }

        // √Q is off by the discriminant's bound over √Q at most, as Q is at least half the computed.
        let root = discriminant.sqrt();
        Some(Some(Self {
            directions,
            to_center,
            across,
            direction_sq,
            along,
            outside,
            scale,
            distance_sq: distance_sq.high,
            inner_side,
            root,
            root_error: discriminant_bound / root.high,
        }))
    }

    /// The distance t, and a bound of its relative error before rounding.
    #[inline(always)]
    pub(super) fn distance(&self) -> (DoubleDouble<FUSED>, f64) {
        let Self { along, root, .. } = *self;
        let length = self.direction_sq.high.sqrt();
        let along_error = BOUND * length * self.distance_sq.sqrt();
        let backward = along.high < 0.0;
        let far = if backward { root - along } else { root + along };
        // From the product of both roots where they would cancel.
        let by_product = !self.inner_side || backward;
        let outside_error = if by_product {
            BOUND * self.scale / self.outside.high.abs()
        } else {
            0.0
        };
        let t = if !by_product {
            far / self.direction_sq
        } else if self.inner_side {
            -self.outside / far
        } else {
            self.outside / far
        };
        let error = (self.root_error + along_error) / far.high + outside_error;
        (t, error)
    }

    /// d × (d × f), which over A leads from the center to the foot of the perpendicular.
    #[inline(always)]
    pub(super) fn foot(&self) -> Vector<FUSED> {
        cross(self.directions, self.across)
    }

    /// √Q with the sign of the way from that foot to the hit: half a chord, over A.
    #[inline(always)]
    pub(super) fn half_chord(&self) -> DoubleDouble<FUSED> {
        if self.inner_side {
            self.root
        } else {
            -self.root
        }
    }
}

#[inline(always)]
fn decide<const FUSED: bool>(sphere: &Sphere, ray: &Ray) -> Option<Option<Hit>> {
    let Some(crossing) = Crossing::<FUSED>::new(sphere, ray)? else {
        return Some(None);
    };
    let (t, distance_error) = crossing.distance();
    // The point is off by |d| / A of the root's error, and by the error of d × (d × f) over A.
    let length = crossing.direction_sq.high.sqrt();
    let point_error = crossing.root_error / length + BOUND * crossing.distance_sq.sqrt();
    let is_proved = distance_error <= TOLERANCE && point_error <= TOLERANCE * sphere.radius;
    if !is_proved {
        return None;
    }
    let (foot, half_chord) = (crossing.foot(), crossing.half_chord());
    // In full, so that the normal is as unit as it is straight.
    let scale = crossing.direction_sq * DoubleDouble::from(sphere.radius);
    let inverse = DoubleDouble::from(1.0) / scale;
    let component =
        |axis: usize| ((foot[axis] + half_chord * crossing.directions[axis]) * inverse).high;
    let normal = DVec3::new(component(0), component(1), component(2));
    Some(Some(Hit {
        t: t.high,
        normal,
        inner_side: crossing.inner_side,
    }))
}

/// c − o, exactly.
#[inline(always)]
fn to_center<const FUSED: bool>(sphere: &Sphere, origin: DVec3) -> Vector<FUSED> {
    three([0, 1, 2], |axis| {
        let (high, low) = two_difference(sphere.center[axis], origin[axis]);
        DoubleDouble { high, low }
    })
}

#[inline(always)]
fn dot<const FUSED: bool>(a: Vector<FUSED>, b: Vector<FUSED>) -> DoubleDouble<FUSED> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross<const FUSED: bool>(a: Vector<FUSED>, b: Vector<FUSED>) -> Vector<FUSED> {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
