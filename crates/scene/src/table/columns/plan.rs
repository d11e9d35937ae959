//! The way in which the columns of a table are read.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::super::contents::MOST;
use super::super::elements::Elements;
use super::super::request::{Coloring, ColumnRef, Missing, RadiusLaw, Request, Value};
use super::filter::Test;
use super::names::{Names, marked};
use super::slot::{Allowed, Slot};
use super::uses::Uses;
use super::{positions, units};
use crate::values::linear;

/// The source of radii.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum RadiusSource {
    /// All are this one.
    Fixed(f64),
    /// From the table by a law, times this.
    Column(f64, RadiusLaw),
    /// From the element, times this.
    Element(f64),
}

/// The source of the numbers that a colormap turns into colors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ValueSource {
    /// A column.
    Column,
    /// The length of a vector.
    Length,
}

/// The facts about columns besides their names.
pub(crate) struct Nature<'a> {
    /// Numbers from 0 to 255 that are sRGB where they are colors.
    pub(crate) is_byte: &'a dyn Fn(usize) -> bool,
    /// Text that is no number.
    pub(crate) is_text: &'a dyn Fn(usize) -> bool,
    /// The length of an ångström, in the table's unit.
    pub(crate) angstrom: f64,
    /// The axes and the origin of the cell, where the table has one.
    pub(crate) cell: Option<(DMat3, DVec3)>,
    /// The edges of the cell, where the table tells it before its rows.
    pub(crate) edges: Option<DMat3>,
    /// The factors on positions that are lengths.
    pub(crate) scale: DVec3,
}

/// The way in which the columns of a table are read.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// The purposes of each column.
    pub(crate) uses: Vec<Uses>,
    /// The columns' names.
    pub(crate) names: Names,
    pub(crate) radius: RadiusSource,
    /// The scene file names the column of radii.
    has_chosen_radius: bool,
    pub(crate) coloring: Coloring,
    pub(crate) value: ValueSource,
    /// The conditions on rows that are kept.
    pub(crate) filters: Vec<Test>,
    /// The columns up to the last that a condition is on.
    pub(crate) filter_columns: usize,
    pub(crate) elements: Elements,
    /// The column that tells elements, where there is one.
    pub(crate) element_column: Option<usize>,
    /// The categories are those of elements.
    pub(crate) has_element_categories: bool,
    /// The numbers that are allowed.
    pub(crate) allowed: Allowed,
    /// The places of rows are noted.
    pub(crate) has_places: bool,
    /// Rows whose value is missing are left out.
    pub(crate) hides_missing: bool,
    /// The numbers of a row before anything of it is read: those of columns that are constant.
    pub(crate) constants: [f64; Slot::COUNT],
    /// The axes and the origin of the positions, where they are not those of the table's lengths.
    pub(crate) axes: Option<(DMat3, DVec3)>,
    /// The edges by which image flags move particles, where these do.
    pub(crate) images: Option<DMat3>,
    /// The coordinates that are constant, whatever the axes.
    pub(crate) fixed: [Option<f64>; 3],
    /// Sentences about what was assumed.
    pub(crate) doubts: Vec<String>,
    /// The linear values of sRGB ones, where colors are.
    linear: Vec<f32>,
}

