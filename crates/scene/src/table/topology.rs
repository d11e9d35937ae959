//! The atoms of a trajectory, as another table tells them: everything but where they are.

use std::sync::Arc;

use glam::DVec3;
use marbles_core::Sphere;

use super::columns::{Test, axis_of};
use super::error::TableError;
use super::frame::damaged;
use super::other_file::{OtherFile, OtherName};
use super::other_table::{OtherTable, ReadOther};
use super::paint::Paint;
use super::request::{Coloring, ColumnRef, Columns, Missing, Periodic, Request, Value};
use super::rows::Rows;
use crate::text::quoted;

/// The atoms of a trajectory.
pub(crate) struct Topology {
    /// The name of the table.
    name: String,
    /// The atoms that are kept, by all conditions on other columns than positions, with their radii in the trajectory's unit.
    rows: Rows,
    /// The sources of x, y and z.
    position: [Source; 3],
    /// The conditions on positions.
    filters: Vec<(usize, Test)>,
    /// The axis whose positions a colormap turns into colors, and the name of its column.
    value: Option<(usize, &'static str)>,
}

/// The source of a coordinate.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// The position along an axis.
    Axis(usize),
    Constant(f64),
}

const AXES: [&str; 3] = ["x", "y", "z"];

impl Topology {
    /// Reads the first frame of a table for trajectories in whose unit an ångström has this length.
    pub(super) fn read(
        named: &OtherName,
        request: &Request,
        angstrom: f64,
        read_other: ReadOther,
    ) -> Result<(Self, OtherFile), TableError> {
        let in_table = |error| TableError::InOther(named.clone(), Box::new(error));
        let own = Self::try_read(named, request, angstrom, read_other);
        own.map_err(|error| match error {
            TableError::InTopology(_) => error,
            error => in_table(error),
        })
    }

    fn try_read(
        named: &OtherName,
        request: &Request,
        angstrom: f64,
        read_other: ReadOther,
    ) -> Result<(Self, OtherFile), TableError> {
        let division = Division::of(request, &names(named, read_other)?)?;
        let table = read_other(named, &division.of_atoms)?;
        let OtherTable { mut rows, file, .. } = table;
        let count = rows.spheres.len();
        if rows.places.len() != count || rows.kept.is_some_and(|kept| kept != count as u64) {
            let message = "expected a row for each atom, found the atoms of a crystal, which follow from its symmetry";
            return Err(damaged(message.to_owned()));
        }
        let has_own_unit = request.radius.is_some()
            || matches!(request.columns.radius, Some(ColumnRef::Constant(_)));
        let factor = angstrom / table.angstrom;
        if !has_own_unit && factor != 1.0 {
            for sphere in &mut rows.spheres {
                let scaled = Sphere::new(DVec3::ZERO, sphere.radius() * factor);
                *sphere = scaled.map_err(|_| refused("expected finite radii, found others"))?;
            }
        }
        rows.remarks.file = Some(Arc::from(&*named.path));
        let topology = Self {
            name: named.name.clone(),
            position: division.position,
            filters: division.filters,
            value: division.value.map(|axis| (axis, AXES[axis])),
            rows,
        };
        Ok((topology, file))
    }

