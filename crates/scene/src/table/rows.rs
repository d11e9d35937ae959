//! Rows of a table, as spheres and their colors.

use glam::DVec3;
use marbles_core::Sphere;

use super::columns::{Plan, RadiusSource, Slot};
use super::element;
use super::error::TableError;
use super::paint::Paint;

/// A sphere for each row that was read.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    pub(crate) spheres: Vec<Sphere>,
    pub(crate) paint: Paint,
}

/// The numbers of a row, by [`Slot`].
pub(crate) type Numbers = [f64; Slot::COUNT];

impl Rows {
    /// No rows of a table that is read by this plan.
    pub(crate) fn new(plan: &Plan) -> Self {
        Self {
            spheres: Vec::new(),
            paint: Paint::new(plan.coloring),
        }
    }

    /// Makes room for so many more rows.
    pub(crate) fn reserve(&mut self, count: u64) -> Result<(), TableError> {
        let too_many = TableError::OutOfMemory(count);
        let Ok(more) = usize::try_from(count) else {
            return Err(too_many);
        };
        let spheres = self.spheres.try_reserve_exact(more);
        let paint = self.paint.reserve(more);
        spheres.and(paint).map_err(|_| too_many)
    }

    /// The number of rows.
    pub(crate) fn len(&self) -> usize {
        self.spheres.len()
    }

    /// Adds a row whose every number was found allowed.
    ///
    /// # Errors
    /// Returns what was expected instead of the element.
    #[inline(always)]
    pub(crate) fn push(
        &mut self,
        plan: &Plan,
        numbers: &Numbers,
        element: u8,
    ) -> Result<(), &'static str> {
        let number = |slot: Slot| numbers[slot as usize];
        let radius = match plan.radius {
            RadiusSource::Fixed(radius) => radius,
            RadiusSource::Column => number(Slot::Radius),
            RadiusSource::Element(radii) => {
                element::radius(element, radii).ok_or("an element whose radius is known")?
            }
        };
        let center = DVec3::new(number(Slot::X), number(Slot::Y), number(Slot::Z));
        let sphere = Sphere::new(center, radius).map_err(|_| "a finite center and radius")?;
        match &mut self.paint {
            Paint::Material => {}
            Paint::Colors(colors) => {
                let color = [Slot::Red, Slot::Green, Slot::Blue].map(number);
                colors.push(color.map(|channel| plan.channel(channel)));
            }
            Paint::Elements(numbers) => numbers.push(element),
            Paint::Values(values) => values.push(number(plan.value)),
        }
        self.spheres.push(sphere);
        Ok(())
    }

    /// Adds the first `most` rows of others that are read by the same plan.
    pub(crate) fn append(&mut self, mut others: Self, most: usize) {
        others.spheres.truncate(most);
        self.spheres.append(&mut others.spheres);
        self.paint.append(others.paint, most);
    }
}
