//! The purpose of each column of a table.

use super::element::Radii;
use super::request::{Coloring, Request};
use crate::text::{did_you_mean, show};
use crate::values::linear;

/// The purpose of a column.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Slot {
    X,
    Y,
    Z,
    Radius,
    Red,
    Green,
    Blue,
    Value,
    Element,
}

impl Slot {
    /// The number of purposes.
    pub(crate) const COUNT: usize = 9;

    /// The names that a column for this may have.
    fn names(self) -> &'static [&'static str] {
        match self {
            Self::X => &["x"],
            Self::Y => &["y"],
            Self::Z => &["z"],
            Self::Radius => &["radius", "r"],
            Self::Red => &["red", "r"],
            Self::Green => &["green", "g"],
            Self::Blue => &["blue", "b"],
            Self::Value => &["value"],
            Self::Element => &["element", "species", "symbol"],
        }
    }

    /// The expected thing instead of this number; `None` where it is allowed.
    #[inline(always)]
    pub(crate) fn refusal(self, number: f64, is_encoded: bool) -> Option<&'static str> {
        match self {
            _ if !number.is_finite() => Some("a finite number"),
            Self::Element => {
                let is_known = (1.0..=118.0).contains(&number) && number.fract() == 0.0;
                (!is_known).then_some("the number of an element, from 1 to 118")
            }
            Self::Radius if number <= 0.0 => Some("a radius greater than 0"),
            Self::Red | Self::Green | Self::Blue => {
                if is_encoded {
                    let is_byte = (0.0..=255.0).contains(&number) && number.fract() == 0.0;
                    (!is_byte).then_some("a whole number from 0 to 255")
                } else {
                    let most = f64::from(f32::MAX);
                    (!(0.0..=most).contains(&number)).then_some("a color channel of at least 0")
                }
            }
            _ => None,
        }
    }
}

/// The source of radii.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum RadiusSource {
    /// All are this one.
    Fixed(f64),
    /// From the table.
    Column,
    /// From the element.
    Element(Radii),
}

/// The way in which the columns of a table are read.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// The purpose of each column; `None` for those that are passed over.
    pub(crate) slots: Vec<Option<Slot>>,
    /// The columns' names.
    pub(crate) names: Vec<String>,
    pub(crate) radius: RadiusSource,
    pub(crate) coloring: Coloring,
    /// The purpose of the column whose numbers a colormap turns into colors.
    pub(crate) value: Slot,
    /// Colors are sRGB values from 0 to 255.
    pub(crate) is_encoded: bool,
    /// The linear values of these.
    linear: Vec<f32>,
}

impl Plan {
    /// Plans the reading of a table with columns of these names as `request` says.
    ///
    /// Upper and lower case are the same. Colors are encoded if `is_encoded` says so of the column
    /// of red.
    ///
    /// # Errors
    /// Returns the message that says what is missing.
    pub(crate) fn new(
        names: Vec<String>,
        request: &Request,
        is_encoded: impl Fn(usize) -> bool,
    ) -> Result<Self, String> {
        let mut plan = Self {
            slots: vec![None; names.len()],
            radius: RadiusSource::Column,
            coloring: Coloring::Material,
            value: Slot::Value,
            is_encoded: false,
            linear: (0..=255).map(|value| linear(value) as f32).collect(),
            names,
        };
        for slot in [Slot::X, Slot::Y, Slot::Z] {
            plan.take(slot)?;
        }
        let has_colors = [Slot::Red, Slot::Green, Slot::Blue]
            .into_iter()
            .all(|slot| plan.find(slot).is_some());
        let has_element = plan.find(Slot::Element).is_some();
        plan.coloring = match request.coloring {
            Some(coloring) => coloring,
            None if request.value.is_some() => Coloring::Value,
            None if has_colors => Coloring::Table,
            None if has_element && !request.has_material => Coloring::Element,
            None => Coloring::Material,
        };
        plan.radius = match (request.radius, plan.find_radius(has_colors)) {
            (Some(radius), _) => RadiusSource::Fixed(radius),
            (None, Some(column)) => {
                plan.slots[column] = Some(Slot::Radius);
                RadiusSource::Column
            }
            (None, None) if has_element => {
                plan.take(Slot::Element)?;
                RadiusSource::Element(request.radii)
            }
            (None, None) => {
                return Err(format!(
                    "expected a column `radius`, or else `radius: …` in the scene, found {}",
                    plan.list()
                ));
            }
        };
        match plan.coloring {
            Coloring::Material => {}
            Coloring::Element => plan.take(Slot::Element)?,
            Coloring::Value => plan.take_value(request.value.as_deref())?,
            Coloring::Table => {
                for slot in [Slot::Red, Slot::Green, Slot::Blue] {
                    plan.take(slot)?;
                }
                let red = plan.slots.iter().position(|slot| *slot == Some(Slot::Red));
                plan.is_encoded = red.is_some_and(is_encoded);
            }
        }
        Ok(plan)
    }

