//! Facts about a table that is open.

use super::super::format::Format;
use super::Frames;

impl Frames<'_> {
    /// True of formats of simulations, in whose tables z usually points up.
    pub(crate) fn has_z_up(&self) -> bool {
        matches!(
            self.format,
            Format::Lammps
                | Format::LammpsData
                | Format::Gro
                | Format::Gsd
                | Format::Xtc
                | Format::Dcd
        )
    }

    /// True of a table that lists the atoms of a crystal's cell, after a frame was read.
    pub(crate) fn is_crystal(&self) -> bool {
        let header = self.previous.as_ref();
        self.format == Format::Vasp || header.is_some_and(|header| header.crystal.is_some())
    }

    /// True of a table that has nothing but the positions of atoms.
    pub(crate) fn is_trajectory(&self) -> bool {
        self.trajectory.is_some()
    }

    /// The name of the format.
    pub(crate) fn format(&self) -> &'static str {
        self.format.name()
    }

    /// True of lines that are stored as they are.
    pub(crate) fn is_plain_text(&self) -> bool {
        let is_binary = matches!(
            self.format,
            Format::Npy
                | Format::Npz
                | Format::Ply
                | Format::Pvd
                | Format::Vtk
                | Format::VtkXml
                | Format::Gsd
        );
        !is_binary && self.trajectory.is_none() && self.input.can_seek()
    }

    /// The length of an ångström, in the unit of the frame that was read.
    pub(crate) fn angstrom(&self) -> f64 {
        let header = self.previous.as_ref();
        header.map_or(1.0, |header| header.angstrom)
    }
}
