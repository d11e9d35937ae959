//! Values near ends where edges turn back, against products of sines, which lose nothing there.

use fearless_simd::{Level, dispatch};

use super::*;

#[test]
fn nothing_is_lost_beside_an_end() {
    // The angles of the slope, of the end that is a root, and of the whole piece.
    let cases = [
        (0.3, 1.1, 0.9),
        (0.3, 1.1, -1e-3),
        (-1.57, -1.5702, 1.3e-4),
        (2.0, 2.001, -1e-3),
        (0.1, -0.4, 1.0),
    ];
    for (toward, root, turn) in cases {
        let at = |angle: f64| DVec2::new(libm::cos(angle), libm::sin(angle));
        let slope = at(toward) * 3.0;
        let both = (2.0 * (toward - root) - turn).abs() < 1e-12;
        let (start, end) = (at(root), at(root + turn));
        for is_first in [true, false] {
            let piece = Piece {
                ends: if is_first { [start, end] } else { [end, start] },
                roots: [is_first || both, !is_first || both],
            };
            for s in [0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.2, 0.5, 0.9] {
                let way = libm::atan2(s * libm::sin(turn), 1.0 - s + s * libm::cos(turn));
                let exact = -6.0 * libm::sin(root - toward + 0.5 * way) * libm::sin(0.5 * way);
                let value = value(&piece, if is_first { s } else { 1.0 - s }, slope);
                // Ends are known to an ulp, and so is 1 − s.
                let known = 3e-15 / turn.abs() / (root - toward).abs().min(1.0);
                let rounded = if is_first {
                    0.0
                } else {
                    f64::EPSILON / s.max(f64::EPSILON)
                };
                assert!(
                    (value - exact).abs() <= (known + rounded) * exact.abs(),
                    "slope at {toward}, root at {root}, {turn} long, at {s}: {value:e}, not {exact:e}",
                );
            }
        }
    }
}

fn value(piece: &Piece, s: f64, slope: DVec2) -> f64 {
    dispatch!(Level::new(), simd => {
        let s = f64x8::splat(simd, s);
        from_ends(piece, s, [s; 2], [f64::NAN, slope.x, slope.y])[0]
    })
}