    /// The linear value of a color channel that is allowed.
    #[inline(always)]
    pub(crate) fn channel(&self, value: f64) -> f32 {
        if self.is_encoded {
            self.linear[usize::from(value as u8)]
        } else {
            value as f32
        }
    }

    /// The expected thing in a column, for messages.
    pub(crate) fn expected(&self, column: usize, what: &str) -> String {
        match self.names.get(column) {
            Some(name) => format!("{what} for {}", marked(name)),
            None => what.to_owned(),
        }
    }

    /// Uses a column for this.
    fn take(&mut self, slot: Slot) -> Result<(), String> {
        let column = self.column(slot.names())?;
        self.slots[column] = Some(slot);
        Ok(())
    }

    /// Uses a column for the numbers of a colormap; it may be one that is used otherwise, too.
    fn take_value(&mut self, name: Option<&str>) -> Result<(), String> {
        let names = name
            .as_ref()
            .map_or(Slot::Value.names(), std::slice::from_ref);
        let column = self.column(names)?;
        match self.slots[column] {
            Some(slot) => self.value = slot,
            None => self.slots[column] = Some(Slot::Value),
        }
        Ok(())
    }

    /// The only column with the first of these names that there is.
    fn column(&self, names: &[&str]) -> Result<usize, String> {
        let Some(column) = names.iter().find_map(|name| self.find_name(name)) else {
            let known = self.names.iter().map(String::as_str);
            let meant = did_you_mean(names[0], known, marked);
            let (name, list) = (marked(names[0]), self.list());
            return Err(format!("expected a column {name}, found {list}{meant}"));
        };
        let name = &self.names[column];
        let same = |other: &&String| other.eq_ignore_ascii_case(name);
        if self.names.iter().filter(same).count() > 1 {
            let name = marked(name);
            return Err(format!(
                "expected every column once, found {name} a second time"
            ));
        }
        Ok(column)
    }

    fn find(&self, slot: Slot) -> Option<usize> {
        slot.names().iter().find_map(|name| self.find_name(name))
    }

    /// The column of radii; one called `r` may be red instead.
    fn find_radius(&self, has_colors: bool) -> Option<usize> {
        let is_red = has_colors && self.find_name("red").is_none();
        let names = Slot::Radius.names().iter();
        let mut names = names.filter(|name| !(is_red && **name == "r"));
        names.find_map(|name| self.find_name(name))
    }

    fn find_name(&self, name: &str) -> Option<usize> {
        self.names
            .iter()
            .position(|other| other.eq_ignore_ascii_case(name))
    }

    /// The names of the columns as a message shows them.
    fn list(&self) -> String {
        const LONGEST_LIST: usize = 12;
        let names = self.names.iter().take(LONGEST_LIST);
        let mut names: Vec<String> = names.map(|name| marked(name)).collect();
        if self.names.len() > LONGEST_LIST {
            names.push(String::from("…"));
        }
        match names.is_empty() {
            true => String::from("none"),
            false => names.join(", "),
        }
    }
}

/// The most columns that a table may have, whose header may multiply what it asks for.
pub(crate) const MOST_COLUMNS: usize = 10_000;

/// The names of the columns that hold `count` values called `name` together.
pub(crate) fn components(name: &str, count: u64) -> Vec<String> {
    let names = match (name.to_ascii_lowercase().as_str(), count) {
        ("pos" | "position" | "positions", 3) => ["x", "y", "z"],
        ("color" | "colour", 3) => ["red", "green", "blue"],
        (_, 1) => return vec![name.to_owned()],
        _ => {
            let numbers = 1..=count;
            return numbers.map(|number| format!("{name}_{number}")).collect();
        }
    };
    names.map(String::from).into()
}

/// A name between marks, as a message shows it.
fn marked(name: &str) -> String {
    let shown = show(name);
    match shown.starts_with('`') {
        true => shown,
        false => format!("`{shown}`"),
    }
}
