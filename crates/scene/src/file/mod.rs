//! The structures of a scene file, field by field as a user writes them.
//!
//! A field with a default may be left out. [`crate::world`] and [`crate::motion`] give the fields
//! their meaning.

mod camera;
mod cloud;
mod names;
mod outline;
mod sky;
mod table;

use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

pub(crate) use self::camera::{Animation, Axes, Camera, Channel, Ease, FrameOver, Key, Turned};
pub(crate) use self::cloud::{
    Cloud, ColorScale, Columns, End, OTHERS_COLOR, Others, RadiusLaw, TakenFrames, Up,
};
pub(crate) use self::outline::{Outline, Width};
pub(crate) use self::sky::Sky;
pub(crate) use self::table::{ElementRadii, Keep, Palette, RadiusColumn, Test, Wanted};
use crate::text::{Placed, present};
use crate::values::{
    Amplitude, Color, Coordinate, Diameter, Exponent, FieldOfView, Flag, FocalLength, GrainSize,
    ImageSide, LightName, MaterialName, Mu, Point, Radius, Reference, RetinaDistance, RetinaWidth,
    Seed, Shift, Shininess, Strength, UnitName, Zoom,
};

/// The whole file: black behind unlit, shadowed spheres unless it says more.
#[derive(Debug, Deserialize)]
#[serde(rename = "Scene", deny_unknown_fields)]
pub(crate) struct File {
    pub(crate) image: Placed<Image>,
    pub(crate) lens: Placed<Lens>,
    pub(crate) camera: Placed<Camera>,
    #[serde(default)]
    pub(crate) zoom: Placed<Zoom>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) unit: Option<Placed<UnitName>>,
    #[serde(default = "black")]
    pub(crate) background: Placed<Color>,
    #[serde(default = "black")]
    pub(crate) ambient: Placed<Color>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) sky: Option<Placed<Sky>>,
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

/// The retina, given by its size and distance, by the horizontal field of view in degrees, by the matrix of a
/// camera in pixels, (0, 0) the center of the first one, or by its width alone where all rays are parallel.
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
    Matrix {
        fx: Placed<FocalLength>,
        fy: Placed<FocalLength>,
        cx: Placed<Coordinate>,
        cy: Placed<Coordinate>,
    },
    Parallel {
        width: Placed<RetinaWidth>,
        #[serde(default)]
        shift: Placed<Shift>,
    },
}

/// A light; its intensity is 1 by default, its diameter 0, and it is at rest in the world.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Light {
    Directional {
        #[serde(default, deserialize_with = "present")]
        name: Option<Placed<LightName>>,
        toward: Placed<Point>,
        #[serde(default, deserialize_with = "present")]
        attached: Option<Placed<Attached>>,
        #[serde(default = "white")]
        intensity: Placed<Color>,
        #[serde(default)]
        diameter: Placed<Diameter>,
    },
    Point {
        #[serde(default, deserialize_with = "present")]
        name: Option<Placed<LightName>>,
        position: Placed<Point>,
        #[serde(default, deserialize_with = "present")]
        attached: Option<Placed<Attached>>,
        #[serde(default = "white")]
        intensity: Placed<Color>,
        #[serde(default)]
        falloff: Placed<Falloff>,
        #[serde(default, deserialize_with = "present")]
        reference: Option<Placed<Reference>>,
        #[serde(default, deserialize_with = "present")]
        direction: Option<Placed<Point>>,
        #[serde(default, deserialize_with = "present")]
        mu: Option<Placed<Mu>>,
    },
}

/// The way in which a point light falls off with the distance.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub(crate) enum Falloff {
    #[default]
    InverseSquare,
    None,
}

impl Light {
    /// The light's name with its place, if it has one.
    pub(crate) fn placed_name(&self) -> Option<&Placed<LightName>> {
        let (Self::Directional { name, .. } | Self::Point { name, .. }) = self;
        name.as_ref()
    }

    /// The light's name, if it has one that was not refused.
    pub(crate) fn name(&self) -> Option<&str> {
        Some(&self.placed_name()?.value.as_ref()?.0)
    }

    pub(crate) fn is_attached(&self) -> bool {
        let (Self::Directional { attached, .. } | Self::Point { attached, .. }) = self;
        attached.is_some()
    }

    /// The channels that keys of this light may name.
    pub(crate) fn channels(&self) -> &'static [&'static str] {
        match self {
            Self::Directional { .. } => &["toward", "intensity", "diameter"],
            Self::Point {
                direction: None, ..
            } => &["position", "intensity"],
            Self::Point { .. } => &["position", "direction", "mu", "intensity"],
        }
    }
}

/// The thing that a light moves with.
#[derive(Clone, Copy, Debug, Deserialize)]
pub(crate) enum Attached {
    /// The camera, in whose axes the light is given: x right, y up, z forward.
    Camera,
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
    #[serde(default, deserialize_with = "present")]
    pub(crate) outline: Option<Placed<Outline>>,
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

/// The thing to which the numbers of a rough surface are attached.
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

/// Materials in the file's order, a name given twice included.
#[derive(Debug, Default)]
pub(crate) struct Materials(pub(crate) Vec<(Placed<MaterialName>, Placed<Material>)>);

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

fn cast_shadows() -> Placed<Flag> {
    Flag(true).into()
}
