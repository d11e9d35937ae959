//! `marbles spheres`: a table of where each sphere is in the picture, and how much of it is seen.

mod row;
#[cfg(test)]
mod tests;

use std::io::{BufWriter, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use marbles_core::{Renderer, View};
use marbles_scene::Scene;
use rayon::ThreadPool;

use self::row::{HEADER, write_row};
use super::args::SpheresArguments;
use super::inputs::Inputs;
use super::scene;
use crate::base::failure::Failure;
use crate::base::shown::Shown;
use crate::base::{status, threads};
use crate::files::destination::prepare;
use crate::files::save::{Fault, Unwritten, save};
use crate::sequence::frames::{FrameList, frames_of};
use crate::terminal::console::Console;
use crate::terminal::interrupt;

pub(crate) fn run(arguments: &SpheresArguments, console: &Console) -> Result<u8, Failure> {
    let pool = threads::start(arguments.threads)?;
    let scene = pool.install(|| scene::load(&arguments.scene, console, arguments.quiet))?;
    let path = arguments.output.clone();
    let path = path.unwrap_or_else(|| named_after(&arguments.scene));
    Inputs::of(&arguments.scene, &scene).refuse([path.clone()])?;
    let frames = arguments.frames.clone();
    let frames = frames.unwrap_or_else(|| FrameList::from(frames_of(&scene)));
    let views = views(&scene, &frames, arguments)?;
    interrupt::listen(console);
    prepare(&path)?;

    let table = Table {
        scene: &scene,
        renderer: &pool.install(|| Renderer::new(scene.world())),
        tolerance: arguments.tolerance,
        pool: &pool,
    };
    let written = save(&path, |mut file| {
        let mut to = BufWriter::new(file.file());
        table.write(&views, &mut to)?;
        to.flush()?;
        drop(to);
        Ok(file)
    });
    match written {
        Err(Unwritten::Stopped) => {
            console.warn("interrupted: nothing was written");
            return Ok(status::INTERRUPTED);
        }
        Err(Unwritten::Failed(failure)) => return Err(failure),
        Ok(()) => {}
    }
    if !arguments.quiet {
        let (spheres, frames) = (scene.world().spheres().len(), views.len());
        let path = path.shown();
        let plural = |count: usize| if count == 1 { "" } else { "s" };
        console.result(&format!(
            "{path}: {spheres} sphere{} in {frames} frame{}",
            plural(spheres),
            plural(frames)
        ));
    }
    Ok(status::SUCCESS)
}

/// The views of the frames, which have to be the scene's where they are asked for.
fn views(
    scene: &Scene,
    frames: &FrameList,
    arguments: &SpheresArguments,
) -> Result<Vec<View>, Failure> {
    let view = |frame| {
        let view = scene::view_of(scene, frame, "--frames")?;
        Ok(arguments.size.map_or(view, |size| size.resize(view)))
    };
    frames.iter().map(view).collect()
}

/// The table's name: that of the scene, with another ending.
fn named_after(scene: &Path) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or_default().to_owned();
    name.push(".spheres.csv");
    PathBuf::from(name)
}

/// What the table is made of.
struct Table<'a> {
    scene: &'a Scene,
    renderer: &'a Renderer<'a>,
    tolerance: f64,
    pool: &'a ThreadPool,
}

impl Table<'_> {
    /// Writes the rows of all frames.
    fn write(&self, views: &[View], to: &mut impl Write) -> Result<(), Fault> {
        to.write_all(HEADER.as_bytes())?;
        let go_on = |_| match interrupt::requested() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        for view in views {
            let measured = self
                .pool
                .install(|| self.renderer.visible_areas(view, self.tolerance, &go_on));
            let areas = measured.map_err(|_| Fault::Stopped)?;
            let spheres = self.scene.world().spheres().iter();
            for (id, (sphere, visible)) in spheres.zip(&areas).enumerate() {
                write_row(to, view, (id, sphere), visible)?;
            }
        }
        Ok(())
    }
}
