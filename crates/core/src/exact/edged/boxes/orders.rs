//! The orders in which spheres are seen.

use crate::exact::classify::active::Active;
use crate::numeric::rounding::GEOMETRY_SLACK;

/// The order of a sphere and another along all rays of a cell that meet both.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Order {
    Front,
    Behind,
    /// The spheres intersect: their depths tell.
    ByDepth,
}

/// The orders of all pairs of active spheres.
#[derive(Clone, Debug, Default)]
pub(super) struct Orders {
    count: usize,
    orders: Vec<Order>,
}

impl Orders {
    /// For an eye outside of all spheres. Of two that are apart the nearer has the smaller K.
    pub(super) fn find(&mut self, active: &[Active]) {
        self.count = active.len();
        self.orders.clear();
        for one in active {
            for other in active {
                let apart = (one.ball.center - other.ball.center).length();
                let sum = one.ball.radius + other.ball.radius;
                self.orders.push(if apart <= sum * (1.0 + GEOMETRY_SLACK) {
                    Order::ByDepth
                } else if one.ball.outside < other.ball.outside {
                    Order::Front
                } else {
                    Order::Behind
                });
            }
        }
    }

    #[inline(always)]
    pub(super) fn of(&self, one: usize, other: usize) -> Order {
        self.orders[one * self.count + other]
    }

    /// Returns whether a sphere intersects another.
    #[inline(always)]
    pub(super) fn needs_depth(&self, one: usize) -> bool {
        let row = &self.orders[one * self.count..][..self.count];
        let by_depth = row.iter().filter(|order| **order == Order::ByDepth);
        // It intersects itself.
        by_depth.count() > 1
    }
}
