//! The decoder of PNG files.

use std::io::{BufRead, Seek};

use png::{Decoder, Limits};

/// A decoder without a limit of memory: a large file is no reason to refuse it.
pub(super) fn decoder<R: BufRead + Seek>(file: R) -> Decoder<R> {
    Decoder::new_with_limits(file, Limits { bytes: usize::MAX })
}
