//! The surfaces that eight rays see.

use fearless_simd::Simd;
use glam::DVec3;

use super::groups::{Group, Groups};
use super::places::Places;
use super::rays::{LEAST_SQUARE, Place, Rays};
use super::tile_balls::{TileBall, TileBalls};
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{LANES, f64x8, mask64x8};
use crate::numeric::vectors::Vectors;
use crate::picture::tile::Tile;
use crate::search::view_index::ViewIndex;

/// Rows of a tile.
const SIDE: usize = Tile::SIDE as usize;

/// All lanes of a bit mask.
const ALL_LANES: u64 = (1 << LANES) - 1;

/// The rays of a tile and all that they may meet.
pub(super) struct Tracer<'tile> {
    pub(super) index: &'tile ViewIndex<'tile>,
    pub(super) rays: &'tile Rays,
    pub(super) balls: &'tile TileBalls,
    pub(super) tile: Tile,
    /// How often balls were asked whether a ray meets them.
    pub(super) tests: u64,
}

/// The points that eight rays see; lanes that see nothing hold any numbers. Cold functions get copies:
/// this stays in the processor's registers.
#[derive(Clone, Copy)]
pub(super) struct Sight<S: Simd> {
    pub(super) direction: Vectors<S>,
    pub(super) length_sq: f64x8<S>,
    /// The rays that see anything, as bits.
    pub(super) covered: u64,
    /// The rays that see the inner side of a ball.
    pub(super) inner: u64,
    /// The rays, as bits, that met their ball alone, and outer sides only: not by the formula whose error is
    /// [`DISTANCE_ERROR`].
    pub(super) alone: u64,
    /// From the viewpoint to what is seen, in the lengths of the balls.
    pub(super) point: Vectors<S>,
    /// The unit outward normal there.
    pub(super) normal: Vectors<S>,
}

/// A row of rays, and the nearest ball of each so far.
#[derive(Clone, Copy)]
pub(super) struct RayRow<S: Simd> {
    direction: Vectors<S>,
    length_sq: f64x8<S>,
    /// A t, the distance in multiples of the direction over the direction's square.
    key: f64x8<S>,
    /// The ball's place among those of the tile; −1 for none.
    place: f64x8<S>,
    /// The key at which a ball may begin that was neither met nor missed for certain.
    doubtful: f64x8<S>,
}

impl<S: Simd> RayRow<S> {
    /// Rays that have met nothing.
    #[inline(always)]
    pub(super) fn new(simd: S, direction: Vectors<S>) -> Self {
        let never = f64x8::splat(simd, f64::INFINITY);
        Self {
            direction,
            length_sq: direction.length_squared(),
            key: never,
            place: f64x8::splat(simd, -1.0),
            doubtful: never,
        }
    }

    /// Takes a ball where it is nearer, or counts it as doubtful.
    #[inline(always)]
    fn test(&mut self, simd: S, tested: &Tested<'_, S>) {
        let ball = &tested.ball.ball;
        let zero = f64x8::splat(simd, 0.0);
        let along = self.direction.dot(&tested.center);
        let discriminant = along * along - self.length_sq * ball.outside;
        let doubt = self.length_sq * ball.doubt;
        let missed = discriminant.simd_lt(-doubt).to_bitmask();
        if missed == ALL_LANES {
            return;
        }
        let decided = discriminant.simd_gt(doubt);
        let root = decided.select(discriminant, zero).sqrt();
        let (met, key) = if tested.ball.root_sign > 0.0 {
            (decided, along + root)
        } else {
            (decided & along.simd_gt(zero), along - root)
        };
        let open = !(missed | decided.to_bitmask()) & ALL_LANES;
        if open != 0 {
            let sooner = mask64x8::from_bitmask(simd, open) & tested.begin.simd_lt(self.doubtful);
            self.doubtful = sooner.select(tested.begin, self.doubtful);
        }
        let close = met & (key - self.key).abs().simd_le(tested.blur);
        let closer = met & key.simd_lt(self.key);
        self.key = closer.select(key, self.key);
        self.place = closer.select(tested.place, self.place);
        if close.any_true() {
            let sooner = close & self.key.simd_lt(self.doubtful);
            self.doubtful = sooner.select(self.key, self.doubtful);
        }
    }
}

/// A ball that rows of rays are tested against, with its numbers in all lanes.
struct Tested<'tile, S: Simd> {
    ball: &'tile TileBall,
    center: Vectors<S>,
    /// Its place among those of the tile.
    place: f64x8<S>,
    begin: f64x8<S>,
    /// Keys that differ by less may be in another order.
    blur: f64x8<S>,
}

