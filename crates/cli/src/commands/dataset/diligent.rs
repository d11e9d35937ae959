//! The files of the layout `diligent`, except for the pictures. Some of them exist under two names, for programs that look
//! for them under either.
//!
//! # Source
//! `datasets/UPS_Custom_Dataset.py` of github.com/guanyingc/SDPS-Net reads `names.txt` and `normal.png`.

use std::path::Path;

use glam::DVec3;
use marbles_core::{DirectionalLight, Extrinsics, Light, View};

use super::centers::Centers;
use super::lines::{line, write_lines};
use crate::base::failure::Failure;

/// The lights, if all of them are directional, as the layout with this name needs them.
pub(super) fn lights(
    scene: &Path,
    layout: &str,
    lights: &[Light],
) -> Result<Vec<DirectionalLight>, Failure> {
    let distant = lights.iter().map(|light| match light {
        Light::Directional(light) => Ok(*light),
        Light::Point(_) => {
            let why = format!(
                "the layout {layout} needs directional lights, but the scene has a point light"
            );
            Err(Failure::unusable(scene, &why))
        }
    });
    distant.collect()
}

/// The files except for the pictures and the mask.
pub(super) const NAMES: [&str; 7] = [
    "light_directions.txt",
    "light_intensities.txt",
    "Normal_gt.png",
    "normal.txt",
    "Normal_gt.mat",
    "normal.png",
    "names.txt",
];

/// Writes the true values for the pictures: the lights, multiplied by `gain`, and the normals.
pub(super) fn write(
    folder: &Path,
    view: &View,
    (lights, gain): (&[DirectionalLight], f64),
    centers: &Centers,
    pictures: impl Iterator<Item = String>,
) -> Result<(), Failure> {
    let camera = Extrinsics::of(&view.camera);
    let direction = |light: &DirectionalLight| line(&toward(&camera, light));
    let intensity = |light: &DirectionalLight| line(&(light.intensity() * gain).to_array());
    let [
        directions,
        intensities,
        deep_picture,
        normals,
        matrix,
        picture,
        names,
    ] = NAMES.map(|name| folder.join(name));
    write_lines(&directions, lights.iter().map(direction))?;
    write_lines(&intensities, lights.iter().map(intensity))?;
    centers.write_deep_picture(&deep_picture)?;
    centers.write_text(&normals)?;
    centers.write_mat(&matrix)?;
    centers.write_picture(&picture)?;
    write_lines(&names, pictures)
}

/// The unit vector toward a light: x right, y up, z toward the viewer.
pub(super) fn toward(camera: &Extrinsics, light: &DirectionalLight) -> [f64; 3] {
    let DVec3 { x, y, z } = camera.direction(light.toward());
    [x, -y, -z]
}
