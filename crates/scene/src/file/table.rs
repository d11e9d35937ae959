//! The values of a cloud that are of several forms: columns, conditions, ranges, palettes.

use std::collections::HashSet;
use std::marker::PhantomData;

use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::table::{ColumnRef, Missing, Radii, Value, ValueRange};
use crate::text::{
    Names, Placed, Read, Slice, note_failure, optional, present, quoted, read_simple,
    read_structure, read_tuple, refuse,
};
use crate::values::{Color, Coordinate, Percent, Radius, Step};

/// A condition on the rows of a table that are kept: a column, and what it has to be.
#[derive(Debug, Deserialize)]
pub(crate) struct Keep(pub(crate) Placed<ColumnRef>, pub(crate) Placed<Test>);

/// A condition on a value.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Test {
    Is(Placed<Wanted>),
    Between(Placed<Coordinate>, Placed<Coordinate>),
    Every(Placed<Step>),
}

/// A value that is wanted.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Wanted {
    Number(f64),
    Text(String),
}

/// Values by names, in the file's order.
#[derive(Debug)]
pub(crate) struct Named<T>(pub(crate) Vec<(String, Placed<T>)>);

impl<T: Copy> Named<T> {
    /// The values of all names, each of which, a `noun`, is there once; `None` where a fault was reported.
    pub(crate) fn once(&self, noun: &str) -> Option<Vec<(String, T)>> {
        let mut all: Vec<(String, T)> = Vec::new();
        let mut known = HashSet::new();
        for (name, value) in &self.0 {
            if !known.insert(name) {
                let found = quoted(name);
                let message = format!("expected every {noun} once, found {found} a second time");
                return refuse(value.place.clone(), message);
            }
            all.push((name.clone(), value.get()?));
        }
        Some(all)
    }
}

/// The colors of categories or elements by their names.
pub(crate) type Palette = Named<Color>;

/// The radii of elements: all of a kind, or some by their names.
#[derive(Debug)]
pub(crate) enum ElementRadii {
    Kind(Radii),
    Own(Named<Radius>),
}

impl Default for ElementRadii {
    fn default() -> Self {
        Self::Kind(Radii::default())
    }
}

/// The source of radii.
#[derive(Clone, Debug)]
pub(crate) enum RadiusColumn {
    Column(ColumnRef),
    /// The radius is `offset + factor × number ^ exponent`.
    Power {
        column: ColumnRef,
        factor: f64,
        exponent: f64,
        offset: f64,
    },
}

const COLUMN: &str =
    "the name of a column in quotation marks, its number from 1, or a constant such as `0.0`";

/// Gives a value that is read from its text alone a way to be passed over in broken files.
macro_rules! forms {
    ($($type:ident: $noun:literal, $form:expr, $read:expr;)*) => {$(
        impl<'t> Read<'t> for $type {
            fn read(slice: Slice<'t>) -> Option<Self> {
                let read: fn(Slice<'t>) -> Option<Self> = $read;
                read(slice)
            }

            fn read_strictly<D: Deserializer<'t>>(deserializer: D) -> Result<Option<Self>, D::Error> {
                serde::de::IgnoredAny::deserialize(deserializer)
                    .inspect_err(|_| note_failure(Names { noun: $noun, form: $form }))
                    .map(|_| None)
            }
        }
    )*};
}

forms! {
    ColumnRef: "column", COLUMN, column;
    RadiusColumn: "column of radii", "a column in quotation marks, or `Power(column: …, factor: …, exponent: …, offset: …)`", radius;
    Value: "value", "a column in quotation marks, or `Length(…, …, …)` of three", value;
    ElementRadii: "radii", "radii: `VanDerWaals`, `Covalent`, or `{\"…\": …}` of elements by name", radii;
    Wanted: "wanted value", "a number, or a text in quotation marks", wanted;
    ValueRange: "range", "a range: two numbers `(low, high)`, or `Percentile(low, high)`", range;
    Missing: "treatment of missing values", "a treatment of missing values: `Refuse`, `Hide` or a color", missing;
}

fn column(slice: Slice<'_>) -> Option<ColumnRef> {
    #[derive(Deserialize)]
    enum Form {
        Constant(Placed<Coordinate>),
    }
    if slice.text.starts_with('C') {
        let names = Names {
            noun: "column",
            form: "a column in quotation marks, its number from 1, or `Constant(…)`",
        };
        let Form::Constant(number) = read_structure(slice, names)?;
        return number
            .get()
            .map(|Coordinate(number)| ColumnRef::Constant(number));
    }
    if is_constant(slice.text) {
        return Coordinate::read(slice).map(|Coordinate(number)| ColumnRef::Constant(number));
    }
    if slice.text.starts_with(|c: char| c.is_ascii_digit()) {
        let number: u32 = read_simple(slice, COLUMN)?;
        return match number {
            0 => slice.refuse(COLUMN),
            _ => Some(ColumnRef::Number(number as usize)),
        };
    }
    read_simple(slice, COLUMN).map(ColumnRef::Name)
}