impl<'tile> Tracer<'tile> {
    /// Finds what all rows of rays see, as far as bounds of rounding errors decide it.
    ///
    /// The nearest certain hits, and from where on they are not certain. Two distances are compared
    /// by their B ± √Q, whose errors [`Ball`](crate::hit::ball::Ball) bounds by |d| times its `blur`.
    /// Balls that lie closer together count as doubtful from there on.
    ///
    /// Ball by ball and row by row: the rows do not wait for each other. Rows without a place are left alone.
    #[inline(always)]
    pub(super) fn search<S: Simd>(
        &mut self,
        simd: S,
        places: &Places,
        rows: &mut [RayRow<S>; SIDE],
    ) {
        let lanes = places.as_slice()[0].lanes(self.tile.width) as u64;
        // The rows in which something may come nearer, as bits.
        let mut open = u8::MAX >> (SIDE - places.as_slice().len());
        let blur = f64x8::splat(simd, 2.0 * self.balls.blur);
        for (place, ball) in self.balls.list.iter().enumerate() {
            let tested = Tested {
                ball,
                center: Vectors::splat(simd, ball.ball.to_center),
                place: f64x8::splat(simd, place as f64),
                begin: f64x8::splat(simd, ball.begin),
                blur,
            };
            for number in set_bits(places.of_ball(ball) & open) {
                let row = &mut rows[number % SIDE];
                // Whatever lies within the error of the nearest was met before, or is doubtful; and
                // the next ones begin no sooner.
                if tested.begin.simd_gt(row.key + blur).all_true() {
                    open &= !(1 << number);
                    continue;
                }
                self.tests += lanes;
                row.test(simd, &tested);
            }
            if open == 0 {
                break;
            }
        }
    }

    /// The points that a row of rays sees after the search. Exact arithmetic decides whatever that left
    /// open.
    ///
    /// # Accuracy
    /// The ball that is seen is exact. The point where the ray meets it and the normal there are functions
    /// of the ray and the ball alone, whatever else the tile holds; see [`Tracer::meet`].
    #[inline(always)]
    pub(super) fn look<S: Simd>(
        &mut self,
        simd: S,
        place: Place,
        row: &RayRow<S>,
        groups: &mut Groups<'tile>,
    ) -> Sight<S> {
        let mut places = row.place;
        let trusted = row.length_sq.simd_gt(f64x8::splat(simd, LEAST_SQUARE));
        // Both distances may be off by half of this, the one of what may be nearer too.
        let blur = f64x8::splat(simd, 2.0 * self.balls.blur);
        let open = row.doubtful.simd_lt(row.key + blur) | !trusted;
        if open.any_true() {
            let mut settled: [f64; LANES] = places.into();
            self.settle(place, open.to_bitmask(), &mut settled);
            places = f64x8::from_array(simd, settled);
        }
        self.meet(simd, place, (row.direction, row.length_sq), places, groups)
    }

    /// Settles exactly what some rays see.
    #[cold]
    #[inline(never)]
    fn settle(&self, place: Place, open: u64, places: &mut [f64; LANES]) {
        for lane in set_bits(open) {
            let lane_of_pixel = lane.min(place.lanes(self.tile.width) - 1);
            let ray = self.rays.ray(place, lane_of_pixel);
            let nearest = self.index.nearest(self.tile, &ray);
            let place = nearest.and_then(|(index, _)| {
                let mut balls = self.balls.list.iter();
                balls.position(|ball| ball.index() == index)
            });
            places[lane] = place.map_or(-1.0, |place| place as f64);
        }
    }

    /// The points where rays meet the balls at these places among those of the tile.
    ///
    /// The distance is t = K / (B + √Q), the normal (t d − f) / r.
    ///
    /// # Accuracy
    /// Q is computed as A r² − |d × f|² where |d × f| < B, else as B² − A K. With u the unit
    /// roundoff: each part of d × f is off by 3u (|dᵢ fⱼ| + |dⱼ fᵢ|), so that the vector is off by
    /// 6u |d| |f| and Q, in the first case, by 12u |d × f| |d| |f| + 6u A r²; as |d × f| ≤ |d| r,
    /// √Q ≥ |d| r / 64 (the rim is left to [`Sphere::hit`](crate::Sphere::hit)) and
    /// B ≥ |d| |f| / √2 > |d| r / √2, t is off by (32 · 18u · √2 + 10u) t. In the second case
    /// B² is off by 9u |d| |f| B, A K by 6u B² and Q by 16u |d| |f| B together, while
    /// |f| ≤ √2 r: t is off by (32 · 16u · √2 + 32 · 4u · √2 + 4u) t. Both are below 1024u t,
    /// in the worst place of the rim: [`DISTANCE_ERROR`]. The normal is off by that times
    /// t |d| / r, and by 4u |f| / r.
    #[inline(always)]
    fn meet<S: Simd>(
        &self,
        simd: S,
        place: Place,
        (direction, length_sq): (Vectors<S>, f64x8<S>),
        places: f64x8<S>,
        groups: &mut Groups<'tile>,
    ) -> Sight<S> {
        let covered = places.simd_ge(f64x8::splat(simd, 0.0)).to_bitmask();
        let mut sight = Sight {
            direction,
            length_sq,
            covered,
            inner: 0,
            alone: 0,
            point: Vectors::splat(simd, DVec3::ZERO),
            normal: Vectors::splat(simd, DVec3::ZERO),
        };
        if covered == 0 {
            return sight;
        }
        let selected = self.select(simd, places, &mut sight, groups);
        let center = selected.center;
        let across = direction.cross(&center);
        let (across_sq, along) = (across.length_squared(), direction.dot(&center));
        let along_sq = along * along;
        let discriminant = across_sq.simd_lt(along_sq).select(
            length_sq * selected.radius_sq - across_sq,
            along_sq - length_sq * selected.outside,
        );
        let sound = discriminant.simd_ge(length_sq * selected.rim);
        let one = f64x8::splat(simd, 1.0);
        let root = sound.select(discriminant, one).sqrt();
        sight.point = direction.times(selected.outside / (along + root));
        sight.normal = sight.point.minus(&center).times(selected.inverse_radius);
        // Only the ambient light reaches inner sides, wherever they are met.
        let alone = covered & !sound.to_bitmask() & !sight.inner;
        if alone != 0 {
            sight.alone = alone;
            return self.meet_alone(place, alone, groups, sight);
        }
        sight
    }

