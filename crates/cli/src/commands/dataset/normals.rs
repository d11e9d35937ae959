//! The normals that the rays through the centers of pixels see, in files of several kinds.

use std::io::{BufWriter, Write};
use std::path::Path;

use marbles_core::{Axes, Depth, Geometry, GeometrySettings, Precision, Quantity, Renderer, View};

use crate::base::failure::Failure;
use crate::base::size::Size;
use crate::files::save::{Fault, save, write_bytes};
use crate::formats::mat;
use crate::formats::png::write::{rgb_bytes, write_grey};

/// The normals of a picture, in the camera's axes: x right, y up, z toward the viewer.
pub(super) struct Normals {
    size: Size,
    /// Row by row; 0 where nothing is seen.
    normals: Vec<[f64; 3]>,
    /// Where something is seen.
    mask: Vec<bool>,
}

impl Normals {
    /// The normals that the surfaces of a view are shaded with.
    pub(super) fn of(renderer: &Renderer<'_>, view: &View) -> Self {
        let settings = GeometrySettings {
            quantities: [Quantity::Normal].into_iter().collect(),
            depth: Depth::Axis,
            axes: Axes::CameraOpenGl,
            precision: Precision::Double,
        };
        let geometry = renderer.geometry(view, &settings);
        let (mut normals, mut mask) = (Vec::new(), Vec::new());
        for row in 0..geometry.height() {
            mask.extend(geometry.ids(row).map(|id| id != Geometry::NOTHING));
            let first = normals.len();
            normals.resize(first + geometry.width() as usize, [0.0; 3]);
            for component in 0..3 {
                let values = geometry.values(Quantity::Normal, component, row);
                let values = values.into_iter().flatten();
                for (normal, value) in normals[first..].iter_mut().zip(values) {
                    normal[component] = value + 0.0;
                }
            }
        }
        Self {
            size: Size::of(view),
            normals,
            mask,
        }
    }

    /// Writes 255 where a sphere is seen.
    pub(super) fn write_mask(&self, path: &Path) -> Result<(), Failure> {
        let codes = self.mask.iter().map(|&seen| if seen { 255 } else { 0 });
        let codes: Vec<u8> = codes.collect();
        write_grey(self.size, &codes, path)
    }

    /// Writes a picture for people, and for programs that look at its size: components from −1 to 1 become codes from 0
    /// to 255.
    pub(super) fn write_picture(&self, path: &Path) -> Result<(), Failure> {
        let seen = self.mask.iter().zip(&self.normals);
        let codes = seen.flat_map(|(&seen, normal)| {
            normal.map(|number| match seen {
                true => (127.5 * (number + 1.0)).round() as u8,
                false => 0,
            })
        });
        let codes: Vec<u8> = codes.collect();
        write_bytes(&rgb_bytes(self.size, &codes)?, path)
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
