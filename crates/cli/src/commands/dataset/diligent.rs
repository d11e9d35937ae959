//! The files of the layout `diligent`, except for the pictures.

use std::path::Path;

use glam::DVec3;
use marbles_core::{DirectionalLight, Extrinsics, Light, View};

use super::centers::Centers;
use super::lines::{line, write_lines};
use crate::base::failure::Failure;

/// The lights, if all of them are directional.
pub(super) fn lights(scene: &Path, lights: &[Light]) -> Result<Vec<DirectionalLight>, Failure> {
    let distant = lights.iter().map(|light| match light {
        Light::Directional(light) => Ok(*light),
        Light::Point(_) => Err(Failure::unusable(
            scene,
            "the layout diligent needs directional lights, but the scene has a point light",
        )),
    });
    distant.collect()
}

/// The files except for the pictures and the mask.
pub(super) const NAMES: [&str; 5] = [
    "light_directions.txt",
    "light_intensities.txt",
    "Normal_gt.png",
    "normal.txt",
    "Normal_gt.mat",
];

/// Writes the true values for the pictures: the lights, multiplied by `gain`, and the normals.
pub(super) fn write(
    folder: &Path,
    view: &View,
    (lights, gain): (&[DirectionalLight], f64),
    centers: &Centers,
) -> Result<(), Failure> {
    let camera = Extrinsics::of(&view.camera);
    let direction = |light: &DirectionalLight| {
        let DVec3 { x, y, z } = camera.direction(light.toward());
        line(&[x, -y, -z])
    };
    let intensity = |light: &DirectionalLight| line(&(light.intensity() * gain).to_array());
    let [directions, intensities, picture, normals, matrix] = NAMES.map(|name| folder.join(name));
    write_lines(&directions, lights.iter().map(direction))?;
    write_lines(&intensities, lights.iter().map(intensity))?;
    centers.write_picture(&picture)?;
    centers.write_text(&normals)?;
    centers.write_mat(&matrix)
}
