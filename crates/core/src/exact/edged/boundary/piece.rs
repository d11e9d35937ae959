//! Parts of curves, and numbers that vanish where edges of shadows turn back.

use fearless_simd::Simd;
use glam::DVec2;

use crate::numeric::lanes::f64x8;

/// A part of a curve: between two unit vectors (cos θ, sin θ), by less than half a turn; of a side,
/// between two y, which are the second components.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) ends: [DVec2; 2],
    /// Whether the curve turns back at an end, where places go with the root of the angle.
    pub(super) roots: [bool; 2],
}

/// A function c + b · e at the unit vectors e of a piece with these parameters.
///
/// If the piece ends at zeros of the function, its roots, values are computed from the distance to them. Near such an end
/// c + b · e is a difference of large numbers, of which little but rounding is left.
///
/// # Source
/// A vector p = e₁ + s d leads from the end e₁ that is a root, with d to the other end, and e = p / |p|. As both ends are
/// unit vectors, 1 − |p|² = s (1 − s) |d|², and
///
/// > b · (e − e₁) = s (b · d + b · e₁ (1 − s) |d|² / (1 + |p|)) / |p|,
///
/// where b · d = 0 if both ends are roots.
#[inline(always)]
pub(super) fn from_ends<S: Simd>(
    piece: &Piece,
    s: f64x8<S>,
    [cos, sin]: [f64x8<S>; 2],
    [c, by_cos, by_sin]: [f64; 3],
) -> f64x8<S> {
    let one = s * 0.0 + 1.0;
    let slope = DVec2::new(by_cos, by_sin);
    let [start, end] = piece.ends;
    let (root, chord, s) = match piece.roots {
        [false, false] => return cos * by_cos + sin * by_sin + c,
        [true, _] => (start, end - start, s),
        [false, true] => (end, start - end, one - s),
    };
    let along = match piece.roots {
        [true, true] => 0.0,
        _ => slope.dot(chord),
    };
    let (x, y) = (s * chord.x + root.x, s * chord.y + root.y);
    let length = (x * x + y * y).sqrt();
    let bulge = (one - s) * (slope.dot(root) * chord.length_squared()) / (length + 1.0);
    s * (bulge + along) / length
}

#[cfg(test)]
mod tests;
