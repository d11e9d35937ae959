//! The values of a cloud that are of several forms: columns, conditions, ranges, palettes.

use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::table::{ColumnRef, Missing, Value, ValueRange};
use crate::text::{
    Names, Placed, Read, Slice, note_failure, read_simple, read_structure, read_tuple,
};
use crate::values::{Color, Coordinate, Percent, Step};

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

/// The colors of categories by their names, in the file's order.
#[derive(Debug, Default)]
pub(crate) struct Palette(pub(crate) Vec<(String, Placed<Color>)>);

const COLUMN: &str = "the name of a column in quotation marks, or its number from 1";

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
    Value: "value", "a column in quotation marks, or `Length(…, …, …)` of three", value;
    Wanted: "wanted value", "a number, or a text in quotation marks", wanted;
    ValueRange: "range", "a range: two numbers `(low, high)`, or `Percentile(low, high)`", range;
    Missing: "treatment of missing values", "what becomes of missing values: `Refuse`, `Hide` or a color", missing;
}

fn column(slice: Slice<'_>) -> Option<ColumnRef> {
    if slice.text.starts_with(|c: char| c.is_ascii_digit()) {
        let number: u32 = read_simple(slice, COLUMN)?;
        return match number {
            0 => slice.refuse(COLUMN),
            _ => Some(ColumnRef::Number(number as usize)),
        };
    }
    read_simple(slice, COLUMN).map(ColumnRef::Name)
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
            slice.refuse("what becomes of missing values (`Refuse`, `Hide` or a color)")
        }
        _ => Color::read(slice).map(|color| Missing::Color(color.0)),
    }
}

impl<'de> Deserialize<'de> for Palette {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Pairs;

        impl<'de> Visitor<'de> for Pairs {
            type Value = Palette;

            fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.write_str("colors by name")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Palette, A::Error> {
                let mut palette = Palette::default();
                while let Some(pair) = map.next_entry()? {
                    palette.0.push(pair);
                }
                Ok(palette)
            }
        }

        deserializer.deserialize_map(Pairs)
    }
}