/// Says whether a text is a number with a point or an exponent: the number of a column has neither.
fn is_constant(text: &str) -> bool {
    let is_number = text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    is_number && text.contains(['.', 'e', 'E'])
}

fn radius(slice: Slice<'_>) -> Option<RadiusColumn> {
    #[derive(Deserialize)]
    enum Form {
        Power {
            column: Placed<ColumnRef>,
            #[serde(default, deserialize_with = "present")]
            factor: Option<Placed<Coordinate>>,
            #[serde(default, deserialize_with = "present")]
            exponent: Option<Placed<Coordinate>>,
            #[serde(default, deserialize_with = "present")]
            offset: Option<Placed<Coordinate>>,
        },
    }
    if !slice.text.starts_with('P') {
        let column = column(slice)?;
        return match column {
            ColumnRef::Constant(number) if number <= 0.0 => slice.refuse("a radius greater than 0"),
            column => Some(RadiusColumn::Column(column)),
        };
    }
    let names = Names {
        noun: "column of radii",
        form: "`Power(column: …, factor: …, exponent: …, offset: …)`",
    };
    let Form::Power {
        column,
        factor,
        exponent,
        offset,
    } = read_structure(slice, names)?;
    if let Some(ColumnRef::Constant(_)) = column.value {
        let expected = "the name of a column in quotation marks, or its number from 1";
        return refuse(
            column.place,
            format!("expected {expected}, found a constant"),
        );
    }
    let number = |field| optional(field, |Coordinate(number)| Some(*number));
    let (factor, exponent, offset) = (number(&factor)?, number(&exponent)?, number(&offset)?);
    Some(RadiusColumn::Power {
        column: column.value?,
        factor: factor.unwrap_or(1.0),
        exponent: exponent.unwrap_or(1.0),
        offset: offset.unwrap_or(0.0),
    })
}

fn value(slice: Slice<'_>) -> Option<Value> {
    #[derive(Deserialize)]
    enum Form {
        Length(Placed<ColumnRef>, Placed<ColumnRef>, Placed<ColumnRef>),
    }
    if !slice.text.starts_with(|c: char| c.is_ascii_alphabetic()) || slice.text.starts_with("r#") {
        return column(slice).map(Value::Column);
    }
    let names = Names {
        noun: "value",
        form: "a value: a column in quotation marks, or `Length(…, …, …)`",
    };
    let Form::Length(x, y, z) = read_structure(slice, names)?;
    Some(Value::Length([x.value?, y.value?, z.value?]))
}

fn radii(slice: Slice<'_>) -> Option<ElementRadii> {
    if slice.text.starts_with('{') {
        let names = Names {
            noun: "radii",
            form: "radii `{\"…\": …}` of elements by name",
        };
        return read_structure(slice, names).map(ElementRadii::Own);
    }
    Radii::read(slice).map(ElementRadii::Kind)
}

fn wanted(slice: Slice<'_>) -> Option<Wanted> {
    if slice.text.starts_with(['"', 'r']) {
        return read_simple(slice, "a text in quotation marks").map(Wanted::Text);
    }
    let expected = "a number, or a text in quotation marks";
    read_simple(slice, expected).map(Wanted::Number)
}

fn range(slice: Slice<'_>) -> Option<ValueRange> {
    #[derive(Deserialize)]
    enum Form {
        Percentile(Placed<Percent>, Placed<Percent>),
    }
    let order = "a low number that is less than the high one";
    if slice.text.starts_with('P') {
        let names = Names {
            noun: "range",
            form: "a range: `(low, high)` or `Percentile(low, high)`",
        };
        let Form::Percentile(low, high) = read_structure(slice, names)?;
        let (Percent(low), Percent(high)) = (low.value?, high.value?);
        return match low < high {
            true => Some(ValueRange::Percentile(low, high)),
            false => slice.refuse(order),
        };
    }
    let [Coordinate(low), Coordinate(high)] = read_tuple(slice, "two numbers `(low, high)`")?;
    match low < high {
        true => Some(ValueRange::Fixed(low, high)),
        false => slice.refuse(order),
    }
}

fn missing(slice: Slice<'_>) -> Option<Missing> {
    match slice.text {
        "Refuse" => Some(Missing::Refuse),
        "Hide" => Some(Missing::Hide),
        text if text.starts_with(|c: char| c.is_ascii_alphabetic()) && !text.starts_with('r') => {
            slice.refuse("a treatment of missing values (`Refuse`, `Hide` or a color)")
        }
        _ => Color::read(slice).map(|color| Missing::Color(color.0)),
    }
}

impl<'de, T: Read<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Pairs<T>(PhantomData<T>);

        impl<'de, T: Read<'de>> Visitor<'de> for Pairs<T> {
            type Value = Named<T>;

            fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.write_str("values by name")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Named<T>, A::Error> {
                let mut named = Named(Vec::new());
                while let Some(pair) = map.next_entry()? {
                    named.0.push(pair);
                }
                Ok(named)
            }
        }

        deserializer.deserialize_map(Pairs(PhantomData))
    }
}