    /// The atoms that are kept of this frame, counted from 1, where they are in it.
    pub(super) fn rows(&self, positions: &[[f32; 3]], frame: u64) -> Result<Rows, TableError> {
        let (count, found) = (self.rows.read, positions.len());
        if count != found as u64 {
            let name = quoted(&self.name);
            return Err(damaged(format!(
                "expected as many atoms as in the topology {name}, {count}, found {found} in frame {frame}"
            )));
        }
        let mut rows = self.rows.clone();
        let mut values = Vec::new();
        let place = |atom: u64| {
            positions
                .get(atom as usize)
                .map(|place| place.map(f64::from))
        };
        let is_kept = |place: &[f64; 3]| {
            let mut filters = self.filters.iter();
            filters.all(|(axis, test)| test.holds(place[*axis]))
        };
        if !self.filters.is_empty() {
            let atoms = self.rows.places.iter();
            let kept: Vec<bool> = atoms
                .map(|atom| place(*atom).is_some_and(|place| is_kept(&place)))
                .collect();
            rows.retain(&kept);
        }
        for (sphere, atom) in rows.spheres.iter_mut().zip(&rows.places) {
            let place = place(*atom).unwrap_or_default();
            let center = self.position.map(|source| match source {
                Source::Axis(axis) => place[axis],
                Source::Constant(number) => number,
            });
            let moved = Sphere::new(DVec3::from_array(center), sphere.radius());
            *sphere = moved.map_err(|_| {
                let [x, y, z] = place;
                damaged(format!(
                    "expected finite positions, found ({x}, {y}, {z}) for atom {} in frame {frame}",
                    atom + 1
                ))
            })?;
            if let Some((axis, _)) = self.value {
                values.push(place[axis]);
            }
        }
        if let Some((_, name)) = self.value {
            rows.paint = Paint::Values(values);
            rows.value_name = Some(name.to_owned());
        }
        Ok(rows)
    }
}

/// A request for a trajectory, divided into what concerns its positions and the rest.
struct Division {
    /// The request for the topology.
    of_atoms: Request,
    position: [Source; 3],
    filters: Vec<(usize, Test)>,
    value: Option<usize>,
}

impl Division {
    /// Divides a request for a trajectory whose topology has columns of these names.
    fn of(request: &Request, names: &Arc<Vec<String>>) -> Result<Self, TableError> {
        let axis = |column: &ColumnRef| axis_of(names, column);
        let value = match &request.value {
            Some(Value::Column(column)) => axis(column),
            Some(Value::Length(columns)) if columns.iter().any(|column| axis(column).is_some()) => {
                return Err(refused(
                    "expected columns of the topology in `Length`, found the positions of a trajectory",
                ));
            }
            _ => None,
        };
        if value.is_some() && !matches!(request.coloring, None | Some(Coloring::Value)) {
            return Err(refused(
                "expected `color: Value` for the positions of a trajectory, found another coloring",
            ));
        }
        if request.columns.radius.as_ref().and_then(axis).is_some() {
            return Err(refused(
                "expected a column of the topology for `radius`, found the positions of a trajectory",
            ));
        }
        let mut position = [0, 1, 2].map(Source::Axis);
        for (source, chosen) in position.iter_mut().zip(&request.columns.position) {
            *source = match chosen {
                None => continue,
                Some(ColumnRef::Constant(number)) => Source::Constant(*number),
                Some(column) => Source::Axis(axis(column).ok_or_else(|| {
                    refused(
                        "expected `x`, `y`, `z` or constants for the positions of a trajectory, found another column",
                    )
                })?),
            };
        }
        let mut of_atoms = Request {
            value: request.value.clone().filter(|_| value.is_none()),
            keep: Vec::new(),
            periodic: Periodic::default(),
            has_places: true,
            ..request.clone()
        };
        of_atoms.columns.position = nowhere();
        if value.is_some() {
            of_atoms.coloring = Some(Coloring::Material);
        }
        let mut filters = Vec::new();
        for filter in &request.keep {
            match axis(&filter.column) {
                Some(axis) => filters.push((axis, filter.test.clone())),
                None => of_atoms.keep.push(filter.clone()),
            }
        }
        Ok(Self {
            of_atoms,
            position,
            filters,
            value,
        })
    }
}

fn refused(message: &str) -> TableError {
    TableError::InTopology(message.to_owned())
}

/// The names of the columns of a table.
fn names(named: &OtherName, read_other: ReadOther) -> Result<Arc<Vec<String>>, TableError> {
    let request = Request {
        radius: Some(1.0),
        coloring: Some(Coloring::Material),
        columns: Columns {
            position: nowhere(),
            ..Columns::default()
        },
        missing: Missing::Hide,
        ..Request::default()
    };
    Ok(read_other(named, &request)?.rows.columns)
}

/// Columns of positions in which nothing is read.
fn nowhere() -> [Option<ColumnRef>; 3] {
    [(); 3].map(|()| Some(ColumnRef::Constant(0.0)))
}
