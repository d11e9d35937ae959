//! The files of the layout `luces`, except for the pictures.
//!
//! Its readers model a light by its position P, a direction s, a brightness φ in each color and an exponent μ: a matte
//! surface of albedo ρ at the point X shows
//!
//! > ρ φ (−l · s)^μ max(0, n · l) / |P − X|², l = (P − X) / |P − X|,
//!
//! up to a factor that all lights share. A point light without a `direction` shines equally in all of them: μ = 0. The
//! factor is the
//! square of the mean distance here, as for readers that divide all lengths by this distance.
//!
//! # Source
//! `datasets/io_nf.py`, `datasets/luces_dataset.py` and `normal_integration/near_functions.py` of
//! github.com/dlichy/FastNFPSCode. The first and the last come from the authors of the data set.

use std::path::Path;

use glam::{DVec2, DVec3};
use marbles_core::{Extrinsics, Intrinsics, Light, LightFalloff, PointLight, View};

use super::centers::Centers;
use super::lines::{line, write_lines};
use crate::base::failure::Failure;

/// The first line of `led_params.txt`, the file that programs read first.
const HEADER: &str = "N_img nrows ncols f x0 y0 mean_distance sfull:[Lpos Ldir Phi mu 0]";

/// The lights, if all of them are point lights whose light falls off with the square of the distance.
pub(super) fn lights(scene: &Path, lights: &[Light]) -> Result<Vec<PointLight>, Failure> {
    let near = lights.iter().enumerate().map(|(index, light)| {
        let refuse = |found: &str| {
            let number = index + 1;
            let why = format!(
                "the layout luces needs point lights whose light falls off with the square of the distance, but \
                 light {number} of the scene {found}"
            );
            Err(Failure::unusable(scene, &why))
        };
        match light {
            Light::Directional(_) => refuse("is directional"),
            Light::Point(light) => match light.falloff() {
                LightFalloff::None => refuse("does not fall off"),
                LightFalloff::InverseSquare => Ok(*light),
            },
        }
    });
    near.collect()
}

/// Refuses lenses without a focal length in pixels, or with two.
pub(super) fn check_lens(scene: &Path, view: &View) -> Result<(), Failure> {
    let DVec2 { x, y } = Intrinsics::of(view).focal_lengths;
    let refuse = |why: &str| Err(Failure::unusable(scene, why));
    if !x.is_finite() {
        return refuse("the layout luces needs a focal length, but the lens of the scene has none");
    }
    if x != y {
        let found = format!(
            "the layout luces has a single focal length, for square pixels, but the lens of the scene has two: fx \
             {x} and fy {y}"
        );
        return refuse(&found);
    }
    Ok(())
}

/// The mean depth of the visible surfaces. Refuses pictures without spheres.
pub(super) fn mean_distance(scene: &Path, centers: &Centers) -> Result<f64, Failure> {
    centers.mean_depth().ok_or_else(|| {
        Failure::unusable(
            scene,
            "the layout luces needs the mean distance of the visible surfaces, but no pixel sees a sphere",
        )
    })
}

/// The files except for the pictures and the mask.
pub(super) const NAMES: [&str; 7] = [
    "led_params.txt",
    "K.txt",
    "light_positions.txt",
    "light_directions.txt",
    "light_intensities.txt",
    "normals.png",
    "zgt.npz",
];

/// Writes the true values for the pictures: the lights, multiplied by `gain`, the camera, the normals and the depths.
pub(super) fn write(
    folder: &Path,
    view: &View,
    (lights, gain): (&[PointLight], f64),
    (centers, mean_distance): (&Centers, f64),
) -> Result<(), Failure> {
    let camera = Extrinsics::of(&view.camera);
    let positions = lights.iter().map(|light| camera.point(light.position()));
    let positions: Vec<DVec3> = positions.collect();
    let brightness = |light: &PointLight| {
        let ratio = light.reference() / mean_distance;
        light.intensity() * (gain * ratio * ratio)
    };
    let [
        parameters_file,
        matrix_file,
        positions_file,
        directions_file,
        intensities_file,
        normals_file,
        depths_file,
    ] = NAMES.map(|name| folder.join(name));

    let Intrinsics {
        focal_lengths,
        principal_point: DVec2 { x, y },
    } = Intrinsics::of(view);
    let sizes = format!("{} {} {}", lights.len(), view.height, view.width);
    let setup = line(&[focal_lengths.x, x, y, mean_distance]);
    let setup = [HEADER.to_owned(), format!("{sizes} {setup}")];
    let parameters = lights.iter().zip(&positions).map(|(light, position)| {
        // Of a light that shines equally in all directions, the axis of view; then μ, and a number that nobody reads.
        let (direction, exponent) = match light.emission() {
            Some(emission) => (camera.direction(emission.direction()), emission.mu()),
            None => (DVec3::Z, 0.0),
        };
        let last = 0.0;
        let vectors = [*position, direction, brightness(light)].map(|vector| vector.to_array());
        let mut numbers = vectors.concat();
        numbers.extend([exponent, last]);
        line(&numbers)
    });
    write_lines(&parameters_file, setup.into_iter().chain(parameters))?;
    let matrix = [
        [focal_lengths.x, 0.0, x],
        [0.0, focal_lengths.y, y],
        [0.0, 0.0, 1.0],
    ];
    write_lines(&matrix_file, matrix.map(|row| line(&row)))?;

    let upward = |vector: DVec3| line(&[vector.x, -vector.y, -vector.z]);
    write_lines(
        &positions_file,
        positions.iter().map(|&position| upward(position)),
    )?;
    let middle = DVec3::Z * mean_distance;
    write_lines(
        &directions_file,
        positions
            .iter()
            .map(|&position| upward((position - middle).normalize_or_zero())),
    )?;
    write_lines(
        &intensities_file,
        lights
            .iter()
            .map(|light| line(&brightness(light).to_array())),
    )?;
    centers.write_deep_picture(&normals_file)?;
    centers.write_depths(&["zgt", "zgt_int"], &depths_file)
}
