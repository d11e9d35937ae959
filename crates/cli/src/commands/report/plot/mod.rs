//! A picture of time against RMSE, in an SVG.

mod axis;
mod chart;
mod labels;
mod svg;

use std::path::Path;

pub(super) use self::chart::draw;
use crate::base::failure::Failure;

/// Refuses a name of the plot's file that does not end in `.svg`.
pub(super) fn check_name(path: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = path else {
        return Ok(());
    };
    let ending = path.extension().and_then(|ending| ending.to_str());
    if ending.is_some_and(|ending| ending.eq_ignore_ascii_case("svg")) {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "--plot: expected a file name that ends in .svg, the one format of plots, found `{}`",
        path.display()
    )))
}
