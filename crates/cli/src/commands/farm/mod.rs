//! `marbles farm`: writes a job that renders the frames of a scene on a render farm.
//!
//! As much as possible is checked here, so that errors do not first appear on a thousand machines.

mod chunks;
mod job;
mod openjd;
mod slurm;

use self::job::Job;
use super::args::{Engine, FarmArguments};
use crate::base::failure::Failure;
use crate::base::shown::Shown;
use crate::base::status;
use crate::files::save::write_bytes;
use crate::terminal::console::Console;

/// The largest number of tasks of an array, unless Slurm's `MaxArraySize` is set.
const USUAL_TASKS: usize = 1001;

pub(crate) fn run(arguments: &FarmArguments, console: &Console) -> Result<u8, Failure> {
    let (arguments, is_slurm) = match &arguments.engine {
        Engine::Slurm(arguments) => (arguments, true),
        Engine::OpenJd(arguments) => (arguments, false),
    };
    let job = Job::checked(arguments, is_slurm, console)?;
    let text = if is_slurm {
        slurm::script(&job)?
    } else {
        openjd::template(&job)?
    };
    let tasks = job.tasks();
    match &arguments.job {
        // For a file: as it is.
        None => console.print(&format!("{}\n", text.trim_end())),
        Some(path) => {
            write_bytes(text.as_bytes(), path)?;
            if !arguments.render.parsed.quiet {
                console.result(&format!(
                    "{}: {} frames in {tasks} tasks",
                    path.shown(),
                    job.frames.len()
                ));
            }
        }
    }
    if is_slurm && tasks > USUAL_TASKS {
        console.warn(&format!(
            "the array has {tasks} tasks, and Slurm accepts {USUAL_TASKS} unless MaxArraySize is set; a larger \
             --chunk makes fewer tasks"
        ));
    }
    Ok(status::SUCCESS)
}
