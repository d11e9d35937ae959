//! Crystals in CIF: atoms at fractions of the edges of a cell, and the symmetry that makes all atoms of the cell of them.

use std::collections::HashMap;
use std::ops::Range;

use glam::DVec3;
use marbles_core::Sphere;

use super::atom_list::{AtomLine, Atoms, Listed};
use super::cell::{Cell, ToldCell};
use super::cif::{self, Group, Items, Lexer, Token};
use super::columns::{Nature, Plan, Slot};
use super::error::TableError;
use super::fields::{self, Division};
use super::form::Form;
use super::input::Input;
use super::number::{is_missing, parse};
use super::periodic::whole_cells;
use super::request::{ColumnRef, Request};
use super::rows::Rows;
use super::symmetry::Operation;
use super::text;
use crate::text::LocatedFault;

/// The atoms of a data block, as it lists them, and the symmetry between them and others.
#[derive(Debug)]
pub(crate) struct Crystal {
    atoms: Vec<AtomLine>,
    cell: ToldCell,
    operations: Vec<Operation>,
    /// What is left out or assumed.
    told: Vec<LocatedFault>,
}

/// Atoms nearer to one another than so, along each edge as a share of it, are on one place.
const SAME_PLACE: f64 = 1e-3;

/// The crystal of a data block whose loop of atoms has columns of these names; the rest of the block is read.
pub(super) fn read(
    input: &mut Input<'_>,
    mut items: Items,
    names: &[String],
) -> Result<Crystal, TableError> {
    items.end_loop();
    let mut atoms = Atoms::new(names);
    let (mut lexer, mut is_in_atoms) = (Lexer::default(), true);
    let mut text_start = 0;
    while let Some(line) = input.peek()? {
        let is_next = cif::is_block(line.trim_ascii_start());
        if !lexer.is_in_text() && is_next {
            break;
        }
        let number = input.number + 1;
        let line = input.next()?.unwrap_or_default();
        if !lexer.is_in_text() {
            text_start = number;
            if !is_in_atoms && items.is_unneeded(line) {
                continue;
            }
        }
        lexer.feed(line, |token| match token {
            Token::Value(value) if is_in_atoms => atoms.take(number, line, &value),
            token => {
                is_in_atoms = false;
                items.take(number, line, token);
            }
        });
    }
    let number = input.number + 1;
    if lexer.is_in_text() {
        let expected = format!("a line `;`, which ends the text that line {text_start} starts");
        return Err(LocatedFault::at_end(number, &expected).into());
    }
    if is_in_atoms && input.is_open_at_end() {
        input.doubt_line("the file ends within this line: its last number may have been cut off");
    }
    let atoms = atoms.finish()?;
    input.check_count(atoms.len() as u64, "rows")?;
    Ok(Crystal::new(atoms, items, number)?)
}

/// The columns of a list of atoms.
#[derive(Clone, Copy)]
pub(super) struct Columns<'a> {
    pub(super) names: &'a [String],
    pub(super) form: &'a Form,
    /// The line that names them first, for messages, and the part of it that does.
    pub(super) place: &'a (u64, Vec<u8>, Range<usize>),
}

impl Crystal {
    /// The cell, or what is wrong in it.
    pub(super) fn cell(&self) -> &ToldCell {
        &self.cell
    }

