//! `marbles render`: the frames of a scene, one file each.

use std::path::Path;

use marbles_core::{Method, Settings};
use marbles_scene::Scene;

use crate::args::RenderArguments;
use crate::console::Console;
use crate::failure::Failure;
use crate::frames::FrameList;
use crate::interrupt;
use crate::loading;
use crate::messages;
use crate::output::{self, Encoding, ExrOptions, PngOptions};
use crate::pattern::{Format, Pattern};
use crate::progress::Progress;
use crate::sequence::{Sequence, Tally};
use crate::status;
use crate::threads;

/// The frame that a scene without animation is rendered as.
pub(crate) const FRAME_OF_A_STILL: i32 = 1;

pub(crate) fn run(arguments: &RenderArguments, console: &Console) -> Result<u8, Failure> {
    let pattern = arguments.output.as_deref().map(Pattern::parse).transpose();
    let pattern = pattern.map_err(|error| Failure::Usage(error.to_string()))?;
    let format = pattern.as_ref().map_or(Format::Png, Pattern::format);
    let encoding = encoding(arguments, format)?;

    let threads = threads::start(arguments.threads)?;
    let scene = threads.install(|| loading::scene(&arguments.scene, console, arguments.quiet))?;
    let frames = frames(arguments, &scene);
    let pattern = pattern.unwrap_or_else(|| {
        let numbered = arguments.frames.is_some() || scene.frames().is_some();
        Pattern::named_after(&arguments.scene, numbered)
    });
    let is_loop = pattern.format() == Format::Apng;
    if is_loop && pattern.is_numbered() {
        return Err(Failure::Usage(format!(
            "{}: all frames are one file, whose name has no place for their number",
            arguments
                .output
                .as_deref()
                .unwrap_or(Path::new(""))
                .display()
        )));
    }
    if frames.is_sequence() && !pattern.is_numbered() && !is_loop {
        return Err(Failure::Usage(format!(
            "{}: {} frames need a place for their number in the name: ####, %04d or {{frame:04}}",
            pattern.path(FRAME_OF_A_STILL).display(),
            frames.count()
        )));
    }

    interrupt::listen();
    if let Some(first) = frames.iter().next() {
        output::prepare(&pattern.path(first))?;
    }

    let sequence = Sequence {
        scene: &scene,
        frames: &frames,
        size: arguments.size,
        settings: Settings {
            method: match arguments.samples {
                Some(samples) => Method::Samples(samples),
                None => Method::Tolerance(arguments.tolerance),
            },
            alpha: arguments.alpha,
        },
        pattern: &pattern,
        encoding,
    };
    let progress = Progress::new(console, arguments.quiet, frames.count());
    let tally = sequence.render(&threads, &progress);
    progress.finish();
    if tally.frames > 1
        && !is_loop
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
    let Tally {
        frames, written, ..
    } = tally;
    if tally.interrupted {
        console.warn(&format!(
            "interrupted: {written} of {frames} frames written"
        ));
        status::INTERRUPTED
    } else if tally.failed || tally.is_over_tolerance() {
        if tally.failed && *frames > 1 {
            console.warn(&format!("{written} of {frames} frames written"));
        }
        status::FAILURE
    } else {
        status::SUCCESS
    }
}
