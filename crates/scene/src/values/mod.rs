//! The simple values of a scene file: numbers, colors, points, names.

mod color;
mod point;
mod quantity;
mod rotation;
mod words;

pub(crate) use color::{Color, from_srgb, linear};
pub(crate) use point::{FrameRange, Point, Shift, ValueRange};
pub(crate) use quantity::{
    Amplitude, Coordinate, Degrees, Exponent, FieldOfView, Fill, FocalLength, Frame, FrameCount,
    FramesPerSecond, GrainSize, ImageSide, Radius, Reference, RetinaDistance, RetinaWidth, Scale,
    Seed, Shininess, Shutter, Strength, Turns, Zoom,
};
pub(crate) use rotation::Rotation;
pub(crate) use words::{ColumnName, FileName, Flag, LightName, MaterialName};
