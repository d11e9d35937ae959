//! Loads scenes, and shows the progress of reading on a terminal.

use std::fs;
use std::path::Path;

use marbles_core::{View, World};
use marbles_scene::{Figure, Progress, Scene};

use super::args::SceneOptions;
use crate::base::failure::Failure;
use crate::base::memory;
use crate::base::numbers;
use crate::base::shown::Shown;
use crate::sequence::frames::frames_of;
use crate::terminal::bar::{bar, show_line};
use crate::terminal::console::Console;

/// The size in bytes below which no progress is shown, because reading takes too little time.
const LARGE: u64 = 1 << 20;

/// Loads the scene file at `path`, and the tables that it names, on the threads of the current
/// rayon pool.
pub(super) fn load(
    path: &Path,
    options: &SceneOptions,
    console: &Console,
    quiet: bool,
) -> Result<Scene, Failure> {
    load_figure(path, &Figure::default(), options, console, quiet)
}

/// Loads a scene file with what `figure` changes in it, or the figure of a table of particles.
pub(super) fn load_figure(
    path: &Path,
    figure: &Figure,
    options: &SceneOptions,
    console: &Console,
    quiet: bool,
) -> Result<Scene, Failure> {
    let bar = if quiet { None } else { bar(console) };
    let show = |line: String| {
        if let Some(bar) = &bar {
            show_line(bar, line);
        }
    };
    let size = fs::metadata(path).map_or(0, |metadata| metadata.len());
    if size >= LARGE {
        show(format!(
            "reading {}: {}",
            numbers::bytes(size),
            path.shown()
        ));
    }
    let scene = Scene::load_figure(path, figure, &options.set, &|progress| {
        if progress.read.max(progress.size) >= LARGE {
            show(line(&progress));
        }
    });
    if let Some(bar) = &bar {
        bar.finish_and_clear();
    }
    let scene = scene.map_err(|error| Failure::Scene(Box::new(error)))?;
    for hint in scene.hints() {
        console.warn(&format!("hint: {hint}"));
    }
    warn(scene.warnings(), path, options, console)?;
    Ok(scene)
}

/// Prints warnings about the scene at `path`; with `--strict` they are errors.
pub(super) fn warn(
    warnings: &[String],
    path: &Path,
    options: &SceneOptions,
    console: &Console,
) -> Result<(), Failure> {
    for warning in warnings {
        console.warn(warning);
    }
    match warnings.len() {
        0 => Ok(()),
        _ if !options.strict => Ok(()),
        1 => Err(Failure::unusable(
            path,
            "with --strict the warning is an error",
        )),
        count => {
            let why = format!("with --strict the {count} warnings are errors");
            Err(Failure::unusable(path, &why))
        }
    }
}

/// The view of the frame that `--frame` chooses, or else of the first one. The frame must belong to the scene, which
/// was read from `path`.
pub(super) fn view(scene: &Scene, path: &Path, frame: Option<i32>) -> Result<View, Failure> {
    let frame = frame.unwrap_or(*frames_of(scene).start());
    view_of((scene, path), frame, "--frame")
}

/// The view of a frame chosen by an option. The frame must belong to the scene, which was read from `path`.
pub(super) fn view_of(
    (scene, path): (&Scene, &Path),
    frame: i32,
    option: &str,
) -> Result<View, Failure> {
    require_frames(scene, [frame].into_iter(), option)?;
    let view = scene.view(frame);
    view.map_err(|error| Failure::unusable(path, &error.to_string()))
}

/// Refuses frames that an option chooses and the scene does not have.
pub(crate) fn require_frames(
    scene: &Scene,
    mut asked: impl Iterator<Item = i32>,
    option: &str,
) -> Result<(), Failure> {
    let frames = frames_of(scene);
    if let Some(frame) = asked.find(|frame| !frames.contains(frame)) {
        let expected = match frames.into_inner() {
            (first, last) if first == last => format!("{first}, the only frame of the scene"),
            (first, last) => format!("a frame of the scene, from {first} to {last}"),
        };
        return Err(Failure::Usage(format!(
            "{option}: expected {expected}, found {frame}"
        )));
    }
    Ok(())
}

/// The world of the frame that `--frame` chooses, or else of the first one.
pub(super) fn world(scene: &Scene, frame: Option<i32>) -> Result<World, Failure> {
    world_of(scene, frame.unwrap_or(*frames_of(scene).start()))
}

/// The world of a frame, if there is enough memory to prepare it.
pub(super) fn world_of(scene: &Scene, frame: i32) -> Result<World, Failure> {
    let world = scene.world_at(frame);
    let world = world.map_err(|error| Failure::Scene(Box::new(error)))?;
    memory::require_for(&world)?;
    Ok(world)
}

/// The progress of reading a table, in a line.
fn line(progress: &Progress<'_>) -> String {
    let Progress { table, read, size } = progress;
    let table = table.shown();
    if read > size {
        // What is no ordinary file says that it is empty.
        return format!("reading, {} so far: {table}", numbers::bytes(*read));
    }
    let percent = 100.0 * *read as f64 / *size as f64;
    let size = numbers::bytes(*size);
    format!("reading {percent:>3.0}% of {size}: {table}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_say_how_much_of_what_was_read() {
        let line = |read, size| {
            let table = Path::new("salt.npy");
            line(&Progress { table, read, size })
        };
        assert_eq!(line(2 << 20, 0), "reading, 2.1 MB so far: salt.npy");
        assert_eq!(
            line(9_600_000, 320_000_000),
            "reading   3% of 320 MB: salt.npy"
        );
        assert_eq!(line(5 << 20, 5 << 20), "reading 100% of 5.2 MB: salt.npy");
    }
}
