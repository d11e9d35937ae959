//! The ways in which binary files store values.

use std::borrow::Cow;

/// Declares the types of numbers.
macro_rules! numbers {
    ($($name:ident($type:ty),)*) => {
        /// The type of a number.
        #[derive(Clone, Copy, Debug, Eq, PartialEq)]
        pub(crate) enum Number {
            $($name,)*
            /// Half precision.
            F16,
            /// Extended precision of 80 bits, in so many bytes.
            F80(u8),
        }

        impl Number {
            /// The size of a number, in bytes.
            fn size(self) -> u64 {
                match self {
                    $(Self::$name => size_of::<$type>() as u64,)*
                    Self::F16 => 2,
                    Self::F80(size) => u64::from(size),
                }
            }

            /// The number at the start of these bytes; none where there are too few.
            #[inline(always)]
            fn decode(self, bytes: &[u8], order: Order) -> Option<f64> {
                Some(match self {
                    $(Self::$name => {
                        let bytes = *bytes.first_chunk()?;
                        (match order {
                            Order::Little => <$type>::from_le_bytes(bytes),
                            Order::Big => <$type>::from_be_bytes(bytes),
                        }) as f64
                    })*
                    Self::F16 => {
                        let bytes = *bytes.first_chunk()?;
                        half(match order {
                            Order::Little => u16::from_le_bytes(bytes),
                            Order::Big => u16::from_be_bytes(bytes),
                        })
                    }
                    Self::F80(_) => extended(bytes.first_chunk()?, order),
                })
            }
        }
    };
}

numbers! {
    I8(i8),
    U8(u8),
    I16(i16),
    U16(u16),
    I32(i32),
    U32(u32),
    I64(i64),
    U64(u64),
    F32(f32),
    F64(f64),
}

/// The order of bytes.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Order {
    Little,
    Big,
}

/// The way in which a value is stored.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Kind {
    Number(Number, Order),
    /// So many bytes of text, the last of which may be 0.
    Text(u64),
    /// So many characters of four bytes, the last of which may be 0.
    Characters(u64, Order),
    /// So many bytes that are neither.
    Other(u64),
}

impl Kind {
    /// A little-endian number.
    pub(crate) const fn little(number: Number) -> Self {
        Self::Number(number, Order::Little)
    }

    /// The size of a value, in bytes.
    pub(crate) fn size(self) -> u64 {
        match self {
            Self::Number(number, _) => number.size(),
            Self::Text(size) | Self::Other(size) => size,
            Self::Characters(count, _) => count.saturating_mul(4),
        }
    }

    /// True of numbers from 0 to 255.
    pub(crate) fn is_byte(self) -> bool {
        matches!(self, Self::Number(Number::U8, _))
    }

    pub(crate) fn is_text(self) -> bool {
        matches!(self, Self::Text(_) | Self::Characters(..))
    }

    /// The number at the start of these bytes; none where there are too few, or where it is no number.
    #[inline(always)]
    pub(crate) fn decode(self, bytes: &[u8]) -> Option<f64> {
        match self {
            Self::Number(number, order) => number.decode(bytes, order),
            _ => None,
        }
    }

    /// The text at the start of these bytes; of a number its digits.
    pub(crate) fn text(self, bytes: &[u8]) -> Cow<'_, [u8]> {
        let bytes = bytes.get(..self.size() as usize).unwrap_or_default();
        match self {
            Self::Text(_) | Self::Other(_) => {
                let zeros = bytes.iter().rev().take_while(|byte| **byte == 0).count();
                Cow::Borrowed(bytes[..bytes.len() - zeros].trim_ascii())
            }
            Self::Characters(_, order) => {
                let character = |bytes: &[u8; 4]| match order {
                    Order::Little => u32::from_le_bytes(*bytes),
                    Order::Big => u32::from_be_bytes(*bytes),
                };
                let (characters, _) = bytes.as_chunks();
                let characters = characters
                    .iter()
                    .map(character)
                    .take_while(|&code| code != 0);
                let text: String = characters
                    .map(|code| char::from_u32(code).unwrap_or(char::REPLACEMENT_CHARACTER))
                    .collect();
                Cow::Owned(text.trim().as_bytes().to_vec())
            }
            Self::Number(..) => {
                let number = self.decode(bytes).unwrap_or(f64::NAN);
                Cow::Owned(number.to_string().into_bytes())
            }
        }
    }
}

/// A number of half precision.
fn half(bits: u16) -> f64 {
    let fraction = f64::from(bits & 0x3ff);
    let sign = if bits >> 15 == 0 { 1.0 } else { -1.0 };
    let magnitude = match bits >> 10 & 0x1f {
        0 => fraction * libm::exp2(-24.0),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        exponent => (1024.0 + fraction) * libm::exp2(f64::from(exponent) - 25.0),
    };
    sign * magnitude
}

/// A number of extended precision: sign and exponent of 16 bits, a fraction of 64 with its leading 1.
fn extended(bytes: &[u8; 10], order: Order) -> f64 {
    let mut bytes = *bytes;
    if order == Order::Big {
        bytes.reverse();
    }
    let [f0, f1, f2, f3, f4, f5, f6, f7, e0, e1] = bytes;
    let fraction = u64::from_le_bytes([f0, f1, f2, f3, f4, f5, f6, f7]);
    let bits = u16::from_le_bytes([e0, e1]);
    let sign = if bits >> 15 == 0 { 1.0 } else { -1.0 };
    let exponent = i32::from(bits & 0x7fff);
    let magnitude = match (exponent, fraction << 1) {
        (0x7fff, 0) => f64::INFINITY,
        (0x7fff, _) => f64::NAN,
        _ => libm::ldexp(fraction as f64, exponent - 16_446),
    };
    sign * magnitude
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_other_precisions_are_decoded() {
        for (bits, expected) in [
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (0x7bff, 65504.0),
            (0x0001, 5.960_464_477_539_063e-8),
            (0x3555, 0.333_251_953_125),
            (0x7c00, f64::INFINITY),
        ] {
            assert_eq!(half(bits), expected);
        }
        assert!(half(0x7e00).is_nan());
        let bytes = |fraction: u64, exponent: u16| {
            let mut bytes = [0; 10];
            bytes[..8].copy_from_slice(&fraction.to_le_bytes());
            bytes[8..].copy_from_slice(&exponent.to_le_bytes());
            bytes
        };
        let one = bytes(1 << 63, 0x3fff);
        assert_eq!(extended(&one, Order::Little), 1.0);
        assert_eq!(extended(&bytes(3 << 62, 0xc000), Order::Little), -3.0);
        assert_eq!(extended(&bytes(0, 0), Order::Little), 0.0);
        let mut reversed = one;
        reversed.reverse();
        assert_eq!(extended(&reversed, Order::Big), 1.0);
    }

    #[test]
    fn texts_end_before_zeros() {
        assert_eq!(*Kind::Text(5).text(b"Ar \0\0xx"), *b"Ar");
        let characters: Vec<u8> = "\u{e9}C\0"
            .chars()
            .flat_map(|c| (c as u32).to_be_bytes())
            .collect();
        let text = Kind::Characters(3, Order::Big).text(&characters);
        assert_eq!(*text, *"\u{e9}C".as_bytes());
        assert_eq!(*Kind::little(Number::U8).text(&[7]), *b"7");
    }
}
