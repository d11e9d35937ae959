//! Chooses the colors of a palette such that the sum of squared differences is small.
//!
//! A box with all colors is divided again and again: always the box whose colors differ most, at the cut that minimizes the
//! sum of squares on both sides. Then each color is assigned to the nearest mean, and the means are computed again.
//!
//! Source: X. Wu, "Efficient statistical computations for optimal color quantization", Graphics Gems II, 1991, for the cuts;
//! S. Lloyd, "Least squares quantization in PCM", 1982, for the means.

use glam::DVec3;

use super::histogram::{Color, Histogram, Weighted, numbers};

/// A color is kept exactly if at least one pixel in this number of pixels has it, for example a background.
const FLAT_SHARE: u64 = 400;
/// The largest number of colors that are kept exactly.
const MOST_FLAT: usize = 32;
/// The number of times that the means are computed again.
const ROUNDS: usize = 4;

/// The colors, at most `most` of them.
pub(super) fn choose(histogram: &Histogram, most: usize) -> Vec<Color> {
    if let Some(few) = histogram.few() {
        return few;
    }
    let mut flat = histogram.flat(FLAT_SHARE);
    flat.truncate(MOST_FLAT);
    let means = histogram.means_beside(&flat);
    let mut chosen: Vec<DVec3> = flat.iter().map(|&color| numbers(color)).collect();
    chosen.extend(cut(means.clone(), most - flat.len()));
    for _ in 0..ROUNDS {
        improve(&mut chosen, flat.len(), &means);
    }
    let mut colors: Vec<Color> = chosen
        .iter()
        .map(|color| color.to_array().map(|code| code.round() as u8))
        .collect();
    colors.sort_unstable();
    colors.dedup();
    colors
}

/// A box of colors, and its best cut.
struct Part {
    colors: Vec<Weighted>,
    /// The channel, the number of colors below the cut when they are sorted by the channel, and the decrease of the sum of
    /// squares.
    cut: Option<(usize, usize, f64)>,
}

/// The means of this number of boxes.
fn cut(colors: Vec<Weighted>, most: usize) -> Vec<DVec3> {
    let mut parts = vec![Part::new(colors)];
    while parts.len() < most {
        let gain = |part: &Part| part.cut.map_or(0.0, |(_, _, gain)| gain);
        let best = (0..parts.len())
            .max_by(|&one, &other| gain(&parts[one]).total_cmp(&gain(&parts[other])));
        let Some((channel, below, _)) = best.and_then(|best| parts[best].cut) else {
            break;
        };
        let mut colors = parts.swap_remove(best.unwrap_or_default()).colors;
        sort(&mut colors, channel);
        let above = colors.split_off(below);
        parts.extend([colors, above].map(Part::new));
    }
    parts
        .iter()
        .map(|part| Sums::of(&part.colors).mean())
        .collect()
}

/// Sorts colors by a channel. The result does not depend on their previous order.
fn sort(colors: &mut [Weighted], channel: usize) {
    let order = [channel, (channel + 1) % 3, (channel + 2) % 3];
    colors.sort_by(|one, other| {
        let by = |channel: usize| one.color[channel].total_cmp(&other.color[channel]);
        by(order[0]).then(by(order[1])).then(by(order[2]))
    });
}

impl Part {
    fn new(mut colors: Vec<Weighted>) -> Self {
        let whole = Sums::of(&colors);
        let mut best = None;
        for channel in 0..3 {
            sort(&mut colors, channel);
            let mut below = Sums::default();
            for (index, pair) in colors.windows(2).enumerate() {
                below.add(&pair[0]);
                if pair[0].color[channel] == pair[1].color[channel] {
                    continue;
                }
                let gain = below.square() + whole.minus(&below).square() - whole.square();
                if best.is_none_or(|(_, _, most)| gain > most) {
                    best = Some((channel, index + 1, gain));
                }
            }
        }
        Self { colors, cut: best }
    }
}

/// The weighted sums of colors.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    weight: f64,
    color: DVec3,
}

impl Sums {
    fn of(colors: &[Weighted]) -> Self {
        let mut sums = Self::default();
        colors.iter().for_each(|color| sums.add(color));
        sums
    }

    fn add(&mut self, other: &Weighted) {
        self.weight += other.weight;
        self.color += other.weight * other.color;
    }

    fn minus(&self, other: &Self) -> Self {
        let mut rest = *self;
        rest.weight -= other.weight;
        rest.color -= other.color;
        rest
    }

    fn mean(&self) -> DVec3 {
        self.color / self.weight
    }

    /// The square of the mean, times the weight. The sum of squared differences from the mean is the sum of the squares of
    /// all colors minus this.
    fn square(&self) -> f64 {
        self.color.length_squared() / self.weight
    }
}

/// Replaces each chosen color, except the first `fixed`, by the mean of the colors that are nearest to it.
fn improve(chosen: &mut [DVec3], fixed: usize, colors: &[Weighted]) {
    let mut sums = vec![Sums::default(); chosen.len()];
    for color in colors {
        sums[nearest(chosen, color.color)].add(color);
    }
    for (chosen, sums) in chosen.iter_mut().zip(sums).skip(fixed) {
        if sums.weight > 0.0 {
            *chosen = sums.mean();
        }
    }
}

/// The index of the color nearest to another one. Among equally near colors, it is the first.
pub(super) fn nearest(colors: &[DVec3], color: DVec3) -> usize {
    let mut best = (0, f64::INFINITY);
    for (index, &other) in colors.iter().enumerate() {
        let square = (other - color).length_squared();
        if square < best.1 {
            best = (index, square);
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colors_stay_as_they_are() {
        let mut histogram = Histogram::new(3);
        for color in [[7, 7, 7], [0, 0, 255], [1, 2, 3]] {
            histogram.add(color, 5);
        }
        assert_eq!(choose(&histogram, 3), [[0, 0, 255], [1, 2, 3], [7, 7, 7]]);
    }

    #[test]
    fn many_colors_are_met_as_well_as_they_can_be() {
        let mut histogram = Histogram::new(16);
        // A line of 256 colors, for which the best 16 are 16 codes apart, and a background.
        for code in 0..=255 {
            histogram.add([code, code, code], 1);
        }
        histogram.add([10, 20, 30], 1000);
        let colors = choose(&histogram, 17);
        assert_eq!(colors.len(), 17);
        assert!(colors.contains(&[10, 20, 30]));
        let colors: Vec<DVec3> = colors.iter().map(|&color| numbers(color)).collect();
        let squares: f64 = (0..=255)
            .map(|code| {
                let color = DVec3::splat(code.into());
                let chosen = colors[nearest(&colors, color)];
                (chosen[0] - color[0]).powi(2)
            })
            .sum();
        // The mean square of the differences of 16 codes from their mean is (16² − 1) / 12.
        assert!(squares < 1.2 * 256.0 * 255.0 / 12.0, "{squares}");
    }
}
