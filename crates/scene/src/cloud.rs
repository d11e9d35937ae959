//! Clouds: the spheres of tables, placed in the world.

use std::fs;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

use glam::{DMat3, DVec3};
use marbles_core::{Albedos, Angle, MaterialId, Sphere, World};
use rayon::prelude::*;

use crate::assemble::quoted;
use crate::fault::{Fault, report};
use crate::file;
use crate::framing;
use crate::scene::Progress;
use crate::suggest::{closest, list};
use crate::table::{self, Coloring, Colormap, Paint, Request, Rows, TableError, TableFault};

/// A cloud of the scene file whose table is not yet read.
#[derive(Clone, Debug)]
pub(crate) struct Cloud {
    /// The table as the file names it.
    pub(crate) name: String,
    /// Where the file names it, in bytes of its text.
    pub(crate) place: Range<usize>,
    material: MaterialId,
    request: Request,
    colormap: Colormap,
    range: Option<file::ValueRange>,
    placement: Placement,
}

/// Why a table was refused.
#[derive(Debug)]
pub(crate) enum CloudError {
    /// What the scene file says of it is wrong.
    Scene(Fault),
    /// Something is wrong in the table with this path.
    Table(PathBuf, TableFault),
}

/// Where a cloud is put, step by step.
#[derive(Clone, Copy, Debug)]
struct Placement {
    is_centered: bool,
    is_right_handed: bool,
    scale: f64,
    turn: Option<DMat3>,
    position: DVec3,
}

impl Cloud {
    /// The cloud that the file describes; `None` where a fault was reported.
    pub(crate) fn new(cloud: &file::Cloud, material: MaterialId) -> Option<Self> {
        let value = match &cloud.value {
            Some(name) => Some(name.value.as_ref()?.0.clone()),
            None => None,
        };
        let color = match &cloud.color {
            Some(color) => Some(color.get()?),
            None => None,
        };
        let scale_place = cloud.colormap.as_ref().map(|colormap| &colormap.place);
        let scale_place = scale_place.or(cloud.range.as_ref().map(|range| &range.place));
        let scale_place = scale_place.or(cloud.value.as_ref().map(|name| &name.place));
        if let (Some(place), Some(color)) = (scale_place, color)
            && color != Coloring::Value
        {
            let message = format!("expected `color: Value` with this, found `color: {color:?}`");
            report(Fault::new(place.clone(), message));
            return None;
        }
        Some(Self {
            name: cloud.file.value.as_ref()?.0.clone(),
            place: cloud.file.place.clone(),
            material,
            request: Request {
                radius: match &cloud.radius {
                    Some(radius) => Some(radius.get()?.0),
                    None => None,
                },
                radii: cloud.radii.get()?,
                coloring: color.or(scale_place.map(|_| Coloring::Value)),
                value,
                has_material: cloud.material.is_some(),
            },
            colormap: match &cloud.colormap {
                Some(colormap) => colormap.get()?,
                None => Colormap::default(),
            },
            range: match &cloud.range {
                Some(range) => Some(range.get()?),
                None => None,
            },
            placement: Placement {
                is_centered: cloud.center.get()?.0,
                is_right_handed: cloud.right_handed.get()?.0,
                scale: cloud.scale.get()?.0,
                turn: turn(cloud.rotate_degrees.get()?.0),
                position: cloud.position.get()?.0,
            },
        })
    }

    /// Reads the table and adds its spheres to the world; which ones these are.
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

    /// Why there is no table at `path`.
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
            _ => format!("expected a table, found {name}, which cannot be read: {error}"),
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
        let close = closest(
            path.file_name()?.to_str()?,
            names.iter().map(String::as_str),
        )?;
        Some(
            Path::new(&self.name)
                .with_file_name(close)
                .display()
                .to_string(),
        )
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
                let (low, high) = match self.range {
                    Some(range) => (range.low, range.high),
                    None => values
                        .iter()
                        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                            (low.min(*value), high.max(*value))
                        }),
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

