//! The structures of a scene file, field by field as a user writes them.
//!
//! A field with a default may be left out. The meaning is given by [`crate::assemble`].

use glam::{DVec2, DVec3};
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::color::Color;
use crate::fault::{Names, Slice, note_failure};
use crate::placed::{Placed, Read, present, read_file, read_simple, read_structure, read_tuple};
use crate::quantity::{
    Amplitude, Coordinate, Degrees, Exponent, FieldOfView, Fill, Frame, FrameCount,
    FramesPerSecond, GrainSize, ImageSide, Radius, RetinaDistance, RetinaWidth, Scale, Seed,
    Shininess, Shutter, Strength, Turns, Zoom,
};
use crate::table::{Coloring, Colormap, Radii};

/// The whole file: black behind unlit, shadowed spheres unless it says more.
#[derive(Debug, Deserialize)]
#[serde(rename = "Scene", deny_unknown_fields)]
pub(crate) struct File {
    pub(crate) image: Placed<Image>,
    pub(crate) lens: Placed<Lens>,
    pub(crate) camera: Placed<Camera>,
    #[serde(default)]
    pub(crate) zoom: Placed<Zoom>,
    #[serde(default = "black")]
    pub(crate) background: Placed<Color>,
    #[serde(default = "black")]
    pub(crate) ambient: Placed<Color>,
    #[serde(default = "cast_shadows")]
    pub(crate) shadows: Placed<Flag>,
    #[serde(default)]
    pub(crate) lights: Vec<Placed<Light>>,
    #[serde(default)]
    pub(crate) materials: Materials,
    #[serde(default)]
    pub(crate) spheres: Vec<Placed<Sphere>>,
    #[serde(default)]
    pub(crate) clouds: Vec<Placed<Cloud>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) animation: Option<Placed<Animation>>,
}

/// The size of the picture, in pixels.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Image {
    pub(crate) width: Placed<ImageSide>,
    pub(crate) height: Placed<ImageSide>,
}

/// The retina, given by its size and distance or by the horizontal field of view in degrees.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Lens {
    Retina {
        width: Placed<RetinaWidth>,
        distance: Placed<RetinaDistance>,
        #[serde(default)]
        shift: Placed<Shift>,
    },
    Fov(Placed<FieldOfView>),
}

/// The camera; a `Free` one stands at the origin and looks along z by default.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Camera {
    Free {
        #[serde(default)]
        position: Placed<Point>,
        #[serde(default)]
        pan: Placed<Degrees>,
        #[serde(default)]
        tilt: Placed<Degrees>,
        #[serde(default)]
        roll: Placed<Degrees>,
    },
    LookAt {
        position: Placed<Point>,
        target: Placed<Point>,
        #[serde(default)]
        roll: Placed<Degrees>,
    },
    Orbit {
        target: Placed<Point>,
        radius: Placed<Radius>,
        #[serde(default)]
        azimuth: Placed<Degrees>,
        #[serde(default)]
        elevation: Placed<Degrees>,
        #[serde(default)]
        roll: Placed<Degrees>,
    },
    Frame {
        #[serde(default)]
        azimuth: Placed<Degrees>,
        #[serde(default)]
        elevation: Placed<Degrees>,
        #[serde(default)]
        roll: Placed<Degrees>,
        #[serde(default)]
        fill: Placed<Fill>,
    },
}

/// A light; its intensity is 1 by default.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Light {
    Directional {
        toward: Placed<Point>,
        #[serde(default = "white")]
        intensity: Placed<Color>,
    },
}

/// A material; matte white by default.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Material {
    #[serde(default = "white")]
    pub(crate) albedo: Placed<Color>,
    #[serde(default)]
    pub(crate) exponent: Placed<Exponent>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) highlight: Option<Placed<Highlight>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) rough: Option<Placed<Rough>>,
}

/// A highlight; strength 0.5 and shininess 40 by default.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Highlight {
    #[serde(default)]
    pub(crate) strength: Placed<Strength>,
    #[serde(default)]
    pub(crate) shininess: Placed<Shininess>,
}

/// Roughness; by default the original project's, amplitude 0.5 for each pixel on its own.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Rough {
    #[serde(default)]
    pub(crate) amplitude: Placed<Amplitude>,
    #[serde(default)]
    pub(crate) grain: Placed<Grain>,
    #[serde(default)]
    pub(crate) seed: Placed<Seed>,
}

