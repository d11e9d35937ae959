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

/// A rule that is estimated.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Rule {
    /// That of five samples.
    Star,
    /// Gauss's, of nine.
    Grid,
}

impl Rule {
    #[inline(always)]
    pub(crate) fn samples(self) -> usize {
        match self {
            Self::Star => STAR_SAMPLES,
            Self::Grid => GAUSS_SAMPLES,
        }
    }

    /// The half diagonals of a pixel from which no point is farther from a sample.
    #[inline(always)]
    pub(super) fn farthest(self) -> f64 {
        match self {
            Self::Star => FROM_STAR,
            Self::Grid => FROM_GRID,
        }
    }
}

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
mod tests;
