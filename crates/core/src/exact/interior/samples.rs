//! The places and weights of samples in pixels that one sphere fills.

/// A sample of a pixel, at (u, v) from its middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub(crate) u: f64,
    pub(crate) v: f64,
    /// Weight in the rule of Gauss's with three points a side.
    pub(crate) gauss: f64,
    /// Weight in the rule of the middle and the corners of Gauss's grid: exact for sums of functions
    /// of u and of v that Gauss's rule is exact for.
    pub(crate) star: f64,
    /// Weights, along both diagonals, in the excess of Kronrod's rule with seven points over Gauss's.
    pub(crate) excess: [f64; 2],
}

/// Samples that a pixel takes, at most: those of the star, the rest of Gauss's grid, and Kronrod's
/// on both diagonals.
pub(crate) const SAMPLES: usize = 17;
pub(crate) const STAR_SAMPLES: usize = 5;
pub(crate) const GAUSS_SAMPLES: usize = 9;

/// Weights of Gauss's rule along one axis.
pub(crate) const WEIGHTS: [f64; 3] = [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0];

/// The numbers of Gauss's samples, row by row.
pub(crate) const GRID: [[usize; 3]; 3] = [[1, 5, 2], [6, 0, 7], [3, 8, 4]];

/// Bounds of the distance of a point of a pixel from the nearest sample of the star, and of Gauss's grid, in
/// half diagonals.
pub(crate) const FROM_STAR: f64 = 0.6;
pub(crate) const FROM_GRID: f64 = 0.4;

/// The distance of a corner from the middle over that of the star's other samples: √(5/3).
pub(crate) const TO_CORNER: f64 = 1.290_994_448_735_805_6;

/// The samples: the star's, the rest of Gauss's grid, then those of Kronrod's rule on either diagonal. The
/// numbers are those of the rules for [−½, ½], half of the tabulated ones for [−1, 1].
pub(crate) const POINTS: [Sample; SAMPLES] = {
    const OUTER: f64 = 0.387_298_334_620_741_7;
    const GAUSS: [f64; 3] = [-OUTER, 0.0, OUTER];
    /// Kronrod's weights of Gauss's points less theirs.
    const EXCESS: [f64; 3] = [
        0.134_244_044_934_166_84 - WEIGHTS[0],
        0.225_458_269_329_237_05 - WEIGHTS[1],
        0.134_244_044_934_166_84 - WEIGHTS[0],
    ];
    const OTHERS: [(f64, f64); 4] = [
        (-0.480_245_634_354_010_15, 0.052_328_113_013_233_65),
        (-0.217_121_874_673_401_3, 0.200_698_707_387_981_1),
        (0.217_121_874_673_401_3, 0.200_698_707_387_981_1),
        (0.480_245_634_354_010_15, 0.052_328_113_013_233_65),
    ];
    let mut points = [Sample {
        u: 0.0,
        v: 0.0,
        gauss: 0.0,
        star: 0.0,
        excess: [0.0; 2],
    }; SAMPLES];
    let mut index = 0;
    while index < GAUSS_SAMPLES {
        let (row, col) = (index / 3, index % 3);
        let is_middle = row == 1 && col == 1;
        let is_corner = row != 1 && col != 1;
        points[GRID[row][col]] = Sample {
            u: GAUSS[col],
            v: GAUSS[row],
            gauss: WEIGHTS[col] * WEIGHTS[row],
            star: if is_middle {
                4.0 / 9.0
            } else if is_corner {
                5.0 / 36.0
            } else {
                0.0
            },
            excess: [
                if row == col { EXCESS[col] } else { 0.0 },
                if row + col == 2 { EXCESS[col] } else { 0.0 },
            ],
        };
        index += 1;
    }
    let mut other = 0;
    while other < 4 {
        let (place, weight) = OTHERS[other];
        points[index].u = place;
        points[index].v = place;
        points[index].excess[0] = weight;
        points[index + 4].u = place;
        points[index + 4].v = -place;
        points[index + 4].excess[1] = weight;
        index += 1;
        other += 1;
    }
    points
};

#[cfg(test)]
mod tests {
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
}
