//! The maths of marbles: spheres lit by directional and point lights, seen through a pinhole or by parallel rays, and the
//! average of their light over each pixel.
//!
//! A [`World`] holds the spheres and lights, and a [`View`] the camera. A [`Renderer`] turns both into an [`Image`], which has the
//! value, the error and the [`Status`] of every pixel, or into strips of an image for a [`Sink`].
//!
//! # Example
//! ```
//! use marbles_core::glam::DVec3;
//! use marbles_core::{Angle, Camera, Lens, Light, Material, Renderer, Settings, Sphere, View, World};
//!
//! let mut world = World::new();
//! let white = world.add_material(Material::default());
//! world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
//! world.lights.push(Light::directional(DVec3::NEG_Z, DVec3::ONE)?);
//! let lens = Lens::from_field_of_view(Angle::from_degrees(40.0))?;
//! let view = View::new(Camera::default(), lens, 32, 32);
//! let image = Renderer::new(&world).render(&view, &Settings::default());
//!
//! let summary = image.summary();
//! assert!(summary.largest_error <= 1e-3);
//! assert_eq!(summary.over_tolerance, 0);
//! let codes = image.to_srgb8(); // red, green, blue, alpha of each pixel
//! assert_eq!(codes[..4], [0, 0, 0, 255]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//! With the feature `image`, an [`Image`] converts to buffers of the crate `image`: linear light in an `image::Rgba32FImage`, or sRGB
//! codes in an `image::RgbaImage`.
//!
//! The folder `examples` has a picture with its errors, a sequence, exact hits and visible areas.
//!
//! # Conventions
//!
//! World axes are left-handed: x right, y up, z forward. Lengths are scene units. Color is
//! linear with Rec. 709 primaries; 1 is the radiance of a white surface that faces a light of
//! intensity 1.
//!
//! This crate opens no file, reads no clock and prints nothing. Transcendental functions come from `libm` or are
//! written out, so that a picture is the same, bit for bit, on every machine.

mod edges;
mod exact;
mod hit;
mod light;
mod model;
mod numeric;
#[doc(hidden)]
pub mod parallel;
mod patches;
mod picture;
mod raster;
mod render;
mod sampling;
mod search;
mod soft;
mod time;

pub use glam;

pub use exact::areas::VisibleArea;
#[doc(hidden)]
pub use hit::outcome::Floor;
pub use hit::outcome::Hit;
pub use model::albedos::Albedos;
pub use model::camera::{Camera, CameraError, Lens};
pub use model::color::Color;
pub use model::contour::{Contour, Ellipse};
pub use model::emission::Emission;
pub use model::exposure::{Exposure, Motion, Pose};
pub use model::light::{DirectionalLight, Light, LightFalloff, PointLight};
pub use model::light_error::LightError;
pub use model::material::{Grain, Highlight, Material, Roughness};
pub use model::opencv::{Extrinsics, Intrinsics, right_handed};
pub use model::outline::{Outline, OutlineWidth};
pub use model::ray::Ray;
pub use model::rotation::{RotationError, nearest_rotation};
pub use model::sky::Sky;
pub use model::sphere::{Sphere, SphereError};
pub use model::view::View;
pub use model::world::{LightPart, MaterialId, World};
pub use numeric::angle::Angle;
pub use picture::averages::{Average, AverageSettings};
pub use picture::geometry::Geometry;
pub use picture::image::{Channels, Image};
pub use picture::pixel::{Evidence, Method, Status, Work};
pub use picture::progress::Cancelled;
pub use picture::quantities::{Axes, Depth, GeometrySettings, Precision, Quantities, Quantity};
pub use picture::srgb;
pub use picture::summary::Summary;
pub use picture::window::Window;
pub use render::renderer::Renderer;
pub use render::settings::Settings;
pub use render::sink::{Sink, Strip};
pub use render::strips::Rendering;

/// Runs the program of the README.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
mod readme {}
