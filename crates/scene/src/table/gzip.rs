//! The members of gzip files, one after another, and the zeros with which some programs fill up the file.
//!
//! # Source
//! RFC 1952, "GZIP file format specification version 4.3".

use std::io::{self, BufRead, ErrorKind};

use flate2::bufread::GzDecoder;

use super::compression::REMEDY;
use super::packed::{Blocks, Packed};

/// The most members that hold nothing: each costs as much time as thousands of bytes.
const MOST_EMPTY: u64 = 4096;

/// Sends what the members of a file hold, each compared with its checksum and its size.
///
/// # Errors
/// Fails at members that are damaged or cut, and at other bytes between or after them.
pub(super) fn decode(packed: &mut Packed, blocks: &mut Blocks) -> io::Result<()> {
    let mut empty = 0;
    loop {
        let start = packed.position;
        let mut decoder = GzDecoder::new(&mut *packed);
        let sent = blocks.take_all(&mut decoder);
        let has_begun = decoder.header().is_some();
        match sent.map_err(|error| explain(start, has_begun, error))? {
            None => return Ok(()),
            Some(0) => empty += 1,
            Some(_) => {}
        }
        if empty > MOST_EMPTY {
            let message = format!("more than {MOST_EMPTY} of its gzip members are empty; {REMEDY}");
            return Err(io::Error::other(message));
        }
        if is_at_end(packed)? {
            return Ok(());
        }
    }
}

/// Passes over zeros; says whether the file ends behind them.
///
/// # Errors
/// Fails where neither the end nor another member comes next.
fn is_at_end(packed: &mut Packed) -> io::Result<bool> {
    loop {
        let ahead = packed.fill_buf()?;
        let Some(&first) = ahead.first() else {
            return Ok(true);
        };
        match first {
            0 => {
                let zeros = ahead.iter().take_while(|&&byte| byte == 0).count();
                packed.consume(zeros);
            }
            0x1f => return Ok(false),
            byte => {
                let at = packed.position;
                let message = format!(
                    "expected another gzip member, zeros or the end at byte {at}, found the byte 0x{byte:02x}"
                );
                return Err(io::Error::new(ErrorKind::InvalidData, message));
            }
        }
    }
}

/// The error of the member that begins at the byte `start`, in words.
fn explain(start: u64, has_begun: bool, error: io::Error) -> io::Error {
    let is_of_data = error
        .get_ref()
        .is_some_and(|inner| inner.is::<flate2::DecompressError>());
    let what = match error.kind() {
        ErrorKind::UnexpectedEof => "is cut: the file ends within it",
        ErrorKind::InvalidInput | ErrorKind::InvalidData => match (has_begun, is_of_data) {
            (false, _) => "has a damaged header",
            (true, true) => "has damaged data",
            (true, false) => "has the wrong checksum or size: it is damaged",
        },
        _ => return error,
    };
    let message = format!("the gzip member at byte {start} {what}");
    io::Error::new(ErrorKind::InvalidData, message)
}
