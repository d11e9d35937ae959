//! The command line, as clap reads it.

mod check;
mod compare;
mod dataset;
mod farm;
mod manual;
mod merge;
mod new;
mod preview;
mod render;
mod report;
mod scene;
mod spheres;
mod values;

use clap::{Parser, Subcommand};

pub(crate) use self::check::CheckArguments;
pub(crate) use self::compare::CompareArguments;
pub(crate) use self::dataset::{DatasetArguments, LayoutForm};
pub(crate) use self::farm::{Engine, FarmArguments, JobArguments};
pub(crate) use self::manual::{CompletionsArguments, ManArguments};
pub(crate) use self::merge::MergeArguments;
pub(crate) use self::new::NewArguments;
pub(crate) use self::preview::PreviewArguments;
pub(crate) use self::render::{PerLight, RenderArguments};
pub(crate) use self::report::ReportArguments;
pub(crate) use self::scene::SceneOptions;
pub(crate) use self::spheres::SpheresArguments;

/// Render scenes of spheres to pictures whose pixels are known
#[derive(Debug, Parser)]
#[command(name = "marbles", version, arg_required_else_help = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Render(RenderArguments),
    Preview(PreviewArguments),
    Check(CheckArguments),
    Compare(CompareArguments),
    Merge(MergeArguments),
    Report(ReportArguments),
    Spheres(SpheresArguments),
    Dataset(DatasetArguments),
    Farm(FarmArguments),
    New(NewArguments),
    Completions(CompletionsArguments),
    Man(ManArguments),
}

#[cfg(test)]
mod tests;
