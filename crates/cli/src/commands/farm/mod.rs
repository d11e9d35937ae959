//! `marbles farm`: the job by which a farm renders the frames of a scene.
//!
//! It is checked here as far as it can be, so that what is wrong does not show on a thousand machines.

mod chunks;
mod openjd;
mod slurm;

use std::ffi::OsString;
use std::num::NonZeroU32;
use std::path::{self, Path};

use crate::base::failure::Failure;
use crate::base::status;
use crate::base::threads;
use crate::commands::args::{Engine, FarmArguments, JobArguments};
use crate::commands::render::Plan;
use crate::formats;
use crate::terminal::console::Console;

/// Frames that are looked at before the job is written; more would take long.
const FRAMES_LOOKED_AT: usize = 100_000;
/// The tasks that an array may have where nobody has set Slurm's `MaxArraySize`.
const USUAL_TASKS: usize = 1001;

/// What the tasks of a job have in common; paths are absolute.
struct Job {
    /// Without spaces, quotes and what else scripts and templates read.
    name: String,
    scene: String,
    /// In the order of rendering.
    frames: Vec<i32>,
    chunk: NonZeroU32,
    /// The option that names the files.
    output: String,
    /// Other options.
    options: Vec<String>,
    /// Whether the options say how many threads.
    threads: bool,
    /// Whether they say how to tell progress.
    progress: bool,
}

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
    let tasks = job.frames.len().div_ceil(job.chunk.get() as usize);
    match &arguments.job {
        None => console.result(text.trim_end()),
        Some(path) => {
            formats::write_bytes(text.as_bytes(), path)?;
            if !arguments.render.parsed.quiet {
                console.result(&format!(
                    "{}: {} frames in {tasks} tasks",
                    path.display(),
                    job.frames.len()
                ));
            }
        }
    }
    if is_slurm && tasks > USUAL_TASKS {
        console.warn(&format!(
            "an array of {tasks} tasks: unless MaxArraySize is set, Slurm takes {USUAL_TASKS}; a \
             larger --chunk makes fewer"
        ));
    }
    Ok(status::SUCCESS)
}

impl Job {
    /// Reads the scene and makes sure that its frames can be rendered with these options.
    fn checked(
        arguments: &JobArguments,
        is_slurm: bool,
        console: &Console,
    ) -> Result<Self, Failure> {
        let render = &arguments.render.parsed;
        let plan = Plan::new(render, &threads::start(None)?, console)?;
        if !plan.has_file_per_frame() {
            return Err(Failure::Usage(
                "tasks write a file for each frame, and the output has all of them".to_owned(),
            ));
        }
        let sequence = plan.sequence(render);
        for frame in plan.frames.iter().take(FRAMES_LOOKED_AT) {
            sequence.check(frame)?;
        }
        if !is_slurm && arguments.render.has("progress") {
            return Err(Failure::Usage(
                "--progress: runners of Open Job Description read --progress=openjd, which their \
                 templates always have"
                    .to_owned(),
            ));
        }
        // The parts of a job have their own of these, and tell apart what a path is.
        let own = ["frames", "output", "skip-existing"];
        let options = arguments.render.options_without(&own);
        let output = render.output.as_deref().unwrap_or(Path::new(""));
        let mut output_option = OsString::from("--output=");
        output_option.push(absolute(output)?);
        Ok(Self {
            name: name(&render.scene),
            scene: text(absolute(&render.scene)?)?,
            frames: plan.frames.iter().collect(),
            chunk: arguments.chunk,
            output: text(output_option)?,
            options: options.map(text).collect::<Result<_, _>>()?,
            threads: arguments.render.has("threads"),
            progress: arguments.render.has("progress"),
        })
    }
}

/// A name of a job that any program takes.
fn name(scene: &Path) -> String {
    /// What Open Job Description has room for.
    const LONGEST: usize = 128;
    let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
    let plain = |letter: char| match letter {
        'a'..='z' | 'A'..='Z' | '0'..='9' | '-' | '.' => letter,
        _ => '_',
    };
    let name = format!("marbles-{}", stem.chars().map(plain).collect::<String>());
    name.chars().take(LONGEST).collect()
}

fn absolute(path: &Path) -> Result<OsString, Failure> {
    let absolute = path::absolute(path);
    absolute
        .map(OsString::from)
        .map_err(|error| Failure::io(path, "cannot find the folder", &error))
}

/// What can be part of a job, whose engines read UTF-8.
fn text(word: OsString) -> Result<String, Failure> {
    word.into_string()
        .map_err(|word| Failure::Usage(format!("expected UTF-8, found `{}`", word.display())))
}
