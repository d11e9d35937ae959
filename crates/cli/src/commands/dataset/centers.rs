//! The geometry at the centers of pixels, in files of several kinds.

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
    /// In the camera's axes, x right, y up, z toward the viewer; row by row, 0 where nothing is seen.
    normals: Vec<[f64; 3]>,
    /// Along the axis of view; 0 where nothing is seen.
    depths: Vec<f64>,
    /// The pixels that see something.
    mask: Vec<bool>,
}

impl Centers {
    /// The normals that the surfaces of a view are shaded with, and the depths.
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

    /// The mean depth of all that is seen, if there is anything.
    pub(super) fn mean_depth(&self) -> Option<f64> {
        let count = self.mask.iter().filter(|&&seen| seen).count();
        let mean = |depth: &f64| depth / count as f64;
        (count > 0).then(|| self.depths.iter().map(mean).sum())
    }

    /// Writes 255 where a sphere is seen, with a text by which the file is known.
    pub(super) fn write_mask(&self, path: &Path, text: Text) -> Result<(), Failure> {
        let mut rows = self.mask.chunks(self.size.width as usize);
        write_grey(self.size, path, &[text], |codes| {
            let row = rows.next().unwrap_or_default().iter();
            codes.extend(row.map(|&seen| if seen { 255 } else { 0 }));
            Ok(())
        })
    }

    /// Writes a picture of the normals for people, and for programs that look at its size: components from −1 to 1 become
    /// codes from 0 to 255.
    pub(super) fn write_picture(&self, path: &Path) -> Result<(), Failure> {
        let codes = (0..self.normals.len()).flat_map(|pixel| self.codes(pixel, u8::MAX.into()));
        let codes: Vec<u8> = codes.map(|code| code as u8).collect();
        write_bytes(&rgb_bytes(self.size, &codes)?, path)
    }

    /// Writes a picture from which programs read the normals: components from −1 to 1 become codes from 0 to 65535.
    pub(super) fn write_deep_picture(&self, path: &Path) -> Result<(), Failure> {
        let width = self.size.width as usize;
        let codes = |row: u32| {
            let first = row as usize * width;
            let codes = (first..first + width).flat_map(|pixel| self.codes(pixel, u16::MAX.into()));
            codes.map(|code| code as u16).collect()
        };
        write_rgb_16(self.size, codes, path)
    }

    /// The codes of a pixel's normal, up to the largest one; 0 where nothing is seen.
    fn codes(&self, pixel: usize, most: f64) -> [f64; 3] {
        match self.mask[pixel] {
            true => self.normals[pixel].map(|number| (0.5 * most * (number + 1.0)).round()),
            false => [0.0; 3],
        }
    }

    /// Writes three numbers a line, pixel by pixel and row by row. The last line has no end: some programs count ends.
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

    /// Writes the depths as arrays of height × width, once under each of the names.
    pub(super) fn write_depths(&self, names: &[&str], path: &Path) -> Result<(), Failure> {
        let arrays: Vec<(&str, &[f64])> = names.iter().map(|&name| (name, &*self.depths)).collect();
        self.save(path, |to| Ok(npz::write(to, self.size, &arrays)?))
    }

    /// Writes a file, whole or not at all.
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
