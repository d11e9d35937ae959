//! The box of a data file of LAMMPS.
//!
//! # Source
//! The documentation of LAMMPS, `read_data` and `Howto triclinic`.

use glam::{DMat3, DVec3};

use super::cell::{Cell, ToldCell};
use super::number::parse;
use crate::text::LocatedFault;

/// What the lines of a data file say of its box, as far as they were read.
#[derive(Debug, Default)]
pub(super) struct SimulationBox {
    /// The lower and the upper bound along each axis.
    bounds: [Option<[f64; 2]>; 3],
    /// How far the edges b and c lean: b along x, c along x, c along y.
    tilt: [f64; 3],
    /// The edges of a box in any direction, and its corner.
    vectors: [Option<DVec3>; 4],
    /// The first line about the box, and its number.
    line: Option<(u64, Vec<u8>)>,
}

impl SimulationBox {
    /// Reads a line, of which these are the words, if it says something of the box.
    pub(super) fn read(&mut self, words: &[&[u8]], (number, line): (u64, &[u8])) {
        const BOUNDS: [[&[u8]; 2]; 3] = [[b"xlo", b"xhi"], [b"ylo", b"yhi"], [b"zlo", b"zhi"]];
        const VECTORS: [&[&[u8]]; 4] = [&[b"avec"], &[b"bvec"], &[b"cvec"], &[b"abc", b"origin"]];
        let numbers: Vec<f64> = words.iter().map_while(|word| parse(word, false)).collect();
        let names = &words[numbers.len()..];

        let axis = BOUNDS.iter().position(|known| known[..] == *names);
        let vector = VECTORS.iter().position(|known| *known == names);
        match (numbers[..].try_into(), axis) {
            (Ok(bounds), Some(axis)) => self.bounds[axis] = Some(bounds),
            _ => match (numbers[..].try_into(), vector) {
                (Ok(edge), Some(vector)) => self.vectors[vector] = Some(DVec3::from_array(edge)),
                (Ok(tilt), None) if names == [b"xy", b"xz", b"yz"] => self.tilt = tilt,
                _ => return,
            },
        }

        self.line.get_or_insert_with(|| (number, line.to_vec()));
    }

    /// The cell, where the lines tell all of it. It repeats along all edges: the file does not say otherwise.
    pub(super) fn cell(&self) -> Option<ToldCell> {
        let (edges, origin) = match (self.vectors, self.bounds) {
            ([Some(a), Some(b), Some(c), Some(origin)], _) => (DMat3::from_cols(a, b, c), origin),
            (_, [Some(x), Some(y), Some(z)]) => {
                let [xy, xz, yz] = self.tilt;
                let edges = DMat3::from_cols(
                    DVec3::new(x[1] - x[0], 0.0, 0.0),
                    DVec3::new(xy, y[1] - y[0], 0.0),
                    DVec3::new(xz, yz, z[1] - z[0]),
                );
                (edges, DVec3::new(x[0], y[0], z[0]))
            }
            _ => return None,
        };
        let (number, line) = self.line.as_ref()?;
        let fault = |message| LocatedFault::in_line(*number, line, 0..line.len(), message);
        Some(Cell::new(edges, origin).map_err(fault))
    }
}
