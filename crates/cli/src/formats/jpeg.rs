//! Checks that a JPEG is whole, because its decoder replaces missing pixels without a word.
//!
//! Source: ITU-T T.81, annex B.

use std::io::{self, BufRead, ErrorKind, Seek};

use crate::base::failure::reason;

/// The first byte of every marker.
const MARK: u8 = 0xff;
/// The marker at the end of the picture.
const END: u8 = 0xd9;

/// Refuses a file without the marker at the end of the picture. Other data may follow it.
pub(super) fn check(file: &mut (impl BufRead + Seek)) -> Result<(), String> {
    find_end(file).map_err(|error| match error.kind() {
        ErrorKind::UnexpectedEof => {
            "it ends early: expected the marker of its end (FF D9), found none".to_owned()
        }
        _ => reason(&error),
    })
}

/// Goes on to the end of the picture.
fn find_end(file: &mut (impl BufRead + Seek)) -> io::Result<()> {
    loop {
        match next_marker(file)? {
            END => return Ok(()),
            // These have no data: a stuffed byte of pixels, a restart of their coding, and the start of the file.
            0 | 1 | 0xd0..=0xd8 => {}
            _ => {
                let mut length = [0; 2];
                file.read_exact(&mut length)?;
                // The length includes itself. A preview in the data may have an end of its own.
                let rest = u16::from_be_bytes(length).saturating_sub(2);
                file.seek_relative(rest.into())?;
            }
        }
    }
}

/// The marker that follows, after any pixels.
fn next_marker(file: &mut impl BufRead) -> io::Result<u8> {
    file.skip_until(MARK)?;
    let mut marker = [MARK];
    // A marker may begin with several of these bytes.
    while marker == [MARK] {
        file.read_exact(&mut marker)?;
    }
    Ok(marker[0])
}