    /// The crystal of these atoms and items, in a data block that ends before this line.
    fn new(listed: Listed, items: Items, end: u64) -> Result<Self, LocatedFault> {
        let cell = items.cell().ok_or_else(|| {
            let expected = "the cell of the crystal (`_cell_length_a` to `_cell_angle_gamma`)";
            let message = format!("expected {expected} in this data block, found none");
            LocatedFault::in_line(end, b"", 0..0, message)
        })?;
        let mut told: Vec<LocatedFault> = listed.told.into_iter().collect();
        if let Some(fault) = items.fault {
            return Err(fault);
        }
        let mut operations = items.operations;
        if operations.is_empty() {
            match items.group {
                Group::P1 => {}
                Group::Unknown => {
                    let assumed = "the file tells neither symmetry operations nor a space group: the atoms that it \
                                   lists are taken as all of the cell (P 1)";
                    told.push(LocatedFault::of_file(assumed));
                }
                Group::Other(name, place) => {
                    let message = format!(
                        "expected symmetry operations (a loop of `_space_group_symop_operation_xyz`), because the \
                         space group `{name}` is not P 1, found none: write all atoms of the cell with ASE (`ase \
                         convert FILE atoms.extxyz`) or pymatgen, which know the operations of space groups"
                    );
                    return Err(LocatedFault { message, ..place });
                }
            }
            operations.push(Operation::IDENTITY);
        }
        Ok(Self {
            atoms: listed.atoms,
            cell,
            operations,
            told,
        })
    }

    /// Reads the atoms, and adds those that are equivalent to them.
    pub(super) fn read(&self, columns: Columns<'_>, request: &Request) -> Result<Rows, TableError> {
        let cell = match &self.cell {
            Ok(cell) => cell,
            Err(fault) => return Err(fault.clone().into()),
        };
        let request = with_label(columns.names, request);
        let texts = self.texts(columns.form);
        let nature = Nature {
            is_byte: &|_| false,
            is_text: &|column| texts.get(column).copied().unwrap_or(false),
            angstrom: 1.0,
            cell: None,
            edges: Some(cell.edges),
            scale: DVec3::ONE,
        };
        let plan = Plan::new(columns.names.to_vec(), &request, &nature);
        let plan = plan.map_err(|message| {
            let (number, line, span) = columns.place;
            LocatedFault::in_line(*number, line, span.clone(), message)
        })?;
        let mut rows = Rows::new(&plan);
        rows.reserve(self.atoms.len() as u64)?;
        let occupancy = columns
            .names
            .iter()
            .position(|name| name.eq_ignore_ascii_case("occupancy"));
        let mut partial = (0, None);
        let mut numbers = plan.constants;
        for AtomLine { number, line } in &self.atoms {
            if !text::is_kept(line, *number, &plan, columns.form)? {
                rows.read += 1;
                continue;
            }
            text::read_line(line, *number, &plan, columns.form, &mut numbers, &mut rows)?;
            if is_partial(line, occupancy) {
                partial.0 += 1;
                partial.1.get_or_insert((*number, line));
            }
        }
        if let (count, Some((number, line))) = partial {
            let told = format!(
                "atoms with an occupancy below 1 are shown as all others, though the crystal has some of them only in \
                 some cells: {count} in the list, of which this is the first (`keep: [(\"occupancy\", Between(0.5, 1))]` \
                 keeps those with at least one half)"
            );
            rows.remarks
                .add_guess(LocatedFault::in_line(number, line, 0..line.len(), told));
        }
        for told in &self.told {
            rows.remarks.add_guess(told.clone());
        }
        rows.kept = Some(rows.spheres.len() as u64);
        // Where places are not looked at, all are the same.
        if plan.fixed.iter().any(Option::is_none) {
            self.add_equivalent(&mut rows, cell)?;
        }
        rows.cell = Some(self.cell.clone());
        Ok(rows)
    }

    /// The columns that are no numbers in the first row.
    fn texts(&self, form: &Form) -> Vec<bool> {
        let Some(first) = self.atoms.first() else {
            return Vec::new();
        };
        let fields = fields::all(&first.line, &form.division);
        let is_text = |field: &&[u8]| parse(field, false).is_none() && !is_missing(field);
        fields.iter().map(is_text).collect()
    }

