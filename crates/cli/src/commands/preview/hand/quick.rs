//! Pictures while the camera moves: quick ones first, then better ones.

use std::num::NonZeroU32;
use std::time::Duration;

use marbles_core::Method;

use crate::base::size::Size;

/// The number of pixels of the first quick picture.
const FEW_PIXELS: u64 = 40_000;
/// Pictures that take longer are made smaller, and those that take less become larger.
const SLOW: Duration = Duration::from_millis(100);
const FAST: Duration = Duration::from_millis(30);
/// The largest part of a side that is one pixel.
const LARGEST_PIXEL: u32 = 8;
/// The samples on a side of a pixel in the picture between the quick one and the best one.
const SAMPLES: NonZeroU32 = NonZeroU32::new(2).unwrap();

/// A picture of a series, of which each is better than the one before.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Stage {
    /// While keys are pressed: one sample for each pixel, and large pixels.
    Quick,
    /// In full size, with a few samples.
    Sampled,
    /// Within the tolerance.
    Best,
}

impl Stage {
    pub(super) fn method(self, tolerance: f64) -> Method {
        match self {
            Self::Quick => Method::Samples(NonZeroU32::MIN),
            Self::Sampled => Method::Samples(SAMPLES),
            Self::Best => Method::Tolerance(tolerance),
        }
    }

    /// The stage after this one; `None` after the best.
    pub(super) fn next(self, pace: Pace) -> Option<Self> {
        match self {
            Self::Quick if pace.pixel > 1 => Some(Self::Sampled),
            Self::Quick | Self::Sampled => Some(Self::Best),
            Self::Best => None,
        }
    }
}

/// The size of quick pictures, which follows the time that they take.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) struct Pace {
    /// The side of a pixel of a quick picture, in pixels of the full one.
    pixel: u32,
}

impl Pace {
    /// The pace with which pictures that in full size have this one begin.
    pub(super) fn new(full: Size) -> Self {
        let mut sides = 1..LARGEST_PIXEL;
        let is_small = |pixel: &u32| Self { pixel: *pixel }.size(full).pixels() <= FEW_PIXELS;
        Self {
            pixel: sides.find(is_small).unwrap_or(LARGEST_PIXEL),
        }
    }

    /// The size of a quick picture.
    pub(super) fn size(self, full: Size) -> Size {
        Size {
            width: full.width.div_ceil(self.pixel),
            height: full.height.div_ceil(self.pixel),
        }
    }

    /// A quick picture took this time.
    pub(super) fn learn(&mut self, time: Duration) {
        if time > SLOW {
            self.pixel = (2 * self.pixel).min(LARGEST_PIXEL);
        } else if time < FAST {
            self.pixel = (self.pixel - 1).max(1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quick_pictures_follow_the_time() {
        let full = Size {
            width: 1000,
            height: 601,
        };
        let mut pace = Pace::new(full);
        // 250 times 151 pixels are fewer than 40,000, and 334 times 201 are more.
        assert_eq!((pace.size(full).width, pace.size(full).height), (250, 151));
        pace.learn(Duration::from_millis(101));
        assert_eq!(pace.size(full).width, 125);
        pace.learn(Duration::from_millis(50));
        assert_eq!(pace.size(full).width, 125);
        (0..9).for_each(|_| pace.learn(Duration::from_secs(1)));
        assert_eq!(pace.size(full).width, 125);
        assert_eq!(Stage::Quick.next(pace), Some(Stage::Sampled));
        (0..99).for_each(|_| pace.learn(Duration::ZERO));
        assert_eq!(pace.size(full), full);
        assert_eq!(Stage::Quick.next(pace), Some(Stage::Best));
    }
}
