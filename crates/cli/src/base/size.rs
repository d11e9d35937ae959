//! Sizes of pictures.

use std::str::FromStr;

use marbles_core::View;

/// The longest side of a picture, as in scene files.
pub(crate) const LONGEST_SIDE: u32 = 65_536;

/// The number of columns and rows of a picture.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct Size {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl Size {
    /// The size of a view's picture.
    pub(crate) fn of(view: &View) -> Self {
        let View { width, height, .. } = *view;
        Self { width, height }
    }

    /// The same view in this size.
    pub(crate) fn resize(self, view: View) -> View {
        let Self { width, height } = self;
        View {
            width,
            height,
            ..view
        }
    }

    /// The number of pixels.
    pub(crate) fn pixels(self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// The column and row of every pixel, row by row.
    pub(crate) fn places(self) -> impl Iterator<Item = (u32, u32)> + Clone {
        (0..self.height).flat_map(move |row| (0..self.width).map(move |col| (col, row)))
    }
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let side = |text: &str| {
            let digits = text.bytes().all(|byte| byte.is_ascii_digit());
            text.parse()
                .ok()
                .filter(|side| digits && (1..=LONGEST_SIDE).contains(side))
        };
        let sides = text.split_once(['x', 'X']);
        match sides.map(|(width, height)| (side(width), side(height))) {
            // The longest sides together make 2³² pixels, which is the most there may be.
            Some((Some(width), Some(height))) => Ok(Self { width, height }),
            _ => {
                let width: Option<u32> = side(text);
                let example = width.map_or_else(String::new, |width| {
                    format!(", such as {width}x{}", (5 * width / 8).max(1))
                });
                Err(format!(
                    "expected WIDTHxHEIGHT, each from 1 to {LONGEST_SIDE}{example}"
                ))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read() {
        let size = |text: &str| {
            text.parse::<Size>()
                .ok()
                .map(|size| (size.width, size.height))
        };
        assert_eq!(size("640x480"), Some((640, 480)));
        assert_eq!(size("1X65536"), Some((1, 65_536)));
        for wrong in [
            "640", "0x4", "4x0", "65537x1", "-1x4", "+1x4", "4x", "x", "4x4x4", " 4x4",
        ] {
            assert_eq!(size(wrong), None, "{wrong}");
        }
        let refused = "3000".parse::<Size>().unwrap_err();
        assert!(refused.ends_with(", such as 3000x1875"), "{refused}");
    }
}
