//! Counts the colors of all pictures of an animation.

use std::collections::BTreeSet;

use glam::DVec3;

/// The number of upper bits of a channel that determine the bin of a color.
const BITS: u32 = 6;

/// A color: codes of red, green and blue.
pub(super) type Color = [u8; 3];

/// The codes of a color as numbers.
pub(super) fn numbers([red, green, blue]: Color) -> DVec3 {
    DVec3::new(red.into(), green.into(), blue.into())
}

/// The counted colors.
#[derive(Clone, Debug)]
pub(super) struct Histogram {
    /// One bin for each combination of the upper bits.
    bins: Vec<Bin>,
    /// All colors, as long as there are few.
    few: Option<BTreeSet<Color>>,
    most: usize,
    pixels: u64,
}

/// Colors that agree in their upper bits.
#[derive(Clone, Copy, Debug, Default)]
struct Bin {
    count: u64,
    sums: [u64; 3],
    /// The color that is more frequent than all others together, if there is one, and a lower bound of its lead
    /// (Boyer and Moore, 1981).
    candidate: Color,
    ahead: u64,
}

/// A color that represents others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Weighted {
    pub(super) color: DVec3,
    /// The number of pixels.
    pub(super) weight: f64,
}

impl Histogram {
    /// An empty histogram, which keeps a list of all colors if there are at most `most`.
    pub(super) fn new(most: usize) -> Self {
        Self {
            bins: vec![Bin::default(); 1 << (3 * BITS)],
            few: Some(BTreeSet::new()),
            most,
            pixels: 0,
        }
    }

    /// Counts a number of pixels of a color.
    pub(super) fn add(&mut self, color: Color, count: u64) {
        let most = self.most;
        if let Some(few) = &mut self.few {
            few.insert(color);
            if few.len() > most {
                self.few = None;
            }
        }
        self.pixels += count;
        let index = color.iter().fold(0, |index, &code| {
            index << BITS | usize::from(code >> (u8::BITS - BITS))
        });
        let bin = &mut self.bins[index];
        bin.count += count;
        for (sum, code) in bin.sums.iter_mut().zip(color) {
            *sum += count * u64::from(code);
        }
        if bin.candidate == color {
            bin.ahead += count;
        } else if bin.ahead >= count {
            bin.ahead -= count;
        } else {
            (bin.candidate, bin.ahead) = (color, count - bin.ahead);
        }
    }

    /// All colors, if there are few.
    pub(super) fn few(&self) -> Option<Vec<Color>> {
        let few = self.few.as_ref()?;
        Some(few.iter().copied().collect())
    }

    /// The colors of uniform areas: each has more than `1 / share` of all pixels. The most frequent color is the first.
    pub(super) fn flat(&self, share: u64) -> Vec<Color> {
        let flat = self
            .bins
            .iter()
            .filter(|bin| bin.ahead * share > self.pixels);
        let mut flat: Vec<(u64, Color)> = flat.map(|bin| (bin.ahead, bin.candidate)).collect();
        flat.sort_by(|one, other| other.cmp(one));
        flat.into_iter().map(|(_, color)| color).collect()
    }

    /// The mean color of each bin, without the pixels of these colors.
    pub(super) fn means_beside(&self, flat: &[Color]) -> Vec<Weighted> {
        let bins = self
            .bins
            .iter()
            .map(|bin| match flat.contains(&bin.candidate) {
                true => bin.without_candidate(),
                false => *bin,
            });
        bins.filter(|bin| bin.count > 0)
            .map(|bin| {
                let weight = bin.count as f64;
                Weighted {
                    color: DVec3::from(bin.sums.map(|sum| sum as f64)) / weight,
                    weight,
                }
            })
            .collect()
    }
}

impl Bin {
    /// The bin without the pixels that certainly have its most frequent color.
    fn without_candidate(mut self) -> Self {
        self.count -= self.ahead;
        for (sum, code) in self.sums.iter_mut().zip(self.candidate) {
            *sum -= self.ahead * u64::from(code);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colors_are_known_one_by_one() {
        let mut histogram = Histogram::new(2);
        histogram.add([9, 0, 0], 3);
        histogram.add([1, 2, 3], 1);
        histogram.add([9, 0, 0], 1);
        assert_eq!(histogram.few(), Some(vec![[1, 2, 3], [9, 0, 0]]));
        histogram.add([255, 0, 0], 1);
        assert_eq!(histogram.few(), None);
    }

    #[test]
    fn flat_areas_keep_their_color_among_others_like_it() {
        let mut histogram = Histogram::new(2);
        for code in 0..100 {
            histogram.add([code, 100, 100], 1);
            histogram.add([17, 100, 100], 2);
            histogram.add([200, code, 0], 2);
        }
        assert_eq!(histogram.flat(10), [[17, 100, 100]]);
        let weight = |flat: &[Color]| -> f64 {
            let means = histogram.means_beside(flat);
            means.iter().map(|mean| mean.weight).sum()
        };
        assert_eq!(weight(&[]), 500.0);
        // 4 pixels of its bin have another color.
        assert_eq!(weight(&[[17, 100, 100]]), 500.0 - (201.0 - 3.0));
    }
}
