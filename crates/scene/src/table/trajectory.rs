//! Trajectories: the positions of the same atoms, frame after frame. Another table may tell the rest of the atoms.

use std::borrow::Cow;

use super::array::Column;
use super::error::TableError;
use super::frame::Frame;
use super::input::Input;
use super::kind::{Kind, Number};
use super::other_file::{OtherFile, OtherName};
use super::other_table::ReadOther;
use super::request::Request;
use super::rows::Rows;
use super::topology::Topology;
use super::{binary, dcd, xtc};
use crate::text::LocatedFault;

/// A trajectory that is open.
pub(crate) struct Trajectory {
    kind: TrajectoryKind,
    /// The table that tells the atoms, as it is called and where it is.
    topology: Option<OtherName>,
    /// What it tells, once it was read.
    atoms: Option<Topology>,
}

/// The format of a trajectory.
#[derive(Clone, Debug)]
pub(crate) enum TrajectoryKind {
    Xtc,
    /// Once the start of the file was read.
    Dcd(Option<dcd::File>),
}

impl Trajectory {
    pub(crate) fn new(kind: TrajectoryKind) -> Self {
        Self {
            kind,
            topology: None,
            atoms: None,
        }
    }

    /// Takes the atoms from a table.
    pub(crate) fn set_topology(&mut self, topology: OtherName) {
        self.topology = Some(topology);
    }

    /// Reads the next frame, and the atoms with the first one; `None` behind the last one. All frames are read by the same request.
    pub(crate) fn read(
        &mut self,
        input: &mut Input<'_>,
        (others, read_other): (&mut Vec<OtherFile>, ReadOther),
        request: &Request,
    ) -> Result<Option<Rows>, TableError> {
        if request.periodic.unwraps {
            let message = "expected a table with image flags for `unwrap`, found a trajectory, which has none";
            return Err(TableError::InScene(message.to_owned()));
        }
        let frame = match &mut self.kind {
            TrajectoryKind::Xtc => xtc::read(input)?,
            TrajectoryKind::Dcd(file) => Self::dcd(file, input)?.read(input)?,
        };
        let Some(frame) = frame else {
            return Ok(None);
        };
        let mut rows = match &self.topology {
            None => frame.rows(request)?,
            Some(topology) => {
                let atoms = match &self.atoms {
                    Some(atoms) => atoms,
                    None => {
                        let (atoms, file) =
                            Topology::read(topology, request, self.kind.angstrom(), read_other)?;
                        others.push(file);
                        self.atoms.insert(atoms)
                    }
                };
                atoms.rows(&frame.positions, input.number)?
            }
        };
        rows.cell = frame.cell;
        Ok(Some(rows))
    }

    /// Passes over the next frame; returns whether there was one.
    pub(crate) fn skip(&mut self, input: &mut Input<'_>) -> Result<bool, TableError> {
        match &mut self.kind {
            TrajectoryKind::Xtc => xtc::skip(input),
            TrajectoryKind::Dcd(file) => Ok(Self::dcd(file, input)?.skip(input)),
        }
    }

    /// Says whether another frame follows.
    pub(crate) fn has_more(&mut self, input: &mut Input<'_>) -> Result<bool, TableError> {
        let (position, number) = (input.position, input.number);
        let has_more = self.skip(input)?;
        input.skip_to(position, number)?;
        Ok(has_more)
    }

    /// The start of a DCD file, which is read once.
    fn dcd<'a>(
        start: &'a mut Option<dcd::File>,
        input: &mut Input<'_>,
    ) -> Result<&'a dcd::File, TableError> {
        Ok(match start {
            Some(file) => file,
            None => start.insert(dcd::File::new(input)?),
        })
    }
}

impl TrajectoryKind {
    /// The length of an ångström, in the trajectory's unit.
    fn angstrom(&self) -> f64 {
        match self {
            Self::Xtc => 0.1,
            Self::Dcd(_) => 1.0,
        }
    }
}

impl Frame {
    /// The atoms, of which nothing is known but where they are.
    fn rows(&self, request: &Request) -> Result<Rows, TableError> {
        let kind = Kind::little(Number::F32);
        let names = ["x", "y", "z"].map(String::from);
        let plan = binary::plan(names.into(), &[kind; 3], request).map_err(|message| {
            let hint =
                "(`topology: \"atoms.gro\"` names a table of the same atoms that has more columns)";
            LocatedFault::of_file(format!("{message} {hint}"))
        })?;
        let numbers = self.positions.iter().flatten();
        let bytes: Vec<u8> = numbers.flat_map(|number| number.to_le_bytes()).collect();
        let each = kind.size() as usize;
        let column = |axis: usize| Column {
            kind,
            bytes: Cow::Borrowed(&bytes),
            offset: axis * each,
            step: 3 * each,
            start: None,
        };
        binary::read_columns(&[0, 1, 2].map(column), self.positions.len() as u64, &plan)
    }
}
