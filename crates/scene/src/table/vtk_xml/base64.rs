//! Numbers in Base64, one text behind another: each may end with `=`, and blanks stand between them.
//!
//! # Source
//! RFC 4648, section 4.

use super::super::error::TableError;
use super::bytes::Bytes;
use crate::text::LocatedFault;

/// The bytes that texts in Base64 stand for, one text after another.
#[derive(Debug, Default)]
pub(super) struct Base64 {
    /// Bytes that were decoded and not yet handed out; at most two.
    ready: Vec<u8>,
}

/// No digit.
const NONE: u8 = 0xff;
/// The value of each digit.
const VALUES: [u8; 256] = {
    let digits = *b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut values = [NONE; 256];
    let mut value = 0;
    while value < 64 {
        values[digits[value] as usize] = value as u8;
        value += 1;
    }
    values
};

impl Base64 {
    /// The next bytes, so many or as many as there are before another character.
    pub(super) fn take(
        &mut self,
        bytes: &mut Bytes<'_, '_>,
        count: usize,
    ) -> Result<Vec<u8>, TableError> {
        let mut taken = std::mem::take(&mut self.ready);
        let mut four = [0; 4];
        let (mut digits, mut ends) = (0, 0);
        while taken.len() < count {
            let start = bytes.position();
            let ahead = bytes.ahead()?;
            let (mut passed, mut is_at_end) = (0, ahead.is_empty());
            for &byte in ahead {
                let value = VALUES[usize::from(byte)];
                if value != NONE && ends == 0 {
                    four[digits] = value;
                    digits += 1;
                } else if byte == b'=' && digits + ends >= 2 {
                    ends += 1;
                } else if !byte.is_ascii_whitespace() {
                    is_at_end = true;
                    break;
                }
                passed += 1;
                if digits + ends == 4 {
                    let [a, b, c, d] = four;
                    let three = [a << 2 | b >> 4, b << 4 | c >> 2, c << 6 | d];
                    taken.extend(&three[..digits - 1]);
                    (four, digits, ends) = ([0; 4], 0, 0);
                    if taken.len() >= count {
                        break;
                    }
                }
            }
            bytes.pass(passed);
            if is_at_end {
                if digits + ends > 0 {
                    let at = start + passed as u64;
                    let expected = "four characters of Base64 each";
                    let message = format!("expected {expected}, found fewer before byte {at}");
                    return Err(LocatedFault::of_file(message).into());
                }
                break;
            }
        }
        if taken.len() > count {
            self.ready = taken.split_off(count);
        }
        Ok(taken)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_behind_one_another_are_decoded() {
        // The examples of RFC 4648, section 10.
        let text = b" Zg==Zm8=\nZm9v Zm9vYg==Zm9vYmE=Zm9vYmFy</DataArray>";
        let all = b"ffofoofoobfoobafoobar";
        for step in 1..8 {
            let mut bytes = Bytes::Decompressed(text.to_vec(), 0);
            let mut decoder = Base64::default();
            let mut found: Vec<u8> = Vec::new();
            loop {
                let part = decoder.take(&mut bytes, step).unwrap();
                found.extend(&part);
                if part.len() < step {
                    break;
                }
            }
            assert_eq!(found, all);
        }
        let mut bytes = Bytes::Decompressed(b"Zm9vZ<".to_vec(), 0);
        let error = Base64::default().take(&mut bytes, 9);
        assert!(
            matches!(error, Err(TableError::Fault(fault)) if fault.message.ends_with("byte 5"))
        );
        let values: Vec<u8> = (0..64)
            .map(|digit| VALUES[usize::from(b"AZaz09+/"[digit % 8])])
            .collect();
        assert_eq!(values[..8], [0, 25, 26, 51, 52, 61, 62, 63]);
    }
}
