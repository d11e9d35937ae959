//! The sign that boxes will not find the areas in a pixel, however small its parts are.

/// Sizes of parts, one after the other, over which the share may stay.
const MOST_SIZES: u32 = 2;

/// The share of a pixel that boxes were tried on in vain, and the sizes of parts over which it stayed as it is.
///
/// If spheres nearly coincide, boxes do not find the nearer one, however small the boxes are.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct InVain {
    share: f64,
    before: f64,
    sizes: u32,
}

impl InVain {
    /// Counts a part that is not known, with the work of its boxes.
    pub(super) fn add(&mut self, of_boxes: u64, share: f64) {
        if of_boxes > 0 {
            self.share += share;
        }
    }

    /// Begins with parts of the next size.
    pub(super) fn end_size(&mut self) {
        /// A number that falls by a smaller factor counts as constant.
        const SAME: f64 = 0.9;
        let stays = self.before > 0.0 && self.share > SAME * self.before;
        self.sizes = if stays { self.sizes + 1 } else { 0 };
        self.before = std::mem::take(&mut self.share);
    }

    /// Returns whether boxes of smaller parts are not worth a try.
    pub(super) fn is_hopeless(&self) -> bool {
        self.sizes >= MOST_SIZES
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOXES: u64 = 1000;

    /// The sizes of parts after which it is hopeless, where so much of a pixel is in vain in those of each size.
    fn sizes(in_vain: impl Fn(i32) -> f64) -> Option<i32> {
        let mut found = InVain::default();
        (0..10).find(|&size| {
            found.add(BOXES, in_vain(size));
            found.end_size();
            found.is_hopeless()
        })
    }

    #[test]
    fn a_share_that_stays_ends_soon() {
        assert_eq!(sizes(|_| 1.0), Some(2));
        assert_eq!(sizes(|_| 0.3), Some(2));
        assert_eq!(sizes(|size| if size < 2 { 0.0 } else { 0.3 }), Some(4));
    }

    #[test]
    fn points_and_edges_are_followed() {
        assert_eq!(sizes(|size| 0.25_f64.powi(size)), None);
        assert_eq!(sizes(|size| 0.5_f64.powi(size)), None);
        assert_eq!(sizes(|_| 0.0), None);
    }

    #[test]
    fn parts_without_boxes_do_not_count() {
        let mut found = InVain::default();
        for _ in 0..10 {
            found.add(0, 1.0);
            found.end_size();
            assert!(!found.is_hopeless());
        }
    }
}
