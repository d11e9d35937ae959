//! Normals and depths at the centers of pixels, in several file formats.

use std::io::{BufWriter, Write};
use std::path::Path;

use marbles_core::{
    AverageSettings, Axes, Depth, Geometry, GeometrySettings, Precision, Quantity, Renderer, View,
};

use crate::base::failure::Failure;
use crate::base::size::Size;
use crate::files::save::{Fault, save, write_bytes};
use crate::formats::mat;
use crate::formats::npy::npz;
use crate::formats::png::write::{Text, rgb_bytes, write_grey, write_rgb_16};

/// The normals and depths of a picture.
pub(super) struct Centers {
    size: Size,
    /// In the axes of the camera: x right, y up, z toward the viewer; row by row, 0 if no sphere is visible.
    normals: Vec<[f64; 3]>,
    /// Along the axis of view; 0 if no sphere is visible.
    depths: Vec<f64>,
    /// The number of pixels in which a sphere is visible.
    mask: Vec<bool>,
}

impl Centers {
    /// The shading normals and the depths of a view.
    pub(super) fn of(renderer: &Renderer<'_>, view: &View) -> Self {
        let settings = GeometrySettings {
            quantities: [Quantity::Normal, Quantity::Depth].into_iter().collect(),
            depth: Depth::Axis,
            axes: Axes::CameraOpenGl,
            precision: Precision::Double,
            averages: AverageSettings::default(),
        };
        let geometry = renderer.geometry(view, &settings);
        let values = |quantity, component, row| {
            let values = geometry.values(quantity, component, row);
            values.into_iter().flatten()
        };
        let (mut normals, mut depths, mut mask) = (Vec::new(), Vec::new(), Vec::new());
        for row in 0..geometry.height() {
            let first = normals.len();
            mask.extend(geometry.ids(row).map(|id| id != Geometry::NOTHING));
            normals.resize(first + geometry.width() as usize, [0.0; 3]);
            for component in 0..3 {
                let values = values(Quantity::Normal, component, row);
                for (normal, value) in normals[first..].iter_mut().zip(values) {
                    normal[component] = value + 0.0;
                }
            }
            let seen = mask[first..].iter().zip(values(Quantity::Depth, 0, row));
            depths.extend(seen.map(|(&seen, depth)| if seen { depth } else { 0.0 }));
        }
        Self {
            size: Size::of(view),
            normals,
            depths,
            mask,
        }
    }

    /// The mean depth of the visible surfaces, if there are any.
    pub(super) fn mean_depth(&self) -> Option<f64> {
        let count = self.mask.iter().filter(|&&seen| seen).count();
        let mean = |depth: &f64| depth / count as f64;
        (count > 0).then(|| self.depths.iter().map(mean).sum())
    }

    /// Writes 255 for pixels in which a sphere is visible, with a text that identifies the file.
    pub(super) fn write_mask(&self, path: &Path, text: Text) -> Result<(), Failure> {
        let mut rows = self.mask.chunks(self.size.width as usize);
        write_grey(self.size, path, &[text], |codes| {
            let row = rows.next().unwrap_or_default().iter();
            codes.extend(row.map(|&seen| if seen { 255 } else { 0 }));
            Ok(())
        })
    }

    /// Writes a picture of the normals to look at: components from −1 to 1 become codes from 0 to 255. Some programs
    /// also read its size.
    pub(super) fn write_picture(&self, path: &Path) -> Result<(), Failure> {
        let codes = (0..self.normals.len()).flat_map(|pixel| self.codes(pixel, u8::MAX.into()));
        let codes: Vec<u8> = codes.map(|code| code as u8).collect();
        write_bytes(&rgb_bytes(self.size, &codes)?, path)
    }

    /// Writes a picture of the normals for programs: components from −1 to 1 become codes from 0 to 65535.
    pub(super) fn write_deep_picture(&self, path: &Path) -> Result<(), Failure> {
        let width = self.size.width as usize;
        let codes = |row: u32| {
            let first = row as usize * width;
            let codes = (first..first + width).flat_map(|pixel| self.codes(pixel, u16::MAX.into()));
            codes.map(|code| code as u16).collect()
        };
        write_rgb_16(self.size, codes, path)
    }

    /// The codes of the normal of a pixel, up to the largest code; 0 if no sphere is visible.
    fn codes(&self, pixel: usize, most: f64) -> [f64; 3] {
        match self.mask[pixel] {
            true => self.normals[pixel].map(|number| (0.5 * most * (number + 1.0)).round()),
            false => [0.0; 3],
        }
    }

    /// Writes three numbers per line, pixel by pixel and row by row. The last line has no line feed, because some
    /// programs count line feeds.
    pub(super) fn write_text(&self, path: &Path) -> Result<(), Failure> {
        self.save(path, |to| {
            for (index, [x, y, z]) in self.normals.iter().enumerate() {
                if index > 0 {
                    to.write_all(b"\n")?;
                }
                write!(to, "{x} {y} {z}")?;
            }
            Ok(())
        })
    }

    /// Writes an array `Normal_gt` of height × width × 3.
    pub(super) fn write_mat(&self, path: &Path) -> Result<(), Failure> {
        let [width, height] = [self.size.width, self.size.height].map(|side| side as usize);
        self.save(path, |to| {
            let value = |row: usize, col: usize, component: usize| {
                self.normals[row * width + col][component]
            };
            Ok(mat::write_array(
                to,
                "Normal_gt",
                [height, width, 3],
                value,
            )?)
        })
    }

    /// Writes the depths as arrays of height × width, once under each name.
    pub(super) fn write_depths(&self, names: &[&str], path: &Path) -> Result<(), Failure> {
        let arrays: Vec<(&str, &[f64])> = names.iter().map(|&name| (name, &*self.depths)).collect();
        self.save(path, |to| Ok(npz::write(to, self.size, &arrays)?))
    }

    /// Writes a file, completely or not at all.
    fn save(
        &self,
        path: &Path,
        write: impl FnOnce(&mut dyn Write) -> Result<(), Fault>,
    ) -> Result<(), Failure> {
        let saved = save(path, |mut file| {
            let mut to = BufWriter::new(file.file());
            write(&mut to)?;
            to.flush()?;
            drop(to);
            Ok(file)
        });
        Ok(saved?)
    }
}
