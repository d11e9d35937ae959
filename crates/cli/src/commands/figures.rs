//! Drawings that explain a picture: legend and scale bar.

use std::path::{Path, PathBuf};

use super::inputs::Inputs;
use super::{legend, scale_bar};
use crate::base::failure::Failure;
use crate::base::shown::Shown;
use crate::files::destination::{is_same, prepare};
use crate::files::save::write_bytes;
use crate::sequence::request::Request;

/// Writes the requested drawings; for the first frame, if they depend on it.
pub(super) fn write(
    request: &Request,
    legend: Option<PathBuf>,
    scale_bar: Option<PathBuf>,
) -> Result<(), Failure> {
    let scene = &request.scene;
    for (option, path) in [("--legend", &legend), ("--scale-bar", &scale_bar)] {
        path.as_deref()
            .map_or(Ok(()), |path| check_name(option, "drawings", path))?;
    }
    if let (Some(legend), Some(scale_bar)) = (&legend, &scale_bar)
        && is_same(legend, scale_bar)
    {
        let why = "--legend and --scale-bar name the same file";
        return Err(Failure::unusable(legend, why));
    }
    let inputs = Inputs::of(&request.scene_path, scene);
    inputs.refuse(legend.iter().chain(&scale_bar).cloned())?;
    let legend = legend.map(|path| Ok((legend::draw(scene, &request.scene_path)?, path)));
    let scale_bar = scale_bar.map(|path| {
        let frame = request.frames.first();
        let view = request.view(frame)?;
        Ok((
            scale_bar::draw(scene, frame, &view, &request.scene_path)?,
            path,
        ))
    });
    let drawings: Vec<(String, PathBuf)> = legend
        .into_iter()
        .chain(scale_bar)
        .collect::<Result<_, Failure>>()?;
    for (drawing, path) in drawings {
        prepare(&path)?;
        write_bytes(drawing.as_bytes(), &path)?;
    }
    Ok(())
}

/// Refuses the name of a drawing that does not end in `.svg`.
pub(super) fn check_name(option: &str, noun: &str, path: &Path) -> Result<(), Failure> {
    let ending = path.extension().and_then(|ending| ending.to_str());
    if ending.is_some_and(|ending| ending.eq_ignore_ascii_case("svg")) {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "{option}: expected a file name that ends in .svg, the only format of {noun}, found `{}`",
        path.shown()
    )))
}
