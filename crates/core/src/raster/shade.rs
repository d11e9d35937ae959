//! The light of what samples see.

use fearless_simd::Simd;

use super::Raster;
use super::ball::RasterBall;
use super::depth::{At, Columns};
use super::occluders::Occluders;
use super::plane::Plane;
use super::samples::Samples;
use crate::numeric::lanes::{LANES, f32x8, mask32x8};

impl Raster<'_> {
    /// Computes the light of all samples that see a ball.
    #[inline(always)]
    pub(super) fn shade<S: Simd>(
        &self,
        simd: S,
        plane: &Plane,
        (number, ball): (f32, &RasterBall),
        occluders: &Occluders,
        samples: &mut Samples,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let number = f32x8::splat(simd, number);
                for group in ball.groups() {
                    let column = group * LANES;
                    let columns = Columns::new(simd, plane, ball, column);
                    for row in ball.rows() {
                        let place = row * samples.stride + column;
                        let seen = f32x8::read(simd, &samples.balls, place);
                        let seen = seen.simd_eq(number);
                        if seen.any_true() {
                            let at = columns.at(simd, plane, ball, row);
                            self.shade_eight(
                                simd,
                                (&columns, at),
                                (ball, occluders),
                                (place, seen),
                                samples,
                            );
                        }
                    }
                }
            },
        );
    }

    /// The same for eight samples, of which some see the ball.
    #[inline(always)]
    fn shade_eight<S: Simd>(
        &self,
        simd: S,
        (columns, at): (&Columns<S>, At<S>),
        (ball, occluders): (&RasterBall, &Occluders),
        (place, seen): (usize, mask32x8<S>),
        samples: &mut Samples,
    ) {
        let zero = f32x8::splat(simd, 0.0);
        let root = at.discriminant.max(zero).sqrt();
        let Columns { x, right, .. } = *columns;
        let forward = zero - (x * right + at.y * at.up + root) * at.square.reciprocal();
        let normal = [right + forward * x, forward * at.y + at.up, forward];
        let channels = self.channels.count();
        let mut light = [zero; 3];
        for (light, ambient) in light.iter_mut().zip(self.ambient.to_array()) {
            *light = f32x8::splat(simd, ambient as f32);
        }
        let (mut kept, mut names) = (zero, zero);
        let mut first = 0;
        for (sun, &end) in self.suns.iter().zip(&occluders.ends) {
            let of_sun = first..end;
            first = end;
            let cosine = dot(normal, sun.toward);
            let facing = seen & cosine.simd_gt(zero);
            if !facing.any_true() {
                continue;
            }
            let mut lit = facing;
            if !of_sun.is_empty() {
                let (right, up) = (dot(normal, sun.right), dot(normal, sun.up));
                for occluder in &occluders.list[of_sun] {
                    let (aside, away) = (right - occluder.right, up - occluder.up);
                    let distance = aside * aside + away * away;
                    let dark = lit
                        & distance.simd_lt(f32x8::splat(simd, occluder.radius_square))
                        & cosine.simd_lt(f32x8::splat(simd, occluder.above));
                    if dark.any_true() {
                        let name = f32x8::splat(simd, occluder.name);
                        names = dark.select(names + names + name, names);
                        lit &= !dark;
                        if !lit.any_true() {
                            break;
                        }
                    }
                }
                let most = (sun.intensity * ball.albedo).max_element() as f32;
                kept = (facing & !lit).select(kept + cosine * most, kept);
            }
            for (channel, light) in light[..channels].iter_mut().enumerate() {
                let more = cosine * sun.intensity[channel] as f32;
                *light = lit.select(*light + more, *light);
            }
        }
        for (channel, light) in light[..channels].iter().enumerate() {
            let light = *light * ball.albedo[channel] as f32;
            write(simd, seen, light, (&mut samples.light[channel], place));
        }
        if self.has_alpha {
            let one = f32x8::splat(simd, 1.0);
            write(simd, seen, one, (&mut samples.light[channels], place));
        }
        if !occluders.list.is_empty() {
            write(simd, seen, kept, (&mut samples.kept, place));
            write(simd, seen, names, (&mut samples.occluders, place));
        }
    }
}

/// The products of vectors with one.
#[inline(always)]
fn dot<S: Simd>(vectors: [f32x8<S>; 3], other: [f32; 3]) -> f32x8<S> {
    vectors[0] * other[0] + vectors[1] * other[1] + vectors[2] * other[2]
}

/// Writes numbers where a mask holds.
#[inline(always)]
fn write<S: Simd>(
    simd: S,
    mask: mask32x8<S>,
    numbers: f32x8<S>,
    (known, place): (&mut [f32], usize),
) {
    let before = f32x8::read(simd, known, place);
    mask.select(numbers, before).write(known, place);
}
