//! The files of the layout `lp`, except for the pictures: the list of lights that programs for reflectance transformation
//! imaging read, such as RelightLab and RTIBuilder.
//!
//! The first line is the number of pictures. Each further line is the name of a picture and the unit vector toward its
//! light: x right, y up, z toward the viewer.

use std::path::Path;

use glam::DVec3;
use marbles_core::{DirectionalLight, Extrinsics, Light, View};

use super::centers::Centers;
use super::diligent;
use super::lines::{line, write_lines};
use crate::base::failure::Failure;

/// The files except for the pictures and the mask.
pub(super) const NAMES: [&str; 2] = ["lights.lp", "Normal_gt.png"];

/// The lights, if all of them are directional and equally bright: the list has no brightness.
pub(super) fn lights(scene: &Path, lights: &[Light]) -> Result<Vec<DirectionalLight>, Failure> {
    let lights = diligent::lights(scene, "lp", lights)?;
    let first: DVec3 = lights
        .first()
        .map_or(DVec3::ZERO, DirectionalLight::intensity);
    match lights.iter().position(|light| light.intensity() != first) {
        None => Ok(lights),
        Some(place) => {
            let why = format!(
                "the layout lp needs lights of the same intensity, but light {} of the scene has another one than light 1",
                place + 1
            );
            Err(Failure::unusable(scene, &why))
        }
    }
}

/// Writes the lights of the pictures with these names, and the normals.
pub(super) fn write(
    folder: &Path,
    view: &View,
    lights: &[DirectionalLight],
    centers: &Centers,
    pictures: impl Iterator<Item = String>,
) -> Result<(), Failure> {
    let camera = Extrinsics::of(&view.camera);
    let [list, picture] = NAMES.map(|name| folder.join(name));
    let lines = lights.iter().zip(pictures).map(|(light, name)| {
        let numbers = line(&diligent::toward(&camera, light));
        format!("{name} {numbers}")
    });
    write_lines(&list, [lights.len().to_string()].into_iter().chain(lines))?;
    centers.write_deep_picture(&picture)
}
