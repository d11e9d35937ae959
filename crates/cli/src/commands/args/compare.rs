//! The arguments of `marbles compare`.

use std::path::PathBuf;

use clap::Args;

use super::values::{tolerance, worst};

const EXAMPLES: &str = "\
Examples:
  marbles compare a.png b.exr                         print how far they differ, and where
  marbles compare a.exr b.exr --tolerance 1e-3        end with 1 if any pixel is over it
  marbles compare a.png b.png --diff diff.png         a picture of where they differ

A and B are PNG, EXR, NPY, TIFF, JPEG, WebP, GIF, Radiance HDR, PNM or PAM, TGA, BMP or QOI; the content tells
which, and only a TGA needs its ending. Of an animation, the first frame is read.

sRGB codes are decoded to linear light and multiplied by alpha, as in EXR. Whole numbers are sRGB codes,
unless the file says that they are in proportion to light, as a TIFF of `marbles render` does; floats and
HDR are light. Grey stands for three equal colors, and alpha is 1 in a picture that has none. The channel
`error` of an EXR is no light, and not compared. An NPY is an array of height × width, or height × width ×
1 to 4 channels.

Rows of the result:
  largest     the largest difference of any channel of any pixel
  rms         root of the mean square, over all channels of all pixels
  99.9 %      the least number that the differences of 99.9 % of the pixels do not exceed; the
              difference of a pixel is the largest of its channels
  over        pixels over the tolerance
  rounding    the part of the largest difference that half a step of both formats accounts for
  beyond      pixels that differ by more than such rounding
  clipped     those of them that are too bright for one of the files, as above the white of a PNG
  not finite  pixels with NaN or infinity, whose difference counts as infinite

Exit codes:
  0  no pixel is over the tolerance, or none was given
  1  some pixel is over the tolerance, the sizes differ, or something failed
  2  the command line or a picture is wrong
  130  interrupted while --diff was written";

/// Tell how far two pictures differ, as the absolute difference in linear light
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct CompareArguments {
    /// Picture
    #[arg(value_name = "A")]
    pub(crate) a: PathBuf,

    /// Picture to compare it with
    #[arg(value_name = "B")]
    pub(crate) b: PathBuf,

    /// Largest difference that is all right
    #[arg(long, value_name = "E", value_parser = tolerance, allow_negative_numbers = true)]
    pub(crate) tolerance: Option<f64>,

    /// List the N pixels that differ most
    #[arg(long, value_name = "N", default_value = "5", value_parser = worst, allow_negative_numbers = true)]
    pub(crate) worst: usize,

    /// Write a picture of the differences: .png in grey, on a logarithmic scale with the tolerance
    /// in the middle (else 1e-3); .exr as they are
    #[arg(long, value_name = "FILE")]
    pub(crate) diff: Option<PathBuf>,

    /// Print nothing but errors and warnings
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
