//! The names of colors that CSS has.

use crate::text;

/// Each name with its color of sRGB in hexadecimal digits, in alphabetical order.
///
/// # Source
/// CSS Color Module Level 4, "Named Colors".
const NAMES: &str = include_str!("color_names.csv");

/// The color 0xrrggbb of a name, in small or capital letters.
pub(super) fn find(name: &str) -> Option<u32> {
    let is_it = |(other, _): &(&str, &str)| other.eq_ignore_ascii_case(name);
    let (_, digits) = names().find(is_it)?;
    u32::from_str_radix(digits, 16).ok()
}

/// The end of a message about an unknown name: the known name that is closest to it, if there is one.
pub(super) fn did_you_mean(name: &str) -> String {
    text::did_you_mean(name, names().map(|(name, _)| name), |name| {
        format!("\"{name}\"")
    })
}

fn names() -> impl Iterator<Item = (&'static str, &'static str)> {
    NAMES
        .lines()
        .skip(1)
        .filter_map(|line| line.split_once(','))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Colors by webcolors 25.10.0, the package of Python.
    #[test]
    fn names_of_css_are_known() {
        assert_eq!(names().count(), 148);
        for (name, color) in [
            ("black", 0x00_0000),
            ("white", 0xff_ffff),
            ("tomato", 0xff_6347),
            ("SteelBlue", 0x46_82b4),
            ("lightgoldenrodyellow", 0xfa_fad2),
            ("rebeccapurple", 0x66_3399),
            ("yellowgreen", 0x9a_cd32),
        ] {
            assert_eq!(find(name), Some(color), "{name}");
        }
        assert!(names().all(|(name, _)| find(name).is_some()));
        for unknown in ["", "name", "reddish", "steel blue"] {
            assert_eq!(find(unknown), None, "{unknown}");
        }
    }

    #[test]
    fn the_closest_name_is_suggested() {
        for (unknown, hint) in [
            ("bleu", ", did you mean \"blue\"?"),
            ("steel blue", ", did you mean \"steelblue\"?"),
            ("light-grey", ", did you mean \"lightgrey\"?"),
            ("infrared", ""),
        ] {
            assert_eq!(did_you_mean(unknown), hint, "{unknown}");
        }
    }
}
