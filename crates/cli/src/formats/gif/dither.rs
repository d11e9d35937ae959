//! Colors that are not in the palette, as patterns of two that are.
//!
//! A pixel's place alone decides between the two, so that what stands still does not flicker.
//!
//! Source: B. Bayer, "An optimum method for two-level rendition of continuous-tone pictures", 1973, for the pattern.

use std::collections::HashMap;

use super::histogram::Color;
use super::palette::nearest;

/// The side of the pattern.
const SIDE: usize = 8;
/// The number of its places.
const PLACES: f64 = (SIDE * SIDE) as f64;

/// Colors for which the pair is remembered; then it is found anew.
const MOST_KNOWN: usize = 1 << 20;

/// The palette, and what stands for the colors that were looked for.
pub(super) struct Dither {
    palette: Vec<[f64; 3]>,
    /// Two indices, and the number of places of the pattern that have the second.
    known: HashMap<Color, (u8, u8, u8)>,
    /// The color that was looked for last, and its pair.
    last: Option<(Color, (u8, u8, u8))>,
}

impl Dither {
    /// A palette of at most 256 colors.
    pub(super) fn new(palette: &[Color]) -> Self {
        Self {
            palette: palette.iter().map(|color| color.map(f64::from)).collect(),
            known: HashMap::new(),
            last: None,
        }
    }

    /// The index of the color for a pixel.
    pub(super) fn index(&mut self, color: Color, col: usize, row: usize) -> u8 {
        let pair = match self.last {
            Some((last, pair)) if last == color => pair,
            _ => self.find(color),
        };
        self.last = Some((color, pair));
        let (first, second, places) = pair;
        match threshold(col, row) < places {
            true => second,
            false => first,
        }
    }

    fn find(&mut self, color: Color) -> (u8, u8, u8) {
        if let Some(&pair) = self.known.get(&color) {
            return pair;
        }
        if self.known.len() == MOST_KNOWN {
            self.known.clear();
        }
        let pair = self.pair(color);
        self.known.insert(color, pair);
        pair
    }

    /// The nearest color, and that one of which some places of the pattern make the mean come nearest, without being too
    /// different from it.
    fn pair(&self, color: Color) -> (u8, u8, u8) {
        /// The weight of the squares of what pixels are off, besides that of what their mean is.
        const NOISE: f64 = 0.1;
        let color = color.map(f64::from);
        let first = nearest(&self.palette, color);
        let near = self.palette[first];
        let wanted = [0, 1, 2].map(|channel| color[channel] - near[channel]);
        let product = |one: &[f64; 3], other: &[f64; 3]| {
            let [red, green, blue] = [0, 1, 2].map(|channel| one[channel] * other[channel]);
            red + green + blue
        };
        let mut best = (first, 0.0, product(&wanted, &wanted));
        for (second, other) in self.palette.iter().enumerate() {
            let way = [0, 1, 2].map(|channel| other[channel] - near[channel]);
            let (along, length) = (product(&wanted, &way), product(&way, &way));
            if along <= 0.0 {
                continue;
            }
            // The nearest one has at least half of the places.
            let share = (along / length).min(0.5);
            let left = [0, 1, 2].map(|channel| wanted[channel] - share * way[channel]);
            let square = product(&left, &left) + NOISE * share * (1.0 - share) * length;
            if square < best.2 {
                best = (second, share, square);
            }
        }
        let (second, share, _) = best;
        (first as u8, second as u8, (share * PLACES).round() as u8)
    }
}

/// The number of a place in the pattern, from 0 to 63: its bits are those of the column and of the column and row together,
/// the last ones first.
fn threshold(col: usize, row: usize) -> u8 {
    let (col, row) = (col % SIDE, row % SIDE);
    (0..3).fold(0, |number, bit| {
        let [own, both] = [row, col ^ row].map(|bits| bits >> bit & 1);
        number << 2 | (both as u8) << 1 | own as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pattern_has_each_number_once_and_neighbors_far_apart() {
        let rows = (0..SIDE).map(|row| (0..SIDE).map(|col| threshold(col, row)).collect());
        let rows: Vec<Vec<u8>> = rows.collect();
        let mut all = rows.concat();
        all.sort_unstable();
        assert_eq!(all, Vec::from_iter(0..64));
        assert_eq!(rows[0], [0, 32, 8, 40, 2, 34, 10, 42]);
        assert_eq!(rows[1], [48, 16, 56, 24, 50, 18, 58, 26]);
    }

    #[test]
    fn areas_have_the_mean_of_their_color() {
        let mut dither = Dither::new(&[[0, 0, 0], [100, 100, 100], [200, 0, 0]]);
        let mut mean = |color: Color| {
            let mut sums = [0.0; 3];
            for row in 0..SIDE {
                for col in 0..SIDE {
                    let index = usize::from(dither.index(color, col, row));
                    let found = dither.palette[index];
                    sums = [0, 1, 2].map(|channel| sums[channel] + found[channel] / PLACES);
                }
            }
            sums
        };
        assert_eq!(mean([0, 0, 0]), [0.0; 3]);
        assert_eq!(mean([100, 100, 100]), [100.0; 3]);
        assert_eq!(mean([25, 25, 25]), [25.0; 3]);
        // As good as black.
        assert_eq!(mean([5, 5, 5]), [0.0; 3]);
        assert_eq!(mean([75, 75, 75]), [75.0; 3]);
        assert_eq!(mean([50, 0, 0]), [50.0, 0.0, 0.0]);
    }
}