impl Plan {
    /// Plans the reading of a table with columns of these names as `request` says.
    ///
    /// Upper and lower case are the same.
    ///
    /// # Errors
    /// Returns the message that says what is missing.
    pub(crate) fn new(
        names: Vec<String>,
        request: &Request,
        nature: &Nature<'_>,
    ) -> Result<Self, String> {
        let columns = &request.columns;
        let mut plan = Self {
            uses: vec![Uses::None; names.len()],
            radius: RadiusSource::Fixed(1.0),
            has_chosen_radius: columns.radius.is_some(),
            coloring: Coloring::Material,
            value: ValueSource::Column,
            filters: request
                .keep
                .iter()
                .map(|filter| filter.test.clone())
                .collect(),
            filter_columns: 0,
            elements: Elements::new(request),
            element_column: None,
            has_element_categories: false,
            allowed: Allowed {
                may_miss: request.missing != Missing::Refuse,
                is_encoded: false,
                has_radius_law: columns.radius_law != RadiusLaw::Linear,
            },
            has_places: request.has_places,
            hides_missing: request.missing == Missing::Hide,
            constants: [0.0; Slot::COUNT],
            axes: None,
            images: None,
            fixed: columns.position.each_ref().map(|chosen| match chosen {
                Some(ColumnRef::Constant(number)) => Some(*number),
                _ => None,
            }),
            linear: Vec::new(),
            doubts: Vec::new(),
            names: Names(Arc::new(names)),
        };
        let [x, y, z] = &columns.position;
        for (slot, chosen) in [(Slot::X, x), (Slot::Y, y), (Slot::Z, z)] {
            match chosen {
                Some(chosen) => plan.take_or_fix(slot, chosen)?,
                None => plan.take(slot, None)?,
            }
        }
        let positions = [Slot::X, Slot::Y, Slot::Z].map(|slot| plan.name_of(slot));
        let are_chosen = columns.position.iter().all(Option::is_some);
        let are_unwrapped = positions::are_unwrapped(positions);
        plan.axes = positions::axes(positions, are_chosen, nature.cell)?;
        if plan.axes.is_none() && nature.scale != DVec3::ONE {
            plan.axes = Some((DMat3::from_diagonal(nature.scale), DVec3::ZERO));
        }
        if request.periodic.unwraps && !are_unwrapped {
            plan.take_images()?;
            plan.images = Some(nature.edges.unwrap_or(DMat3::ZERO));
        }
        let colors = [Slot::Red, Slot::Green, Slot::Blue];
        let has_colors = colors
            .into_iter()
            .all(|slot| plan.names.find_slot(slot).is_some());
        let element = columns.element.as_ref();
        plan.element_column = match element {
            Some(chosen) => Some(plan.names.chosen(chosen)?),
            None => plan.names.find_slot(Slot::Element),
        };
        let has_element = plan.element_column.is_some();
        let is_of_elements = match &request.value {
            Some(Value::Column(name)) => {
                has_element && Some(plan.names.chosen(name)?) == plan.element_column
            }
            _ => false,
        };
        plan.coloring = match request.coloring {
            Some(coloring) => coloring,
            None if is_of_elements => Coloring::Element,
            // Whether the column has text or numbers decides further down.
            None if request.value.is_some() && request.palette.is_empty() => Coloring::Value,
            None if request.value.is_some() => Coloring::Category,
            None if !request.palette.is_empty() => {
                match has_element && plan.names.find_slot(Slot::Value).is_none() {
                    true => Coloring::Element,
                    false => Coloring::Category,
                }
            }
            None if has_colors => Coloring::Table,
            None if has_element => Coloring::Element,
            None => Coloring::Material,
        };
        plan.radius = plan.radius(request, nature, has_colors, has_element)?;
        match plan.coloring {
            Coloring::Material => {}
            Coloring::Element => {
                plan.take_element(element)?;
                plan.elements.check(request)?;
            }
            Coloring::Category if is_of_elements => {
                plan.take_element(element)?;
                plan.has_element_categories = true;
            }
            Coloring::Value | Coloring::Category | Coloring::Distinct => {
                plan.take_value(request, nature)?;
            }
            Coloring::Contents(texts) => {
                let of_element = plan.element_column.filter(|column| *column < MOST);
                let of_element = of_element.map_or(0, |column| 1 << column);
                plan.coloring = Coloring::Contents(texts | of_element);
                for (column, index) in (0..plan.uses.len().min(MOST)).zip(0..) {
                    plan.use_for(column, Slot::Contents(index));
                }
            }
            Coloring::Table => {
                for slot in colors {
                    plan.take(slot, None)?;
                }
                let is_red = |uses: &Uses| uses.slots().contains(&Slot::Red);
                let red = plan.uses.iter().position(is_red);
                plan.allowed.is_encoded = red.is_some_and(nature.is_byte);
                if plan.allowed.is_encoded {
                    plan.linear = (0..=255).map(|value| linear(value) as f32).collect();
                }
            }
        }
        for (index, filter) in (0..).zip(&request.keep) {
            let column = plan.names.chosen(&filter.column)?;
            if (nature.is_text)(column) && filter.test.text().is_none() {
                let (name, written) = (marked(&plan.names.0[column]), filter.test.written());
                return Err(format!(
                    "expected numbers in the column {name} for `{written}`, found text"
                ));
            }
            plan.use_for(column, Slot::Filter(index));
            plan.filter_columns = plan.filter_columns.max(column + 1);
        }
        let is_radius_scaled =
            columns.radius_scale.is_some() || columns.radius_law != RadiusLaw::Linear;
        let is_of_elements = matches!(plan.radius, RadiusSource::Element(_));
        if is_of_elements && nature.angstrom == 1.0 && !is_radius_scaled {
            let doubt = units::of_elements(plan.name_of(Slot::X));
            plan.doubts.extend(doubt);
        }
        let radius = (!is_radius_scaled).then_some(Slot::Radius);
        let lengths = [Slot::X, Slot::Y, Slot::Z].into_iter().chain(radius);
        let doubt = units::unequal(lengths.filter_map(|slot| plan.name_of(slot)));
        plan.doubts.extend(doubt);
        Ok(plan)
    }

