//! The stamp of a file: the digest of its picture, and the part of the picture that the file contains.
//!
//! NumPy refuses headers with additional keys, and readers in other languages refuse comments and data after the array.
//! But all of them skip white space. Therefore the padding of the header contains the stamp, bit by bit: a tab is 1, a
//! space 0.

use blake3::Hash;
use marbles_core::Window;

use crate::base::region::Region;
use crate::base::size::Size;

/// The numbers of a region, with four bytes each.
const NUMBERS: usize = 6;
/// Bytes of a stamp.
const BYTES: usize = 32 + 4 * NUMBERS;

const ONE: u8 = b'\t';
const ZERO: u8 = b' ';

/// The origin of a file's picture, and the place in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stamp {
    pub(crate) digest: Hash,
    pub(crate) region: Region,
}

impl Stamp {
    /// The white space that contains it.
    pub(super) fn padding(&self) -> Vec<u8> {
        let Region { window, whole } = self.region;
        let Window {
            col,
            row,
            width,
            height,
        } = window;
        let mut bytes = self.digest.as_bytes().to_vec();
        for number in [col, row, width, height, whole.width, whole.height] {
            bytes.extend(number.to_be_bytes());
        }
        let bits = |byte: u8| (0..8).rev().map(move |bit| byte >> bit & 1);
        let letter = |bit| if bit == 1 { ONE } else { ZERO };
        bytes.into_iter().flat_map(bits).map(letter).collect()
    }

    /// The stamp at the start of some padding; `None` where there is none.
    pub(super) fn of(padding: &[u8]) -> Option<Self> {
        let mut bytes = [0; BYTES];
        let (letters, _) = padding.as_chunks::<8>();
        for (byte, letters) in bytes.iter_mut().zip(letters.get(..BYTES)?) {
            for &letter in letters {
                let bit = match letter {
                    ONE => 1,
                    ZERO => 0,
                    _ => return None,
                };
                *byte = *byte << 1 | bit;
            }
        }
        let (digest, numbers) = bytes.split_first_chunk()?;
        let (numbers, _) = numbers.as_chunks::<4>();
        let numbers: Vec<u32> = numbers.iter().map(|n| u32::from_be_bytes(*n)).collect();
        let &[col, row, width, height, whole_width, whole_height] = &numbers[..] else {
            return None;
        };
        let window = Window {
            col,
            row,
            width,
            height,
        };
        let whole = Size {
            width: whole_width,
            height: whole_height,
        };
        // Padding by others is spaces, which would be a region without pixels.
        let region = Region::new(window, whole)?;
        let digest = Hash::from_bytes(*digest);
        Some(Self { digest, region })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_come_back_from_padding() {
        let window = Window {
            col: 3,
            row: 0,
            width: 65_533,
            height: 1,
        };
        let whole = Size {
            width: 65_536,
            height: 2,
        };
        let stamp = Stamp {
            digest: Hash::from_bytes(std::array::from_fn(|index| 7 * index as u8)),
            region: Region::new(window, whole).unwrap(),
        };
        let mut padding = stamp.padding();
        assert!(padding.iter().all(u8::is_ascii_whitespace));
        assert_eq!(Stamp::of(&padding), Some(stamp));
        padding.extend(b"   \n");
        assert_eq!(Stamp::of(&padding), Some(stamp));
        padding[20] = b'x';
        assert_eq!(Stamp::of(&padding), None);
        assert_eq!(Stamp::of(&stamp.padding()[1..]), None);
        assert_eq!(Stamp::of(&[b' '; 1000]), None);
        assert_eq!(Stamp::of(b""), None);
    }
}
