//! Loads a picture from a file and scales it to the screen.

use std::ops::Range;
use std::path::Path;

use marbles_core::srgb;

use super::picture::Picture;
use super::screen::Area;
use crate::base::failure::Failure;
use crate::base::size::Size;
use crate::commands::args::PreviewArguments;
use crate::formats::load;
use crate::formats::picture;
use crate::terminal::console::Console;

/// Returns whether the file that is to be shown is a picture rather than a scene.
pub(super) fn is_picture(path: &Path) -> bool {
    load::is_picture(path)
}

/// Loads the picture in a file, and prints a warning if it is not fully supported.
pub(super) fn load(
    arguments: &PreviewArguments,
    area: &Area,
    console: &Console,
) -> Result<Picture, Failure> {
    let path = &arguments.scene;
    for (is_given, option) in [
        (arguments.watch, "--watch"),
        (arguments.frame.is_some(), "--frame"),
        (!arguments.options.set.is_empty(), "--set"),
    ] {
        if is_given {
            let why = format!("{option} is for scenes, but this is a picture");
            return Err(Failure::unusable(path, &why));
        }
    }
    let picture = load::picture(path)?;
    picture.warn(path, console);
    let size = area.fit(picture.size);
    scaled(picture, size).map_err(|reason| Failure::unusable(path, &reason))
}

/// The picture in another size. Each pixel is the mean of the light in its area.
fn scaled(mut picture: picture::Picture, size: Size) -> Result<Picture, String> {
    let from = picture.size;
    let mut light = vec![[0.0; 3]; size.width as usize * size.height as usize];
    for row in 0..from.height {
        picture.advance()?;
        for (to_row, height) in shares(row, from.height, size.height) {
            let light = &mut light[to_row * size.width as usize..][..size.width as usize];
            for col in 0..from.width {
                let rgba = picture.row.rgba(col);
                for (to_col, width) in shares(col, from.width, size.width) {
                    for (sum, value) in light[to_col].iter_mut().zip(rgba) {
                        *sum += width * height * value;
                    }
                }
            }
        }
    }
    let codes = light.into_iter().map(|light| light.map(srgb::encode_8));
    Ok(Picture {
        size,
        codes: codes.collect(),
    })
}

/// The pixels that one of `from` pixels in a line overlaps when the same line has `to` pixels, and the share of each that it
/// covers.
fn shares(pixel: u32, from: u32, to: u32) -> impl Iterator<Item = (usize, f64)> {
    // In units such that an old pixel has the length `to`, and a new one the length `from`.
    let covered = |index: u64, length: u64| index * length..(index + 1) * length;
    let (from, to) = (u64::from(from), u64::from(to));
    let own = covered(pixel.into(), to);
    let Range { start, end } = own;
    (start / from..end.div_ceil(from)).map(move |index| {
        let other = covered(index, from);
        let common = end.min(other.end) - start.max(other.start);
        (index as usize, common as f64 / from as f64)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_a_pixel_add_up_to_one() {
        for (from, to) in [(5, 3), (3, 5), (4, 4), (1, 7), (65_536, 80)] {
            let mut sums = vec![0.0; to as usize];
            for pixel in 0..from {
                for (index, share) in shares(pixel, from, to) {
                    sums[index] += share;
                }
            }
            for sum in sums {
                assert!((sum - 1.0).abs() < 1e-9, "{from} {to}: {sum}");
            }
        }
        let shares: Vec<(usize, f64)> = shares(1, 3, 2).collect();
        assert_eq!(shares, [(0, 1.0 / 3.0), (1, 1.0 / 3.0)]);
    }
}
