//! The spheres that parallel rays see, eight pixels of a row at a time.

use std::cmp::Ordering;

use fearless_simd::Simd;
use glam::DVec3;

use super::groups::Groups;
use super::rays::Place;
use super::tile_balls::TileBall;
use super::trace::{Sight, Tracer};
use crate::hit::outcome::Hit;
use crate::model::ray::Ray;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{LANES, f64x8};
use crate::numeric::vectors::Vectors;

/// Far above the rounding of squared lengths, relative to the largest of them: a ball is left out where that
/// cannot be what keeps a ray from it.
const MARGIN: f64 = 1e-12;

/// The ball that a ray sees, and where.
type Seen<'tile> = Option<(&'tile TileBall, Hit)>;

impl<'tile> Tracer<'tile> {
    /// The points that a row of parallel rays sees.
    ///
    /// # Accuracy
    /// The ball that is seen is exact, and the distance within one unit in the last place: each ray asks
    /// [`Sphere::hit`](crate::Sphere::hit) of all balls that it comes near to.
    #[inline(always)]
    pub(super) fn look_along<S: Simd>(
        &mut self,
        simd: S,
        place: Place,
        groups: &mut Groups<'tile>,
    ) -> Sight<S> {
        let width = place.lanes(self.tile.width);
        let viewpoint = self.rays.viewpoint();
        let rays: [Ray; LANES] =
            std::array::from_fn(|lane| self.rays.ray(place, lane.min(width - 1)));
        let direction = rays[0].direction;
        let scale = libm::scalbn(1.0, -self.index.length_exponent());
        let mut offset = Vectors::splat(simd, DVec3::ZERO);
        for (lane, ray) in rays.iter().enumerate() {
            offset.set_lane(lane, (ray.origin - viewpoint) * scale);
        }
        let mut seen: [Seen<'tile>; LANES] = [None; LANES];
        self.search_along(simd, (&rays, &offset), width, &mut seen);

        let length_sq = f64x8::splat(simd, direction.length_squared());
        let nothing = Vectors::splat(simd, DVec3::ZERO);
        let mut sight = Sight {
            direction: Vectors::splat(simd, direction),
            length_sq,
            covered: 0,
            inner: 0,
            alone: 0,
            point: nothing,
            normal: nothing,
        };
        groups.clear();
        for (lane, seen) in seen.iter().enumerate() {
            let Some((ball, hit)) = seen else { continue };
            sight.covered |= 1 << lane;
            sight.inner |= u64::from(hit.inner_side) << lane;
            let way = rays[lane].direction * (hit.t * scale);
            sight.point.set_lane(lane, offset.lane(lane) + way);
            sight.normal.set_lane(lane, hit.normal);
            groups.add(ball, lane);
        }
        sight.alone = sight.covered & !sight.inner;
        sight
    }

    /// Finds the nearest ball of each of the first rays.
    #[inline(always)]
    fn search_along<S: Simd>(
        &mut self,
        simd: S,
        (rays, offset): (&[Ray; LANES], &Vectors<S>),
        width: usize,
        seen: &mut [Seen<'tile>; LANES],
    ) {
        let direction = rays[0].direction;
        let all = (1_u64 << width) - 1;
        for ball in &self.balls.list {
            self.tests += width as u64;
            let from_ray = Vectors::splat(simd, ball.ball.to_center).minus(offset);
            let along = from_ray.dot_one(direction);
            let distance_sq = from_ray.length_squared();
            let aside_sq = distance_sq - along * along;
            let slack = (distance_sq + ball.radius_sq) * MARGIN;
            // What is not a number is asked.
            let misses = (aside_sq - slack).simd_gt(f64x8::splat(simd, ball.radius_sq));
            let asked = all & !misses.to_bitmask();
            if asked != 0 {
                self.ask(rays, ball, asked, seen);
            }
        }
    }

    /// Takes a ball where it is nearer; of coincident ones that with the lower index.
    #[inline(never)]
    fn ask(
        &self,
        rays: &[Ray; LANES],
        ball: &'tile TileBall,
        asked: u64,
        seen: &mut [Seen<'tile>; LANES],
    ) {
        let spheres = self.index.visibility.spheres();
        let sphere = &spheres[ball.index()];
        for lane in set_bits(asked) {
            let ray = &rays[lane];
            let Some(hit) = sphere.hit(ray) else { continue };
            let is_nearer = seen[lane].as_ref().is_none_or(|(other, other_hit)| {
                match sphere.compare(&hit, &spheres[other.index()], other_hit, ray) {
                    Ordering::Less => true,
                    Ordering::Equal => ball.index() < other.index(),
                    Ordering::Greater => false,
                }
            });
            if is_nearer {
                seen[lane] = Some((ball, hit));
            }
        }
    }
}
