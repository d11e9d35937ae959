//! Pictures from files, PNG and EXR alike, as linear light.
//!
//! The format is known by the first bytes, not by the name. Samples stay as the file has them, and
//! become light where a pixel is asked for: a table turns codes into light, and what a number of the
//! file may have been before it was rounded is known as well.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use crate::base::failure::{Failure, lower};

/// The first bytes of every PNG.
pub(super) const PNG_MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The first bytes of every EXR.
pub(super) const EXR_MAGIC: &[u8] = b"\x76\x2f\x31\x01";
/// The longest side of a picture, as in scene files.
const LONGEST_SIDE: usize = 65_536;

/// A picture that was read: linear light, premultiplied by its alpha.
///
/// Row 0 is the top row, column 0 the left one. All values come as red, green, blue and alpha;
/// grey stands in all three colors, and alpha is 1 where the file has none.
#[derive(Debug)]
pub(crate) struct Picture {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Whether there is one channel of light instead of three.
    pub(crate) grey: bool,
    pub(crate) alpha: bool,
    /// What the file is, for people: `PNG, 8 bit sRGB, grey`.
    pub(crate) description: String,
    /// What the user should know about how the file was understood.
    pub(crate) remarks: Vec<String>,
    pub(super) samples: Samples,
}

#[derive(Debug)]
pub(super) enum Samples {
    Png(super::png::read::Samples),
    Exr(super::exr::read::Samples),
}

impl Picture {
    /// Reads the picture at `path`.
    ///
    /// All that can be wrong is like an invalid scene: the command cannot begin.
    pub(crate) fn load(path: &Path) -> Result<Self, Failure> {
        let refused = |reason: &str| Failure::Usage(format!("{}: {reason}", path.display()));
        if path.is_dir() {
            return Err(refused("expected a picture, found a folder"));
        }
        let bytes = fs::read(path).map_err(|error| match error.kind() {
            ErrorKind::NotFound => refused("no such file"),
            ErrorKind::PermissionDenied => refused("no permission to read this file"),
            _ => refused(&lower(&error.to_string())),
        })?;
        Self::decode(&bytes).map_err(|reason| refused(&reason))
    }

    /// The picture in the bytes of a file, or what is wrong with them.
    pub(crate) fn decode(bytes: &[u8]) -> Result<Self, String> {
        if bytes.starts_with(PNG_MAGIC) {
            super::png::read::decode(bytes)
                .map_err(|reason| format!("not a usable PNG: {}", lower(&reason)))
        } else if bytes.starts_with(EXR_MAGIC) {
            super::exr::read::decode(bytes)
                .map_err(|reason| format!("not a usable EXR: {}", lower(&reason)))
        } else if bytes.is_empty() {
            Err("expected a PNG or EXR picture, found an empty file".to_owned())
        } else {
            let start = bytes[..bytes.len().min(EXR_MAGIC.len())].escape_ascii();
            Err(format!(
                "expected a PNG or EXR picture, found a file that begins with `{start}`"
            ))
        }
    }

    /// The light of a pixel, and its alpha.
    pub(crate) fn rgba(&self, col: u32, row: u32) -> [f64; 4] {
        match &self.samples {
            Samples::Png(samples) => samples.rgba(col, row),
            Samples::Exr(samples) => samples.rgba(col, row),
        }
    }

    /// How far the numbers that the file rounded may lie from those of [`Picture::rgba`]: half a
    /// step of the format there.
    pub(crate) fn rounding(&self, col: u32, row: u32) -> [f64; 4] {
        match &self.samples {
            Samples::Png(samples) => samples.rounding(col, row),
            Samples::Exr(samples) => samples.rounding(col, row),
        }
    }

    /// Where a value is the largest that the file can hold, so that a larger one may be meant.
    pub(crate) fn is_full(&self, col: u32, row: u32) -> [bool; 4] {
        match &self.samples {
            Samples::Png(samples) => samples.is_full(col, row),
            Samples::Exr(samples) => samples.is_full(col, row),
        }
    }
}

/// Refuses pictures for which there is certainly no memory, where allocating it would end the
/// process.
pub(super) fn check_memory(
    width: usize,
    height: usize,
    bytes_per_pixel: usize,
) -> Result<(), String> {
    if width == 0 || height == 0 || width > LONGEST_SIDE || height > LONGEST_SIDE {
        return Err(format!(
            "{width} x {height} pixels, expected each side from 1 to {LONGEST_SIDE}"
        ));
    }
    let bytes = width
        .checked_mul(height)
        .and_then(|pixels| pixels.checked_mul(bytes_per_pixel));
    match bytes.map(|bytes| Vec::<u8>::new().try_reserve_exact(bytes)) {
        Some(Ok(())) => Ok(()),
        _ => Err(format!(
            "{width} x {height} pixels need more memory than there is"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_what_is_no_picture() {
        let refusal = |bytes: &[u8]| Picture::decode(bytes).unwrap_err();
        assert_eq!(
            refusal(b""),
            "expected a PNG or EXR picture, found an empty file"
        );
        assert_eq!(
            refusal(b"\xff\xd8\xff\xe0JFIF"),
            "expected a PNG or EXR picture, found a file that begins with `\\xff\\xd8\\xff\\xe0`"
        );
    }

    #[test]
    fn refuses_sizes_without_memory() {
        assert!(check_memory(LONGEST_SIDE, 1, 1).is_ok());
        for (width, height) in [
            (0, 1),
            (1, 0),
            (LONGEST_SIDE + 1, 1),
            (usize::MAX, usize::MAX),
        ] {
            assert!(check_memory(width, height, 1).is_err());
        }
        assert!(check_memory(LONGEST_SIDE, LONGEST_SIDE, usize::MAX).is_err());
    }
}
