//! The parts of curves that may lie in a cell.

use glam::{DVec2, DVec3};

use super::circle::Circle;
use super::curve::Shape;
use super::near_shadow::NearShadow;
use super::piece::Piece;
use crate::edges::cell::Cell;
use crate::numeric::pair::both;

/// The parts of a circle in front of the eye that lie in a cell, each no more than a quarter of it.
pub(super) fn of_circle(cell: &Cell, circle: &Circle, pieces: &mut Vec<Piece>) {
    /// Axes of the sides.
    const SIDES: [(usize, f64); 4] = [(0, -0.5), (0, 0.5), (1, -0.5), (1, 0.5)];
    // What lies beyond a side is positive; behind the eye everything lies beyond one of them.
    // Parallel rays see points beside fixed places: there only a point, not a direction, has a third
    // component that counts, and that is 1.
    let is_parallel = cell.is_parallel();
    let beyond = |(axis, side): (usize, f64), vector: DVec3| {
        let edge = cell.middle[axis] + side * cell.size[axis];
        side.signum() * (vector[axis] - edge * vector.z)
    };
    let direction = |vector: DVec3| match is_parallel {
        true => vector.with_z(0.0),
        false => vector,
    };
    let place = |point: DVec3| match is_parallel {
        true => point.with_z(1.0),
        false => point,
    };
    // Beside the cell, by so much of its side, nothing ends that lies in it.
    const BESIDE: f64 = 0.25;
    let mut roots = [DVec2::ZERO; 8];
    let mut count = 0;
    let mut passes = false;
    for side in SIDES {
        let (a, b) = (
            beyond(side, direction(circle.right)),
            beyond(side, direction(circle.up)),
        );
        let c = beyond(side, place(circle.middle));
        let [Some(one), Some(other)] = zeros(a, b, c) else {
            if c >= 0.0 || c.is_nan() {
                // All of it lies beyond.
                return;
            }
            continue;
        };
        let across = 1 - side.0;
        for root in [one, other] {
            let point = place(circle.at(root));
            let slack = BESIDE * cell.size[across] * point.z;
            let is_beside = |end: f64| beyond((across, end), point) > slack;
            if is_beside(-0.5) || is_beside(0.5) {
                passes = true;
            } else {
                roots[count] = root;
                count += 1;
            }
        }
    }
    if count == 0 && passes {
        return;
    }
    between(&mut roots[..count], pieces, |e| {
        let point = place(circle.at(e));
        SIDES.iter().all(|&side| beyond(side, point) < 0.0)
    });
}

/// The unit vectors e with a e.x + b e.y + c = 0.
fn zeros(a: f64, b: f64, c: f64) -> [Option<DVec2>; 2] {
    let size_sq = a * a + b * b;
    let rest = size_sq - c * c;
    if rest <= 0.0 || rest.is_nan() {
        return [None; 2];
    }
    let root = rest.sqrt();
    let foot = DVec2::new(a, b) * -c;
    let aside = DVec2::new(-b, a) * root;
    [
        Some((foot + aside) / size_sq),
        Some((foot - aside) / size_sq),
    ]
}

/// The part of the edge of a shadow of a light that exists and may come as near as `around` to a point, as the light
/// sees them.
pub(super) fn of_shadow(
    shape: &Shape,
    (toward, point): (DVec3, DVec3),
    around: f64,
    pieces: &mut Vec<Piece>,
) {
    let (circle, radius_sq, center) = match shape {
        Shape::Shadow {
            circle,
            radius_sq,
            center,
            ..
        } => (circle, radius_sq, center),
        Shape::NearShadow(shadow) => return of_near_shadow(shadow, point, around, pieces),
        Shape::Cone {
            cone,
            rim,
            to_center,
            outside,
            ..
        } => {
            let near = [*to_center, point - cone.apex];
            return of_cone(rim, near, (*outside, around), pieces);
        }
        Shape::Side(_) | Shape::Circle(_) => return,
    };
    let middle = point - *center;
    let near = middle - toward * middle.dot(toward);
    let disc_sq = circle.right.length_squared();
    let mut roots = [DVec2::ZERO; 4];
    let (mut count, mut of_near) = (0, 0);
    // Both ask for |middle + r e - p|² < limit.
    let limits = [(near, around * around), (DVec3::ZERO, *radius_sq)];
    let first = pieces.len();
    for (point, limit) in limits {
        let to_middle = circle.middle - point;
        let (a, b) = (
            2.0 * circle.right.dot(to_middle),
            2.0 * circle.up.dot(to_middle),
        );
        let c = to_middle.length_squared() + disc_sq - limit;
        of_near = count;
        let [one, other] = zeros(a, b, c);
        if let (Some(one), Some(other)) = (one, other) {
            roots[count] = one;
            roots[count + 1] = other;
            count += 2;
        } else if c >= 0.0 || c.is_nan() {
            return;
        }
    }
    let mut turning = [DVec2::NAN; 2];
    turning[..count - of_near].copy_from_slice(&roots[of_near..count]);
    between(&mut roots[..count], pieces, |e| {
        let at = circle.at(e);
        limits
            .iter()
            .all(|(point, limit)| (at - point).length_squared() < *limit)
    });
    // Where it ends it turns back, if it ends on the terminator.
    for piece in &mut pieces[first..] {
        piece.roots = piece.ends.map(|e| turning.contains(&e));
    }
}

