//! The decoder of PNG files.

use std::io::{BufRead, Seek};

use png::{Decoder, Limits};

/// A decoder without a limit of memory: who has large pictures has the memory for their rows.
pub(super) fn decoder<R: BufRead + Seek>(file: R) -> Decoder<R> {
    Decoder::new_with_limits(file, Limits { bytes: usize::MAX })
}
