//! The balls that matter in a tile.

use std::f64::consts::PI;

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x8};

use super::lanes::{LANES, Vectors, lanes_of};
use super::rays::Cone;
use crate::World;
use crate::sphere::Ball;

/// A ball with what every ray asks of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    pub(super) ball: Ball,
    pub(super) radius_sq: f64,
    pub(super) inverse_radius: f64,
    /// Where Q is at least this times A, distance and normal are computed side by side.
    pub(super) rim: f64,
    /// −1 where rays meet the outer side, at the near root; 1 where they start inside.
    pub(super) root_sign: f64,
    pub(super) material: u32,
    /// About how many samples the ball covers, if nothing is in front of it.
    pub(super) samples: f64,
}

/// The cosine of the incidence, squared, below which distance and normal are computed alone.
const RIM: f64 = 1.0 / 4096.0;

impl Near {
    /// `cells` is how many samples lie side by side on a length of 1 at the distance of 1.
    #[inline(always)]
    fn new(world: &World, ball: &Ball, cells: f64) -> Self {
        let radius_sq = ball.radius * ball.radius;
        Self {
            ball: *ball,
            radius_sq,
            inverse_radius: 1.0 / ball.radius,
            rim: if ball.is_odd() {
                f64::INFINITY
            } else {
                RIM * radius_sq
            },
            root_sign: if ball.outside < 0.0 { 1.0 } else { -1.0 },
            material: world.material_index(ball.index as usize),
            samples: PI * (cells * cells) * (radius_sq / ball.outside.abs()),
        }
    }
}

/// The balls that may be seen in a tile, those that come nearest first.
#[derive(Debug, Default)]
pub(super) struct Nearby {
    pub(super) balls: Vec<Near>,
    /// The largest `blur` among them.
    pub(super) blur: f64,
}

/// More than rounding moves anything below, relative to distance and radius.
const MARGIN: f64 = 1e-12;

impl Nearby {
    /// Leaves out what a cone around the rays misses, and what is behind a ball that fills it.
    #[inline(always)]
    pub(super) fn gather<'a, S: Simd>(
        &mut self,
        simd: S,
        (world, cells): (&World, f64),
        cone: Option<&Cone>,
        mut balls: impl Iterator<Item = &'a Ball>,
    ) {
        self.balls.clear();
        // No ray of the tile sees anything that is farther away.
        let mut farthest = f64::INFINITY;
        while let Some(first) = balls.next() {
            if first.nearest > farthest {
                break;
            }
            let mut group = [first; LANES];
            let mut count = 1;
            for (slot, ball) in group[1..].iter_mut().zip(&mut balls) {
                *slot = ball;
                count += 1;
            }
            let mut kept = (1 << count) - 1;
            if let Some(cone) = cone {
                let (missed, far) = classify(simd, cone, &group);
                kept &= !missed;
                farthest = farthest.min(far);
            }
            for lane in lanes_of(kept) {
                if group[lane].nearest <= farthest {
                    self.balls.push(Near::new(world, group[lane], cells));
                }
            }
        }
        while self
            .balls
            .last()
            .is_some_and(|last| last.ball.nearest > farthest)
        {
            self.balls.pop();
        }
        self.blur = self
            .balls
            .iter()
            .fold(0.0, |blur, near| near.ball.blur.max(blur));
    }
}

/// Which of eight balls lie outside a cone, as bits, and the distance of the farthest point that
/// any ray of the cone can see, if one of them fills it.
///
/// With x and y the center's coordinates along and across the axis and w the cone's angle, the
/// center lies y cos w − x sin w outside of a plane that touches the cone. The ray farthest from
/// the center makes an angle with it whose sine and cosine are y' = y cos w + x sin w and
/// x' = x cos w − y sin w over the distance; where it meets the ball (y' < r), all do, and it does
/// so last, at x' − √(r² − y'²).
#[inline(always)]
fn classify<S: Simd>(simd: S, cone: &Cone, group: &[&Ball; LANES]) -> (u64, f64) {
    let lanes = |part: fn(&Ball) -> f64| f64x8::simd_from(simd, group.map(part));
    let center = Vectors {
        x: lanes(|ball| ball.to_center.x),
        y: lanes(|ball| ball.to_center.y),
        z: lanes(|ball| ball.to_center.z),
    };
    let radius = lanes(|ball| ball.radius);
    let outside = lanes(|ball| ball.outside);
    let axis = Vectors::splat(simd, cone.axis);
    let cross = center.cross(axis);
    let (x, y) = (center.dot(axis), cross.dot(cross).sqrt());
    let margin = (x.abs() + y + radius) * MARGIN;
    let missed = (y * cone.cosine - x * cone.sine).simd_gt(radius + margin);

    let across = y * cone.cosine + x * cone.sine + margin;
    let along = x * cone.cosine - y * cone.sine;
    let zero = f64x8::splat(simd, 0.0);
    let fills = across.simd_lt(radius) & along.simd_gt(zero) & outside.simd_gt(zero);
    let mut farthest = f64::INFINITY;
    if fills.any_true() {
        let chord_sq = (radius - across) * (radius + across) - radius * radius * MARGIN;
        let chord = chord_sq.simd_gt(zero).select(chord_sq, zero).sqrt();
        let far = along - chord + margin;
        for lane in lanes_of(fills.to_bitmask()) {
            farthest = farthest.min(far[lane]);
        }
    }
    (missed.to_bitmask(), farthest)
}