/// The same of an edge whose circle lies beside the point.
fn of_near_shadow(shadow: &NearShadow, point: DVec3, around: f64, pieces: &mut Vec<Piece>) {
    let circle = &shadow.circle;
    let to_middle = circle.middle - point;
    let to_middle = to_middle - shadow.toward * to_middle.dot(shadow.toward);
    let [one, by_cos, by_sin] = shadow.discriminant();
    // Both are positive where the edge exists and comes so near.
    let limits = [
        [
            around * around - to_middle.length_squared() - circle.right.length_squared(),
            -2.0 * circle.right.dot(to_middle),
            -2.0 * circle.up.dot(to_middle),
        ],
        [one, by_cos, by_sin],
    ];
    let mut roots = [DVec2::ZERO; 4];
    let (mut count, mut of_near) = (0, 0);
    for [c, a, b] in limits {
        of_near = count;
        if let [Some(one), Some(other)] = zeros(a, b, c) {
            roots[count] = one;
            roots[count + 1] = other;
            count += 2;
        } else if c <= 0.0 || c.is_nan() {
            return;
        }
    }
    let mut turning = [DVec2::NAN; 2];
    turning[..count - of_near].copy_from_slice(&roots[of_near..count]);
    let first = pieces.len();
    between(&mut roots[..count], pieces, |e| {
        limits.iter().all(|[c, a, b]| c + a * e.x + b * e.y > 0.0)
    });
    // Where it ends because it does not exist any more, it turns back.
    for piece in &mut pieces[first..] {
        piece.roots = piece.ends.map(|e| turning.contains(&e));
    }
}

/// The part of the edge of a cone's shadow that exists and may come as near as `around` to a point. Both the center of
/// the ball and that point are given as seen from the apex.
///
/// # Source
/// Ways w along the cone that meet the ball have w · a ≥ |w| √K. Those that come as near as r to a point p, farther away
/// than that, have w · p ≥ |w| √(p² − r²). All w of a rim have one length.
fn of_cone(
    rim: &Circle,
    [to_center, to_point]: [DVec3; 2],
    (outside, around): (f64, f64),
    pieces: &mut Vec<Piece>,
) {
    let length = (rim.middle.length_squared() + rim.right.length_squared()).sqrt();
    let distance = to_point.length();
    let beyond = (distance - around).max(0.0) * (distance + around);
    // Both are positive where the edge exists and comes so near.
    let limits = both(
        [(to_center, outside.max(0.0)), (to_point, beyond)],
        |(to, square)| {
            let least = length * square.sqrt();
            [
                rim.middle.dot(to) - least,
                rim.right.dot(to),
                rim.up.dot(to),
            ]
        },
    );
    // From among the points no way leads past them.
    let limits = &limits[..1 + usize::from(beyond > 0.0)];
    let mut roots = [DVec2::ZERO; 4];
    let (mut count, mut of_ball) = (0, 0);
    for (index, &[c, a, b]) in limits.iter().enumerate() {
        if let [Some(one), Some(other)] = zeros(a, b, c) {
            roots[count] = one;
            roots[count + 1] = other;
            count += 2;
        } else if c < 0.0 || c.is_nan() {
            return;
        }
        if index == 0 {
            of_ball = count;
        }
    }
    let mut turning = [DVec2::NAN; 2];
    turning[..of_ball].copy_from_slice(&roots[..of_ball]);
    let first = pieces.len();
    between(&mut roots[..count], pieces, |e| {
        limits.iter().all(|[c, a, b]| c + a * e.x + b * e.y > 0.0)
    });
    // Where it ends because it does not exist any more, it turns back.
    for piece in &mut pieces[first..] {
        piece.roots = piece.ends.map(|e| turning.contains(&e));
    }
}

