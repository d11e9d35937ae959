//! The purpose of each column of a table.

mod filter;
mod images;
mod kinds;
mod names;
mod plan;
mod positions;
mod slot;
mod units;
mod uses;

pub(crate) use filter::Test;
pub(crate) use kinds::plan_of_kinds;
pub(crate) use names::{MOST_COLUMNS, axis_of, components, has_axis, marked, tells_radius, unit};
pub(crate) use plan::{Nature, Plan, RadiusSource, ValueSource};
pub(crate) use slot::{MOST_FILTERS, Slot};
pub(crate) use uses::Uses;
