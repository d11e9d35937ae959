//! A picture of time against RMSE, in an SVG.

mod axis;
mod chart;
mod labels;

pub(super) use self::chart::draw;
