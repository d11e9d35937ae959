//! Spheres prepared for the many rays of one viewpoint.

use fearless_simd::{Level, dispatch};
use glam::DVec3;

use super::double;
use crate::model::sphere::Sphere;
use crate::numeric::fused::is_fused;
use crate::numeric::rounding::{UNIT_ROUNDOFF, two_difference};

/// A sphere as seen from a viewpoint, in lengths that a power of two made moderate.
///
/// A ray with the direction d meets it by the numbers of the [module](super): B = d·f,
/// Q = B² − A K. Computed with one rounding an operation, in this order, they decide where
///
/// > Q > A·`doubt`: the ray's line meets the sphere, Q < −A·`doubt`: it does not.
///
/// # Accuracy
/// With u the unit roundoff and s = f·f + r²: f carries u and B another 3u of |d| |f|, so that B²
/// is off by 9u A f·f; A carries 3u, K no more than 2u where a ball is not odd, so that A K is off
/// by 6u A |K|; the subtraction adds u of both. Together that is less than 17u A s, and
/// A·24u s bounds it with room for the rounding of the bound and for terms in u². Where
/// Q > A·`doubt`, B is not near zero unless K < 0: its computed sign is right, as K > 0 gives
/// B² > Q.
///
/// `doubt` is [`SURE`]² times that, so that √Q is then off by |d| √(24u s) / [`SURE`] at most, and
/// so is B ± √Q but for roundings that are smaller by 10⁵: `blur` is that for a direction of
/// length 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    /// f.
    pub(crate) to_center: DVec3,
    pub(crate) radius: f64,
    /// K, off by two units in the last place at most; negative inside.
    pub(crate) outside: f64,
    /// No point of the sphere is nearer to the viewpoint than this.
    pub(crate) nearest: f64,
    /// The number that Q has to exceed to decide; infinite for odd balls, which only exact arithmetic knows:
    /// those whose surface passes through the viewpoint, nearly, and those of immoderate size.
    pub(crate) doubt: f64,
    /// The largest error of B ± √Q.
    pub(crate) blur: f64,
    /// Place of the sphere in the world.
    pub(crate) index: u32,
}

/// The ratio of √Q to the root of the error of Q, at least, where it decides. Not tuned: with more, more
/// rays are left to exact arithmetic; with less, more distances overlap.
const SURE: f64 = 64.0;

/// Squares between these neither overflow nor underflow in anything computed from them.
const MODERATE: std::ops::Range<f64> = 1e-77..1e77;

impl Ball {
    /// The balls of spheres of the world and their indices; all lengths times 2^−`exponent`.
    pub(crate) fn all<'world>(
        spheres: impl Iterator<Item = (u32, &'world Sphere)>,
        viewpoint: DVec3,
        exponent: i32,
    ) -> Vec<Self> {
        let mut balls = Vec::with_capacity(spheres.size_hint().0);
        // The processor is asked once what it can do, not for every ball. A loop and no `collect`:
        // only what is inlined here is compiled for it.
        dispatch!(Level::new(), simd => if is_fused(simd) {
            for (index, sphere) in spheres {
                balls.push(Self::new::<true>(sphere, index, viewpoint, exponent));
            }
        } else {
            for (index, sphere) in spheres {
                balls.push(Self::new::<false>(sphere, index, viewpoint, exponent));
            }
        });
        balls
    }

    /// A bound from below of the distance to a sphere of the given radius, from the vector to its
    /// center. Where the order of such distances tells nothing, negative infinity.
    #[inline(always)]
    pub(crate) fn nearest(to_center: DVec3, radius: f64) -> f64 {
        /// The distance is off by less, relatively.
        const BELOW: f64 = 1.0 - 8.0 * f64::EPSILON;
        let distance_sq = to_center.length_squared();
        if MODERATE.contains(&(distance_sq + radius * radius)) {
            distance_sq.sqrt() * BELOW - radius
        } else {
            f64::NEG_INFINITY
        }
    }

    #[inline(always)]
    fn new<const FUSED: bool>(
        sphere: &Sphere,
        index: u32,
        viewpoint: DVec3,
        exponent: i32,
    ) -> Self {
        let scale = libm::scalbn(1.0, -exponent);
        let axis = |axis: usize| two_difference(sphere.center[axis], viewpoint[axis]);
        let parts = [axis(0), axis(1), axis(2)];
        let to_center = DVec3::from_array(parts.map(|(high, _)| high * scale));
        let rest = DVec3::from_array(parts.map(|(_, low)| low * scale));
        let scaled = Sphere {
            center: to_center,
            radius: sphere.radius * scale,
        };
        let odd = Self {
            to_center,
            radius: scaled.radius,
            outside: 0.0,
            nearest: Self::nearest(to_center, scaled.radius),
            doubt: f64::INFINITY,
            blur: 0.0,
            index,
        };
        let squares = to_center.length_squared() + scaled.radius * scaled.radius;
        if !MODERATE.contains(&squares) || !rest.is_finite() {
            return odd;
        }
        let outside = double::outside::<FUSED>(&scaled, -rest);
        let error = 24.0 * UNIT_ROUNDOFF * squares;
        // Farther from the surface the error of K that is not relative to it, 14u² s, is below
        // u |K|.
        if outside.abs() <= error {
            return odd;
        }
        Self {
            outside,
            doubt: SURE * SURE * error,
            blur: (1.0 + 1.0 / 16.0) * error.sqrt() / SURE,
            ..odd
        }
    }

    /// True where only exact arithmetic knows where rays meet the ball.
    pub(crate) fn is_odd(&self) -> bool {
        self.doubt == f64::INFINITY
    }
}
