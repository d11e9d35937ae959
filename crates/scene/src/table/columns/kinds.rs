//! The plan by which columns are read that are stored in ways known before.

use glam::DVec3;

use super::super::kind::Kind;
use super::super::request::{Coloring, Request};
use super::plan::{Nature, Plan};
use super::slot::Slot;
use crate::text::show;

/// The plan by which columns of these names and kinds are read.
///
/// # Errors
/// Returns what is missing, and what is no number where one is needed.
pub(crate) fn plan_of_kinds(
    names: Vec<String>,
    kinds: &[Kind],
    request: &Request,
) -> Result<Plan, String> {
    let kind = |column: usize| kinds.get(column).copied().unwrap_or(Kind::Other(0));
    let nature = Nature {
        edges: None,
        scale: DVec3::ONE,
        is_byte: &|column| kind(column).is_byte(),
        is_text: &|column| kind(column).is_text(),
        angstrom: 1.0,
        cell: None,
    };
    let plan = Plan::new(names, request, &nature)?;
    for (column, uses) in plan.uses.iter().enumerate() {
        let is_number = matches!(kind(column), Kind::Number(..));
        let may_be_text = |slot: &Slot| match slot {
            Slot::Element | Slot::Contents(_) => true,
            Slot::Value => plan.coloring == Coloring::Category,
            Slot::Filter(filter) => plan.filters[usize::from(*filter)].text().is_some(),
            _ => false,
        };
        let is_good = is_number || kind(column).is_text() && uses.slots().iter().all(may_be_text);
        let is_looked_at = matches!(uses.slots(), [Slot::Contents(_)]);
        if !uses.slots().is_empty() && !is_good && !is_looked_at {
            let name = show(&plan.names.0[column]);
            return Err(format!(
                "expected numbers in the column {name}, found something else"
            ));
        }
    }
    Ok(plan)
}
