//! The arguments of `marbles farm`.

use std::ffi::OsString;
use std::num::NonZeroU32;
use std::path::PathBuf;

use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches, Subcommand};

use super::render::RenderArguments;
use super::values::chunk;

const EXAMPLES: &str = "\
Examples:
  marbles farm slurm ball.ron -o out/####.png --frames 1-2400 --chunk 20 > ball.sh
  sbatch --cpus-per-task=8 ball.sh
  marbles farm openjd ball.ron -o out/####.exr --tolerance 1e-4 --job ball.template.json
  openjd run ball.template.json

The scene is read and all options are checked before anything is written. Paths become absolute
ones; `marbles`, the scene and the folder of the output have to be the same for all machines of the
farm. A task skips frames whose files are complete, so it can be killed and run again.

Exit codes:
  0  the job is written
  1  something failed
  2  the command line or the scene file is wrong";

/// Write the job by which a farm renders the frames of a scene
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct FarmArguments {
    #[command(subcommand)]
    pub(crate) engine: Engine,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Engine {
    /// Write a script with an array of tasks, for `sbatch`
    #[command(after_help = EXAMPLES)]
    Slurm(JobArguments),
    /// Write a template of Open Job Description with chunks of tasks, in JSON
    #[command(name = "openjd", after_help = EXAMPLES)]
    OpenJd(JobArguments),
}

#[derive(Debug, Args)]
pub(crate) struct JobArguments {
    /// Frames that a task renders, one after the other
    #[arg(long, value_name = "N", default_value = "20", value_parser = chunk, allow_negative_numbers = true)]
    pub(crate) chunk: NonZeroU32,

    /// Write the job to FILE instead of printing it
    #[arg(long, value_name = "FILE")]
    pub(crate) job: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) render: GivenArguments,
}

/// The arguments of `marbles render`, of which the output is required, and how to give them again.
#[derive(Debug)]
pub(crate) struct GivenArguments {
    pub(crate) parsed: RenderArguments,
    given: Vec<Given>,
}

/// An option on the command line.
#[derive(Debug)]
struct Given {
    name: String,
    /// The values as they are written, one for each time that the option is given; none of a flag.
    values: Vec<OsString>,
}

impl GivenArguments {
    /// Returns whether the option with this long name is on the command line.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.given.iter().any(|given| given.name == name)
    }

    /// All options on the command line but those named, in their long form with `=`.
    pub(crate) fn options_without(&self, names: &[&str]) -> impl Iterator<Item = OsString> {
        let given = self.given.iter();
        let given = given.filter(|given| !names.contains(&given.name.as_str()));
        given.flat_map(|Given { name, values }| {
            let option = OsString::from(format!("--{name}"));
            let flag = values.is_empty().then(|| option.clone());
            let with_value = values.iter().map(move |value| {
                let mut word = option.clone();
                word.push("=");
                word.push(value);
                word
            });
            flag.into_iter().chain(with_value)
        })
    }
}

impl FromArgMatches for GivenArguments {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Self::from_arg_matches_mut(&mut matches.clone())
    }

    fn from_arg_matches_mut(matches: &mut ArgMatches) -> Result<Self, clap::Error> {
        let command = RenderArguments::augment_args(Command::new("render"));
        let mut given = Vec::new();
        for argument in command.get_arguments() {
            let id = argument.get_id().as_str();
            let Some(name) = argument.get_long() else {
                continue;
            };
            if matches.value_source(id) != Some(ValueSource::CommandLine) {
                continue;
            }
            let values = match argument.get_action().takes_values() {
                true => matches.get_raw(id).into_iter().flatten(),
                false => None.into_iter().flatten(),
            };
            given.push(Given {
                name: name.to_owned(),
                values: values.map(OsString::from).collect(),
            });
        }
        let parsed = RenderArguments::from_arg_matches_mut(matches)?;
        Ok(Self { parsed, given })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for GivenArguments {
    fn augment_args(command: Command) -> Command {
        // Nobody wants what a farm renders in the folder that is the current one by chance.
        RenderArguments::augment_args(command).mut_arg("output", |output| {
            output.required(true).help(
                "File names, with ####, %04d or {frame:04} in place of the frame number; the \
                 ending .png, .exr, .npy or .tif chooses the format",
            )
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}
