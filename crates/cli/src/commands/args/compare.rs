//! The arguments of `marbles compare`.

use std::path::PathBuf;

use clap::Args;

use super::values::{tolerance, worst};

const EXAMPLES: &str = "\
Examples:
  marbles compare a.png b.exr                         print by how much and where they differ
  marbles compare a.exr b.exr --tolerance 1e-3        exit with 1 if a pixel differs by more
  marbles compare a.png b.png --diff diff.png         write a picture of the differences

A and B are PNG, EXR, NPY, NPZ, TIFF, JPEG, WebP, GIF, Radiance HDR, PNM or PAM, TGA, BMP or QOI files. marbles
recognizes the format by the content; only a TGA needs its extension. If a file is an animation, the first
frame is read.

sRGB codes are decoded to linear light and multiplied by alpha, as in EXR. Integers are sRGB codes,
unless the file says that they are linear, as a TIFF of `marbles render` does. Floats and HDR pixels are
light. A gray picture has three equal color channels, and alpha is 1 in a picture without alpha. The
channel `error` of an EXR is not compared, because it is not light. An NPY is an array of height × width,
or height × width × 1 to 4 channels.

Rows of the result:
  largest     the largest difference of any channel of any pixel
  rms         root of the mean square, over all channels of all pixels
  99.9 %      the 99.9th percentile of the differences of pixels; the difference of a pixel is that
              of its worst channel
  over        pixels over the tolerance
  rounding    the part of the largest difference that half a step of both formats explains
  beyond      pixels that differ by more than such rounding
  clipped     those of them that are too bright for one of the files, for example for a PNG
  not finite  pixels with NaN or infinity; their difference counts as infinite

Exit codes:
  0  no pixel is over the tolerance, or none was given
  1  some pixel is over the tolerance, the sizes differ, or something failed
  2  the command line or a picture is wrong
  130  interrupted while --diff was written";

/// Compare two pictures, by absolute differences in linear light
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct CompareArguments {
    /// First picture
    #[arg(value_name = "A")]
    pub(crate) a: PathBuf,

    /// Second picture
    #[arg(value_name = "B")]
    pub(crate) b: PathBuf,

    /// Largest accepted difference
    #[arg(long, value_name = "E", value_parser = tolerance, allow_negative_numbers = true)]
    pub(crate) tolerance: Option<f64>,

    /// List the N pixels with the largest differences
    #[arg(long, value_name = "N", default_value = "5", value_parser = worst, allow_negative_numbers = true)]
    pub(crate) worst: usize,

    /// Write a picture of the differences: .png in gray, on a logarithmic scale with the tolerance (or 1e-3)
    /// in the middle; .exr with the differences themselves
    #[arg(long, value_name = "FILE")]
    pub(crate) diff: Option<PathBuf>,

    /// Print only errors and warnings
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
