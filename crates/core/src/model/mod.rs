//! The scene as a user describes it: world and view.

pub(crate) mod albedos;
pub(crate) mod camera;
pub(crate) mod color;
pub(crate) mod contour;
pub(crate) mod emission;
pub(crate) mod exposure;
pub(crate) mod light;
pub(crate) mod light_error;
pub(crate) mod light_unit;
pub(crate) mod material;
mod material_ids;
pub(crate) mod opencv;
pub(crate) mod outline;
pub(crate) mod ray;
pub(crate) mod rotation;
pub(crate) mod roughness;
pub(crate) mod sky;
pub(crate) mod sphere;
pub(crate) mod view;
pub(crate) mod world;