    /// Groups the rays by the balls that they see, and selects the numbers of these.
    #[inline(always)]
    fn select<S: Simd>(
        &self,
        simd: S,
        places: f64x8<S>,
        sight: &mut Sight<S>,
        groups: &mut Groups<'tile>,
    ) -> Selected<S> {
        let balls = &self.balls.list;
        let first = places[sight.covered.trailing_zeros() as usize];
        let mut selected = Selected::splat(simd, &balls[first as usize]);
        let (mut left, mut count) = (sight.covered, 0);
        while left != 0 {
            let number = places[left.trailing_zeros() as usize];
            let ball = &balls[number as usize];
            let mask = places.simd_eq(f64x8::splat(simd, number));
            let lanes = mask.to_bitmask();
            if count > 0 {
                selected = selected.or(!mask, Selected::splat(simd, ball));
            }
            if ball.root_sign > 0.0 {
                sight.inner |= lanes;
            }
            groups.list[count] = Group { ball, lanes };
            count += 1;
            left &= !lanes;
        }
        groups.count = count;
        selected
    }

    /// The points where single rays meet the balls that they see.
    #[cold]
    #[inline(never)]
    fn meet_alone<S: Simd>(
        &self,
        place: Place,
        alone: u64,
        groups: &Groups<'_>,
        mut sight: Sight<S>,
    ) -> Sight<S> {
        let exponent = self.rays.exponent() - self.index.length_exponent();
        let spheres = self.index.visibility.spheres();
        for lane in set_bits(alone) {
            let sees = |group: &Group<'_>| group.lanes >> lane & 1 == 1;
            let Some(group) = groups.as_slice().iter().find(|group| sees(group)) else {
                continue;
            };
            let lane_of_pixel = lane.min(place.lanes(self.tile.width) - 1);
            let ray = self.rays.ray(place, lane_of_pixel);
            let Some(hit) = spheres[group.ball.index()].hit_from_viewpoint(&ray) else {
                continue;
            };
            let t = libm::scalbn(hit.t, exponent);
            let direction = sight.direction.lane(lane);
            sight.point.set_lane(lane, direction * t);
            sight.normal.set_lane(lane, hit.normal);
            if hit.inner_side {
                sight.inner |= 1 << lane;
            }
        }
        sight
    }
}

/// A bound of the relative error of the distance to what is seen; derived at [`Tracer::meet`].
pub(super) const DISTANCE_ERROR: f64 = 512.0 * f64::EPSILON;

/// The numbers of the ball that each ray sees.
#[derive(Clone, Copy)]
struct Selected<S: Simd> {
    center: Vectors<S>,
    outside: f64x8<S>,
    radius_sq: f64x8<S>,
    inverse_radius: f64x8<S>,
    rim: f64x8<S>,
}

impl<S: Simd> Selected<S> {
    #[inline(always)]
    fn splat(simd: S, ball: &TileBall) -> Self {
        Self {
            center: Vectors::splat(simd, ball.ball.to_center),
            outside: f64x8::splat(simd, ball.ball.outside),
            radius_sq: f64x8::splat(simd, ball.radius_sq),
            inverse_radius: f64x8::splat(simd, ball.inverse_radius),
            rim: f64x8::splat(simd, ball.rim),
        }
    }

    /// `self` where the mask holds, else `other`.
    #[inline(always)]
    fn or(self, mask: mask64x8<S>, other: Self) -> Self {
        Self {
            center: self.center.or(mask, &other.center),
            outside: mask.select(self.outside, other.outside),
            radius_sq: mask.select(self.radius_sq, other.radius_sq),
            inverse_radius: mask.select(self.inverse_radius, other.inverse_radius),
            rim: mask.select(self.rim, other.rim),
        }
    }
}
