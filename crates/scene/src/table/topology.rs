//! The atoms of a trajectory, as another table tells them: everything but where they are.

use std::sync::Arc;

use glam::DVec3;
use marbles_core::Sphere;

use super::columns::{Test, axis_of};
use super::error::TableError;
use super::frames::Frames;
use super::other_file::{OtherFile, OtherName};
use super::paint::Paint;
use super::request::{Coloring, ColumnRef, Columns, Missing, Periodic, Request, Value};
use super::rows::Rows;
use super::trajectory::damaged;
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
    ) -> Result<(Self, OtherFile), TableError> {
        let in_table = |error| TableError::InOther(named.clone(), Box::new(error));
        let own = Self::try_read(named, request, angstrom);
        own.map_err(|error| match error {
            TableError::InTopology(_) => error,
            error => in_table(error),
        })
    }

    fn try_read(
        named: &OtherName,
        request: &Request,
        angstrom: f64,
    ) -> Result<(Self, OtherFile), TableError> {
        let names = names(named)?;
        let axis = |column: &ColumnRef| axis_of(&names, column);
        let (of_positions, keep): (Vec<_>, Vec<_>) = request
            .keep
            .iter()
            .cloned()
            .partition(|filter| axis(&filter.column).is_some());
        let filters = of_positions
            .into_iter()
            .filter_map(|filter| Some((axis(&filter.column)?, filter.test)));
        let value = match &request.value {
            Some(Value::Column(column)) => axis(column),
            Some(Value::Length(columns)) if columns.iter().any(|column| axis(column).is_some()) => {
                let message = "expected columns of the topology in `Length`, found the positions of a trajectory";
                return Err(TableError::InTopology(message.to_owned()));
            }
            _ => None,
        };
        if value.is_some() && !matches!(request.coloring, None | Some(Coloring::Value)) {
            let message =
                "expected `color: Value` for the positions of a trajectory, found another coloring";
            return Err(TableError::InTopology(message.to_owned()));
        }
        if request.columns.radius.as_ref().and_then(axis).is_some() {
            let message = "expected a column of the topology for `radius`, found the positions of a trajectory";
            return Err(TableError::InTopology(message.to_owned()));
        }
        let of_atoms = Request {
            columns: Columns {
                position: nowhere(),
                ..request.columns.clone()
            },
            coloring: match value {
                Some(_) => Some(Coloring::Material),
                None => request.coloring,
            },
            value: request.value.clone().filter(|_| value.is_none()),
            keep,
            periodic: Periodic::default(),
            has_places: true,
            ..request.clone()
        };
        let mut position = [0, 1, 2].map(Source::Axis);
        for (source, chosen) in position.iter_mut().zip(&request.columns.position) {
            match chosen {
                None => {}
                Some(ColumnRef::Constant(number)) => *source = Source::Constant(*number),
                Some(column) => match axis(column) {
                    Some(axis) => *source = Source::Axis(axis),
                    None => {
                        let message = "expected `x`, `y`, `z` or constants for the positions of a trajectory, found another column";
                        return Err(TableError::InTopology(message.to_owned()));
                    }
                },
            }
        }
        let mut frames = Frames::open(&named.path, &|_, _| {})?;
        let rows = frames.read(&of_atoms)?;
        let mut rows = rows.ok_or_else(|| damaged("expected a frame, found none".into()))?;
        if rows.places.len() != rows.spheres.len()
            || rows
                .kept
                .is_some_and(|kept| kept != rows.spheres.len() as u64)
        {
            let message = "expected a row for each atom, found the atoms of a crystal, which follow from its symmetry";
            return Err(damaged(message.to_owned()));
        }
        let has_own_unit = request.radius.is_some()
            || matches!(request.columns.radius, Some(ColumnRef::Constant(_)));
        let factor = angstrom / frames.angstrom();
        if !has_own_unit && factor != 1.0 {
            for sphere in &mut rows.spheres {
                *sphere = Sphere::new(DVec3::ZERO, sphere.radius() * factor).map_err(|_| {
                    TableError::InTopology("expected finite radii, found others".into())
                })?;
            }
        }
        rows.remarks.file = Some(Arc::from(&*named.path));
        frames.finish()?;
        let file = OtherFile {
            path: named.path.clone(),
            state: frames.state(),
            doubts: frames.take_doubts(),
        };
        let topology = Self {
            name: named.name.clone(),
            position,
            filters: filters.collect(),
            value: value.map(|axis| (axis, AXES[axis])),
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

/// The names of the columns of a table.
fn names(named: &OtherName) -> Result<Arc<Vec<String>>, TableError> {
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
    let mut frames = Frames::open(&named.path, &|_, _| {})?;
    let rows = frames.read(&request)?;
    Ok(rows.map(|rows| rows.columns).unwrap_or_default())
}

/// Columns of positions in which nothing is read.
fn nowhere() -> [Option<ColumnRef>; 3] {
    [(); 3].map(|()| Some(ColumnRef::Constant(0.0)))
}
