//! Spheres that lie behind one other sphere in all of a cell.

use crate::edges::cell::{Ball, Cell};
use crate::edges::silhouette::silhouette;
use crate::numeric::pair::both;
use crate::numeric::polynomial::{Linear, Quadratic};
use crate::numeric::rounding::GEOMETRY_SLACK;

/// Spheres from which on this is asked: fewer intersect in few curves.
const FEWEST: usize = 16;

/// A sphere that covers a cell, and is the nearest in its middle.
///
/// The hidden spheres are found before spheres are compared pair by pair: many that overlap would otherwise intersect in as
/// many curves as they have pairs, in each part of a pixel, however small it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cover {
    ball: Ball,
    discriminant: Quadratic,
    along: Linear,
    /// A bound of the square of the longest ray of the cell.
    longest_sq: f64,
}

impl Cover {
    /// The cover of a cell that may see some spheres, if there is one and they are many.
    pub(super) fn of(cell: &Cell, spheres: &[(usize, Ball)]) -> Option<Self> {
        if spheres.len() < FEWEST {
            return None;
        }
        Self::among(cell, spheres.iter().map(|(_, ball)| ball))
    }

    /// The one of some balls that covers a cell and is the nearest in its middle.
    fn among<'ball>(cell: &Cell, balls: impl Iterator<Item = &'ball Ball>) -> Option<Self> {
        let longest_sq = longest_ray_sq(cell);
        let (mut nearest, mut cover) = (f64::INFINITY, None);
        for ball in balls {
            if ball.outside <= 0.0 {
                continue;
            }
            let along = cell.along(ball.center);
            let discriminant = silhouette(cell, ball);
            let [least, _] = range(longest_sq, ball, &discriminant);
            let place = along.one - discriminant.one.sqrt();
            if least > 0.0 && least_of(&along) > 0.0 && place < nearest {
                nearest = place;
                cover = Some(Self {
                    ball: *ball,
                    discriminant,
                    along,
                    longest_sq,
                });
            }
        }
        cover
    }

    /// Returns whether a sphere is behind it wherever the cell sees its outer side.
    ///
    /// # Source
    /// A ray d meets the near side of a sphere, times d · d, at d · c − √Q. Of the spheres a and b the second is
    /// behind where
    ///
    /// > d · (c_b − c_a) + (Q_a − Q_b) / (√Q_a + √Q_b) > 0,
    ///
    /// in which no large terms cancel, and of which each is bounded in the cell.
    pub(super) fn hides(&self, ball: &Ball, discriminant: &Quadratic, along: &Linear) -> bool {
        if ball.outside <= 0.0 {
            // Its far side is seen.
            return false;
        }
        let longest_sq = self.longest_sq;
        let [least, most] = both(range(longest_sq, &self.ball, &self.discriminant), root);
        let [other_least, other_most] = both(range(longest_sq, ball, discriminant), root);
        let squares = self.discriminant - *discriminant;
        let slack = slack(longest_sq, &self.ball, &self.discriminant)
            + slack(longest_sq, ball, discriminant);
        let squares = squares.one - squares.spread() - slack;
        let roots = if squares < 0.0 {
            least + other_least
        } else {
            most + other_most
        };
        let between = Linear {
            one: along.one - self.along.one,
            x: along.x - self.along.x,
            y: along.y - self.along.y,
        };
        let lengths = self.ball.center.length() + ball.center.length();
        let margin = least_of(&between) + squares / roots;
        // What is not a number hides nothing.
        margin > GEOMETRY_SLACK * longest_sq.sqrt() * lengths
    }
}

/// Leaves out of the balls of a tile, and of their numbers, those behind one that covers the tile: each pixel would find
/// that out anew. Returns whether one does.
///
/// Some of them hide most of the others. The nearest of the rest hides most of the rest.
pub(crate) fn leave_out_hidden(
    tile: &Cell,
    numbers: &mut Vec<usize>,
    balls: &mut Vec<Ball>,
) -> bool {
    /// Balls among which the first cover is sought.
    const SOME: usize = 64;
    let mut is_covered = false;
    for count in [SOME, usize::MAX] {
        let Some(cover) = Cover::among(tile, balls.iter().take(count)) else {
            continue;
        };
        is_covered = true;
        let mut kept = 0;
        for place in 0..balls.len() {
            let ball = balls[place];
            if !cover.hides(&ball, &silhouette(tile, &ball), &tile.along(ball.center)) {
                balls[kept] = ball;
                numbers[kept] = numbers[place];
                kept += 1;
            }
        }
        balls.truncate(kept);
        numbers.truncate(kept);
    }
    is_covered
}

/// The least and the largest value of a discriminant in a cell.
fn range(longest_sq: f64, ball: &Ball, discriminant: &Quadratic) -> [f64; 2] {
    let reach = discriminant.spread() + slack(longest_sq, ball, discriminant);
    [discriminant.one - reach, discriminant.one + reach]
}

fn root(square: f64) -> f64 {
    square.max(0.0).sqrt()
}

/// A bound of what rounding changes a discriminant by, that of the center's place included.
fn slack(longest_sq: f64, ball: &Ball, discriminant: &Quadratic) -> f64 {
    let of_place = longest_sq * (ball.center.length() + ball.radius) * ball.radius;
    GEOMETRY_SLACK * (discriminant.spread() + discriminant.one.abs() + of_place)
}

/// A bound of the square of the longest ray of a cell: 1 for parallel ones.
fn longest_ray_sq(cell: &Cell) -> f64 {
    if cell.is_parallel() {
        return 1.0;
    }
    let ray_sq = cell.ray_sq();
    ray_sq.one + ray_sq.spread()
}

/// The least value in a cell.
fn least_of(linear: &Linear) -> f64 {
    linear.one - 0.5 * (linear.x.abs() + linear.y.abs())
}

#[cfg(test)]
mod tests;