/// What the numbers of a rough surface are attached to.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Grain {
    Surface(Placed<GrainSize>),
    #[default]
    Pixel,
}

/// A sphere; matte white without a material.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Sphere {
    pub(crate) center: Placed<Point>,
    pub(crate) radius: Placed<Radius>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) material: Option<Placed<MaterialName>>,
}

/// Spheres of a table; matte white without a material, and where the table puts them.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Cloud {
    pub(crate) file: Placed<FileName>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) material: Option<Placed<MaterialName>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) radius: Option<Placed<Radius>>,
    #[serde(default)]
    pub(crate) radii: Placed<Radii>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) color: Option<Placed<Coloring>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) value: Option<Placed<ColumnName>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) colormap: Option<Placed<Colormap>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) range: Option<Placed<ValueRange>>,
    #[serde(default = "no")]
    pub(crate) center: Placed<Flag>,
    #[serde(default = "no")]
    pub(crate) right_handed: Placed<Flag>,
    #[serde(default)]
    pub(crate) scale: Placed<Scale>,
    #[serde(default)]
    pub(crate) rotate_degrees: Placed<Point>,
    #[serde(default)]
    pub(crate) position: Placed<Point>,
}

/// An animation of 24 frames per second by default; keyframes last from the first key to the last,
/// a turntable 120 frames and one turn.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Animation {
    Keyframes {
        #[serde(default, deserialize_with = "present")]
        frames: Option<Placed<FrameRange>>,
        #[serde(default)]
        fps: Placed<FramesPerSecond>,
        #[serde(default, deserialize_with = "present")]
        shutter: Option<Placed<Shutter>>,
        #[serde(default)]
        keys: Vec<Placed<Key>>,
    },
    Turntable {
        #[serde(default)]
        frames: Placed<FrameCount>,
        #[serde(default)]
        fps: Placed<FramesPerSecond>,
        #[serde(default, deserialize_with = "present")]
        shutter: Option<Placed<Shutter>>,
        #[serde(default)]
        turns: Placed<Turns>,
    },
}

/// The values of some channels at a frame.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Key {
    pub(crate) frame: Placed<Frame>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) position: Option<Placed<Point>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) target: Option<Placed<Point>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) radius: Option<Placed<Radius>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) pan: Option<Placed<Degrees>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) tilt: Option<Placed<Degrees>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) roll: Option<Placed<Degrees>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) azimuth: Option<Placed<Degrees>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) elevation: Option<Placed<Degrees>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) zoom: Option<Placed<Zoom>>,
    #[serde(default)]
    pub(crate) ease: Placed<Ease>,
}

/// How a channel goes from a key to the next.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq)]
pub(crate) enum Ease {
    /// A cubic without overshoot.
    #[default]
    Smooth,
    /// A straight line.
    Linear,
    /// Not at all, until it jumps.
    Hold,
}

/// A point or a vector of the world, the origin by default.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Point(pub(crate) DVec3);

/// A displacement on the retina.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Shift(pub(crate) DVec2);

/// The first and the last frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameRange {
    pub(crate) first: i32,
    pub(crate) last: i32,
}

/// Yes or no.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flag(pub(crate) bool);

/// The name of a material.
#[derive(Clone, Debug)]
pub(crate) struct MaterialName(pub(crate) String);

/// The name of a file, relative to the scene file.
#[derive(Clone, Debug)]
pub(crate) struct FileName(pub(crate) String);

/// The name of a column of a table.
#[derive(Clone, Debug)]
pub(crate) struct ColumnName(pub(crate) String);

/// The numbers that have the first and the last color of a colormap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ValueRange {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

/// Materials in the file's order, a name given twice included.
#[derive(Debug, Default)]
pub(crate) struct Materials(pub(crate) Vec<(Placed<MaterialName>, Placed<Material>)>);

/// Says what a structure is called in messages.
macro_rules! structures {
    ($($type:ident: $noun:literal, $form:literal;)*) => {$(
        impl<'t> Read<'t> for $type {
            fn read(slice: Slice<'t>) -> Option<Self> {
                read_structure(slice, Names { noun: $noun, form: $form })
            }

            fn read_strictly<D: Deserializer<'t>>(deserializer: D) -> Result<Option<Self>, D::Error> {
                Self::deserialize(deserializer)
                    .inspect_err(|_| note_failure(Names { noun: $noun, form: $form }))
                    .map(Some)
            }
        }
    )*};
}

