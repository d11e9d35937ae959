//! Clouds: the spheres of tables.

use std::fs;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

use marbles_core::{Albedos, MaterialId, World};
use rayon::prelude::*;

use super::placement::{Placement, turn};
use crate::file;
use crate::table::{self, Coloring, Colormap, Paint, Request, Rows, TableError};
use crate::text::{Fault, LocatedFault, closest, list, optional, quoted, reason, refuse};
use crate::values::ValueRange;

/// A cloud of the scene file whose table is not yet read.
#[derive(Clone, Debug)]
pub(crate) struct Cloud {
    /// The table as the file names it.
    pub(crate) name: String,
    /// The place of its name, in bytes of the scene file.
    pub(crate) place: Range<usize>,
    material: MaterialId,
    request: Request,
    colormap: Colormap,
    range: Option<ValueRange>,
    placement: Placement,
}

/// The reason for which a table was refused.
#[derive(Debug)]
pub(crate) enum CloudError {
    /// Something is wrong in what the scene file says of it.
    Scene(Fault),
    /// Something is wrong in the table with this path.
    Table(PathBuf, LocatedFault),
}

/// The state of reading a table.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Progress<'scene> {
    /// The table as the scene file names it.
    pub table: &'scene Path,
    /// Bytes that were read.
    pub read: u64,
    /// Bytes of the whole file; 0 where it does not say.
    pub size: u64,
}

impl Cloud {
    /// The cloud that the file describes; `None` where a fault was reported.
    pub(crate) fn new(cloud: &file::Cloud, material: MaterialId) -> Option<Self> {
        let value = optional(&cloud.value, |name| Some(name.0.clone()))?;
        let coloring = optional(&cloud.color, |coloring| Some(*coloring))?;
        let scale_place = cloud.colormap.as_ref().map(|colormap| &colormap.place);
        let scale_place = scale_place.or(cloud.range.as_ref().map(|range| &range.place));
        let scale_place = scale_place.or(cloud.value.as_ref().map(|name| &name.place));
        if let (Some(place), Some(coloring)) = (scale_place, coloring)
            && coloring != Coloring::Value
        {
            let message = format!("expected `color: Value` with this, found `color: {coloring:?}`");
            return refuse(place.clone(), message);
        }
        Some(Self {
            name: cloud.file.value.as_ref()?.0.clone(),
            place: cloud.file.place.clone(),
            material,
            request: Request {
                radius: optional(&cloud.radius, |radius| Some(radius.0))?,
                radii: cloud.radii.get()?,
                coloring: coloring.or(scale_place.map(|_| Coloring::Value)),
                value,
                has_material: cloud.material.is_some(),
            },
            colormap: optional(&cloud.colormap, |colormap| Some(*colormap))?.unwrap_or_default(),
            range: optional(&cloud.range, |range| Some(*range))?,
            placement: Placement {
                is_centered: cloud.center.get()?.0,
                is_right_handed: cloud.right_handed.get()?.0,
                scale: cloud.scale.get()?.0,
                turn: turn(cloud.rotate_degrees.get()?.0),
                position: cloud.position.get()?.0,
            },
        })
    }

    /// Reads the table and adds its spheres to the world; returns their range.
    pub(crate) fn add_to(
        &self,
        world: &mut World,
        folder: &Path,
        watch: &dyn Fn(Progress<'_>),
    ) -> Result<Range<usize>, CloudError> {
        let path = folder.join(&self.name);
        let table = Path::new(&self.name);
        let watch = |read, size| watch(Progress { table, read, size });
        let rows = match table::read(&path, &self.request, &watch) {
            Ok(rows) => rows,
            Err(TableError::Fault(fault)) => return Err(CloudError::Table(path, fault)),
            Err(error) => return Err(self.refused(self.explain(&path, &error))),
        };
        let Rows { mut spheres, paint } = rows;
        if !self.placement.place(&mut spheres) {
            let message = "expected finite spheres with radii greater than 0 after `scale`, \
                           `rotate_degrees` and `position`, found others";
            return Err(self.refused(message.to_owned()));
        }
        let first = world.spheres().len();
        let all = first..first + spheres.len();
        world.add_spheres(spheres, self.material, self.albedos(paint));
        Ok(all)
    }

    fn refused(&self, message: String) -> CloudError {
        CloudError::Scene(Fault::new(self.place.clone(), message))
    }

    /// The reason for which there is no table at `path`.
    fn explain(&self, path: &Path, error: &TableError) -> String {
        let name = quoted(&self.name);
        let error = match error {
            TableError::Fault(fault) => return fault.message.clone(),
            TableError::UnknownFormat => {
                let endings = table::ENDINGS.map(|ending| format!("`.{ending}`"));
                let endings = list(&endings);
                return format!(
                    "expected the name of a table that ends in {endings}, found {name}"
                );
            }
            TableError::OutOfMemory(count) => {
                return format!("expected a table that fits into memory, found {count} rows");
            }
            TableError::Unreadable(error) => error,
        };
        match error.kind() {
            io::ErrorKind::NotFound => {
                let message = format!("expected a table, found no file {name}");
                match self.neighbor(path) {
                    Some(other) => format!("{message}, did you mean {}?", quoted(&other)),
                    None => message,
                }
            }
            io::ErrorKind::IsADirectory => format!("expected a table, found the folder {name}"),
            io::ErrorKind::PermissionDenied => {
                format!("expected a table, found {name}, which nobody here may read")
            }
            _ => {
                let why = reason(error);
                format!("expected a table, found {name}, which cannot be read: {why}")
            }
        }
    }

    /// The name of a file beside `path` that is probably meant.
    fn neighbor(&self, path: &Path) -> Option<String> {
        const MOST_COMPARED: usize = 10_000;
        let entries = fs::read_dir(path.parent()?).ok()?.take(MOST_COMPARED);
        let mut names: Vec<String> = entries
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .collect();
        names.sort_unstable();
        let names = names.iter().map(String::as_str);
        let close = closest(path.file_name()?.to_str()?, names)?;
        let close = Path::new(&self.name).with_file_name(close);
        Some(close.display().to_string())
    }

    /// The colors of the spheres; `None` for those that have their material's.
    fn albedos(&self, paint: Paint) -> Option<Albedos> {
        match paint {
            Paint::Material => None,
            Paint::Colors(colors) => Some(Albedos::Each(colors)),
            Paint::Elements(indices) => Some(Albedos::Palette {
                colors: table::element_colors(),
                indices,
            }),
            Paint::Values(values) => {
                let all = || values.iter().copied();
                let (low, high) = match self.range {
                    Some(range) => (range.low, range.high),
                    None => (
                        all().fold(f64::INFINITY, f64::min),
                        all().fold(f64::NEG_INFINITY, f64::max),
                    ),
                };
                let index = |value: &f64| table::color_index(*value, low, high);
                Some(Albedos::Palette {
                    colors: self.colormap.colors(),
                    indices: values.par_iter().map(index).collect(),
                })
            }
        }
    }
}
