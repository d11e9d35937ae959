//! Drawings that explain a picture: legend and scale bar, in files of their own or next to the picture in one SVG.

use std::fs;
use std::path::{Path, PathBuf};

use super::inputs::Inputs;
use super::svg::Svg;
use super::{legend, scale_bar};
use crate::base::failure::Failure;
use crate::base::shown::Shown;
use crate::files::destination::{is_same, prepare};
use crate::files::save::write_bytes;
use crate::formats::encoding::Encoding;
use crate::sequence::request::Request;

/// In place of a file name: the drawing goes into an SVG that contains the picture.
const INSIDE: &str = "inside";

/// The drawings that an SVG contains next to the picture, and the name of this SVG.
pub(super) struct Inside {
    path: PathBuf,
    drawings: Vec<Svg>,
}

/// Says whether this is no file name, but puts a drawing next to the picture.
pub(super) fn is_inside(name: &Path) -> bool {
    name.as_os_str() == INSIDE
}

/// Writes the requested drawings that have files of their own; for the first frame, if they depend on it. Returns those
/// that an SVG contains together with the picture.
pub(super) fn write(
    request: &Request,
    legend: Option<PathBuf>,
    scale_bar: Option<PathBuf>,
) -> Result<Option<Inside>, Failure> {
    let scene = &request.scene;
    let has_file = |path: &&PathBuf| !is_inside(path);
    let (legend_file, scale_bar_file) = (
        legend.as_ref().filter(has_file),
        scale_bar.as_ref().filter(has_file),
    );
    for (option, path) in [("--legend", legend_file), ("--scale-bar", scale_bar_file)] {
        path.map_or(Ok(()), |path| check_name(option, "drawings", path))?;
    }
    if let (Some(legend), Some(scale_bar)) = (legend_file, scale_bar_file)
        && is_same(legend, scale_bar)
    {
        let why = "--legend and --scale-bar name the same file";
        return Err(Failure::unusable(legend, why));
    }
    let has_inside = [&legend, &scale_bar]
        .into_iter()
        .flatten()
        .any(|path| is_inside(path));
    let path = has_inside.then(|| name_of_inside(request)).transpose()?;
    let inputs = Inputs::of(&request.scene_path, scene);
    let files = legend_file.into_iter().chain(scale_bar_file).chain(&path);
    inputs.refuse(files.cloned())?;
    let frame = request.frames.first();
    let legend = legend.map(|path| {
        let width = request.view(frame)?.width;
        Ok((legend::draw(scene, width, &request.scene_path)?, path))
    });
    let scale_bar = scale_bar.map(|path| {
        let view = request.view(frame)?;
        Ok((
            scale_bar::draw(scene, frame, &view, &request.scene_path)?,
            path,
        ))
    });
    let drawings: Vec<(Svg, PathBuf)> = legend
        .into_iter()
        .chain(scale_bar)
        .collect::<Result<_, Failure>>()?;
    let (inside, own): (Vec<_>, Vec<_>) =
        drawings.into_iter().partition(|(_, path)| is_inside(path));
    for (drawing, path) in own {
        prepare(&path)?;
        write_bytes(drawing.finish().as_bytes(), &path)?;
    }
    let drawings = inside.into_iter().map(|(drawing, _)| drawing).collect();
    Ok(path.map(|path| Inside { path, drawings }))
}

/// The name of the SVG with a picture: that of the picture, with another extension.
fn name_of_inside(request: &Request) -> Result<PathBuf, Failure> {
    let is_single = request.frames.count() == 1 && request.parts.len() == 1;
    let is_png = matches!(request.encoding, Encoding::Png(_));
    if is_single && is_png && request.window.is_none() {
        let picture = request.path(request.frames.first(), 0);
        return Ok(picture.with_extension("svg"));
    }
    Err(Failure::Usage(format!(
        "`{INSIDE}` puts a drawing next to a single whole picture in PNG, in one SVG: name a file instead, such as \
         --legend legend.svg or --scale-bar bar.svg"
    )))
}

impl Inside {
    /// Writes the SVG. The picture is in its file already.
    pub(super) fn write(self, request: &Request) -> Result<(), Failure> {
        let frame = request.frames.first();
        let view = request.view(frame)?;
        let picture = request.path(frame, 0);
        let unread = |error| Failure::io(&picture, "cannot read the picture", &error);
        let png = fs::read(&picture).map_err(unread)?;
        let (width, height) = (f64::from(view.width), f64::from(view.height));
        // The drawings stand at the right, one under the other, the last at the bottom.
        let column = self.drawings.iter().map(|drawing| drawing.size().0);
        let column = column.fold(0.0, f64::max);
        let all: f64 = self.drawings.iter().map(|drawing| drawing.size().1).sum();
        let height_of_all = height.max(all);
        let mut svg = Svg::new(width + column, height_of_all, "Figure");
        svg.png((0.0, 0.5 * (height_of_all - height)), (width, height), &png);
        let last = self.drawings.len().saturating_sub(1);
        let mut top = 0.0;
        for (index, drawing) in self.drawings.into_iter().enumerate() {
            let its_height = drawing.size().1;
            if index == last && index > 0 {
                top = height_of_all - its_height;
            }
            svg.drawing((width, top), drawing);
            top += its_height;
        }
        prepare(&self.path)?;
        write_bytes(svg.finish().as_bytes(), &self.path)
    }
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
