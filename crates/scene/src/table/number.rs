//! Numbers as texts write them.

/// The number that is all of this text.
#[inline(always)]
pub(crate) fn parse(text: &[u8], has_decimal_commas: bool) -> Option<f64> {
    if has_decimal_commas && text.contains(&b',') {
        return with_comma(text);
    }
    plain_decimal(text).or_else(|| with_exponent(text))
}

/// The most digits whose integer is a double for certain: 10¹⁵ is less than 2⁵³.
const MOST_DIGITS: usize = 15;
/// The powers of ten, all of them exact.
const POWERS: [f64; MOST_DIGITS + 1] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
];

/// A number of few digits, as most are: one division rounds it as the standard library does, in less time.
///
/// # Source
/// William Clinger, "How to read floating point numbers accurately", 1990.
#[inline(always)]
fn plain_decimal(text: &[u8]) -> Option<f64> {
    let (is_negative, digits) = match text {
        [b'-', digits @ ..] => (true, digits),
        digits => (false, digits),
    };
    if digits.len() > MOST_DIGITS + 1 {
        return None;
    }
    let mut integer = 0_u64;
    let mut point = None;
    for (place, byte) in digits.iter().enumerate() {
        match byte {
            b'0'..=b'9' => integer = 10 * integer + u64::from(byte - b'0'),
            b'.' if point.is_none() => point = Some(place),
            _ => return None,
        }
    }
    let count = digits.len() - usize::from(point.is_some());
    if count == 0 || count > MOST_DIGITS {
        return None;
    }
    let decimals = point.map_or(0, |place| count - place);
    let number = integer as f64 / POWERS[decimals];
    Some(if is_negative { -number } else { number })
}

/// Any number that the standard library reads, or that other programs write.
fn with_exponent(text: &[u8]) -> Option<f64> {
    let text = str::from_utf8(text).ok()?;
    text.parse().ok().or_else(|| with_other_exponent(text))
}

#[cold]
fn with_comma(text: &[u8]) -> Option<f64> {
    str::from_utf8(text)
        .ok()?
        .replacen(',', ".", 1)
        .parse()
        .ok()
}

/// A number whose exponent is marked as Fortran and Mathematica do: `1.5D-3`, `1.5*^-3`.
#[cold]
fn with_other_exponent(text: &str) -> Option<f64> {
    let starts_with_digit = text
        .trim_start_matches(['+', '-', '.'])
        .starts_with(|c: char| c.is_ascii_digit());
    let (mantissa, exponent) = text
        .split_once("*^")
        .or_else(|| text.split_once(['d', 'D']))?;
    let whole = starts_with_digit && exponent.parse::<i32>().is_ok();
    whole.then(|| format!("{mantissa}e{exponent}").parse().ok())?
}

/// Says whether a field tells that there is no number.
pub(crate) fn is_missing(text: &[u8]) -> bool {
    const WORDS: [&[u8]; 7] = [b"", b"na", b"n/a", b"null", b"none", b"-", b"?"];
    WORDS.iter().any(|word| text.eq_ignore_ascii_case(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_forms_of_several_programs() {
        for (text, expected) in [
            ("-1.5e3", Some(-1500.0)),
            ("1.5D+2", Some(150.0)),
            (".5d0", Some(0.5)),
            ("1.5*^-1", Some(0.15)),
            ("NaN", None),
            ("d5", None),
            ("1d", None),
            ("1,5", None),
            ("", None),
        ] {
            let number = parse(text.as_bytes(), false).filter(|number| !number.is_nan());
            assert_eq!(number, expected, "{text}");
        }
        assert_eq!(parse(b"1,5", true), Some(1.5));
        assert_eq!(parse(b"1,5,2", true), None);
        assert_eq!(parse(b"1.5", true), Some(1.5));
    }

    #[test]
    fn plain_decimals_are_those_of_the_standard_library() {
        let mut state = 1_u64;
        let mut digit = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1);
            state >> 33
        };
        let mut plain = 0;
        for _ in 0..100_000 {
            let length = 1 + digit() % 18;
            let point = digit() % 20;
            let mut text = String::from(["", "-", "+"][digit() as usize % 3]);
            for place in 0..length {
                if place == point {
                    text.push('.');
                }
                text.push(char::from(b'0' + (digit() % 10) as u8));
            }
            if point == length {
                text.push('.');
            }
            let expected: f64 = text.parse().unwrap();
            let found = plain_decimal(text.as_bytes());
            plain += u32::from(found.is_some());
            assert!(
                found.is_none_or(|found| found.to_bits() == expected.to_bits()),
                "{text}"
            );
        }
        assert!(plain > 40_000, "{plain}");
        assert_eq!(
            plain_decimal(b"-0").map(f64::to_bits),
            Some((-0.0_f64).to_bits())
        );
        for none in ["", "-", ".", "-.", "1..2", "1e5", "0x1", "1,5", "1 "] {
            assert_eq!(plain_decimal(none.as_bytes()), None, "{none}");
        }
    }

    #[test]
    fn words_for_nothing_are_known() {
        for word in ["", "NA", "n/a", "null", "-"] {
            assert!(is_missing(word.as_bytes()), "{word}");
        }
        assert!(!is_missing(b"0") && !is_missing(b"nobody"));
    }
}