    /// The source of the radii, whose column is taken.
    fn radius(
        &mut self,
        request: &Request,
        nature: &Nature<'_>,
        has_colors: bool,
        has_element: bool,
    ) -> Result<RadiusSource, String> {
        let law = request.columns.radius_law;
        let scale = request.columns.radius_scale;
        if let Some(radius) = request.radius {
            return Ok(RadiusSource::Fixed(radius));
        }
        if let Some(chosen) = &request.columns.radius {
            self.take_or_fix(Slot::Radius, chosen)?;
            return Ok(RadiusSource::Column(scale.unwrap_or(1.0), law));
        }
        if let Some((column, name)) = self.names.find_radius(has_colors) {
            let column = self.names.once(column, name)?;
            self.use_for(column, Slot::Radius);
            return Ok(RadiusSource::Column(scale.unwrap_or(1.0), law));
        }
        if let Some(column) = self.names.find("diameter") {
            let column = self.names.once(column, "diameter")?;
            self.use_for(column, Slot::Radius);
            return Ok(RadiusSource::Column(scale.unwrap_or(0.5), law));
        }
        if has_element {
            self.take_element(request.columns.element.as_ref())?;
            let scale = scale.unwrap_or(1.0) * nature.angstrom;
            return Ok(RadiusSource::Element(scale));
        }
        Err(format!(
            "expected a column `radius`, or else `radius: …` in the scene, found {}",
            self.names.list()
        ))
    }

    /// The linear value of a color channel that is allowed.
    #[inline(always)]
    pub(crate) fn channel(&self, value: f64) -> f32 {
        if self.allowed.is_encoded {
            self.linear[usize::from(value as u8)]
        } else {
            value as f32
        }
    }

    /// The expected thing instead of this number; `None` where it is allowed.
    #[inline(always)]
    pub(crate) fn refusal(&self, slot: Slot, number: f64) -> Option<&'static str> {
        let refusal = slot.refusal(number, self.allowed);
        match slot {
            Slot::Radius if self.allowed.has_radius_law && refusal.is_none() => {
                let RadiusSource::Column(scale, law) = self.radius else {
                    return None;
                };
                let radius = scale * law.of(number);
                let is_radius = radius.is_finite() && radius > 0.0;
                (!is_radius).then_some("a number that gives a finite radius greater than 0")
            }
            _ => refusal,
        }
    }

    /// The expected thing in a column, for messages.
    pub(crate) fn expected(&self, column: usize, what: &str) -> String {
        let law = match self.radius {
            // Whoever names a column of other numbers means some law.
            RadiusSource::Column(_, RadiusLaw::Linear)
                if what.starts_with("a radius") && self.has_chosen_radius =>
            {
                " (`radius_law: Exponential(0.5)` converts magnitudes to radii)"
            }
            _ => "",
        };
        match self.names.0.get(column) {
            Some(name) => format!("{what} for {}{law}", marked(name)),
            None => what.to_owned(),
        }
    }

    /// The name of the column that is used for this.
    pub(crate) fn name_of(&self, slot: Slot) -> Option<&str> {
        let column = self
            .uses
            .iter()
            .position(|uses| uses.slots().contains(&slot));
        Some(&self.names.0[column?])
    }

    /// The name of the column that colors stand for.
    pub(crate) fn value_name(&self) -> Option<&str> {
        match self.has_element_categories || self.coloring == Coloring::Element {
            true => self.name_of(Slot::Element),
            false => self.name_of(Slot::Value),
        }
    }

    /// Uses a column for this: the one that the scene file means, or else the one of its name.
    pub(super) fn take(&mut self, slot: Slot, chosen: Option<&ColumnRef>) -> Result<(), String> {
        let column = match chosen {
            Some(chosen) => self.names.chosen(chosen)?,
            None => self.names.of(slot)?,
        };
        self.use_for(column, slot);
        Ok(())
    }

    /// Uses the column that the scene file means for this, or else its constant.
    fn take_or_fix(&mut self, slot: Slot, chosen: &ColumnRef) -> Result<(), String> {
        match chosen {
            ColumnRef::Constant(number) => {
                self.constants[slot.index()] = *number;
                Ok(())
            }
            chosen => self.take(slot, Some(chosen)),
        }
    }

    fn take_element(&mut self, chosen: Option<&ColumnRef>) -> Result<(), String> {
        let is_taken = self.name_of(Slot::Element).is_some();
        if is_taken {
            Ok(())
        } else {
            self.take(Slot::Element, chosen)
        }
    }

    /// Uses columns for the numbers of a colormap, or for categories.
    fn take_value(&mut self, request: &Request, nature: &Nature<'_>) -> Result<(), String> {
        match &request.value {
            Some(Value::Length(components)) => {
                self.value = ValueSource::Length;
                for (index, chosen) in (0..).zip(components) {
                    self.take_or_fix(Slot::Vector(index), chosen)?;
                }
            }
            Some(Value::Column(name)) => {
                let column = self.names.chosen(name)?;
                self.use_for(column, Slot::Value);
                if request.coloring.is_none() && (nature.is_text)(column) {
                    self.coloring = Coloring::Category;
                }
            }
            None => self.take(Slot::Value, None)?,
        }
        Ok(())
    }

    fn use_for(&mut self, column: usize, slot: Slot) {
        let uses = &mut self.uses[column];
        *uses = match std::mem::take(uses) {
            Uses::None => Uses::One(slot),
            Uses::One(first) => Uses::Several(vec![first, slot]),
            Uses::Several(mut slots) => {
                slots.push(slot);
                Uses::Several(slots)
            }
        };
    }
}
