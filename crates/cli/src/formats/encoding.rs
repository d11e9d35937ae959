//! Picture formats, and the settings for writing each of them.

use std::path::Path;

/// A file format, chosen by the extension of the file name.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Format {
    Png,
    /// All frames in one file.
    Animation(AnimationFormat),
    Exr,
    Npy,
    Npz,
    Tiff,
}

/// A format for all frames of a sequence in one file, which plays in a loop.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum AnimationFormat {
    /// Animated PNG.
    Apng,
    Gif,
    Webp,
}

impl Format {
    /// The format for an extension.
    pub(crate) fn of(name: &str) -> Option<Self> {
        const ENDINGS: [(&str, Format); 9] = [
            ("png", Format::Png),
            ("apng", Format::Animation(AnimationFormat::Apng)),
            ("gif", Format::Animation(AnimationFormat::Gif)),
            ("webp", Format::Animation(AnimationFormat::Webp)),
            ("exr", Format::Exr),
            ("npy", Format::Npy),
            ("npz", Format::Npz),
            ("tif", Format::Tiff),
            ("tiff", Format::Tiff),
        ];
        let (_, ending) = name.rsplit_once('.')?;
        ENDINGS
            .into_iter()
            .find_map(|(known, format)| ending.eq_ignore_ascii_case(known).then_some(format))
    }

    /// The format for the extension of a file name.
    pub(crate) fn of_file(path: &Path) -> Option<Self> {
        Self::of(path.file_name()?.to_str()?)
    }
}

/// The format of pictures, with its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Encoding {
    Png(PngOptions),
    /// All pictures of a sequence in one file.
    Animation(AnimationFormat, PngOptions),
    Exr(ExrOptions),
    Npy(NpyOptions),
    Tiff(TiffOptions),
}

impl Encoding {
    /// Returns whether files contain codes. The largest code stands for white and all brighter light.
    pub(crate) fn has_white(self) -> bool {
        match self {
            Self::Png(_) | Self::Animation(..) => true,
            Self::Tiff(options) => !options.float,
            Self::Exr(_) | Self::Npy(_) => false,
        }
    }
}

/// The settings for writing a PNG file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PngOptions {
    /// 16 bits instead of 8.
    pub(crate) deep: bool,
    /// Three channels even for gray pictures.
    pub(crate) rgb: bool,
    /// Linear codes with 16 bits instead of sRGB codes.
    pub(crate) linear: bool,
    /// The factor by which light is multiplied before it is converted to codes; above 0.
    pub(crate) gain: f64,
}

/// The settings for writing an EXR file.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct ExrOptions {
    /// Single precision instead of half.
    pub(crate) float: bool,
    /// An additional channel with the error of each pixel.
    pub(crate) error: bool,
}

/// The settings for writing NPY files, or an NPZ file.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct NpyOptions {
    /// A second array with the error of each pixel.
    pub(crate) error: bool,
    /// All arrays in one NPZ file.
    pub(crate) archive: bool,
    /// An array that says of each pixel whether its error is a bound. No file has it.
    pub(crate) evidence: bool,
}

/// The settings for writing a TIFF file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TiffOptions {
    /// Light in single precision instead of linear codes with 16 bits.
    pub(crate) float: bool,
    /// Three channels even for gray pictures.
    pub(crate) rgb: bool,
    /// The factor by which light is multiplied before it is converted to codes with 16 bits; above 0.
    pub(crate) gain: f64,
}