impl Placement {
    /// Puts spheres to their place; whether they are still finite and have radii.
    fn place(&self, spheres: &mut [Sphere]) -> bool {
        let middle = match self.is_centered {
            true => framing::bounds(spheres).map_or(DVec3::ZERO, |bounds| bounds.middle()),
            false => DVec3::ZERO,
        };
        let is_as_it_is = middle == DVec3::ZERO
            && !self.is_right_handed
            && self.scale == 1.0
            && self.turn.is_none()
            && self.position == DVec3::ZERO;
        if is_as_it_is {
            return true;
        }
        let mut axes = DVec3::splat(self.scale);
        if self.is_right_handed {
            axes.z = -axes.z;
        }
        spheres.par_iter_mut().all(|sphere| {
            let mut center = (sphere.center() - middle) * axes;
            if let Some(turn) = self.turn {
                center = turn * center;
            }
            let placed = Sphere::new(center + self.position, sphere.radius() * self.scale);
            placed.map(|placed| *sphere = placed).is_ok()
        })
    }
}

/// The turn about x by the first angle, then about y, then about z; `None` for no turn.
///
/// Positive angles lead from y to z, from z to x, and from x to y.
fn turn(degrees: DVec3) -> Option<DMat3> {
    if degrees == DVec3::ZERO {
        return None;
    }
    let [x, y, z] = degrees.to_array().map(Angle::from_degrees);
    let about_x = DMat3::from_cols(
        DVec3::X,
        DVec3::new(0.0, x.cos, x.sin),
        DVec3::new(0.0, -x.sin, x.cos),
    );
    let about_y = DMat3::from_cols(
        DVec3::new(y.cos, 0.0, -y.sin),
        DVec3::Y,
        DVec3::new(y.sin, 0.0, y.cos),
    );
    let about_z = DMat3::from_cols(
        DVec3::new(z.cos, z.sin, 0.0),
        DVec3::new(-z.sin, z.cos, 0.0),
        DVec3::Z,
    );
    Some(about_z * about_y * about_x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_go_from_axis_to_axis() {
        let turned = |x, y, z, vector: DVec3| turn(DVec3::new(x, y, z)).unwrap() * vector;
        assert_eq!(turned(90.0, 0.0, 0.0, DVec3::Y), DVec3::Z);
        assert_eq!(turned(0.0, 90.0, 0.0, DVec3::Z), DVec3::X);
        assert_eq!(turned(0.0, 0.0, 90.0, DVec3::X), DVec3::Y);
        // First about x, then about z.
        assert_eq!(turned(90.0, 0.0, 90.0, DVec3::Y), DVec3::Z);
        assert_eq!(turned(90.0, 0.0, 90.0, DVec3::X), DVec3::Y);
        assert!(turn(DVec3::ZERO).is_none());
    }

    #[test]
    fn placing_centers_mirrors_scales_turns_and_moves() {
        let sphere = |x, y, z, radius| Sphere::new(DVec3::new(x, y, z), radius).unwrap();
        let mut spheres = [sphere(0.0, 0.0, 0.0, 1.0), sphere(9.0, 0.0, 4.0, 2.0)];
        let placement = Placement {
            is_centered: true,
            is_right_handed: true,
            scale: 2.0,
            turn: turn(DVec3::new(0.0, 90.0, 0.0)),
            position: DVec3::new(100.0, 0.0, 0.0),
        };
        assert!(placement.place(&mut spheres));
        // The box is from (-1, -2, -1) to (11, 2, 6).
        assert_eq!(spheres[0], sphere(105.0, 0.0, 10.0, 2.0));
        assert_eq!(spheres[1], sphere(97.0, 0.0, -8.0, 4.0));
        let mut tiny = [sphere(0.0, 0.0, 0.0, 1e-300)];
        let scale = 1e-300;
        assert!(!Placement { scale, ..placement }.place(&mut tiny));
    }
}
