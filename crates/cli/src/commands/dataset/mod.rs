//! `marbles dataset`: writes a data set for photometric stereo from a scene with many lights.

mod centers;
mod diligent;
mod lines;
mod lp;
mod luces;
mod mark;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use marbles_core::{
    DirectionalLight, Light, LightPart, Method, PointLight, Renderer, Settings, View, World,
    parallel,
};
use marbles_scene::Scene;
use rayon::ThreadPool;

use self::centers::Centers;
use self::lines::write_lines;
use super::args::{DatasetArguments, LayoutForm};
use super::inputs::Inputs;
use super::render::conclusion;
use super::scene;
use crate::base::failure::Failure;
use crate::base::threads;
use crate::files::destination::prepare;
use crate::formats::encoding::{Encoding, PngOptions};
use crate::sequence::frames::{FrameList, frames_of};
use crate::sequence::messages;
use crate::sequence::parts::PicturePart;
use crate::sequence::pattern::Pattern;
use crate::sequence::render::render;
use crate::sequence::request::{Destination, Request};
use crate::terminal::console::Console;
use crate::terminal::interrupt;
use crate::terminal::progress::Progress;

pub(crate) fn run(arguments: &DatasetArguments, console: &Console) -> Result<u8, Failure> {
    if let Some(form) = arguments.progress {
        console.speak_to(form.reader());
    }
    let pool = threads::start(arguments.threads)?;
    let silent = arguments.quiet || arguments.progress.is_some();
    let scene = parallel::install(&pool, || {
        scene::load(&arguments.scene, &arguments.options, console, silent)
    })?;
    if scene.world().lights.is_empty() {
        return Err(Failure::unusable(
            &arguments.scene,
            "the scene has no lights",
        ));
    }
    let view = scene::view(&scene, &arguments.scene, arguments.frame)?;
    let view = arguments.size.map_or(view, |size| size.resize(view));
    let lights = scene.lights(&view);
    let layout = Layout::new(arguments, &view, &lights)?;
    let world = parallel::install(&pool, || scene::world(&scene, arguments.frame))?;
    let gain = gain(&world, &lights);
    let request = request(arguments, scene, (&layout, lights.len()), gain)?;
    layout.refuse_files(&arguments.output, &request)?;
    interrupt::listen(console);

    layout.write(arguments, &request, (&view, gain), (&world, &pool))?;
    drop(world);
    let (form, quiet) = (arguments.progress, arguments.quiet);
    let progress = Progress::new(console, form, quiet, request.pictures());
    let outcome = render(&request, &pool, &progress);
    progress.finish();
    let outcome = outcome?;
    if !quiet && let Some(total) = messages::total(&outcome, "picture") {
        console.result(&total);
    }
    Ok(conclusion(&outcome, "picture", console))
}

/// The file that lists the pictures.
const PICTURES: &str = "filenames.txt";

/// A layout, and the lights of the kind that it needs.
enum Layout {
    Diligent(Vec<DirectionalLight>),
    Luces(Vec<PointLight>),
    Lp(Vec<DirectionalLight>),
}

impl Layout {
    /// The requested layout. Refuses lights and lenses that it does not support.
    fn new(arguments: &DatasetArguments, view: &View, lights: &[Light]) -> Result<Self, Failure> {
        let scene = &arguments.scene;
        Ok(match arguments.layout {
            LayoutForm::Diligent => Self::Diligent(diligent::lights(scene, "diligent", lights)?),
            LayoutForm::Lp => Self::Lp(lp::lights(scene, lights)?),
            LayoutForm::Luces => {
                luces::check_lens(scene, view)?;
                Self::Luces(luces::lights(scene, lights)?)
            }
        })
    }

