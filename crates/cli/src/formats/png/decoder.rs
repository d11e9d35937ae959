//! The decoder of PNG files, compiled for one kind of input.

use png::{DecodeOptions, Decoder, Limits};

use crate::formats::source::Input;

/// The memory limit for a row and for all metadata, because a compressed color profile may expand a thousandfold. The
/// picture itself does not count.
const MOST_BESIDE: Limits = Limits { bytes: 1 << 26 };

/// A decoder without a limit on the size of the picture: large files are allowed.
pub(super) fn decoder<'a>(file: Box<dyn Input + 'a>) -> Decoder<Box<dyn Input + 'a>> {
    Decoder::new_with_limits(file, MOST_BESIDE)
}

/// A decoder that also refuses wrong checksums of optional chunks and of the pixels.
pub(super) fn strict_decoder<'a>(file: Box<dyn Input + 'a>) -> Decoder<Box<dyn Input + 'a>> {
    let mut options = DecodeOptions::default();
    options.set_ignore_adler32(false);
    options.set_skip_ancillary_crc_failures(false);
    let mut decoder = Decoder::new_with_options(file, options);
    decoder.set_limits(MOST_BESIDE);
    decoder
}
