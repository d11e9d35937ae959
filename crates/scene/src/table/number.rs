//! Numbers as texts write them.

/// The number that is all of this text.
#[inline(always)]
pub(crate) fn parse(text: &[u8], has_decimal_commas: bool) -> Option<f64> {
    if has_decimal_commas && text.contains(&b',') {
        return with_comma(text);
    }
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
    fn words_for_nothing_are_known() {
        for word in ["", "NA", "n/a", "null", "-"] {
            assert!(is_missing(word.as_bytes()), "{word}");
        }
        assert!(!is_missing(b"0") && !is_missing(b"nobody"));
    }
}
