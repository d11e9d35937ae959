//! Shares of boxes by points, to test formulas against.

/// Points on a side of a box.
const SIDE: usize = 2000;

/// The share of a box that is inside, and the integrals over it of the coordinates from the middle, in sides.
pub(super) fn by_points(is_inside: impl Fn(f64, f64) -> bool) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for row in 0..SIDE {
        for col in 0..SIDE {
            let (x, y) = (place(col), place(row));
            if is_inside(x, y) {
                for (sum, term) in sums.iter_mut().zip([1.0, x, y]) {
                    *sum += term;
                }
            }
        }
    }
    sums.map(|sum| sum / (SIDE * SIDE) as f64)
}

fn place(index: usize) -> f64 {
    (index as f64 + 0.5) / SIDE as f64 - 0.5
}