    /// Its name on the command line.
    fn name(&self) -> &'static str {
        match self {
            Self::Diligent(_) => "diligent",
            Self::Luces(_) => "luces",
            Self::Lp(_) => "lp",
        }
    }

    /// The smallest number of digits in the name of a picture.
    fn digits(&self) -> usize {
        match self {
            Self::Diligent(_) | Self::Lp(_) => 3,
            Self::Luces(_) => 2,
        }
    }

    /// Refuses a folder in which a file would replace the scene, a table, or a file of somebody else.
    fn refuse_files(&self, folder: &Path, request: &Request) -> Result<(), Failure> {
        let names: &[&str] = match self {
            Self::Diligent(_) => &diligent::NAMES,
            Self::Luces(_) => &luces::NAMES,
            Self::Lp(_) => &lp::NAMES,
        };
        let beside = names.iter().chain([&mark::MASK, &PICTURES]);
        let frame = request.frames.first();
        let pictures = (0..request.parts.len()).map(|part| request.path(frame, part));
        let files = beside.map(|name| folder.join(name)).chain(pictures);
        let files: Vec<PathBuf> = files.collect();
        Inputs::of(&request.scene_path, &request.scene).refuse(files.iter().cloned())?;
        mark::refuse_files_of_others(folder, self.name(), files)
    }

    /// Writes all files except for the pictures.
    fn write(
        &self,
        arguments: &DatasetArguments,
        request: &Request,
        (view, gain): (&View, f64),
        (world, pool): (&World, &ThreadPool),
    ) -> Result<(), Failure> {
        let renderer = || Renderer::new(world);
        let centers = parallel::install(pool, || Centers::of(&renderer(), view));
        let folder = &arguments.output;
        let names = folder.join(PICTURES);
        let pictures = || file_names(request.parts.len(), self.digits());
        let write_first = || {
            prepare(&names)?;
            // What comes after it is known as marbles' own by it.
            centers.write_mask(&folder.join(mark::MASK), mark::of(self.name()))?;
            write_lines(&names, pictures())
        };
        match self {
            Self::Diligent(lights) => {
                write_first()?;
                diligent::write(folder, view, (lights, gain), &centers, pictures())
            }
            Self::Lp(lights) => {
                write_first()?;
                lp::write(folder, view, lights, &centers, pictures())
            }
            Self::Luces(lights) => {
                let mean_distance = luces::mean_distance(&arguments.scene, &centers)?;
                write_first()?;
                luces::write(folder, view, (lights, gain), (&centers, mean_distance))
            }
        }
    }
}

/// A picture for each light, in linear codes of 16 bits.
fn request(
    arguments: &DatasetArguments,
    scene: Scene,
    (layout, lights): (&Layout, usize),
    gain: f64,
) -> Result<Request, Failure> {
    let names = file_names(lights, layout.digits());
    let parts = (0..lights).map(LightPart::Light).zip(names);
    let parts = parts.map(|(light, name)| PicturePart::named(light, name));
    let encoding = Encoding::Png(PngOptions {
        // Those in proportion to light have 16 bit.
        deep: false,
        rgb: true,
        linear: true,
        gain,
    });
    let frame = arguments.frame.unwrap_or(*frames_of(&scene).start());
    // Parts have names of their own in this folder.
    let pattern = Pattern::parse(&arguments.output.join("picture.png"));
    Ok(Request {
        parts: parts.collect(),
        layers: Vec::new(),
        pattern: pattern.map_err(Failure::Usage)?,
        encoding,
        frames: FrameList::from(frame..=frame),
        size: arguments.size,
        window: None,
        frames_per_second: None,
        settings: Settings {
            // Light is multiplied by a power of two, and so is the error that is accepted.
            method: Method::Tolerance(arguments.tolerance / gain),
            alpha: false,
        },
        error_scale: gain,
        scene: Arc::new(scene),
        scene_path: arguments.scene.clone(),
        centers: None,
        sidecar: false,
        skip_existing: arguments.skip_existing,
        fail_fast: false,
        destination: Destination::Files,
    })
}

/// The names of the pictures: 001.png and so on, with as many digits as the last number has, but at least `least`.
fn file_names(count: usize, least: usize) -> impl Iterator<Item = String> {
    let digits = count.to_string().len().max(least);
    (1..=count).map(move |number| format!("{number:0digits$}.png"))
}

/// The power of two by which light is multiplied. It brings the largest possible light of a pixel above ½ and not above
/// 1, so that no picture is clipped.
fn gain(world: &World, lights: &[Light]) -> f64 {
    let mut brightest = 0.0_f64;
    for light in lights {
        for (sphere, ball) in world.spheres().iter().enumerate() {
            let intensity = light.brightest_on(ball);
            let highlight = world.material(sphere).highlight;
            let strength = highlight.map_or(0.0, |highlight| highlight.strength);
            let most = world.albedo(sphere) * intensity + intensity * strength;
            brightest = brightest.max(most.max_element());
        }
    }
    if brightest > 0.0 && brightest.is_finite() {
        // Beyond that, powers of two and tolerances times them are no numbers any more.
        const MOST: f64 = 1000.0;
        libm::exp2((-brightest.log2().ceil()).clamp(-MOST, MOST))
    } else {
        1.0
    }
}
