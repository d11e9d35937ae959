//! The numbers of a scene file, each with its range and its default.

use marbles_core::Highlight;

use crate::text::{Read, Slice, read_simple};

/// The most frames of an animation: at 24 a second more than eleven hours.
pub(crate) const MOST_FRAMES: i32 = 1_000_000;

/// Declares a kind of number: its type, what is expected, which are allowed, the default.
macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident($type:ty): $expected:literal, $allowed:expr $(, default $default:expr)?;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) struct $name(pub(crate) $type);

        impl<'t> Read<'t> for $name {
            fn read(slice: Slice<'t>) -> Option<Self> {
                number::<$type>(slice, $expected, $allowed).map(Self)
            }
        }

        impl From<$name> for $type {
            fn from($name(number): $name) -> Self {
                number
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
    Coordinate(f64): "a number", |_| true;
    /// An angle.
    Degrees(f64): "an angle in degrees", |_| true, default 0.0;
    /// The radius of a sphere, or of an orbit.
    Radius(f64): "a radius greater than 0", |x| x > 0.0;
    /// The width of the retina.
    RetinaWidth(f64): "a width greater than 0", |x| x > 0.0;
    /// The distance of the retina.
    RetinaDistance(f64): "a distance greater than 0", |x| x > 0.0;
    /// The angle that the disc of a sun has across.
    Diameter(f64): "a diameter of at least 0 and less than 180 degrees", |x| (0.0..180.0).contains(&x), default 0.0;
    /// The distance at which a point light has its intensity.
    Reference(f64): "a distance greater than 0", |x| x > 0.0;
    /// The power of the cosine with which a lamp sends light beside the direction that it faces; Lambert's law by default.
    Mu(f64): "a power of at least 0", |x| x >= 0.0, default 1.0;
    /// The focal length of a matrix.
    FocalLength(f64): "a focal length in pixels, greater than 0", |x| x > 0.0;
    /// The horizontal field of view.
    FieldOfView(f64): "an angle greater than 0 and less than 180 degrees", |x| x > 0.0 && x < 180.0;
    /// The factor on the retina's distance.
    Zoom(f64): "a zoom greater than 0", |x| x > 0.0, default 1.0;
    /// The part of the picture that a framing camera fills.
    Fill(f64): "a fill greater than 0 and at most 1", |x| x > 0.0 && x <= 1.0, default 0.9;
    /// The factor on the lengths of a table.
    Scale(f64): "a scale greater than 0", |x| x > 0.0, default 1.0;
    /// The factor on the radii of a table.
    RadiusScale(f64): "a factor greater than 0", |x| x > 0.0;
    /// Steps of a time series that a frame is on from the one before.
    Speed(f64): "a speed greater than 0, in steps per frame", |x| x > 0.0, default 1.0;
    /// A number of which others are multiples.
    Step(f64): "a number greater than 0", |x| x > 0.0;
    /// A part in a hundred.
    Percent(f64): "a number from 0 to 100", |x| (0.0..=100.0).contains(&x);
    /// A channel of a color.
    ColorChannel(f64): "a color channel of at least 0", |x| x >= 0.0;
    /// The contrast exponent; Lambert's law by default.
    Exponent(f64): "an exponent greater than 0", |x| x > 0.0, default 1.0;
    /// The strength of a highlight.
    Strength(f64): "a strength of at least 0", |x| x >= 0.0, default Highlight::default().strength;
    /// The exponent of a highlight.
    Shininess(f64): "a shininess greater than 0", |x| x > 0.0, default Highlight::default().shininess;
    /// The amplitude of a rough surface; the original project's by default.
    Amplitude(f64): "an amplitude of at least 0 and less than 1", |x| (0.0..1.0).contains(&x), default 0.5;
    /// The cell size of a rough surface.
    GrainSize(f64): "a grain size greater than 0", |x| x > 0.0;
    /// The width of an outline in pixels.
    OutlineWidth(f64): "a width in pixels greater than 0, or `Units(…)`", |x| x > 0.0, default 1.5;
    /// The same in scene units.
    OutlineUnits(f64): "a width greater than 0", |x| x > 0.0;
    /// Frames per second.
    FramesPerSecond(f64): "a number of frames per second greater than 0", |x| x > 0.0, default 24.0;
    /// The time for which the shutter is open, in frames.
    Shutter(f64): "a shutter greater than 0 and at most 1", |x| x > 0.0 && x <= 1.0;
    /// Turns of a turntable.
    Turns(f64): "a number of turns", |_| true, default 1.0;
    /// The angle to which something swings, to both sides.
    Swing(f64): "an angle in degrees greater than 0 and at most 180", |x| x > 0.0 && x <= 180.0;
    /// A side of the image, in pixels.
    ImageSide(u32): "a whole number from 1 to 65536", |n| (1..=65536).contains(&n);
    /// The number of a frame.
    Frame(i32): "a whole number (a frame)", |_| true;
    /// A number of frames.
    FrameCount(i32): "a whole number of frames from 1 to 1000000", |n| (1..=MOST_FRAMES).contains(&n), default 120;
    /// Lines before a table.
    LineCount(u32): "a whole number of lines, at least 0", |_| true, default 0;
    /// One of so many steps.
    Every(u32): "a whole number, at least 1", |n| n >= 1, default 1;
    /// A number of cells side by side.
    CellCount(u32): "a whole number of cells, at least 1", |n| n >= 1, default 1;
    /// The seed of a rough surface.
    Seed(u64): "a whole number from 0 to 18446744073709551615", |_| true, default 0;
}

/// A type of numbers.
pub(super) trait Number: Copy {
    /// Reads any number of this type.
    fn read(slice: Slice<'_>, expected: &str) -> Option<Self>;
}

impl Number for f64 {
    /// Reads a finite number.
    fn read(slice: Slice<'_>, expected: &str) -> Option<Self> {
        let number: f64 = match plain_number(slice.text) {
            Some(number) => number,
            None => read_simple(slice, expected)?,
        };
        if number.is_finite() {
            return Some(number);
        }
        let is_named = slice.text.contains(['N', 'i']);
        slice.refuse(match is_named {
            true => "a finite number",
            false => "a number between -1.8e308 and 1.8e308",
        })
    }
}

macro_rules! whole_numbers {
    ($($type:ty),*) => {$(
        impl Number for $type {
            fn read(slice: Slice<'_>, expected: &str) -> Option<Self> {
                read_simple(slice, expected)
            }
        }
    )*};
}

whole_numbers!(u32, i32, u64);

/// Reads a number that is `allowed`.
pub(super) fn number<T: Number>(
    slice: Slice<'_>,
    expected: &str,
    allowed: impl Fn(T) -> bool,
) -> Option<T> {
    let number = T::read(slice, expected)?;
    if allowed(number) {
        Some(number)
    } else {
        slice.refuse(expected)
    }
}

/// The number in the usual notation: what nearly all are, without the detour over `ron`.
fn plain_number(text: &str) -> Option<f64> {
    let is_usual = |byte: u8| byte.is_ascii_digit() || b"+-.eE".contains(&byte);
    text.bytes().all(is_usual).then(|| text.parse().ok())?
}
