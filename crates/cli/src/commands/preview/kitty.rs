//! Pictures in kitty's graphics protocol: a PNG in base64, divided into pieces.
//!
//! Source: "Terminal graphics protocol", sw.kovidgoyal.net/kitty/graphics-protocol.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::picture::Picture;
use crate::base::failure::Failure;
use crate::formats::png::write::rgb_bytes;

/// The largest size of a piece in the protocol, in bytes of base64.
const PIECE: usize = 4096;

/// The text that removes the picture of this process from the screen and from the memory of the terminal.
pub(super) fn delete() -> String {
    let process = std::process::id();
    format!("\x1b_Ga=d,d=I,i={process},q=2\x1b\\")
}

/// The text that shows the picture at the cursor, and moves the cursor below it.
///
/// The picture replaces the one that this process showed before.
pub(super) fn text(picture: &Picture) -> Result<String, Failure> {
    let data = STANDARD.encode(rgb_bytes(picture.size, picture.codes.as_flattened())?);
    let mut text = String::new();
    let mut rest = &*data;
    // Transmit and show (a), as a PNG (f), under a name that others do not use (i), and answer
    // nothing (q).
    let mut control = format!("a=T,f=100,i={},q=2,", std::process::id());
    while !rest.is_empty() {
        let (piece, more) = rest.split_at(rest.len().min(PIECE));
        let has_more = u8::from(!more.is_empty());
        text.push_str(&format!("\x1b_G{control}m={has_more};{piece}\x1b\\"));
        (rest, control) = (more, String::new());
    }
    text.push('\n');
    Ok(text)
}

#[cfg(test)]
mod tests;
