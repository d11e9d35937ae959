//! `marbles render`: the frames of a scene, one file each.

use std::path::Path;

use marbles_core::{Method, Settings};
use marbles_scene::Scene;
use rayon::ThreadPool;

use crate::base::failure::Failure;
use crate::base::status;
use crate::base::threads;
use crate::commands::args::{ProgressForm, RenderArguments};
use crate::commands::scene;
use crate::files::place;
use crate::formats::{Encoding, ExrOptions, PngOptions};
use crate::sequence::frames::FrameList;
use crate::sequence::messages;
use crate::sequence::outcome::Tally;
use crate::sequence::pattern::{Format, Pattern};
use crate::sequence::{Persistence, Sequence};
use crate::terminal::console::{Console, Reader};
use crate::terminal::interrupt;
use crate::terminal::progress::Progress;

/// The frame that a scene without animation is rendered as.
pub(crate) const FRAME_OF_A_STILL: i32 = 1;

/// What is rendered, and where it goes.
pub(crate) struct Plan {
    scene: Scene,
    pub(crate) frames: FrameList,
    pattern: Pattern,
    encoding: Encoding,
}

impl Plan {
    /// Reads the scene and checks what can be before anything is rendered.
    pub(crate) fn new(
        arguments: &RenderArguments,
        threads: &ThreadPool,
        console: &Console,
    ) -> Result<Self, Failure> {
        let pattern = arguments.output.as_deref().map(Pattern::parse).transpose();
        let pattern = pattern.map_err(|error| Failure::Usage(error.to_string()))?;
        let format = pattern.as_ref().map_or(Format::Png, Pattern::format);
        let encoding = encoding(arguments, format)?;

        let silent = arguments.quiet || arguments.progress.is_some();
        let scene = threads.install(|| scene::load(&arguments.scene, console, silent))?;
        let frames = frames(arguments, &scene);
        let pattern = pattern.unwrap_or_else(|| {
            let numbered = arguments.frames.is_some() || scene.frames().is_some();
            Pattern::named_after(&arguments.scene, numbered)
        });
        let is_loop = pattern.format() == Format::Apng;
        if is_loop && pattern.is_numbered() {
            let output = arguments.output.as_deref().unwrap_or(Path::new(""));
            return Err(Failure::Usage(format!(
                "{}: all frames are one file, whose name has no place for their number",
                output.display()
            )));
        }
        if frames.is_sequence() && !pattern.is_numbered() && !is_loop {
            return Err(Failure::Usage(format!(
                "{}: {} frames need a place for their number in the name: ####, %04d or {{frame:04}}",
                pattern.path(FRAME_OF_A_STILL).display(),
                frames.count()
            )));
        }
        Ok(Self {
            scene,
            frames,
            pattern,
            encoding,
        })
    }

    /// Whether frames are files of their own.
    pub(crate) fn has_file_per_frame(&self) -> bool {
        self.pattern.format() != Format::Apng
    }

    /// The frames, as they are asked for.
    pub(crate) fn sequence(&self, arguments: &RenderArguments) -> Sequence<'_> {
        Sequence {
            scene: &self.scene,
            frames: &self.frames,
            size: arguments.size,
            window: arguments.region,
            settings: Settings {
                method: match arguments.samples {
                    Some(samples) => Method::Samples(samples),
                    None => Method::Tolerance(arguments.tolerance),
                },
                alpha: arguments.alpha,
            },
            frames_per_second: arguments.fps.or(self.scene.frames_per_second()),
            pattern: &self.pattern,
            encoding: self.encoding,
            persistence: Persistence {
                skip_existing: arguments.skip_existing,
                fail_fast: arguments.fail_fast,
            },
        }
    }
}

pub(crate) fn run(arguments: &RenderArguments, console: &Console) -> Result<u8, Failure> {
    match arguments.progress {
        Some(ProgressForm::Json) => console.speak_to(Reader::Json),
        Some(ProgressForm::OpenJd) => console.speak_to(Reader::OpenJd),
        Some(ProgressForm::Plain | ProgressForm::None) | None => {}
    }
    let threads = threads::start(arguments.threads)?;
    let plan = Plan::new(arguments, &threads, console)?;

    interrupt::listen(console.farewell());
    if let Some(first) = plan.frames.iter().next() {
        place::prepare(&plan.pattern.path(first))?;
    }

    let sequence = plan.sequence(arguments);
    let progress = Progress::new(
        console,
        arguments.progress,
        arguments.quiet,
        plan.frames.count(),
    );
    let tally = sequence.render(&threads, &progress);
    progress.finish();
    let tally = tally?;
    if tally.frames > 1
        && plan.pattern.is_numbered()
        && !arguments.quiet
        && let Some(total) = &tally.total
    {
        console.result(&messages::total(tally.written, total, tally.time));
    }
    Ok(conclusion(&tally, console))
}

/// What is asked for, all frames of the scene, or the only one.
fn frames(arguments: &RenderArguments, scene: &Scene) -> FrameList {
    arguments.frames.clone().unwrap_or_else(|| {
        let frames = scene.frames();
        FrameList::from(frames.unwrap_or(FRAME_OF_A_STILL..=FRAME_OF_A_STILL))
    })
}

/// The options of the format; those of the other one are refused.
fn encoding(arguments: &RenderArguments, format: Format) -> Result<Encoding, Failure> {
    let refused = |option: &str, works: &str, is: &str| {
        Err(Failure::Usage(format!(
            "{option} is for {works} files, and the output is {is}"
        )))
    };
    match format {
        Format::Png | Format::Apng if arguments.float => refused("--float", "EXR", "PNG"),
        Format::Png | Format::Apng if arguments.error_channel => {
            refused("--error-channel", "EXR", "PNG")
        }
        Format::Apng if arguments.skip_existing => Err(Failure::Usage(
            "--skip-existing is for files of one frame each, and the output has all of them"
                .to_owned(),
        )),
        Format::Exr if arguments.rgb => refused("--rgb", "PNG", "EXR"),
        Format::Exr if arguments.bits.is_some() => refused("--bits", "PNG", "EXR"),
        Format::Png | Format::Apng => {
            let options = PngOptions {
                deep: arguments.bits == Some(16),
                rgb: arguments.rgb,
            };
            Ok(if format == Format::Png {
                Encoding::Png(options)
            } else {
                Encoding::Apng(options)
            })
        }
        Format::Exr => Ok(Encoding::Exr(ExrOptions {
            float: arguments.float,
            error: arguments.error_channel,
        })),
    }
}

/// The last word of a run, and its exit code.
fn conclusion(tally: &Tally, console: &Console) -> u8 {
    if tally.interrupted {
        console.warn(&format!("interrupted: {}", messages::counts(tally)));
        status::INTERRUPTED
    } else if !tally.failed.is_empty() {
        if tally.frames > 1 {
            console.warn(&messages::counts(tally));
        }
        status::FAILURE
    } else if tally.is_over_tolerance() {
        console.reason("some pixels are over the tolerance");
        status::FAILURE
    } else {
        status::SUCCESS
    }
}
