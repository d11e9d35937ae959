//! Ways to alter a file.

use super::sums::mend_sums;
use crate::numbers::Numbers;

/// Pieces of text that readers recognize, or that are numbers at the limits of their types.
const TOKENS: [&[u8]; 36] = [
    b"0",
    b"-0",
    b"1",
    b"-1",
    b"1e308",
    b"-1e308",
    b"1e309",
    b"5e-324",
    b"1e-300",
    b"nan",
    b"inf",
    b"-inf",
    b"9223372036854775808",
    b"18446744073709551616",
    b"4294967295",
    b"2147483648",
    b"65536",
    b"\n",
    b"\r\n",
    b"\n\n",
    b"\"",
    b"\\",
    b"(",
    b")",
    b"[",
    b"]",
    b"{",
    b"}",
    b",",
    b";",
    b"\t",
    b"\0",
    b"\xff",
    b"\xc3\xa9",
    b"#",
    b"//",
];

/// Alters a file in one to eight places; `other` is a file from which pieces may be copied.
pub(super) fn mutated(numbers: &mut Numbers, file: &[u8], other: &[u8]) -> Vec<u8> {
    let mut bytes = file.to_vec();
    for _ in 0..=numbers.below(3) * numbers.below(4) {
        mutate(numbers, &mut bytes, other);
    }
    if numbers.below(2) == 0 {
        mend_sums(&mut bytes);
    }
    bytes
}

fn mutate(numbers: &mut Numbers, bytes: &mut Vec<u8>, other: &[u8]) {
    let place = numbers.below(bytes.len() + 1);
    let length = numbers.below(8) * numbers.below(8);
    let end = (place + length).min(bytes.len());
    match numbers.below(11) {
        0 if place < bytes.len() => bytes[place] ^= 1 << numbers.below(8),
        1 if place < bytes.len() => bytes[place] = numbers.bits() as u8,
        2 => {
            bytes.drain(place..end);
        }
        3 => bytes.truncate(place),
        4 => {
            let piece = bytes[place..end].to_vec();
            let to = numbers.below(bytes.len() + 1);
            bytes.splice(to..to, piece);
        }
        5 => {
            let from = numbers.below(other.len() + 1);
            let piece = &other[from..(from + length).min(other.len())];
            bytes.splice(place..end, piece.iter().copied());
        }
        6 | 7 => {
            let token = numbers.either(&TOKENS);
            let end = if numbers.below(2) == 0 { place } else { end };
            bytes.splice(place..end, token.iter().copied());
        }
        _ => replace_number(numbers, bytes, place),
    }
}

/// Replaces the next number of a text.
fn replace_number(numbers: &mut Numbers, bytes: &mut Vec<u8>, place: usize) {
    let is_part = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'e');
    let Some(first) = bytes[place..].iter().position(u8::is_ascii_digit) else {
        return;
    };
    let start = place + first;
    let length = bytes[start..]
        .iter()
        .take_while(|byte| is_part(byte))
        .count();
    let number = match numbers.below(4) {
        0 => numbers.either(&TOKENS).to_vec(),
        1 => numbers.below(300).to_string().into_bytes(),
        2 => format!("{}", numbers.between(-3.0, 3.0)).into_bytes(),
        _ => format!(
            "{:e}",
            numbers.between(-1.0, 1.0) * libm::exp10(numbers.between(-320.0, 309.0))
        )
        .into_bytes(),
    };
    bytes.splice(start..start + length, number);
}
