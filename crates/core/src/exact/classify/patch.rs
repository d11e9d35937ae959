//! The part of space in which a cell sees a sphere.

use glam::{DVec2, DVec3};

use crate::edges::cell::{Ball, Cell};
use crate::model::camera::Projection;
use crate::numeric::polynomial::{Linear, Quadratic};
use crate::numeric::rounding::{GEOMETRY_SLACK, WIDER};

/// The part of space in which a cell sees a sphere: all that lies within `around` of the way between
/// two points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    pub(crate) ends: [DVec3; 2],
    pub(crate) around: f64,
}

/// The side of another sphere's surface on which all of a patch lies.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Side {
    Inside,
    Outside,
}

impl Patch {
    /// For an eye outside. The ray d through the middle of the cell is off by half its diagonal at
    /// most; with Q = B² − A K ≥ 0, t = K / (B + √Q) lies between K / (B⁺ + √Q⁺) and √(K / A⁻).
    pub(crate) fn new(cell: &Cell, ball: &Ball, discriminant: &Quadratic, along: &Linear) -> Self {
        if cell.is_parallel() {
            return Self::of_parallel_rays(cell, ball, discriminant);
        }
        let k = ball.outside;
        let spread = discriminant.spread();
        let (lowest, highest) = (discriminant.one - spread, discriminant.one + spread);
        let half = 0.5 * (along.x.abs() + along.y.abs());
        let half_diagonal = 0.5 * DVec2::from_array(cell.size).length();
        let shortest = (cell.middle.length() - half_diagonal).max(1.0);
        let nearest = k / (along.one + half + highest.max(0.0).sqrt());
        let mut farthest = k.sqrt() / shortest;
        if along.one > half {
            farthest = farthest.min(k / (along.one - half + lowest.max(0.0).sqrt()));
        }
        Self {
            ends: [cell.middle * nearest, cell.middle * farthest],
            around: farthest * half_diagonal * WIDER
                + GEOMETRY_SLACK * farthest * cell.middle.length(),
        }
    }

    /// For parallel rays, which all begin outside: they meet the sphere at c_z − √Q.
    fn of_parallel_rays(cell: &Cell, ball: &Ball, discriminant: &Quadratic) -> Self {
        let spread = discriminant.spread();
        let root = |square: f64| square.max(0.0).sqrt();
        let nearest = ball.center.z - root(discriminant.one + spread);
        let farthest = ball.center.z - root(discriminant.one - spread);
        let half_diagonal = 0.5 * DVec2::from_array(cell.size).length();
        let size = cell.extent() + ball.center.length() + ball.radius;
        Self {
            ends: [cell.at(nearest), cell.at(farthest)],
            around: half_diagonal * WIDER + GEOMETRY_SLACK * size,
        }
    }

    /// The distance of all of it from a point, at least.
    pub(crate) fn distance_from(&self, point: DVec3) -> f64 {
        let [start, end] = self.ends;
        let way = end - start;
        let share = (point - start).dot(way) / way.length_squared();
        let share = if share.is_finite() {
            share.clamp(0.0, 1.0)
        } else {
            0.0
        };
        ((start + way * share - point).length() - self.around).max(0.0)
    }

    /// A ball around it.
    pub(crate) fn ball(&self) -> (DVec3, f64) {
        let [start, end] = self.ends;
        (
            0.5 * (start + end),
            0.5 * (end - start).length() + self.around,
        )
    }

    /// The side of the sphere `other` on which all of this patch of `ball` lies, if it is one.
    ///
    /// A point p of a sphere i lies outside of a sphere j where p · w > m, with w = cᵢ − cⱼ and
    /// m = (Kᵢ − Kⱼ) / 2.
    pub(super) fn side_of(&self, ball: &Ball, other: &Ball) -> Option<Side> {
        let w = ball.center - other.center;
        let [k, other_k] = [ball, other].map(|ball| match ball.projection {
            Projection::Central => ball.outside,
            Projection::Parallel => ball.center.length_squared() - ball.radius * ball.radius,
        });
        let m = 0.5 * (k - other_k);
        let places = self.ends.map(|point| point.dot(w) - m);
        let mut slack = GEOMETRY_SLACK * (k.abs() + other_k.abs());
        if ball.is_parallel() {
            // What K consists of may nearly cancel.
            slack +=
                GEOMETRY_SLACK * (ball.center.length_squared() + other.center.length_squared());
        }
        let around = self.around * w.length() + slack;
        if places[0].min(places[1]) > around {
            Some(Side::Outside)
        } else if places[0].max(places[1]) < -around {
            Some(Side::Inside)
        } else {
            None
        }
    }
}
