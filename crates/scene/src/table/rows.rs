//! Rows of a table, as spheres and their colors.

use std::collections::TryReserveError;
use std::sync::Arc;

use glam::DVec3;
use marbles_core::Sphere;

use super::categories::Categories;
use super::cell::ToldCell;
use super::columns::{Plan, RadiusSource, Slot, ValueSource};
use super::elements::{Atom, AtomRadius};
use super::error::TableError;
use super::paint::Paint;
use super::remarks::Remarks;
use crate::text::LocatedFault;

/// A sphere for each row that was read and kept.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    /// The number of rows that were read, those that are not kept among them.
    pub(crate) read: u64,
    /// The number of rows that were kept, if each of them may be several spheres.
    pub(crate) kept: Option<u64>,
    /// The last line of a text is a row.
    pub(crate) ends_with_row: bool,
    pub(crate) spheres: Vec<Sphere>,
    /// The rows that the spheres are, counted from 0, if the request asks for them.
    pub(crate) places: Vec<u64>,
    pub(crate) paint: Paint,
    /// The numbers that a colormap turns into colors are those of this column.
    pub(crate) value_name: Option<String>,
    /// The names of all columns.
    pub(crate) columns: Arc<Vec<String>>,
    /// The column that tells elements, where one does.
    pub(crate) element_column: Option<usize>,
    /// Doubts and guesses.
    pub(crate) remarks: Remarks,
    /// The format has right-handed axes.
    pub(crate) is_right_handed: bool,
    /// The values are times, in seconds.
    pub(crate) has_times: bool,
    /// The cell, where the table tells one.
    pub(crate) cell: Option<ToldCell>,
}

/// The numbers of a row, by [`Slot`].
pub(crate) type Numbers = [f64; Slot::COUNT];

/// A row, as it was read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<'a> {
    pub(crate) numbers: &'a Numbers,
    pub(crate) atom: Atom<'a>,
    /// The category's name, where there is one.
    pub(crate) category: &'a [u8],
}

/// The outcome of a row.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Pushed {
    /// It is a sphere, or was left out because its value is missing.
    AsItIs,
    /// It is a sphere, some of which is that of others because its element is unknown.
    OfUnknown,
}

/// Says whether a row's radius comes from the table and is 0.
#[inline(always)]
pub(crate) fn is_point(plan: &Plan, numbers: &Numbers) -> bool {
    matches!(plan.radius, RadiusSource::Column(..)) && numbers[Slot::Radius.index()] == 0.0
}

impl Rows {
    /// No rows of a table that is read by this plan.
    pub(crate) fn new(plan: &Plan) -> Self {
        Self {
            read: 0,
            kept: None,
            ends_with_row: false,
            spheres: Vec::new(),
            places: Vec::new(),
            paint: Paint::new(plan.coloring, plan.uses.len()),
            columns: Arc::clone(&plan.names.0),
            value_name: plan.value_name().map(str::to_owned),
            element_column: plan.element_column,
            remarks: Remarks::of_plan(plan),
            is_right_handed: false,
            has_times: false,
            cell: None,
        }
    }

    /// Makes room for so many more rows.
    pub(crate) fn reserve(&mut self, count: u64) -> Result<(), TableError> {
        let too_many = TableError::OutOfMemory(count);
        let Ok(more) = usize::try_from(count) else {
            return Err(too_many);
        };
        self.try_reserve(more).map_err(|_| too_many)
    }

    fn try_reserve(&mut self, more: usize) -> Result<(), TryReserveError> {
        self.spheres.try_reserve_exact(more)?;
        self.paint.reserve(more)
    }

