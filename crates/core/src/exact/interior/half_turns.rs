//! The turn of directions toward the eye in pixels, and of half vectors with them: also where normals do not turn.

use fearless_simd::Simd;

use super::filled::Filled;
use crate::edges::cell::Ball;
use crate::exact::scene::Light;
use crate::numeric::lanes::f64x8;

/// The least |l + v| that is divided by. Where it is less, the eye looks along the light, which reaches contours alone.
const LEAST_LENGTH: f64 = 1e-3;

/// The largest turn of directions toward the eye from the middles of pixels, whose rays have this length, to the corners; 0
/// where they count as still, so that it is no bound.
///
/// Rays on the retina at distance 1 are at least 1 long, and at least as long as that of the middle less half of the
/// diagonal.
#[inline(always)]
pub(super) fn view_turn<S: Simd>(ball: &Ball, length: f64x8<S>, half_diagonal: f64) -> f64x8<S> {
    let zero = length * 0.0;
    if !ball.is_near_eye() {
        return zero;
    }
    (zero + half_diagonal) / (length - half_diagonal).max(zero + 1.0)
}

/// The extent of pixels over the distance to the silhouette, as [`Filled`] has it: the change of the square of the cosine
/// toward the eye, over itself. The cosine changes as normals turn, and as the view does: of a floor the view alone.
#[inline(always)]
pub(super) fn nearness_of_silhouette<S: Simd>(
    turn: f64x8<S>,
    view_turn: f64x8<S>,
    grazing: f64x8<S>,
) -> f64x8<S> {
    (turn + view_turn) * 2.0 / grazing
}

impl<S: Simd> Filled<'_, S> {
    /// The turn of the half vectors of a light far away from the middles of pixels to the corners: as far as the view, over
    /// the least length of l + v. An estimate, as the turn of the view is.
    #[inline(always)]
    pub(super) fn half_turn(&self, simd: S, light: &Light) -> f64x8<S> {
        let zero = f64x8::splat(simd, 0.0);
        if !self.ball.is_near_eye() {
            return zero;
        }
        let ray_length = self.middle.length_squared().sqrt();
        let cosine = self.middle.dot_one(light.toward) * -1.0 / ray_length;
        let length = (cosine * 2.0 + 2.0).max(zero).sqrt();
        self.view_turn / (length - self.view_turn).max(zero + LEAST_LENGTH)
    }
}
