//! Errors of pixels relative to their claims.

/// The ratios of true and claimed errors of some pixels, each of which may represent several.
#[derive(Clone, Debug, Default)]
pub struct Honesty {
    /// Ratios, and the number of pixels that they represent. Output never shows more than two digits of a ratio.
    ratios: Vec<(f32, u32)>,
}

impl Honesty {
    /// Adds a pixel that represents several, unless its ratio is not a number.
    pub fn count(&mut self, ratio: f64, pixels: u32) {
        if !ratio.is_nan() {
            self.ratios.push((ratio as f32, pixels));
        }
    }

    /// Adds other pixels.
    pub fn add(&mut self, other: &Self) {
        self.ratios.extend(&other.ratios);
    }

    /// The median, or the upper one of the two in the middle; `None` without pixels.
    pub fn median(&self) -> Option<f64> {
        let mut sorted = self.ratios.clone();
        sorted.sort_unstable_by(|(one, _), (other, _)| one.total_cmp(other));
        let all: u64 = sorted.iter().map(|&(_, pixels)| u64::from(pixels)).sum();
        let mut so_far = 0;
        let middle = sorted.into_iter().find(|&(_, pixels)| {
            so_far += u64::from(pixels);
            2 * so_far > all
        });
        middle.map(|(ratio, _)| f64::from(ratio))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(pixels: &[(f64, u32)]) -> Honesty {
        let mut honesty = Honesty::default();
        for &(ratio, pixels) in pixels {
            honesty.count(ratio, pixels);
        }
        honesty
    }

    #[test]
    fn no_pixels_have_no_median() {
        assert_eq!(of(&[]).median(), None);
        assert_eq!(of(&[(f64::NAN, 1)]).median(), None);
    }

    #[test]
    fn the_median_is_the_middle_one_or_the_upper_of_two() {
        assert_eq!(of(&[(0.5, 1), (0.125, 1), (2.0, 1)]).median(), Some(0.5));
        assert_eq!(of(&[(0.5, 1), (0.125, 1)]).median(), Some(0.5));
        assert_eq!(of(&[(f64::INFINITY, 1), (0.25, 2)]).median(), Some(0.25));
    }

    #[test]
    fn a_pixel_stands_for_as_many_as_it_says() {
        assert_eq!(of(&[(0.5, 16), (0.125, 15)]).median(), Some(0.5));
        assert_eq!(of(&[(0.5, 15), (0.125, 16)]).median(), Some(0.125));
    }

    #[test]
    fn pixels_of_both_are_in_the_sum() {
        let mut sum = of(&[(0.125, 1), (0.25, 1)]);
        sum.add(&of(&[(0.5, 3)]));
        assert_eq!(sum.median(), Some(0.5));
    }
}
