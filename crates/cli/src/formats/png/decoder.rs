//! The decoder of PNG files.

use std::io::{BufRead, Seek};

use png::{Decoder, Limits};

/// The memory for a row, and for all that a file tells beside its picture: a profile of colors may be compressed a
/// thousand times. The picture itself is none of this.
const MOST_BESIDE: usize = 1 << 26;

/// A decoder without a limit of the picture's size: a large file is no reason to refuse it.
pub(super) fn decoder<R: BufRead + Seek>(file: R) -> Decoder<R> {
    Decoder::new_with_limits(file, Limits { bytes: MOST_BESIDE })
}
