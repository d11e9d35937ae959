//! The nearest ball of every sample.

use fearless_simd::Simd;

use super::ball::RasterBall;
use super::plane::Plane;
use super::samples::Samples;
use crate::numeric::lanes::{LANES, f32x8};

/// The numbers of a ball at eight samples of a row: see [`RasterBall`].
#[derive(Clone, Copy)]
pub(super) struct At<S: Simd> {
    /// X, and a.
    pub(super) x: f32x8<S>,
    pub(super) square: f32x8<S>,
    /// U, and D.
    pub(super) right: f32x8<S>,
    pub(super) discriminant: f32x8<S>,
}

/// The numbers of a ball in a row of samples.
#[derive(Clone, Copy)]
pub(super) struct Row<S: Simd> {
    /// Y, and 1 + Y².
    pub(super) y: f32x8<S>,
    square: f32x8<S>,
    /// V, its square, and p.x V.
    pub(super) up: f32x8<S>,
    up_square: f32x8<S>,
    across: f32x8<S>,
    scale: f32x8<S>,
    offset: f32x8<S>,
    at_y: f32x8<S>,
}

impl<S: Simd> Row<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, plane: &Plane, ball: &RasterBall, row: usize) -> Self {
        let up = plane.rows.from_middle[row] * ball.scale - ball.offset[1];
        Self {
            y: f32x8::splat(simd, plane.rows.places[row]),
            square: f32x8::splat(simd, 1.0 + plane.rows.squares[row]),
            up: f32x8::splat(simd, up),
            up_square: f32x8::splat(simd, up * up),
            across: f32x8::splat(simd, ball.at[0] * up),
            scale: f32x8::splat(simd, ball.scale),
            offset: f32x8::splat(simd, ball.offset[0]),
            at_y: f32x8::splat(simd, ball.at[1]),
        }
    }

    /// The numbers at the samples from this column on.
    #[inline(always)]
    pub(super) fn at(&self, simd: S, plane: &Plane, column: usize) -> At<S> {
        let columns = &plane.columns;
        let square = f32x8::read(simd, &columns.squares, column) + self.square;
        let right = f32x8::read(simd, &columns.from_middle, column) * self.scale - self.offset;
        let turned = self.across - self.at_y * right;
        At {
            x: f32x8::read(simd, &columns.places, column),
            square,
            right,
            discriminant: square - right * right - self.up_square - turned * turned,
        }
    }
}

/// Holds balls against the samples that they may cover.
#[inline(always)]
pub(super) fn find_nearest<S: Simd>(
    simd: S,
    plane: &Plane,
    balls: &[RasterBall],
    samples: &mut Samples,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            for (number, ball) in balls.iter().enumerate() {
                hold(simd, plane, (number as f32, ball), samples);
            }
        },
    );
}

#[inline(always)]
fn hold<S: Simd>(
    simd: S,
    plane: &Plane,
    (number, ball): (f32, &RasterBall),
    samples: &mut Samples,
) {
    let zero = f32x8::splat(simd, 0.0);
    let number = f32x8::splat(simd, number);
    let (depth, radius) = (
        f32x8::splat(simd, ball.depth),
        f32x8::splat(simd, ball.radius),
    );
    let (blur, one) = (f32x8::splat(simd, ball.blur), f32x8::splat(simd, 1.0));
    let first = ball.columns.0 as usize / LANES * LANES;
    for row in ball.rows.0 as usize..ball.rows.1 as usize {
        let of_row = Row::new(simd, plane, ball, row);
        for column in (first..ball.columns.1 as usize).step_by(LANES) {
            let At {
                x,
                square,
                right,
                discriminant,
            } = of_row.at(simd, plane, column);
            let met = discriminant.simd_gt(zero);
            if !met.any_true() {
                continue;
            }
            let root = discriminant.max(zero).sqrt();
            let key = depth * square - radius * (x * right + of_row.y * of_row.up + root);
            let place = row * samples.stride + column;
            let known = f32x8::read(simd, &samples.keys, place);
            let apart = known - key;
            let is_close = met & apart.abs().simd_lt(blur);
            let is_nearer = met & apart.simd_gt(zero);
            if !(is_nearer | is_close).any_true() {
                continue;
            }
            let doubts = f32x8::read(simd, &samples.doubts, place);
            let doubts = is_close.select(one, is_nearer.select(zero, doubts));
            let nearest = f32x8::read(simd, &samples.balls, place);
            let nearest = is_nearer.select(number, nearest);
            doubts.write(&mut samples.doubts, place);
            nearest.write(&mut samples.balls, place);
            is_nearer.select(key, known).write(&mut samples.keys, place);
        }
    }
}
