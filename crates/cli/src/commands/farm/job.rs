//! The job that is written, whatever the scheduler.

use std::ffi::OsString;
use std::num::NonZeroU32;
use std::path::{self, Path};

use marbles_scene::STANDARD_INPUT;

use crate::base::failure::Failure;
use crate::base::threads;
use crate::commands::args::JobArguments;
use crate::commands::inputs::Inputs;
use crate::commands::render::request;
use crate::terminal::console::Console;

/// The most frames that are checked before the job is written.
const FRAMES_LOOKED_AT: usize = 100_000;

/// The common parts of a job's tasks; paths are absolute.
pub(super) struct Job {
    /// A name without spaces, quotes and other characters with a meaning in scripts and templates.
    pub(super) name: String,
    pub(super) scene: String,
    /// The frames in the order of rendering.
    pub(super) frames: Vec<i32>,
    pub(super) chunk: NonZeroU32,
    /// The option that names the files.
    pub(super) output: String,
    /// Other options.
    pub(super) options: Vec<String>,
    /// Whether the options set the number of threads.
    pub(super) threads: bool,
    /// Whether the options set the form of progress.
    pub(super) progress: bool,
}

impl Job {
    /// Reads the scene, and makes sure that its frames can be rendered with these options.
    pub(super) fn checked(
        arguments: &JobArguments,
        is_slurm: bool,
        console: &Console,
    ) -> Result<Self, Failure> {
        let render = &arguments.render.parsed;
        let [scene] = &render.scenes[..] else {
            return Err(Failure::Usage(
                "expected one scene, found several".to_owned(),
            ));
        };
        if scene.as_path() == Path::new(STANDARD_INPUT) {
            let message =
                "expected the file of a scene, which every task reads, found the standard input";
            return Err(Failure::Usage(message.to_owned()));
        }
        let request = request(render, scene, &threads::start(None)?, console)?;
        if request.pattern.is_standard_output() {
            let message = "expected names of files, which tasks write, found the standard output";
            return Err(Failure::Usage(message.to_owned()));
        }
        if request.is_animation() {
            return Err(Failure::Usage(
                "a task writes one file per frame, but this output contains all frames".to_owned(),
            ));
        }
        let inputs = Inputs::of(&request.scene_path, &request.scene);
        inputs.refuse(arguments.job.clone())?;
        for frame in request.frames.iter().take(FRAMES_LOOKED_AT) {
            request.check(frame)?;
        }
        if !is_slurm && arguments.render.has("progress") {
            return Err(Failure::Usage(
                "--progress: templates of Open Job Description always use --progress=openjd, because their \
                 runners read no other form"
                    .to_owned(),
            ));
        }
        // The parts of a job have their own of these, and tell apart what a path is.
        let own = ["frames", "output", "skip-existing", "legend", "scale-bar"];
        let options = arguments.render.options_without(&own);
        let output = render.output.as_deref().unwrap_or(Path::new(""));
        let mut output_option = OsString::from("--output=");
        output_option.push(absolute(output)?);
        Ok(Self {
            name: name(scene),
            scene: text(absolute(scene)?)?,
            frames: request.frames.iter().collect(),
            chunk: arguments.chunk,
            output: text(output_option)?,
            options: options.map(text).collect::<Result<_, _>>()?,
            threads: arguments.render.has("threads"),
            progress: arguments.render.has("progress"),
        })
    }

    /// The number of tasks.
    pub(super) fn tasks(&self) -> usize {
        self.frames.len().div_ceil(self.chunk.get() as usize)
    }
}

/// A name for the job that all programs accept.
fn name(scene: &Path) -> String {
    /// The longest name in Open Job Description.
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

/// A word of a job, as UTF-8, which schedulers need.
fn text(word: OsString) -> Result<String, Failure> {
    word.into_string()
        .map_err(|word| Failure::Usage(format!("expected UTF-8, found `{}`", word.display())))
}
