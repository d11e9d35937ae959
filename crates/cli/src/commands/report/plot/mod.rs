//! A picture of time against RMSE, in an SVG.

mod axis;
mod chart;
mod labels;
mod svg;

pub(super) use self::chart::draw;
