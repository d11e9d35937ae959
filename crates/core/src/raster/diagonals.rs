//! Edges along the diagonals of the grid of samples.

/// Rises, falls, and the light of strips.
const KINDS: usize = 3;

/// Sums over the ways from one column of samples to the next along the diagonals of pixels, for a row of pixels.
#[derive(Debug, Default)]
pub(super) struct Diagonals {
    /// For each pixel, kind, and direction, downward to the right and upward, the diagonals that go through its ways.
    sums: Vec<f32>,
    /// The numbers of a row of ways in a pixel.
    row: Vec<f32>,
    pixels: usize,
    /// The diagonals of a direction.
    count: usize,
}

impl Diagonals {
    /// Forgets all, for so many pixels with so many samples on a side.
    pub(super) fn clear(&mut self, pixels: usize, side: usize) {
        self.pixels = pixels;
        self.count = 2 * side + 1;
        self.sums.clear();
        self.sums.resize(pixels * KINDS * 2 * self.count, 0.0);
    }

    /// Adds the ways in a row of so many pixels: the differences on them, and the light of strips there.
    pub(super) fn add(&mut self, (changes, strips): (&[f32], &[f32]), side: usize, row: usize) {
        let numbers = &mut self.row;
        for pixel in 0..self.pixels {
            let ways = pixel * side..(pixel + 1) * side + 1;
            for kind in 0..KINDS {
                let from = if kind == 2 { strips } else { changes };
                numbers.clear();
                numbers.extend_from_slice(&from[ways.clone()]);
                for number in numbers.iter_mut() {
                    *number = match kind {
                        0 => number.max(0.0),
                        1 => number.min(0.0),
                        _ => *number,
                    };
                }
                // Half of what lies across the border is in the pixel.
                numbers[0] *= 0.5;
                numbers[side] *= 0.5;
                let first = (pixel * KINDS + kind) * 2 * self.count;
                for offset in [side - row, self.count + row] {
                    let sums = &mut self.sums[first + offset..];
                    add_to(&mut sums[..=side], numbers);
                }
            }
        }
    }

    /// The squares of the sums over all diagonals of a pixel.
    pub(super) fn squares(&self, pixel: usize) -> f64 {
        let length = KINDS * 2 * self.count;
        let sums = &self.sums[pixel * length..(pixel + 1) * length];
        sums.iter()
            .map(|&sum| f64::from(sum) * f64::from(sum))
            .sum()
    }
}

/// Adds the first of some numbers to as many sums.
#[inline]
pub(super) fn add_to(sums: &mut [f32], numbers: &[f32]) {
    let count = sums.len();
    let numbers = &numbers[..count];
    for place in 0..count {
        sums[place] += numbers[place];
    }
}
