//! Colors as a scene file writes them.

use glam::DVec3;
use serde::de::IgnoredAny;
use serde::{Deserialize, Deserializer};

use super::color_name;
use super::quantity::{ColorChannel, number};
use crate::text::{Names, Read, Slice, note_failure, read_simple, read_tuple, refuse, show};

const ANY_FORM: &str =
    r##"a color: a number, `(red, green, blue)`, "#rrggbb" or a name such as "gold""##;

/// A color: a number (gray), `(red, green, blue)`, both linear, or `"#rrggbb"` or a name of CSS, in sRGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Color(pub(crate) DVec3);

impl Color {
    pub(crate) const BLACK: Self = Self(DVec3::ZERO);
    pub(crate) const WHITE: Self = Self(DVec3::ONE);
}

impl<'t> Read<'t> for Color {
    fn read(slice: Slice<'t>) -> Option<Self> {
        let is_number = |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | 'N' | 'i');
        if slice.text.starts_with(['"', 'r']) && slice.text.contains('"') {
            let text: String = read_simple(slice, ANY_FORM)?;
            let color = from_hexadecimal(&text).or_else(|| color_name::find(&text).map(from_srgb));
            return color.map(Self).or_else(|| refuse_text(slice, &text));
        }
        if slice.text.starts_with(['(', '[']) {
            let [red, green, blue]: [ColorChannel; 3] = read_tuple(slice, ANY_FORM)?;
            return Some(Self(DVec3::new(red.0, green.0, blue.0)));
        }
        if color_name::find(slice.text).is_some() {
            let name = slice.text;
            let message = format!("expected {ANY_FORM}, found `{name}`, did you mean \"{name}\"?");
            return refuse(slice.place(), message);
        }
        let expected = if slice.text.starts_with(is_number) {
            "a color of at least 0"
        } else {
            ANY_FORM
        };
        let grey = number(slice, expected, |x| x >= 0.0)?;
        Some(Self(DVec3::splat(grey)))
    }

    fn read_strictly<D: Deserializer<'t>>(deserializer: D) -> Result<Option<Self>, D::Error> {
        // `#rrggbb` without its quotation marks breaks the syntax of the file.
        IgnoredAny::deserialize(deserializer)
            .inspect_err(|_| {
                note_failure(Names {
                    noun: "color",
                    form: ANY_FORM,
                })
            })
            .map(|_| None)
    }
}

/// Reports a text that is no color, with the color that it may stand for.
fn refuse_text(slice: Slice<'_>, text: &str) -> Option<Color> {
    let expected = match text.starts_with('#') {
        true => r##"a color "#rrggbb" of hexadecimal digits"##,
        false => r##"a color "#rrggbb" of hexadecimal digits, or a name of CSS such as "gold""##,
    };
    let found = show(slice.text);
    let hint = match text.to_ascii_lowercase().as_str() {
        "transparent" | "none" => {
            "; for a picture without background, render with `--transparent`".to_owned()
        }
        _ if from_hexadecimal(&format!("#{text}")).is_some() => {
            format!(", did you mean \"#{text}\"?")
        }
        _ => color_name::did_you_mean(text),
    };
    refuse(
        slice.place(),
        format!("expected {expected}, found {found}{hint}"),
    )
}

/// The linear color of `#rrggbb`.
fn from_hexadecimal(text: &str) -> Option<DVec3> {
    let digits = text.strip_prefix('#')?;
    let doubled: String;
    let digits = match digits.len() {
        3 => {
            doubled = digits.chars().flat_map(|digit| [digit, digit]).collect();
            &doubled
        }
        _ => digits,
    };
    if digits.len() != 6 || !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return None;
    }
    u32::from_str_radix(digits, 16).ok().map(from_srgb)
}

/// The linear color of the sRGB color 0xrrggbb.
pub(crate) fn from_srgb(color: u32) -> DVec3 {
    let [_, red, green, blue] = color.to_be_bytes();
    DVec3::new(linear(red), linear(green), linear(blue))
}

/// The linear value of an sRGB value of 8 bits; 0 and 1 are exact.
///
/// # Source
/// IEC 61966-2-1, the definition of sRGB.
pub(crate) fn linear(value: u8) -> f64 {
    let encoded = f64::from(value) / 255.0;
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        libm::pow((encoded + 0.055) / 1.055, 2.4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_colors_are_decoded_from_srgb() {
        assert_eq!(from_hexadecimal("#000000"), Some(DVec3::ZERO));
        assert_eq!(from_hexadecimal("#FFffFF"), Some(DVec3::ONE));
        let channel = |text| from_hexadecimal(text).unwrap().y;
        assert!((channel("#008000") - 0.215_860_500_113_899_25).abs() < 1e-15);
        assert!((channel("#000a00") - 10.0 / 255.0 / 12.92).abs() < 1e-18);
        assert!((channel("#000b00") - 0.003_346_535_763_899_161).abs() < 1e-15);
    }

    #[test]
    fn other_strings_are_no_colors() {
        for text in [
            "", "#", "d02840", "#d0284", "#d028400", "#d0284g", "#+12345", "#äöü",
        ] {
            assert_eq!(from_hexadecimal(text), None, "{text}");
        }
    }
}