/// The parts between unit vectors whose middles lie inside; all, where there are none.
fn between(roots: &mut [DVec2], pieces: &mut Vec<Piece>, inside: impl Fn(DVec2) -> bool) {
    const QUARTERS: [DVec2; 5] = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y, DVec2::X];
    if roots.is_empty() {
        for ends in QUARTERS.windows(2) {
            pieces.push(Piece {
                ends: [ends[0], ends[1]],
                roots: [false; 2],
            });
        }
        return;
    }
    let mut angles = [0.0; 8];
    for index in 0..roots.len() {
        let (root, here) = (roots[index], angle(roots[index]));
        let mut at = index;
        while at > 0 && angles[at - 1] > here {
            (roots[at], angles[at]) = (roots[at - 1], angles[at - 1]);
            at -= 1;
        }
        (roots[at], angles[at]) = (root, here);
    }
    for index in 0..roots.len() {
        let next = (index + 1) % roots.len();
        let (start, end) = (roots[index], roots[next]);
        let turn = angles[next] - angles[index];
        let turn = if turn <= 0.0 { turn + 4.0 } else { turn };
        if roots.len() > 1 && turn < 1e-12 {
            continue;
        }
        if inside(middle(start, end, turn)) {
            divide(start, end, turn, pieces);
        }
    }
}

/// Divides each piece into so many.
pub(super) fn split(pieces: &mut Vec<Piece>, parts: usize) {
    if parts <= 1 {
        return;
    }
    for index in 0..pieces.len() {
        let Piece { ends, roots } = pieces[index];
        let at = |part: usize| {
            let e = ends[0].lerp(ends[1], part as f64 / parts as f64);
            if ends[0].x == 0.0 && ends[1].x == 0.0 {
                e
            } else {
                e.normalize()
            }
        };
        for part in 0..parts {
            let piece = Piece {
                ends: [at(part), at(part + 1)],
                roots: [roots[0] && part == 0, roots[1] && part + 1 == parts],
            };
            if part == 0 {
                pieces[index] = piece;
            } else {
                pieces.push(piece);
            }
        }
    }
}

/// Halves parts until they are no more than a quarter turn.
fn divide(start: DVec2, end: DVec2, turn: f64, pieces: &mut Vec<Piece>) {
    if turn <= 1.0 {
        pieces.push(Piece {
            ends: [start, end],
            roots: [false; 2],
        });
        return;
    }
    let middle = middle(start, end, turn);
    let first = angle(middle) - angle(start);
    let first = if first <= 0.0 { first + 4.0 } else { first };
    divide(start, middle, first, pieces);
    divide(middle, end, turn - first, pieces);
}

/// The unit vector halfway, counterclockwise, between two.
fn middle(start: DVec2, end: DVec2, turn: f64) -> DVec2 {
    let sum = start + end;
    if turn > 1.9 && turn < 2.1 {
        return (start.perp() - end.perp()).normalize();
    }
    let sum = if turn > 2.0 { -sum } else { sum };
    sum.normalize()
}

/// Rises from 0 to 4 in a turn.
fn angle(e: DVec2) -> f64 {
    let share = e.y / (e.x.abs() + e.y.abs());
    if e.x >= 0.0 {
        if e.y >= 0.0 { share } else { 4.0 + share }
    } else {
        2.0 - share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_rise_through_a_turn() {
        let mut last = -1.0;
        for step in 0..1000 {
            let turn = f64::from(step) * std::f64::consts::TAU / 1000.0;
            let here = angle(DVec2::new(libm::cos(turn), libm::sin(turn)));
            assert!(here > last && here < 4.0, "{step}");
            last = here;
        }
    }
}
