//! `marbles dataset`: the files that programs for photometric stereo read, from a scene with many lights.

mod lights;
mod normals;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use marbles_core::{DirectionalLight, Light, LightPart, Method, Renderer, Settings, View, World};
use marbles_scene::Scene;
use rayon::ThreadPool;

use self::normals::Normals;
use super::args::{DatasetArguments, LayoutForm};
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
use crate::sequence::request::Request;
use crate::terminal::console::Console;
use crate::terminal::interrupt;
use crate::terminal::progress::Progress;

pub(crate) fn run(arguments: &DatasetArguments, console: &Console) -> Result<u8, Failure> {
    if let Some(form) = arguments.progress {
        console.speak_to(form.reader());
    }
    let pool = threads::start(arguments.threads)?;
    let silent = arguments.quiet || arguments.progress.is_some();
    let scene = pool.install(|| scene::load(&arguments.scene, console, silent))?;
    if scene.world().lights.is_empty() {
        return Err(Failure::unusable(
            &arguments.scene,
            "the scene has no lights",
        ));
    }
    let view = scene::view(&scene, arguments.frame)?;
    let view = arguments.size.map_or(view, |size| size.resize(view));
    let lights = match arguments.layout {
        LayoutForm::Diligent => distant_lights(arguments, &scene.lights(&view))?,
    };
    let request = request(arguments, scene, &lights)?;
    interrupt::listen(console);
    prepare(&arguments.output.join("mask.png"))?;

    match arguments.layout {
        LayoutForm::Diligent => write_truth(&arguments.output, &request, (&view, &lights), &pool)?,
    }
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

/// The lights of a layout that has directions of them alone.
fn distant_lights(
    arguments: &DatasetArguments,
    lights: &[Light],
) -> Result<Vec<DirectionalLight>, Failure> {
    let distant = lights.iter().map(|light| match light {
        Light::Directional(light) => Ok(*light),
        Light::Point(_) => Err(Failure::unusable(
            &arguments.scene,
            "the layout diligent has directions of lights, and the scene a point light",
        )),
    });
    distant.collect()
}

/// A picture for each light, in codes of 16 bit that are in proportion to light.
fn request(
    arguments: &DatasetArguments,
    scene: Scene,
    lights: &[DirectionalLight],
) -> Result<Request, Failure> {
    let world = scene.world();
    let names = file_names(lights.len());
    let parts = (0..lights.len()).map(LightPart::Light).zip(names);
    let parts = parts.map(|(light, name)| PicturePart::named(light, name));
    let encoding = Encoding::Png(PngOptions {
        // Those in proportion to light have 16 bit.
        deep: false,
        rgb: true,
        linear: true,
        gain: gain(world, lights),
    });
    let frame = arguments.frame.unwrap_or(*frames_of(&scene).start());
    // Parts have names of their own in this folder.
    let pattern = Pattern::parse(&arguments.output.join("picture.png"));
    Ok(Request {
        parts: parts.collect(),
        pattern: pattern.map_err(Failure::Usage)?,
        encoding,
        frames: FrameList::from(frame..=frame),
        size: arguments.size,
        window: None,
        frames_per_second: None,
        settings: Settings {
            method: Method::Tolerance(arguments.tolerance),
            alpha: false,
        },
        scene,
        scene_path: arguments.scene.clone(),
        centers: None,
        sidecar: false,
        skip_existing: arguments.skip_existing,
        fail_fast: false,
    })
}

/// The names of the pictures: 001.png and so on, with as many digits as the last one has, and three at least.
fn file_names(count: usize) -> impl Iterator<Item = String> {
    let digits = count.to_string().len().max(3);
    (1..=count).map(move |number| format!("{number:0digits$}.png"))
}

/// The power of two by which light is multiplied so that the brightest that a light can make is above ½ and not
/// above 1: no picture is clipped.
fn gain(world: &World, lights: &[DirectionalLight]) -> f64 {
    let mut brightest = 0.0_f64;
    for light in lights {
        let intensity = light.intensity();
        for sphere in 0..world.spheres().len() {
            let highlight = world.material(sphere).highlight;
            let strength = highlight.map_or(0.0, |highlight| highlight.strength);
            let most = world.albedo(sphere) * intensity + intensity * strength;
            brightest = brightest.max(most.max_element());
        }
    }
    if brightest > 0.0 && brightest.is_finite() {
        libm::exp2(-brightest.log2().ceil())
    } else {
        1.0
    }
}

/// Writes what the pictures are to be held against: the lights, the mask and the normals.
fn write_truth(
    folder: &Path,
    request: &Request,
    (view, lights): (&View, &[DirectionalLight]),
    pool: &ThreadPool,
) -> Result<(), Failure> {
    let world = request.scene.world();
    let path = |name: &str| -> PathBuf { folder.join(name) };
    lights::write_names(&path("filenames.txt"), file_names(lights.len()))?;
    lights::write_directions(&path("light_directions.txt"), lights, view)?;
    lights::write_intensities(&path("light_intensities.txt"), lights, gain(world, lights))?;
    let normals = pool.install(|| Normals::of(&Renderer::new(world), view));
    normals.write_mask(&path("mask.png"))?;
    normals.write_picture(&path("Normal_gt.png"))?;
    normals.write_text(&path("normal.txt"))?;
    normals.write_mat(&path("Normal_gt.mat"))
}
