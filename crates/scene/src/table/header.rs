//! Facts about the rows of a text that come before them.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::cell::ToldCell;
use super::columns::{Nature, Plan, Slot};
use super::crystal::{self, Crystal};
use super::error::TableError;
use super::fields;
use super::form::{FixedAtom, Form, LineKind};
use super::guess::{self, Guess};
use super::input::{Input, without_return};
use super::number::{is_missing, parse};
use super::request::{Coloring, ColumnRef, Columns, Request};
use super::rows::Rows;
use super::{text, time};
use crate::text::LocatedFault;

/// Facts about the rows of a text that come before them.
#[derive(Clone, Debug)]
pub(crate) struct Header {
    pub(crate) names: Vec<String>,
    pub(crate) form: Form,
    /// The number of rows, and what they are called; `None` where the form tells the end.
    pub(crate) count: Option<(u64, &'static str)>,
    /// Reads what has to stand behind the rows, the last line of which may be another one, and refuses rows that are cut.
    pub(crate) close: Close,
    /// The length of an ångström, in the table's unit.
    pub(crate) angstrom: f64,
    /// The axes and the origin of positions that are parts of a box.
    pub(crate) scaled: Option<(DMat3, DVec3)>,
    /// The factors on positions that are lengths.
    pub(crate) scale: DVec3,
    /// The cell, where the table tells one before its rows.
    pub(crate) cell: Option<ToldCell>,
    /// The atoms that the rows are, one kind after another, where no column tells them.
    pub(crate) species: Vec<Species>,
    /// The atoms of a crystal, which were read already.
    pub(crate) crystal: Option<Arc<Crystal>>,
    /// The assumption about the elements, unless the scene file says which column tells them.
    pub(crate) guess: Option<Guess>,
    /// Columns of text; `None` where the first row tells them.
    pub(crate) texts: Option<Vec<bool>>,
    /// The line that names the columns, for messages, and the part of it that does.
    pub(crate) place: (u64, Vec<u8>, Range<usize>),
}

/// Reads what has to stand behind the rows, the last line of which may be another one; returns the cell that it tells.
pub(crate) type Close =
    fn(&mut Input<'_>, ends_with_row: bool) -> Result<Option<ToldCell>, TableError>;

/// Atoms of one kind, which follow one another.
#[derive(Clone, Debug)]
pub(crate) struct Species {
    pub(crate) count: u64,
    pub(crate) atom: FixedAtom,
}

impl Header {
    /// The header of rows with columns of these names, which are listed in this line.
    pub(crate) fn new(names: Vec<String>, form: Form, (number, line): (u64, &[u8])) -> Self {
        Self {
            names,
            form,
            count: None,
            close: |_, _| Ok(None),
            angstrom: 1.0,
            scaled: None,
            scale: DVec3::ONE,
            cell: None,
            species: Vec::new(),
            crystal: None,
            guess: None,
            texts: None,
            place: (number, line.to_vec(), 0..line.len()),
        }
    }

    /// Reads the rows behind the header.
    pub(crate) fn read(
        &self,
        input: &mut Input<'_>,
        request: &Request,
    ) -> Result<Rows, TableError> {
        if let Some(crystal) = &self.crystal {
            let columns = crystal::Columns {
                names: &self.names,
                form: &self.form,
                place: &self.place,
            };
            return crystal.read(columns, request);
        }
        let texts = match &self.texts {
            Some(texts) => texts.clone(),
            None => self.texts_of_first_row(input, request)?,
        };
        let nature = Nature {
            is_byte: &|_| false,
            is_text: &|column| texts.get(column).copied().unwrap_or(false),
            angstrom: self.angstrom,
            cell: self.scaled,
            edges: self.edges(),
            scale: self.scale,
        };
        let plan = Plan::new(self.names.clone(), request, &nature);
        let plan = plan.map_err(|message| {
            let (number, line, span) = &self.place;
            LocatedFault::in_line(*number, line, span.clone(), message)
        })?;
        if plan.images.is_some() {
            match &self.cell {
                Some(Ok(_)) => {}
                Some(Err(fault)) => return Err(fault.clone().into()),
                None => return Err(TableError::NoCell("unwrap")),
            }
        }
        let mut form = Cow::Borrowed(&self.form);
        // Whoever names the column knows what is in it.
        let guess = self.guess.as_ref();
        let guess = guess.filter(|_| request.columns.element.is_none());
        if let Some(guess) = guess {
            form.to_mut().element = guess.element;
        }
        let doubt = match guess {
            Some(_) => None,
            None => self.doubt_numbers(input, &plan, request)?,
        };
        let mut rows = match self.count {
            Some(count) if !self.species.is_empty() => {
                self.read_species(input, &plan, &mut form, count)?
            }
            Some((count, noun)) => text::read_count(input, &plan, &form, count, noun)?,
            None => text::read(input, &plan, &form, None)?,
        };
        if let Some(guess) = guess
            && plan.name_of(Slot::Element).is_some()
        {
            rows.remarks.add_guess(guess.told.clone());
        }
        if let Some(doubt) = doubt {
            rows.remarks.add_guess(doubt);
        }
        let cell = (self.close)(input, rows.ends_with_row)?;
        rows.cell = cell.or_else(|| self.cell.clone());
        Ok(rows)
    }

    /// The edges of the cell, if it is told before the rows and has a volume.
    fn edges(&self) -> Option<DMat3> {
        let cell = self.cell.as_ref()?.as_ref().ok()?;
        Some(cell.edges)
    }

    /// Reads rows that are atoms of one kind after another.
    fn read_species(
        &self,
        input: &mut Input<'_>,
        plan: &Plan,
        form: &mut Cow<'_, Form>,
        (count, noun): (u64, &'static str),
    ) -> Result<Rows, TableError> {
        let mut rows = Rows::new(plan);
        for species in &self.species {
            form.to_mut().atom = Some(species.atom.clone());
            let more = text::read(input, plan, form, Some(species.count))?;
            let is_cut = more.read < species.count;
            rows.append(more)?;
            if is_cut {
                return Err(text::too_few(input.number, rows.read, count, noun).into());
            }
        }
        Ok(rows)
    }

    /// Doubts atomic numbers that may be those of types, unless the scene file says which column tells elements.
    fn doubt_numbers(
        &self,
        input: &mut Input<'_>,
        plan: &Plan,
        request: &Request,
    ) -> Result<Option<LocatedFault>, TableError> {
        const ROWS: usize = 1000;
        let column = plan.element_column;
        let column = column.filter(|_| plan.name_of(Slot::Element).is_some());
        let is_open = request.columns.element.is_none() && self.guess.is_none();
        let column = column.filter(|_| is_open && self.form.types.is_empty());
        let (Some(column), Some(first)) = (column, input.peek()?.map(<[u8]>::to_vec)) else {
            return Ok(None);
        };
        let (division, kind) = (&self.form.division, self.form.kind);
        let rows = self.count.map_or(ROWS, |(count, _)| {
            usize::try_from(count).unwrap_or(ROWS).min(ROWS)
        });
        let numbers = guess::numbers(input, column, division, kind, rows);
        let are_of_types = numbers.is_some_and(|numbers| guess::are_of_types(&numbers))
            && guess::is_atomic_number(&first, column, &self.form);
        let told = guess::as_atomic_numbers(&self.names[column]);
        let place = 0..first.len();
        let doubt = LocatedFault::in_line(input.number + 1, &first, place, told);
        Ok(are_of_types.then_some(doubt))
    }

    /// Passes over the rows behind the header, and what belongs to them.
    pub(crate) fn skip(&self, input: &mut Input<'_>) -> Result<(), TableError> {
        if self.crystal.is_some() {
            return Ok(());
        }
        let ends_with_row = match self.count {
            Some((count, noun)) => {
                let found = input.skip_lines(count)?;
                if found < count {
                    return Err(text::too_few(input.number, found, count, noun).into());
                }
                count > 0
            }
            None => text::skip(input, &self.form)?,
        };
        (self.close)(input, ends_with_row)?;
        Ok(())
    }

    /// The columns that are no numbers in the first row that is kept, or in the first of all where none comes soon.
    fn texts_of_first_row(
        &self,
        input: &mut Input<'_>,
        request: &Request,
    ) -> Result<Vec<bool>, TableError> {
        let Some(first) = input.peek()?.map(<[u8]>::to_vec) else {
            return Ok(Vec::new());
        };
        if (self.form.kind)(&first) != LineKind::Row {
            return Ok(Vec::new());
        }
        let line = match request.keep.is_empty() {
            true => &first[..],
            false => self.first_kept(input, request).unwrap_or(&first),
        };
        let is_text = |field: &&[u8]| {
            let is_number = parse(field, self.form.has_decimal_commas).is_some();
            !is_number && !is_missing(field) && time::parse(field).is_none()
        };
        let fields = fields::all(line, &self.form.division);
        Ok(fields.iter().map(is_text).collect())
    }

    /// The first row that is kept of those that come next.
    fn first_kept<'a>(&self, input: &'a Input<'_>, request: &Request) -> Option<&'a [u8]> {
        let of_conditions = Request {
            radius: Some(1.0),
            coloring: Some(Coloring::Material),
            columns: Columns {
                position: [(); 3].map(|()| Some(ColumnRef::Constant(0.0))),
                ..Columns::default()
            },
            keep: request.keep.clone(),
            ..Request::default()
        };
        let nature = Nature {
            is_byte: &|_| false,
            is_text: &|_| false,
            angstrom: self.angstrom,
            cell: self.scaled,
            edges: self.edges(),
            scale: self.scale,
        };
        let plan = Plan::new(self.names.clone(), &of_conditions, &nature).ok()?;
        let lines = input
            .head()
            .split(|byte| *byte == b'\n')
            .map(without_return);
        let mut rows = lines.filter(|line| (self.form.kind)(line) == LineKind::Row);
        rows.find(|row| text::is_kept(row, 0, &plan, &self.form).unwrap_or(false))
    }
}
