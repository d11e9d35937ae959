//! The nearest ball of every sample.

use fearless_simd::Simd;

use super::ball::RasterBall;
use super::plane::Plane;
use super::samples::Samples;
use crate::numeric::lanes::{LANES, f32x8};

/// The numbers of a ball at eight samples of a row: see [`RasterBall`].
#[derive(Clone, Copy)]
pub(super) struct At<S: Simd> {
    /// Y and V, which are the same for all.
    pub(super) y: f32,
    pub(super) up: f32,
    /// a, and D.
    pub(super) square: f32x8<S>,
    pub(super) discriminant: f32x8<S>,
}

/// The numbers of a ball in eight columns of samples: from row to row little changes, and what is met in one is met
/// in the next.
#[derive(Clone, Copy)]
pub(super) struct Columns<S: Simd> {
    /// X, and its square.
    pub(super) x: f32x8<S>,
    square: f32x8<S>,
    /// U, its square, and p.y U.
    pub(super) right: f32x8<S>,
    right_square: f32x8<S>,
    along: f32x8<S>,
}

impl<S: Simd> Columns<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, plane: &Plane, ball: &RasterBall, column: usize) -> Self {
        let columns = &plane.columns;
        let right = f32x8::read(simd, &columns.from_middle, column) * ball.scale - ball.offset[0];
        Self {
            x: f32x8::read(simd, &columns.places, column),
            square: f32x8::read(simd, &columns.squares, column),
            right,
            right_square: right * right,
            along: right * ball.at[1],
        }
    }

    /// The numbers at the samples of a row.
    #[inline(always)]
    pub(super) fn at(&self, simd: S, plane: &Plane, ball: &RasterBall, row: usize) -> At<S> {
        let up = plane.rows.from_middle[row] * ball.scale - ball.offset[1];
        let square = self.square + (1.0 + plane.rows.squares[row]);
        let turned = f32x8::splat(simd, ball.at[0] * up) - self.along;
        At {
            y: plane.rows.places[row],
            up,
            square,
            discriminant: square - self.right_square - up * up - turned * turned,
        }
    }
}

/// How many balls are held against samples until it is found out anew how far these see. Not tuned finely.
const BALLS: usize = 8;

/// Holds balls against the samples that they may cover, and finds out which of them are seen.
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
                if number % BALLS == 0 && number > 0 {
                    find_far(simd, ball.least, samples);
                }
                hold(simd, plane, (number as f32, ball), samples);
            }
            for (number, ball) in balls.iter().enumerate() {
                samples.seen[number] = is_seen(simd, (number as f32, ball), samples);
            }
        },
    );
}

/// Finds out which blocks of samples see nothing beyond a key.
#[inline(always)]
fn find_far<S: Simd>(simd: S, least: f32, samples: &mut Samples) {
    let groups = samples.stride / LANES;
    for (block, far) in samples.far.iter_mut().enumerate() {
        if *far <= least {
            continue;
        }
        let row = block / groups * LANES;
        let first = row * samples.stride + block % groups * LANES;
        let mut most = f32x8::read(simd, &samples.keys, first);
        for row in 1..LANES.min(samples.count - row) {
            most = most.max(f32x8::read(
                simd,
                &samples.keys,
                first + row * samples.stride,
            ));
        }
        if !most.simd_gt(f32x8::splat(simd, least)).any_true() {
            *far = least;
        }
    }
}

/// True if any sample sees a ball.
#[inline(always)]
fn is_seen<S: Simd>(simd: S, (number, ball): (f32, &RasterBall), samples: &Samples) -> bool {
    let number = f32x8::splat(simd, number);
    for group in ball.groups() {
        for row in ball.rows() {
            let place = row * samples.stride + group * LANES;
            let seen = f32x8::read(simd, &samples.balls, place);
            if seen.simd_eq(number).any_true() {
                return true;
            }
        }
    }
    false
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
    let (blur, one) = (f32x8::splat(simd, ball.blur), f32x8::splat(simd, 1.0));
    let of_row = samples.stride / LANES;
    for group in ball.groups() {
        let column = group * LANES;
        let columns = Columns::new(simd, plane, ball, column);
        for row in ball.rows() {
            if samples.far[row / LANES * of_row + group] <= ball.least {
                continue;
            }
            let At {
                y,
                up,
                square,
                discriminant,
            } = columns.at(simd, plane, ball, row);
            let met = discriminant.simd_gt(zero);
            if !met.any_true() {
                continue;
            }
            let root = discriminant.max(zero).sqrt();
            let key =
                square * ball.depth - (columns.x * columns.right + y * up + root) * ball.radius;
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
