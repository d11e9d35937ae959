//! A picture of time against RMSE, in an SVG or a PNG.

mod axis;
mod chart;
mod drawing;
mod labels;
mod raster;
mod svg;

use std::path::{Path, PathBuf};

use super::Report;
use crate::base::failure::Failure;
use crate::formats;

/// The file of `--plot`.
#[derive(Debug)]
pub(super) struct PlotFile {
    path: PathBuf,
    format: Format,
}

#[derive(Clone, Copy, Debug)]
enum Format {
    Svg,
    Png,
}

impl PlotFile {
    /// The plot at `path`, whose ending chooses the format.
    pub(super) fn at(path: &Path) -> Result<Self, Failure> {
        let ending = path.extension().and_then(|ending| ending.to_str());
        let format = match ending.map(str::to_ascii_lowercase).as_deref() {
            Some("svg") => Format::Svg,
            Some("png") => Format::Png,
            _ => {
                return Err(Failure::Usage(format!(
                    "--plot: expected a file name that ends in .svg or .png, found `{}`",
                    path.display()
                )));
            }
        };
        Ok(Self {
            path: path.to_owned(),
            format,
        })
    }

    pub(super) fn write(&self, report: &Report) -> Result<(), Failure> {
        let drawing = chart::draw(report);
        match self.format {
            Format::Svg => formats::write_bytes(svg::text(&drawing).as_bytes(), &self.path),
            Format::Png => {
                let (width, height, codes) = raster::rgb(&drawing);
                formats::write_rgb_codes(width, height, &codes, &self.path)
            }
        }
    }
}
