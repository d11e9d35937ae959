//! Rows of a table, as spheres and their colors.

use std::collections::TryReserveError;
use std::sync::Arc;

use glam::DVec3;
use marbles_core::Sphere;

use super::columns::{Plan, RadiusSource, Slot, ValueSource};
use super::element;
use super::error::TableError;
use super::paint::{Categories, Paint};
use crate::text::LocatedFault;

/// A sphere for each row that was read and kept.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    /// The number of rows that were read.
    pub(crate) read: u64,
    /// The last line of a text is a row.
    pub(crate) ends_with_row: bool,
    pub(crate) spheres: Vec<Sphere>,
    pub(crate) paint: Paint,
    /// The numbers that a colormap turns into colors are those of this column.
    pub(crate) value_name: Option<String>,
    /// The names of all columns.
    pub(crate) columns: Arc<Vec<String>>,
}

/// The numbers of a row, by [`Slot`].
pub(crate) type Numbers = [f64; Slot::COUNT];

/// A row, as it was read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<'a> {
    pub(crate) numbers: &'a Numbers,
    /// The atomic number, 0 where there is none.
    pub(crate) element: u8,
    /// The category's name, where there is one.
    pub(crate) category: &'a [u8],
}

impl Rows {
    /// No rows of a table that is read by this plan.
    pub(crate) fn new(plan: &Plan) -> Self {
        Self {
            read: 0,
            ends_with_row: false,
            spheres: Vec::new(),
            paint: Paint::new(plan.coloring),
            columns: Arc::clone(&plan.names.0),
            value_name: plan.name_of(Slot::Value).map(str::to_owned),
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

    /// Adds a row whose every number was found allowed, unless it is not kept.
    ///
    /// # Errors
    /// Returns what was expected instead of the element, or of the category.
    #[inline(always)]
    pub(crate) fn push(&mut self, plan: &Plan, row: Row<'_>) -> Result<(), &'static str> {
        self.read += 1;
        let number = |slot: Slot| row.numbers[slot.index()];
        for (index, test) in (0..).zip(&plan.filters) {
            if !test.holds(number(Slot::Filter(index))) {
                return Ok(());
            }
        }
        let value = match plan.value {
            ValueSource::Column => number(Slot::Value),
            ValueSource::Length => {
                let vector = [0, 1, 2].map(|component| number(Slot::Vector(component)));
                DVec3::from_array(vector).length()
            }
        };
        if plan.hides_missing && value.is_nan() {
            return Ok(());
        }
        let radius = match plan.radius {
            RadiusSource::Fixed(radius) => radius,
            RadiusSource::Column(scale) => scale * number(Slot::Radius),
            RadiusSource::Element(radii, scale) => {
                let radius = element::radius(row.element, radii);
                scale * radius.ok_or("an element whose radius is known")?
            }
        };
        let mut center = DVec3::new(number(Slot::X), number(Slot::Y), number(Slot::Z));
        if let Some((axes, origin)) = plan.axes {
            center = axes * center + origin;
        }
        let sphere = Sphere::new(center, radius).map_err(|_| "a finite center and radius")?;
        match &mut self.paint {
            Paint::Material => {}
            Paint::Colors(colors) => {
                let color = [Slot::Red, Slot::Green, Slot::Blue].map(number);
                colors.push(color.map(|channel| plan.channel(channel)));
            }
            Paint::Elements(numbers) => numbers.push(row.element),
            Paint::Values(values) => values.push(value),
            Paint::Categories(categories) => {
                let index = categories.index(row.category);
                let index = index.ok_or("at most 65536 categories")?;
                categories.indices.push(index);
            }
        }
        self.spheres.push(sphere);
        Ok(())
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
        self.read += others.read;
        self.spheres.append(&mut others.spheres);
        if self.paint.append(others.paint) {
            let most = Categories::MOST;
            let message = format!("expected at most {most} categories, found more");
            return Err(LocatedFault::of_file(message).into());
        }
        Ok(())
    }
}
