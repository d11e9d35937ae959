//! The files that tell the lights, one a line.

use std::path::Path;

use glam::DVec3;
use marbles_core::{DirectionalLight, Extrinsics, View};

use crate::base::failure::Failure;
use crate::files::save::write_bytes;

/// Writes the names of the pictures.
pub(super) fn write_names(path: &Path, names: impl Iterator<Item = String>) -> Result<(), Failure> {
    write_lines(path, names)
}

/// Writes the unit vectors toward the lights, in the camera's axes: x right, y up, z toward the viewer.
pub(super) fn write_directions(
    path: &Path,
    lights: &[DirectionalLight],
    view: &View,
) -> Result<(), Failure> {
    let camera = Extrinsics::of(&view.camera);
    let direction = |light: &DirectionalLight| {
        let DVec3 { x, y, z } = camera.direction(light.toward());
        line([x, -y, -z])
    };
    write_lines(path, lights.iter().map(direction))
}

/// Writes the intensities of the lights in the pictures' own numbers, in which white is 1.
pub(super) fn write_intensities(
    path: &Path,
    lights: &[DirectionalLight],
    gain: f64,
) -> Result<(), Failure> {
    let intensity = |light: &DirectionalLight| line((light.intensity() * gain).to_array());
    write_lines(path, lights.iter().map(intensity))
}

/// Three numbers, with as many digits as it takes to read the same doubles; `+ 0` makes no negative zeros.
fn line(numbers: [f64; 3]) -> String {
    let [x, y, z] = numbers.map(|number| number + 0.0);
    format!("{x} {y} {z}")
}

/// Writes lines, the last of which ends as the others do.
fn write_lines(path: &Path, lines: impl Iterator<Item = String>) -> Result<(), Failure> {
    let text: String = lines.map(|line| line + "\n").collect();
    write_bytes(text.as_bytes(), path)
}
