//! The formats of pictures, and the ways to write each.

use std::path::Path;

/// A file format, known by the ending of the name.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Format {
    Png,
    /// All frames in one file, an animated PNG.
    Apng,
    Exr,
    Npy,
}

impl Format {
    /// The format that the ending of a name asks for.
    pub(crate) fn of(name: &str) -> Option<Self> {
        const ENDINGS: [(&str, Format); 4] = [
            ("png", Format::Png),
            ("apng", Format::Apng),
            ("exr", Format::Exr),
            ("npy", Format::Npy),
        ];
        let (_, ending) = name.rsplit_once('.')?;
        ENDINGS
            .into_iter()
            .find_map(|(known, format)| ending.eq_ignore_ascii_case(known).then_some(format))
    }

    /// Its name.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Png => "PNG",
            Self::Apng => "APNG",
            Self::Exr => "EXR",
            Self::Npy => "NPY",
        }
    }

    /// The format that the ending of a file's name asks for.
    pub(crate) fn of_file(path: &Path) -> Option<Self> {
        Self::of(path.file_name()?.to_str()?)
    }
}

/// The way in which pictures are turned into bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Encoding {
    Png(PngOptions),
    /// The pictures of a sequence in one file.
    Apng(PngOptions),
    Exr(ExrOptions),
    Npy(NpyOptions),
}

/// The way in which a PNG file is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PngOptions {
    /// 16 bit instead of 8.
    pub(crate) deep: bool,
    /// Three channels for pictures without color as well.
    pub(crate) rgb: bool,
    /// Codes of 16 bit in proportion to light, instead of those of sRGB.
    pub(crate) linear: bool,
    /// The factor by which light is multiplied before it becomes codes; above 0.
    pub(crate) gain: f64,
}

/// The way in which an EXR file is written.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct ExrOptions {
    /// Single precision instead of half.
    pub(crate) float: bool,
    /// A channel with the error of each pixel.
    pub(crate) error: bool,
}

/// The way in which NPY files are written.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct NpyOptions {
    /// A second file with the error of each pixel.
    pub(crate) error: bool,
}
