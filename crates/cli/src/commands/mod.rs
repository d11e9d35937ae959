//! The commands, each in a file or a folder with its name, and their arguments.

pub(crate) mod args;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod dataset;
mod dim_light;
pub(crate) mod farm;
mod figures;
pub(crate) mod format_options;
mod inputs;
mod legend;
pub(crate) mod man;
pub(crate) mod merge;
pub(crate) mod new;
mod oversights;
pub(crate) mod preview;
pub(crate) mod render;
pub(crate) mod report;
mod scale_bar;
pub(crate) mod scene;
mod several_scenes;
pub(crate) mod spheres;
mod standard_output;
pub(crate) mod svg;