structures! {
    Image: "image", "an image `(width: …, height: …)`";
    Lens: "lens", "a lens: `Retina(width: …, distance: …)` or `Fov(…)`";
    Camera: "camera", "a camera: `Free(…)`, `LookAt(…)`, `Orbit(…)` or `Frame(…)`";
    Light: "light", "a light `Directional(toward: …)`";
    Material: "material", "a material `(albedo: …)`";
    Highlight: "highlight", "a highlight `(strength: …, shininess: …)`";
    Rough: "rough surface", "a rough surface `(amplitude: …, grain: …, seed: …)`";
    Grain: "grain", "a grain: `Surface(…)` or `Pixel`";
    Sphere: "sphere", "a sphere `(center: …, radius: …)`";
    Cloud: "cloud", "a cloud `(file: …)`";
    Radii: "kind of radii", "a kind of radii: `VanDerWaals` or `Covalent`";
    Coloring: "coloring", "a coloring: `Material`, `Table`, `Element` or `Value`";
    Colormap: "colormap", "a colormap: `Viridis`, `Inferno`, `Magma`, `Plasma`, `Cividis`, `CoolWarm` or `Grey`";
    Animation: "animation", "an animation: `Keyframes(…)` or `Turntable(…)`";
    Key: "key", "a key `(frame: …)`";
    Ease: "ease", "an ease: `Smooth`, `Linear` or `Hold`";
}

impl<'t> Read<'t> for File {
    fn read(slice: Slice<'t>) -> Option<Self> {
        let form = "a scene `(image: …, lens: …, camera: …)`";
        let noun = "scene";
        read_file(slice, Names { noun, form })
    }
}

impl<'t> Read<'t> for Point {
    fn read(slice: Slice<'t>) -> Option<Self> {
        let [x, y, z]: [Coordinate; 3] = read_tuple(slice, "three numbers `(x, y, z)`")?;
        Some(Self(DVec3::new(x.0, y.0, z.0)))
    }
}

impl<'t> Read<'t> for Shift {
    fn read(slice: Slice<'t>) -> Option<Self> {
        let [right, up]: [Coordinate; 2] = read_tuple(slice, "two numbers `(right, up)`")?;
        Some(Self(DVec2::new(right.0, up.0)))
    }
}

impl<'t> Read<'t> for FrameRange {
    fn read(slice: Slice<'t>) -> Option<Self> {
        let [Frame(first), Frame(last)] = read_tuple(slice, "two frames `(first, last)`")?;
        if first > last {
            return slice.refuse("a first frame that is not after the last");
        }
        Some(Self { first, last })
    }
}

impl<'t> Read<'t> for Flag {
    fn read(slice: Slice<'t>) -> Option<Self> {
        read_simple(slice, "`true` or `false`").map(Self)
    }
}

impl<'t> Read<'t> for MaterialName {
    fn read(slice: Slice<'t>) -> Option<Self> {
        read_simple(slice, "the name of a material in quotation marks").map(Self)
    }
}

impl<'t> Read<'t> for FileName {
    fn read(slice: Slice<'t>) -> Option<Self> {
        read_simple(slice, "the name of a file in quotation marks").map(Self)
    }
}

impl<'t> Read<'t> for ColumnName {
    fn read(slice: Slice<'t>) -> Option<Self> {
        read_simple(slice, "the name of a column in quotation marks").map(Self)
    }
}

impl<'t> Read<'t> for ValueRange {
    fn read(slice: Slice<'t>) -> Option<Self> {
        let [Coordinate(low), Coordinate(high)] = read_tuple(slice, "two numbers `(low, high)`")?;
        if low >= high {
            return slice.refuse("a low number that is less than the high one");
        }
        Some(Self { low, high })
    }
}

impl<'de> Deserialize<'de> for Materials {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Pairs;

        impl<'de> Visitor<'de> for Pairs {
            type Value = Materials;

            fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.write_str("materials by name")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Materials, A::Error> {
                let mut materials = Materials::default();
                while let Some(pair) = map.next_entry()? {
                    materials.0.push(pair);
                }
                Ok(materials)
            }
        }

        deserializer.deserialize_map(Pairs)
    }
}

fn black() -> Placed<Color> {
    Color::BLACK.into()
}

fn white() -> Placed<Color> {
    Color::WHITE.into()
}

fn no() -> Placed<Flag> {
    Flag(false).into()
}

fn cast_shadows() -> Placed<Flag> {
    Flag(true).into()
}
