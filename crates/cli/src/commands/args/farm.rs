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

marbles reads the scene and checks all options before it writes the job. Paths become absolute. All
machines of the farm need the same `marbles`, the same scene and the same output folder. A task skips
frames whose files are complete, so it can be killed and run again.

Exit codes:
  0  the job is written
  1  something failed
  2  the command line or the scene file is wrong";

/// Write a job that renders the frames of a scene on a render farm
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct FarmArguments {
    #[command(subcommand)]
    pub(crate) engine: Engine,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Engine {
    /// Write an array script for Slurm's `sbatch`
    #[command(after_help = EXAMPLES)]
    Slurm(JobArguments),
    /// Write an Open Job Description template with chunks of frames, in JSON
    #[command(name = "openjd", after_help = EXAMPLES)]
    OpenJd(JobArguments),
}

#[derive(Debug, Args)]
pub(crate) struct JobArguments {
    /// Frames per task
    #[arg(long, value_name = "N", default_value = "20", value_parser = chunk, allow_negative_numbers = true)]
    pub(crate) chunk: NonZeroU32,

    /// Write the job to FILE instead of printing it
    #[arg(long, value_name = "FILE")]
    pub(crate) job: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) render: GivenArguments,
}

/// The arguments of `marbles render`, with a required output, and their text on the command line.
#[derive(Debug)]
pub(crate) struct GivenArguments {
    pub(crate) parsed: RenderArguments,
    given: Vec<Given>,
}

/// An option on the command line.
#[derive(Debug)]
struct Given {
    name: String,
    /// The values as written on the command line, one for each time that the option is given. Empty for a flag.
    values: Vec<OsString>,
}

impl GivenArguments {
    /// Returns whether the option with this long name is on the command line.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.given.iter().any(|given| given.name == name)
    }

    /// All options on the command line except `names`, in their long form with `=`.
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
        // The current folder of a task is arbitrary, so a default in it would be of no use.
        RenderArguments::augment_args(command).mut_arg("output", |output| {
            output.required(true).help(
                "Names of the files; ####, %04d or {frame:04} stands for the frame number. The \
                 extension .png, .exr, .npy or .tif chooses the format",
            )
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}
