//! Dithering: a color that is not in the palette is replaced by a pattern of two colors that are.
//!
//! Only the position of a pixel decides between the two, so that parts that do not move do not flicker.
//!
//! Source: B. Bayer, "An optimum method for two-level rendition of continuous-tone pictures", 1973, for the pattern.

use std::collections::HashMap;

use glam::DVec3;

use super::histogram::{Color, numbers};
use super::palette::nearest;

/// The side of the pattern.
const SIDE: usize = 8;
/// The number of its positions.
const PLACES: f64 = (SIDE * SIDE) as f64;

/// The largest number of colors whose pair is stored. If there are more, all stored pairs are dropped.
const MOST_KNOWN: usize = 1 << 20;

/// The palette, and the pairs that were computed.
pub(super) struct Dither {
    palette: Vec<DVec3>,
    /// Two indices, and the number of positions in the pattern that have the second color.
    known: HashMap<Color, (u8, u8, u8)>,
    /// The most recent color, and its pair.
    last: Option<(Color, (u8, u8, u8))>,
}

impl Dither {
    /// Begins with a palette of at most 256 colors.
    pub(super) fn new(palette: &[Color]) -> Self {
        Self {
            palette: palette.iter().map(|&color| numbers(color)).collect(),
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

    /// The nearest color, and the color that brings the mean of the pattern closest to the wanted color without differing
    /// too much from it.
    fn pair(&self, color: Color) -> (u8, u8, u8) {
        /// The weight of the squared differences of the pixels, relative to that of the mean.
        const NOISE: f64 = 0.1;
        let color = numbers(color);
        let first = nearest(&self.palette, color);
        let near = self.palette[first];
        let wanted = color - near;
        let mut best = (first, 0.0, wanted.length_squared());
        for (second, &other) in self.palette.iter().enumerate() {
            let way = other - near;
            let (along, length) = (wanted.dot(way), way.length_squared());
            if along <= 0.0 {
                continue;
            }
            // The nearest color has at least half of the positions.
            let share = (along / length).min(0.5);
            let left = wanted - share * way;
            let square = left.length_squared() + NOISE * share * (1.0 - share) * length;
            if square < best.2 {
                best = (second, share, square);
            }
        }
        let (second, share, _) = best;
        (first as u8, second as u8, (share * PLACES).round() as u8)
    }
}

/// The rank of a position in the pattern, from 0 to 63. Its bits are those of the row, and of the exclusive or of row and
/// column, interleaved in reverse order.
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
            let mut sum = DVec3::ZERO;
            for row in 0..SIDE {
                for col in 0..SIDE {
                    let index = usize::from(dither.index(color, col, row));
                    sum += dither.palette[index] / PLACES;
                }
            }
            sum.to_array()
        };
        assert_eq!(mean([0, 0, 0]), [0.0; 3]);
        assert_eq!(mean([100, 100, 100]), [100.0; 3]);
        assert_eq!(mean([25, 25, 25]), [25.0; 3]);
        // Almost black.
        assert_eq!(mean([5, 5, 5]), [0.0; 3]);
        assert_eq!(mean([75, 75, 75]), [75.0; 3]);
        assert_eq!(mean([50, 0, 0]), [50.0, 0.0, 0.0]);
    }
}
