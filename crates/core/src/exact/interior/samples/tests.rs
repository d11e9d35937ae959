//! Tests of `samples.rs`.

use super::*;

fn sum(of: &dyn Fn(&Sample) -> f64) -> f64 {
    POINTS.iter().map(of).sum()
}

/// Gauss's rule is exact to degree 5, Kronrod's to degree 11.
#[test]
fn rules_are_exact_for_polynomials() {
    for power in (0..=11).step_by(2) {
        let exact = 0.5_f64.powi(power) / f64::from(power + 1);
        let gauss = sum(&|at| at.gauss * at.u.powi(power));
        let star = sum(&|at| at.star * at.v.powi(power));
        assert!((gauss - star).abs() < 1e-15);
        for axis in 0..2 {
            let excess = sum(&|at| at.excess[axis] * at.u.powi(power));
            let error = gauss + excess - exact;
            assert!(error.abs() < 1e-15 * exact.max(0.1), "{power}");
            let is_nothing = excess.abs() < 1e-15 * exact.max(0.1);
            assert_eq!(is_nothing, power <= 4, "{power}: {excess}");
        }
    }
    let mixed = sum(&|at| at.gauss * at.u.powi(4) * at.v.powi(4));
    assert!((mixed - (0.5_f64.powi(4) / 5.0).powi(2)).abs() < 1e-16);
    assert!(sum(&|at| at.star * at.u * at.v).abs() < 1e-16);
}

#[test]
fn corners_are_beyond_the_star() {
    for number in [GRID[0][0], GRID[0][2], GRID[2][0], GRID[2][2]] {
        let Sample { u, v, .. } = POINTS[number];
        assert!((u.abs() * TO_CORNER - 0.5).abs() < 1e-15);
        assert!((v.abs() * TO_CORNER - 0.5).abs() < 1e-15);
        assert!(number < STAR_SAMPLES);
    }
}

#[test]
fn the_grid_lies_in_rows() {
    for (row, numbers) in GRID.iter().enumerate() {
        for (col, &number) in numbers.iter().enumerate() {
            let signs = [POINTS[number].u, POINTS[number].v].map(|at| at / at.abs().max(1e-9));
            assert_eq!(signs, [col as f64 - 1.0, row as f64 - 1.0]);
            assert!(number < GAUSS_SAMPLES);
        }
    }
}

#[test]
fn no_point_is_far_from_the_samples() {
    let grid = |index: u32| f64::from(index) / 200.0 - 0.5;
    for (samples, bound) in [(STAR_SAMPLES, FROM_STAR), (GAUSS_SAMPLES, FROM_GRID)] {
        let places = (0..=200).flat_map(|row| (0..=200).map(move |col| (grid(col), grid(row))));
        let farthest = places.map(|(x, y)| {
            let distances = POINTS[..samples]
                .iter()
                .map(|at| (x - at.u).hypot(y - at.v));
            distances.fold(f64::INFINITY, f64::min)
        });
        let half_diagonals = farthest.fold(0.0, f64::max) / 0.5_f64.sqrt();
        assert!(
            (0.9 * bound..bound).contains(&half_diagonals),
            "{half_diagonals}"
        );
    }
}
