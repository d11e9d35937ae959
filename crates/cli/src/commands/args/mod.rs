//! The command line, as clap reads it.

mod check;
mod compare;
mod dataset;
mod farm;
mod figure;
mod manual;
mod merge;
mod new;
mod preview;
mod render;
mod report;
mod scene;
mod spheres;
mod tips;
mod values;

use std::ffi::OsString;

use clap::error::ContextValue;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::base::layout::lay_out;

pub(crate) use self::check::CheckArguments;
pub(crate) use self::compare::CompareArguments;
pub(crate) use self::dataset::{DatasetArguments, LayoutForm};
pub(crate) use self::farm::{Engine, FarmArguments, JobArguments};
pub(crate) use self::manual::{CompletionsArguments, ManArguments};
pub(crate) use self::merge::MergeArguments;
pub(crate) use self::new::NewArguments;
pub(crate) use self::preview::PreviewArguments;
pub(crate) use self::render::{DEFAULT_TOLERANCE, PerLight, RenderArguments};
pub(crate) use self::report::ReportArguments;
pub(crate) use self::scene::SceneOptions;
pub(crate) use self::spheres::SpheresArguments;

/// Render scenes of spheres to pictures with a known error
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

impl Arguments {
    /// Parses `words`, which begin with the name of the program. Messages and help fit into `columns`.
    pub(crate) fn of(
        words: impl IntoIterator<Item = OsString>,
        columns: usize,
    ) -> Result<Self, clap::Error> {
        let mut command = fitted(Self::command(), columns).term_width(columns);
        let words: Vec<OsString> = words.into_iter().collect();
        let matches = command.try_get_matches_from_mut(&words);
        let mut matches = matches.map_err(|error| {
            let name = words.get(1).and_then(|name| name.to_str());
            harmless(tips::with_tip(error, &command, name.unwrap_or_default()))
        })?;
        Self::from_arg_matches_mut(&mut matches).map_err(|error| error.format(&mut command))
    }
}

/// The same error, with control characters from the command line escaped, so that they cannot control a terminal.
fn harmless(mut error: clap::Error) -> clap::Error {
    let context = error.context().map(|(kind, value)| (kind, value.clone()));
    let context: Vec<_> = context.collect();
    let is_harmful = |text: &String| escaped(text) != *text;
    let mut values = context.iter().map(|(_, value)| value);
    let has_harmful = values.any(|value| match value {
        ContextValue::String(text) => is_harmful(text),
        ContextValue::Strings(texts) => texts.iter().any(is_harmful),
        _ => false,
    });
    if !has_harmful {
        return error;
    }
    for (kind, value) in context {
        let value = match value {
            ContextValue::String(text) => ContextValue::String(escaped(&text)),
            ContextValue::Strings(texts) => {
                ContextValue::Strings(texts.iter().map(|text| escaped(text)).collect())
            }
            // Tips repeat the word between styles. Plain text removes the styles, which are escape sequences too.
            ContextValue::StyledStrs(texts) => {
                let plain = texts.iter().map(|text| escaped(&text.to_string()).into());
                ContextValue::StyledStrs(plain.collect())
            }
            _ => continue,
        };
        error.insert(kind, value);
    }
    error
}

fn escaped(text: &str) -> String {
    marbles_scene::harmless(text)
}

/// The command and its subcommands, with the end of their help wrapped at `columns`.
fn fitted(command: clap::Command, columns: usize) -> clap::Command {
    let command = match command.get_after_help() {
        Some(help) => {
            // It has no colors that would have to be taken away, which takes milliseconds.
            let help = lay_out(&help.ansi().to_string(), columns);
            command.after_help(help)
        }
        None => command,
    };
    command.mut_subcommands(|command| fitted(command, columns))
}

#[cfg(test)]
mod tests;
