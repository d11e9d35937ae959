//! The maths of marbles: spheres lit by directional and point lights, seen through a pinhole or by parallel rays, and the
//! average of their light over each pixel.
//!
//! A [`World`] is what is rendered, a [`View`] is from where; a [`Renderer`] turns both into an
//! [`Image`] whose every pixel says its value, its error and its [`Status`], or into strips of one
//! for a [`Sink`].
//!
//! World axes are left-handed: x right, y up, z forward. Lengths are scene units. Color is
//! linear with Rec. 709 primaries; 1 is the radiance of a white surface that faces a light of
//! intensity 1.
//!
//! This crate knows no file, no clock and no terminal. Transcendental functions come from `libm` or
//! are written out, so that a picture is the same, bit for bit, on every machine.

mod edges;
mod exact;
mod hit;
mod light;
mod model;
mod numeric;
mod picture;
mod render;
mod sampling;
mod search;
mod time;

pub use exact::areas::VisibleArea;
pub use hit::outcome::{Floor, Hit};
pub use model::albedos::Albedos;
pub use model::camera::{Camera, Lens};
pub use model::color::Color;
pub use model::exposure::{Exposure, Motion, Pose};
pub use model::light::{DirectionalLight, Light, LightFalloff, PointLight};
pub use model::material::{Grain, Highlight, Material, Roughness};
pub use model::opencv::{Extrinsics, Intrinsics, right_handed};
pub use model::outline::{Ellipse, Outline};
pub use model::ray::Ray;
pub use model::rotation::{RotationError, nearest_rotation};
pub use model::sphere::{Sphere, SphereError};
pub use model::stroke::{Stroke, StrokeWidth};
pub use model::view::View;
pub use model::world::{LightPart, MaterialId, World};
pub use numeric::angle::Angle;
pub use picture::averages::{Average, AverageSettings};
pub use picture::geometry::Geometry;
pub use picture::image::{Channels, Image, Summary};
pub use picture::pixel::{Evidence, Method, Status, Work};
pub use picture::progress::Cancelled;
pub use picture::quantities::{Axes, Depth, GeometrySettings, Precision, Quantities, Quantity};
pub use picture::window::Window;
pub use render::renderer::Renderer;
pub use render::settings::Settings;
pub use render::strips::{BAND_ROWS, Rendering, Sink, Strip};
