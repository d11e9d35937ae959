//! The simple values of a scene file: numbers, colors, points, names.

mod color;
mod color_name;
mod point;
mod quantity;
mod rotation;
mod words;

pub(crate) use color::{Color, from_srgb, linear};
pub(crate) use point::{Axis, FrameRange, Point, Repeat, Shift};
pub(crate) use quantity::{
    Amplitude, Coordinate, Degrees, Diameter, Every, Exponent, FieldOfView, Fill, FocalLength,
    Frame, FrameCount, FramesPerSecond, GrainSize, ImageSide, LineCount, MOST_FRAMES, Mu,
    OutlineUnits, OutlineWidth, Percent, Radius, RadiusScale, Reference, RetinaDistance,
    RetinaWidth, Scale, Seed, Shininess, Shutter, Speed, Step, Strength, Swing, Turns, Zoom,
};
pub(crate) use rotation::Rotation;
pub(crate) use words::{FileName, Flag, LightName, MaterialName, UnitName};
