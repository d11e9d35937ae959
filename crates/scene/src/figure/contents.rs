//! The contents of a table, as far as a figure depends on them.

use std::path::Path;
use std::sync::Arc;

use glam::DVec3;
use marbles_core::Sphere;

use super::colors::{self, Colors};
use super::reader::{Reader, first, ignoring_positions};
use super::spacing;
use crate::table::{
    Coloring, ColumnRef, Columns, Paint, Periodic, Radii, Request, has_axis, tells_radius,
};

/// The contents of a table, as far as a figure depends on them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Contents {
    /// The spheres in the axes of the scene, of the first frame.
    pub(super) spheres: Vec<Sphere>,
    /// The columns of positions and radii, as the scene file names them, if their names do not tell them.
    pub(super) columns: Option<&'static str>,
    /// The radius of spheres that have none in the table.
    pub(super) radius: Option<f64>,
    /// The colors, if the table has neither elements nor colors.
    pub(super) colors: Option<Colors>,
    /// The table tells the colors of spheres, or their elements.
    pub(super) is_colored: bool,
    /// In the table, z points up.
    pub(super) has_z_up: bool,
    /// The axes are right-handed.
    pub(super) is_right_handed: bool,
    /// The table has nothing but the positions of atoms.
    pub(super) is_trajectory: bool,
    /// The table lists the atoms of a crystal's cell.
    pub(super) is_crystal: bool,
    /// The table has a cell that can be repeated.
    pub(super) has_cell: bool,
    /// The table has frames after the first.
    pub(super) has_more: bool,
}

impl Contents {
    /// Reads the first frame of the table at `path`; of a table that cannot be read, nothing is known.
    pub(super) fn read(path: &Path) -> Self {
        // Loading the scene tells what is wrong in the table, and not that it has no radii.
        Self::try_read(path).unwrap_or_else(|| Self {
            radius: Some(1.0),
            ..Self::default()
        })
    }

    fn try_read(path: &Path) -> Option<Self> {
        let (facts, names) = first(path, &ignoring_positions())?;
        let is_crystal = facts.is_crystal;
        let has_elements = names.element_column.is_some();
        let names = names.columns;
        let layout = Layout::of(path, &names);
        let has_radii = has_elements || tells_radius(&names) || layout.has_radius();
        let request = Request {
            radius: (!has_radii).then_some(1.0),
            radii: match is_crystal {
                true => Radii::Covalent,
                false => Radii::default(),
            },
            periodic: Periodic {
                shows_edges: is_crystal,
                ..Periodic::default()
            },
            columns: layout.columns(),
            ..Request::default()
        };
        let Some((facts, rows)) = first(path, &request) else {
            // Loading the scene tells what is wrong in the rows.
            return Some(Self {
                columns: layout.text(),
                radius: request.radius,
                is_crystal,
                ..Self::default()
            });
        };
        let is_colored = !matches!(rows.paint, Paint::Material);
        let radius = (!has_radii).then(|| spacing::radius(&rows.spheres));
        let is_right_handed = rows.is_right_handed;
        let has_cell = matches!(rows.cell, Some(Ok(_)));
        let mut spheres = rows.spheres;
        for sphere in &mut spheres {
            let center = in_scene(sphere.center(), is_right_handed, facts.has_z_up);
            *sphere = Sphere::new(center, radius.unwrap_or(sphere.radius())).ok()?;
        }
        let reader = Reader {
            path,
            names: &names,
            used: layout.used(),
        };
        Some(Self {
            spheres,
            columns: layout.text(),
            radius,
            colors: (!is_colored).then(|| colors::choose(&reader)).flatten(),
            is_colored,
            has_z_up: facts.has_z_up,
            is_right_handed,
            is_trajectory: facts.is_trajectory,
            is_crystal,
            has_cell,
            has_more: facts.has_more,
        })
    }

