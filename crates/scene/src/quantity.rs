//! The numbers of a scene file, each with its range and its default.

use crate::fault::Slice;
use crate::placed::{Read, read_simple};

/// Declares a kind of number: what is expected, which finite numbers are allowed, the default.
macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident: $expected:literal, $allowed:expr $(, default $default:literal)?;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) struct $name(pub(crate) f64);

        impl<'t> Read<'t> for $name {
            fn read(slice: Slice<'t>) -> Option<Self> {
                number(slice, $expected, $allowed).map(Self)
            }
        }

        $(impl Default for $name {
            fn default() -> Self {
                Self($default)
            }
        })?
    )*};
}

/// Declares a kind of whole number: its type, what is expected, which are allowed, the default.
macro_rules! whole_quantities {
    ($($(#[$doc:meta])* $name:ident($type:ty): $expected:literal, $allowed:expr $(, default $default:literal)?;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Eq, PartialEq)]
        pub(crate) struct $name(pub(crate) $type);

        impl<'t> Read<'t> for $name {
            fn read(slice: Slice<'t>) -> Option<Self> {
                let allowed: fn($type) -> bool = $allowed;
                let whole = read_simple(slice, $expected)?;
                if allowed(whole) {
                    Some(Self(whole))
                } else {
                    slice.refuse($expected)
                }
            }
        }

        $(impl Default for $name {
            fn default() -> Self {
                Self($default)
            }
        })?
    )*};
}

quantities! {
    /// A component of a point or a vector.
    Coordinate: "a number", |_| true;
    /// An angle.
    Degrees: "an angle in degrees", |_| true, default 0.0;
    /// The radius of a sphere, or of an orbit.
    Radius: "a radius greater than 0", |x| x > 0.0;
    /// The width of the retina.
    RetinaWidth: "a width greater than 0", |x| x > 0.0;
    /// The distance of the retina.
    RetinaDistance: "a distance greater than 0", |x| x > 0.0;
    /// The horizontal field of view.
    FieldOfView: "an angle greater than 0 and less than 180 degrees", |x| x > 0.0 && x < 180.0;
    /// The factor on the retina's distance.
    Zoom: "a zoom greater than 0", |x| x > 0.0, default 1.0;
    /// How much of the picture is filled by what is framed.
    Fill: "a fill greater than 0 and at most 1", |x| x > 0.0 && x <= 1.0, default 0.9;
    /// The factor on the lengths of a table.
    Scale: "a scale greater than 0", |x| x > 0.0, default 1.0;
    /// A channel of a color.
    ColorChannel: "a color channel of at least 0", |x| x >= 0.0;
    /// The contrast exponent; Lambert's law by default.
    Exponent: "an exponent greater than 0", |x| x > 0.0, default 1.0;
    /// The strength of a highlight.
    Strength: "a strength of at least 0", |x| x >= 0.0, default 0.5;
    /// The exponent of a highlight.
    Shininess: "a shininess greater than 0", |x| x > 0.0, default 40.0;
    /// The amplitude of a rough surface; the original project's by default.
    Amplitude: "an amplitude of at least 0 and less than 1", |x| (0.0..1.0).contains(&x), default 0.5;
    /// The cell size of a rough surface.
    GrainSize: "a grain size greater than 0", |x| x > 0.0;
    /// Frames per second.
    FramesPerSecond: "a number of frames per second greater than 0", |x| x > 0.0, default 24.0;
    /// How long the shutter is open, in frames.
    Shutter: "a shutter greater than 0 and at most 1", |x| x > 0.0 && x <= 1.0;
    /// Turns of a turntable.
    Turns: "a number of turns", |_| true, default 1.0;
}

whole_quantities! {
    /// A side of the image, in pixels.
    ImageSide(u32): "a whole number from 1 to 65536", |n| (1..=65536).contains(&n);
    /// The number of a frame.
    Frame(i32): "a whole number (a frame)", |_| true;
    /// A number of frames.
    FrameCount(i32): "a whole number of frames, at least 1", |n| n >= 1, default 120;
    /// The seed of a rough surface.
    Seed(u64): "a whole number from 0 to 18446744073709551615", |_| true, default 0;
}

/// Reads a finite number that is `allowed`.
pub(crate) fn number(
    slice: Slice<'_>,
    expected: &str,
    allowed: impl Fn(f64) -> bool,
) -> Option<f64> {
    let number = match plain_number(slice.text) {
        Some(number) => number,
        None => read_simple(slice, expected)?,
    };
    if !number.is_finite() {
        let is_named = slice.text.contains(['N', 'i']);
        return slice.refuse(if is_named {
            "a finite number"
        } else {
            "a number between -1.8e308 and 1.8e308"
        });
    }
    if allowed(number) {
        Some(number)
    } else {
        slice.refuse(expected)
    }
}

/// The number in the usual notation: what nearly all are, without the detour over `ron`.
fn plain_number(text: &str) -> Option<f64> {
    let is_usual = |byte: u8| byte.is_ascii_digit() || b"+-.eE".contains(&byte);
    if text.bytes().all(is_usual) {
        text.parse().ok()
    } else {
        None
    }
}