    /// Replaces the fractions of the atoms by their places, and adds the atoms that are equivalent to them.
    fn add_equivalent(&self, rows: &mut Rows, cell: &Cell) -> Result<(), TableError> {
        let has_symmetry = self.operations.len() > 1;
        let listed = std::mem::take(&mut rows.spheres);
        let mut occupied = Occupied::default();
        let (mut sources, mut shared) = (Vec::new(), 0);
        for (source, atom) in listed.iter().enumerate() {
            for operation in &self.operations {
                let mut fractions = operation.of(atom.center());
                if has_symmetry {
                    fractions -= whole_cells(fractions);
                }
                match occupied.add(fractions, source) {
                    None => {
                        let sphere = Sphere::new(cell.point(fractions), atom.radius());
                        let sphere = sphere.map_err(|_| {
                            let message = "expected finite places of atoms, found an infinite one";
                            LocatedFault::of_file(message)
                        })?;
                        rows.spheres.push(sphere);
                        sources.push(source);
                    }
                    Some(other) if other != source => shared += 1,
                    Some(_) => {}
                }
            }
        }
        rows.paint.copy(sources.into_iter());
        rows.paint.remove_first(listed.len());
        if shared > 0 {
            let told = format!(
                "atoms are left out that lie within {SAME_PLACE} of an edge from one that the file lists before, as \
                 those of disordered crystals do: {shared}"
            );
            rows.remarks.add_guess(LocatedFault::of_file(told));
        }
        Ok(())
    }
}

/// The request that takes elements from the labels of atoms, where no other column tells them.
fn with_label(names: &[String], request: &Request) -> Request {
    let mut request = request.clone();
    let is_there = |wanted: &str| names.iter().any(|name| name.eq_ignore_ascii_case(wanted));
    let mut known = Slot::Element.names().iter();
    if request.columns.element.is_none() && !known.any(|name| is_there(name)) && is_there(LABEL) {
        request.columns.element = Some(ColumnRef::Name(LABEL.to_owned()));
    }
    request
}

/// The column of the labels of atoms, which begin with symbols of elements.
const LABEL: &str = "label";

/// Says whether the crystal has the atom of a line in some cells only, by this column.
fn is_partial(line: &[u8], occupancy: Option<usize>) -> bool {
    let Some(column) = occupancy else {
        return false;
    };
    let fields = fields::all(line, &Division::QuotedWords);
    let occupancy = fields.get(column).and_then(|field| parse(field, false));
    occupancy.is_some_and(|occupancy| occupancy < 1.0 - SAME_PLACE)
}

/// The places of atoms in a cell, by the parts of the cell in which they lie.
#[derive(Default)]
struct Occupied(HashMap<[i32; 3], Vec<(DVec3, usize)>>);

impl Occupied {
    /// Parts along an edge: atoms on one place lie in the same part or in neighbors.
    const PARTS: i32 = 256;

    /// Adds an atom of this source; returns the source of one that is on the same place, in this cell or another one.
    fn add(&mut self, fractions: DVec3, source: usize) -> Option<usize> {
        let inside = fractions - fractions.floor();
        let part = |at: f64| (at * f64::from(Self::PARTS)) as i32;
        let [i, j, k] = inside.to_array().map(part);
        let around = -1..=1;
        for part_i in around.clone().map(|step| i + step) {
            for part_j in around.clone().map(|step| j + step) {
                for part_k in around.clone().map(|step| k + step) {
                    let part = [part_i, part_j, part_k].map(|at| at.rem_euclid(Self::PARTS));
                    let is_same = |(other, _): &&(DVec3, usize)| {
                        let apart = inside - other;
                        (apart - apart.round()).abs().max_element() <= SAME_PLACE
                    };
                    let found = self.0.get(&part).and_then(|all| all.iter().find(is_same));
                    if let Some((_, source)) = found {
                        return Some(*source);
                    }
                }
            }
        }
        let part = [i, j, k].map(|at| at.rem_euclid(Self::PARTS));
        self.0.entry(part).or_default().push((inside, source));
        None
    }
}
