//! `marbles spheres`: writes a table with the position and the visible area of each sphere.

mod row;
#[cfg(test)]
mod tests;

use std::io::{BufWriter, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use marbles_core::{Renderer, parallel};
use marbles_scene::Scene;
use rayon::ThreadPool;

use self::row::{HEADER, write_row};
use super::args::SpheresArguments;
use super::inputs::Inputs;
use super::scene;
use crate::base::failure::Failure;
use crate::base::scene_name::scene_name;
use crate::base::shown::Shown;
use crate::base::size::Size;
use crate::base::{status, threads};
use crate::files::destination::prepare;
use crate::files::save::{Fault, Unwritten, save};
use crate::sequence::frames::{FrameList, frames_of};
use crate::terminal::console::Console;
use crate::terminal::interrupt;

pub(crate) fn run(arguments: &SpheresArguments, console: &Console) -> Result<u8, Failure> {
    let pool = threads::start(arguments.threads)?;
    let scene = parallel::install(&pool, || {
        scene::load(
            &arguments.scene,
            &arguments.options,
            console,
            arguments.quiet,
        )
    })?;
    let path = arguments.output.clone();
    let path = path.unwrap_or_else(|| named_after(&arguments.scene));
    Inputs::of(&arguments.scene, &scene).refuse([path.clone()])?;
    let frames = arguments.frames.clone();
    let frames = frames.unwrap_or_else(|| FrameList::from(frames_of(&scene)));
    let frames: Vec<i32> = frames.iter().collect();
    for &frame in &frames {
        scene::view_of((&scene, &arguments.scene), frame, "--frames")?;
    }
    interrupt::listen(console);
    prepare(&path)?;

    let table = Table {
        scene: &scene,
        size: arguments.size,
        tolerance: arguments.tolerance,
        pool: &pool,
    };
    let mut spheres = 0;
    let written = save(&path, |mut file| {
        let mut to = BufWriter::new(file.file());
        spheres = table.write(&frames, &mut to)?;
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
        let frames = frames.len();
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

/// The name of the table: that of the scene with another extension.
fn named_after(scene: &Path) -> PathBuf {
    let mut name = scene_name(scene).to_owned();
    name.push(".spheres.csv");
    PathBuf::from(name)
}

/// The data from which the table is made.
struct Table<'a> {
    scene: &'a Scene,
    /// A size instead of the scene's.
    size: Option<Size>,
    tolerance: f64,
    pool: &'a ThreadPool,
}

impl Table<'_> {
    /// Writes the rows of all frames; returns the number of spheres in the first of them.
    fn write(&self, frames: &[i32], to: &mut impl Write) -> Result<usize, Fault> {
        to.write_all(HEADER.as_bytes())?;
        let go_on = |_| match interrupt::requested() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        let mut count = None;
        let same_step =
            |one: &i32, other: &i32| self.scene.steps_at(*one) == self.scene.steps_at(*other);
        for frames in frames.chunk_by(same_step) {
            let world = parallel::install(self.pool, || scene::world_of(self.scene, frames[0]));
            let world = world.map_err(Fault::Failed)?;
            let renderer = parallel::install(self.pool, || Renderer::new(&world));
            count.get_or_insert(world.spheres().len());
            for &frame in frames {
                // All of them were looked at before.
                let view = self.scene.view(frame);
                let view = view.map_err(|error| Fault::Encoding(error.to_string()))?;
                let view = self.size.map_or(view, |size| size.resize(view));
                let measured = parallel::install(self.pool, || {
                    renderer.visible_areas(&view, self.tolerance, &go_on)
                });
                let areas = measured.map_err(|_| Fault::Stopped)?;
                let spheres = world.spheres().iter();
                for (id, (sphere, visible)) in spheres.zip(&areas).enumerate() {
                    write_row(to, &view, (id, sphere), visible)?;
                }
            }
        }
        Ok(count.unwrap_or(0))
    }
}
