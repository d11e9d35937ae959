//! The bits of compressed positions.

/// Reads bits from the highest of each byte on.
pub(super) struct Bits<'a> {
    bytes: &'a [u8],
    /// The bits that were taken from the bytes and not yet handed out, the next one highest among the last `left`.
    held: u64,
    left: u32,
}

impl<'a> Bits<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            held: 0,
            left: 0,
        }
    }

    /// The next bits, at most 32; `None` behind the last ones.
    #[inline]
    pub(super) fn take(&mut self, count: u32) -> Option<u32> {
        while self.left < count {
            let (&byte, rest) = self.bytes.split_first()?;
            self.bytes = rest;
            self.held = self.held << 8 | u64::from(byte);
            self.left += 8;
        }
        self.left -= count;
        let mask = (1_u64 << count) - 1;
        Some((self.held >> self.left & mask) as u32)
    }

    /// The number of so many bits, at most 72, whose lowest eight come first, then the next eight; what is left is highest.
    #[inline]
    fn number(&mut self, count: u32) -> Option<u128> {
        let (mut number, mut shift) = (0, 0);
        while shift + 32 <= count {
            number |= u128::from(self.take(32)?.swap_bytes()) << shift;
            shift += 32;
        }
        while shift < count {
            let bits = (count - shift).min(8);
            number |= u128::from(self.take(bits)?) << shift;
            shift += bits;
        }
        Some(number)
    }

    /// Three whole numbers less than these sizes, that are one number of so many bits; `None` behind the last bits, or if
    /// the first of them is not less.
    #[inline]
    pub(super) fn triple(&mut self, count: u32, sizes: [u32; 3]) -> Option<[u32; 3]> {
        let [x_size, y_size, z_size] = sizes;
        let number = self.number(count)?;
        let [x, y, z] = match u64::try_from(number) {
            Ok(number) => {
                let (y_size, z_size) = (u64::from(y_size), u64::from(z_size));
                let rest = number / z_size;
                [rest / y_size, rest % y_size, number % z_size]
            }
            Err(_) => {
                let (y_size, z_size) = (u128::from(y_size), u128::from(z_size));
                let rest = number / z_size;
                [rest / y_size, rest % y_size, number % z_size].map(|part| part as u64)
            }
        };
        (x < u64::from(x_size)).then_some([x, y, z].map(|part| part as u32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_come_from_the_highest_on() {
        let mut bits = Bits::new(&[0b1010_0001, 0xff, 0x12, 0x34, 0x56, 0x78, 0x9a]);
        assert_eq!(bits.take(3), Some(0b101));
        assert_eq!(bits.take(0), Some(0));
        assert_eq!(bits.take(9), Some(0b0_0001_1111));
        assert_eq!(bits.take(32), Some(0xf123_4567));
        assert_eq!(bits.take(12), Some(0x89a));
        assert_eq!(bits.take(1), None);
    }

    #[test]
    fn three_numbers_are_one() {
        // 2 · 7 · 11 + 3 · 11 + 5 = 192 = 0xc0, of eight bits, and 1 · 7 · 300 + 6 · 300 + 299 = 4199 = 0x1067, of 13.
        assert_eq!(Bits::new(&[0xc0]).triple(8, [4, 7, 11]), Some([2, 3, 5]));
        assert_eq!(
            Bits::new(&[0x67, 0b1000_0000]).triple(13, [3, 7, 300]),
            Some([1, 6, 299])
        );
        assert_eq!(Bits::new(&[0xc0]).triple(8, [2, 7, 11]), None);
        assert_eq!(Bits::new(&[0x67]).triple(13, [3, 7, 300]), None);
        // 2^71 of 72 bits: (2^24 - 1)² · 128 is less.
        let most = [0xff_ffff; 3];
        let number = (5_u128 * 0xff_ffff + 6) * 0xff_ffff + 7;
        let bytes = number.to_le_bytes();
        assert_eq!(Bits::new(&bytes[..9]).triple(72, most), Some([5, 6, 7]));
    }
}