    /// Adds a row that is kept, and whose every number was found allowed.
    ///
    /// # Errors
    /// Returns what was expected instead of the radius, or of the category.
    #[inline(always)]
    pub(crate) fn push(&mut self, plan: &Plan, row: Row<'_>) -> Result<Pushed, &'static str> {
        self.read += 1;
        let number = |slot: Slot| row.numbers[slot.index()];
        let value = match plan.value {
            ValueSource::Column => number(Slot::Value),
            ValueSource::Length => {
                let vector = [0, 1, 2].map(|component| number(Slot::Vector(component)));
                DVec3::from_array(vector).length()
            }
        };
        if plan.hides_missing && value.is_nan() {
            return Ok(Pushed::AsItIs);
        }
        if let Paint::Contents(_) = &self.paint {
            return Ok(Pushed::AsItIs);
        }
        if let Paint::Distinct(numbers) = &mut self.paint {
            numbers.add(value);
            return Ok(Pushed::AsItIs);
        }
        let mut pushed = Pushed::AsItIs;
        let radius = match plan.radius {
            RadiusSource::Fixed(radius) => radius,
            RadiusSource::Column(scale, law) => scale * law.of(number(Slot::Radius)),
            RadiusSource::Element(scale) => {
                scale
                    * match plan.elements.radius(row.atom) {
                        AtomRadius::Known(radius) => radius,
                        AtomRadius::Own(radius, name) => {
                            self.remarks.use_radius(name);
                            radius
                        }
                        AtomRadius::Other(radius) => {
                            pushed = Pushed::OfUnknown;
                            radius
                        }
                    }
            }
        };
        let mut center = DVec3::new(number(Slot::X), number(Slot::Y), number(Slot::Z));
        if let Some((axes, origin)) = plan.axes {
            center = axes * center + origin;
            for (axis, fixed) in plan.fixed.iter().enumerate() {
                center[axis] = fixed.unwrap_or(center[axis]);
            }
        }
        if let Some(edges) = plan.images {
            let images = [0, 1, 2].map(|axis| number(Slot::Image(axis)));
            center += edges * DVec3::from_array(images);
        }
        let sphere = Sphere::new(center, radius).map_err(|_| "a finite center and radius")?;
        match &mut self.paint {
            Paint::Material | Paint::Distinct(_) | Paint::Contents(_) => {}
            Paint::Colors(colors) => {
                let color = [Slot::Red, Slot::Green, Slot::Blue].map(number);
                colors.push(color.map(|channel| plan.channel(channel)));
            }
            Paint::Elements(colors) => {
                let color = plan.elements.color(row.atom);
                if color == 0 {
                    pushed = Pushed::OfUnknown;
                }
                colors.push(color);
            }
            Paint::Values(values) => values.push(value),
            Paint::Categories(categories) => {
                let index = categories.index(row.category);
                let index = index.ok_or("at most 65536 categories")?;
                categories.indices.push(index);
            }
        }
        self.spheres.push(sphere);
        if plan.has_places {
            self.places.push(self.read - 1);
        }
        Ok(pushed)
    }

    /// Takes away the spheres that are not kept.
    pub(crate) fn retain(&mut self, kept: &[bool]) {
        fn retain<T>(all: &mut Vec<T>, kept: &[bool]) {
            let mut kept = kept.iter();
            all.retain(|_| kept.next().is_some_and(|is_kept| *is_kept));
        }
        retain(&mut self.spheres, kept);
        retain(&mut self.places, kept);
        match &mut self.paint {
            Paint::Material | Paint::Distinct(_) | Paint::Contents(_) => {}
            Paint::Colors(colors) => retain(colors, kept),
            Paint::Elements(numbers) => retain(numbers, kept),
            Paint::Values(values) => retain(values, kept),
            Paint::Categories(categories) => retain(&mut categories.indices, kept),
        }
        self.kept = Some(self.spheres.len() as u64);
    }

    /// Adds others that are read by the same plan.
    ///
    /// # Errors
    /// Refuses more memory than there is, and too many categories.
    pub(crate) fn append(&mut self, mut others: Self) -> Result<(), TableError> {
        let more = others.spheres.len();
        if self.spheres.capacity() - self.spheres.len() < more {
            // As a vector grows by itself, but with an error where there is no memory.
            let grown = more.max(self.spheres.len() / 2);
            let enough = self.try_reserve(grown).or_else(|_| self.try_reserve(more));
            let all = self.spheres.len() + more;
            enough.map_err(|_| TableError::OutOfMemory(all as u64))?;
        }
        let before = self.read;
        self.places
            .extend(others.places.iter().map(|place| before + place));
        self.read += others.read;
        self.remarks.append(others.remarks);
        self.has_times |= others.has_times;
        self.spheres.append(&mut others.spheres);
        if self.paint.append(others.paint) {
            let most = Categories::MOST;
            let message = format!("expected at most {most} categories, found more");
            return Err(LocatedFault::of_file(message).into());
        }
        Ok(())
    }
}
