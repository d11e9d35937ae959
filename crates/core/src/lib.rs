//! The maths of marbles: spheres lit by directional lights, seen by a pinhole camera, and the
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

mod albedos;
mod angle;
mod camera;
mod color;
mod edges;
mod exposure;
mod hierarchy;
mod image;
mod integration;
mod lanes;
mod light;
mod material;
mod plane;
mod power;
mod ray;
mod render;
mod roughness;
mod rounding;
mod shading;
mod sphere;
mod strips;
mod tile;
mod view;
mod visibility;
mod world;

pub use albedos::Albedos;
pub use angle::Angle;
pub use camera::{Camera, Lens};
pub use color::{Color, Radiance};
pub use exposure::{Exposure, Motion, Pose};
pub use image::{Channels, Image, Summary};
pub use integration::{Evidence, Status, Work};
pub use light::DirectionalLight;
pub use material::{Grain, Highlight, Material, Roughness};
pub use ray::Ray;
pub use render::{Cancelled, Method, Renderer, Settings};
pub use sphere::{Floor, Hit, Sphere, SphereError};
pub use strips::{BAND_ROWS, Rendering, Sink, Strip, Window};
pub use view::View;
pub use world::{MaterialId, World};

pub(crate) use tile::{Tile, TileLight};
