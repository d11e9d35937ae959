//! The digest and the region stored in a file, read without its numbers.

use std::io::{Read, Seek, SeekFrom};

use blake3::Hash;

use super::header::{self, Header};
use super::stamp::Stamp;
use crate::base::region::Region;

/// The digest and the region of the picture in a file; `None` if the file does not contain them, or was truncated or
/// extended.
pub(crate) fn contents(file: &mut (impl Read + Seek)) -> Option<(Hash, Region)> {
    let end = file.seek(SeekFrom::End(0)).ok()?;
    file.rewind().ok()?;
    let Header {
        array,
        stamp,
        start,
    } = header::read(file).ok()?;
    let Stamp { digest, region } = stamp.as_ref()?;
    let is_whole = start.checked_add(array.bytes()?)? == end && array.size == region.size();
    // Nothing else was written there.
    let expected = header::bytes(&array, stamp.as_ref());
    let mut found = vec![0; expected.len()];
    file.rewind().ok()?;
    file.read_exact(&mut found).ok()?;
    (is_whole && found == expected).then_some((*digest, *region))
}
