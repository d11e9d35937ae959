//! The decoder of PNG files.

use std::io::{BufRead, Seek};

use png::{DecodeOptions, Decoder, Limits};

/// The memory for a row, and for all that a file tells beside its picture: a profile of colors may be compressed a
/// thousand times. The picture itself is none of this.
const MOST_BESIDE: Limits = Limits { bytes: 1 << 26 };

/// A decoder without a limit of the picture's size: a large file is no reason to refuse it.
pub(super) fn decoder<R: BufRead + Seek>(file: R) -> Decoder<R> {
    Decoder::new_with_limits(file, MOST_BESIDE)
}

/// The same, which refuses every wrong checksum: of the chunks that it could do without, and of the pixels, as well.
pub(super) fn strict_decoder<R: BufRead + Seek>(file: R) -> Decoder<R> {
    let mut options = DecodeOptions::default();
    options.set_ignore_adler32(false);
    options.set_skip_ancillary_crc_failures(false);
    let mut decoder = Decoder::new_with_options(file, options);
    decoder.set_limits(MOST_BESIDE);
    decoder
}