    /// The median of the radii; `None` without spheres.
    pub(super) fn typical_radius(&self) -> Option<f64> {
        let mut radii: Vec<f64> = self.spheres.iter().map(Sphere::radius).collect();
        let middle = radii.len() / 2;
        let is_empty = radii.is_empty();
        (!is_empty).then(|| *radii.select_nth_unstable_by(middle, f64::total_cmp).1)
    }
}

/// The columns of positions and radii.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Layout {
    /// Their names tell them.
    Named,
    /// There is no z.
    Flat,
    /// Columns without names: x and y; x, y and z; or these and the radius.
    Numbered(usize),
}

impl Layout {
    fn of(path: &Path, names: &Arc<Vec<String>>) -> Self {
        let axes = [0, 1, 2].map(|axis| has_axis(names, axis));
        match axes {
            [true, true, false] => return Self::Flat,
            [true, ..] => return Self::Named,
            _ => {}
        }
        if !names.iter().all(|name| name.parse::<u32>().is_ok()) {
            return Self::Named;
        }
        match names.len() {
            0 | 1 => Self::Named,
            2 => Self::Numbered(2),
            4 if is_radius(path) => Self::Numbered(4),
            _ => Self::Numbered(3),
        }
    }

    fn has_radius(self) -> bool {
        self == Self::Numbered(4)
    }

    /// The fields of a scene file's `columns`.
    fn text(self) -> Option<&'static str> {
        match self {
            Self::Named => None,
            Self::Flat => Some("z: 0.0"),
            Self::Numbered(2) => Some("x: 1, y: 2, z: 0.0"),
            Self::Numbered(4) => Some("x: 1, y: 2, z: 3, radius: 4"),
            Self::Numbered(_) => Some("x: 1, y: 2, z: 3"),
        }
    }

    /// The same for a request.
    fn columns(self) -> Columns {
        let flat = || Some(ColumnRef::Constant(0.0));
        let number = |number| Some(ColumnRef::Number(number));
        let (position, radius) = match self {
            Self::Named => ([None, None, None], None),
            Self::Flat => ([None, None, flat()], None),
            Self::Numbered(2) => ([number(1), number(2), flat()], None),
            Self::Numbered(4) => ([number(1), number(2), number(3)], number(4)),
            Self::Numbered(_) => ([number(1), number(2), number(3)], None),
        };
        Columns {
            position,
            radius,
            ..Columns::default()
        }
    }

    /// The numbers of the columns that are positions or radii.
    fn used(self) -> &'static [usize] {
        match self {
            Self::Named | Self::Flat => &[],
            Self::Numbered(2) => &[1, 2],
            Self::Numbered(4) => &[1, 2, 3, 4],
            Self::Numbered(_) => &[1, 2, 3],
        }
    }
}

/// Says whether the fourth of four columns without names may hold radii: all numbers are greater than 0, and small
/// beside the extent of the positions.
fn is_radius(path: &Path) -> bool {
    let request = Request {
        columns: Layout::Numbered(4).columns(),
        coloring: Some(Coloring::Material),
        ..Request::default()
    };
    let Some((_, rows)) = first(path, &request) else {
        return false;
    };
    let (mut low, mut high, mut largest) = (DVec3::INFINITY, DVec3::NEG_INFINITY, 0.0f64);
    for sphere in &rows.spheres {
        low = low.min(sphere.center());
        high = high.max(sphere.center());
        largest = largest.max(sphere.radius());
    }
    2.0 * largest <= (high - low).max_element()
}

/// A point of a table in the axes of the scene, as the cloud places it.
fn in_scene(center: DVec3, is_right_handed: bool, has_z_up: bool) -> DVec3 {
    let DVec3 { x, y, z } = center;
    match (is_right_handed, has_z_up) {
        (true, true) => DVec3::new(x, z, y),
        (true, false) => DVec3::new(x, y, -z),
        (false, true) => DVec3::new(x, z, -y),
        (false, false) => center,
    }
}
