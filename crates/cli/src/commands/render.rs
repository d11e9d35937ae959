//! `marbles render`: renders the frames of a scene to picture files.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use marbles_core::{Method, Settings, View, parallel};
use marbles_scene::Setting;
use rayon::ThreadPool;

use super::args::{PerLight, RenderArguments};
use super::format_options::encoding;
use super::inputs::Inputs;
use super::several_scenes::Others;
use super::{dim_light, figures, oversights, scene, standard_output};
use crate::base::failure::Failure;
use crate::base::scene_name::scene_name;
use crate::base::shown::Shown;
use crate::base::{status, threads};
use crate::files::destination::prepare;
use crate::formats::center_channels::{AxesForm, CenterChannels, DepthForm};
use crate::formats::encoding::{Encoding, Format};
use crate::formats::loops::why_other_rate;
use crate::formats::npy::files::names_beside;
use crate::formats::sidecar;
use crate::sequence::frames::{FRAME_OF_A_STILL, FrameList, frames_of};
use crate::sequence::layers::LightLayer;
use crate::sequence::messages;
use crate::sequence::outcome::Outcome;
use crate::sequence::parts::PicturePart;
use crate::sequence::pattern::{Pattern, with_scene};
use crate::sequence::render::render;
use crate::sequence::request::{Destination, Request};
use crate::terminal::console::Console;
use crate::terminal::interrupt;
use crate::terminal::progress::Progress;

pub(crate) fn run(arguments: &RenderArguments, console: &Console) -> Result<u8, Failure> {
    if let Some(form) = arguments.progress {
        console.speak_to(form.reader());
    }
    let threads = threads::start(arguments.threads)?;
    let is_alone = arguments.scenes.len() == 1;
    let mut others = Others::of(arguments)?;
    let mut code = status::SUCCESS;
    for scene in &arguments.scenes {
        let ended = match run_scene(arguments, scene, &mut others, &threads, console) {
            // One that cannot be rendered does not stop the others.
            Err(failure) if !is_alone && !arguments.fail_fast => {
                console.failure(&failure);
                failure.exit_code()
            }
            ended => ended?,
        };
        code = status::worse(code, ended);
        if ended == status::INTERRUPTED {
            break;
        }
    }
    Ok(code)
}

/// Renders one of the scenes.
fn run_scene(
    arguments: &RenderArguments,
    scene: &Path,
    others: &mut Others,
    threads: &ThreadPool,
    console: &Console,
) -> Result<u8, Failure> {
    let request = request(arguments, scene, threads, console)?;
    if request.pattern.is_standard_output() {
        console.keep_results_aside();
    }
    others.add(&request)?;
    check_view(&request, arguments, threads, console)?;
    let of_scene = |path: &PathBuf| with_scene(path, scene_name(scene));
    let (legend, scale_bar) = (&arguments.legend, &arguments.scale_bar);
    let inside = figures::write(
        &request,
        legend.as_ref().map(of_scene),
        scale_bar.as_ref().map(of_scene),
    )?;

    interrupt::listen(console);
    prepare(&request.path(request.frames.first(), 0))?;

    let (form, quiet) = (arguments.progress, arguments.quiet);
    let progress = Progress::new(console, form, quiet, request.pictures());
    let outcome = render(&request, threads, &progress);
    progress.finish();
    let outcome = outcome?;
    // A frame has one picture, or one for each light.
    let is_single = request.parts.len() == 1;
    let noun = if is_single { "frame" } else { "picture" };
    if outcome.pictures > 1 && (request.pattern.is_numbered() || !is_single) && !quiet {
        let were_there = outcome.skipped == outcome.pictures;
        let counts = || were_there.then(|| messages::counts(&outcome, noun));
        if let Some(total) = messages::total(&outcome, noun).or_else(counts) {
            console.result(&total);
        }
    }
    let code = conclusion(&outcome, noun, console);
    let late = request.scene.take_late_warnings();
    late.iter().for_each(|warning| console.warn(warning));
    let is_written = [status::SUCCESS, status::OVER_TOLERANCE].contains(&code);
    if let Some(inside) = inside
        && is_written
    {
        inside.write(&request)?;
    }
    if is_written && arguments.options.strict && !late.is_empty() {
        console.reason("with --strict warnings are errors");
        return Ok(status::FAILURE);
    }
    if is_written && arguments.options.strict && outcome.clipped > 0 {
        let why = "with --strict clipped pixels are an error";
        console.warn(why);
        console.reason(why);
        return Ok(status::FAILURE);
    }
    Ok(code)
}

/// Reads the scene, and checks everything that can be checked before rendering.
pub(super) fn request(
    arguments: &RenderArguments,
    path: &Path,
    threads: &ThreadPool,
    console: &Console,
) -> Result<Request, Failure> {
    let output = arguments.output.as_deref();
    let pattern = output.map(|output| Pattern::of_scene(output, scene_name(path)));
    let pattern = pattern.transpose().map_err(Failure::Usage)?;
    let format = pattern.as_ref().map_or(Format::Png, Pattern::format);
    let encoding = encoding(arguments, format)?;

    let silent = arguments.quiet || arguments.progress.is_some();
    let size = arguments.size.map(|size| (size.width, size.height));
    let figure = arguments.figure.figure(size);
    let mut options = arguments.options.clone();
    if arguments.white {
        options.set.insert(0, Setting::new("background", "1"));
    }
    let load = || scene::load_figure(path, &figure, &options, console, silent);
    let scene = parallel::install(threads, load)?;
    if scene.frames().is_none()
        && let Err(error) = scene.view(FRAME_OF_A_STILL)
    {
        return Err(Failure::unusable(path, &error.to_string()));
    }
    let frames = arguments.frames.clone();
    if let Some(frames) = &frames {
        scene::require_frames(&scene, frames.iter(), "--frames")?;
    }
    let frames = frames.unwrap_or_else(|| FrameList::from(frames_of(&scene)));
    let pattern = pattern.unwrap_or_else(|| {
        let numbered = arguments.frames.is_some() || scene.frames().is_some();
        Pattern::named_after(path, numbered)
    });
    standard_output::check(arguments, &pattern, &frames, encoding)?;
    check_names(&pattern, &frames, output)?;
    let centers = (!arguments.channels.is_empty()).then(|| {
        CenterChannels::new(
            &arguments.channels,
            arguments.depth.unwrap_or(DepthForm::Axis),
            arguments.axes.unwrap_or(AxesForm::World),
            scene.world().has_bumps(),
            arguments.tolerance,
        )
    });
    let names = &scene.description().lights;
    let (parts, layers) = match arguments.per_light {
        Some(PerLight::Files) => (PicturePart::each(scene.world(), names), Ok(Vec::new())),
        Some(PerLight::Layers) => {
            let has_errors = arguments.error_channel;
            let layers = LightLayer::each(scene.world(), names, centers.as_ref(), has_errors);
            (Ok(vec![PicturePart::whole()]), layers)
        }
        None => (Ok(vec![PicturePart::whole()]), Ok(Vec::new())),
    };
    let (parts, layers) = (
        parts.map_err(Failure::Usage)?,
        layers.map_err(Failure::Usage)?,
    );
    let request = Request {
        size: arguments.size,
        window: arguments.region,
        settings: Settings {
            method: match arguments.samples {
                Some(samples) => Method::Samples(samples),
                None => Method::Tolerance(arguments.tolerance),
            },
            alpha: arguments.alpha,
        },
        error_scale: 1.0,
        frames_per_second: arguments.fps.or(scene.frames_per_second()),
        scene: Arc::new(scene),
        scene_path: path.to_owned(),
        frames,
        parts,
        layers,
        pattern,
        encoding,
        centers,
        sidecar: arguments.sidecar,
        skip_existing: arguments.skip_existing,
        fail_fast: arguments.fail_fast,
        destination: Destination::Files,
    };
    check_outputs(&request)?;
    Ok(request)
}

/// Warns about mistakes in the first frame.
fn check_view(
    request: &Request,
    arguments: &RenderArguments,
    threads: &ThreadPool,
    console: &Console,
) -> Result<(), Failure> {
    if let Some(warning) = other_rate(request) {
        scene::warn(&[warning], &request.scene_path, &arguments.options, console)?;
    }
    let warnings = view_warnings(request, threads);
    scene::warn(&warnings, &request.scene_path, &arguments.options, console)
}

/// The warnings about mistakes in the first frame.
pub(crate) fn view_warnings(request: &Request, threads: &ThreadPool) -> Vec<String> {
    /// The most frames that are checked.
    const FRAMES: usize = 1000;
    let scene = &request.scene;
    let frame = request.frames.first();
    parallel::install(threads, || {
        // Tables that cannot be read are told when their turn comes.
        let Ok(world) = scene.world_at(frame) else {
            return Vec::new();
        };
        // Of clouds that change, the world of the first frame is that of no other one.
        let most = if scene.has_steps() { 1 } else { FRAMES };
        let frames = request.frames.iter().take(most);
        let views: Vec<View> = frames.filter_map(|frame| scene.view(frame).ok()).collect();
        let lights_move = scene.has_moving_lights();
        let mut warnings = oversights::warnings(&world, &views, frame, lights_move);
        if let Method::Tolerance(tolerance) = request.settings.method {
            if !lights_move || views.len() == 1 {
                warnings.extend(oversights::too_weak(&world, tolerance));
            }
            let option = format!("`--tolerance {tolerance:e}`");
            let of_parts = request.parts.iter().map(|part| part.of(&world));
            let of_layers = request.layers.iter().map(|layer| world.under(layer.light));
            warnings.extend(dim_light::warning(
                of_parts.chain(of_layers),
                tolerance,
                &option,
            ));
        }
        warnings
    })
}

/// The warning about an animation that is too fast for players, or too slow for its format.
fn other_rate(request: &Request) -> Option<String> {
    let Encoding::Animation(format, _) = request.encoding else {
        return None;
    };
    let is_moving = request.frames.count() > 1;
    let rate = request.frames_per_second.filter(|_| is_moving)?;
    let path = request.pattern.path(request.frames.first());
    let reason = why_other_rate(format, rate)?;
    Some(format!("{}: {reason}", path.shown()))
}

/// Refuses a pattern of file names that does not fit the number of frames.
fn check_names(
    pattern: &Pattern,
    frames: &FrameList,
    output: Option<&Path>,
) -> Result<(), Failure> {
    let is_animation = matches!(pattern.format(), Format::Animation(_));
    if is_animation && pattern.is_numbered() {
        return Err(Failure::unusable(
            output.unwrap_or(Path::new("")),
            "all frames go into one file, so its name cannot contain the frame number",
        ));
    }
    let count = frames.count();
    if count > 1 && !pattern.is_numbered() && !is_animation {
        return Err(Failure::unusable(
            &pattern.path(FRAME_OF_A_STILL),
            &format!(
                "{count} frames need the frame number in the file name: ####, %04d or {{frame:04}}"
            ),
        ));
    }
    Ok(())
}

/// Refuses to replace the scene or its tables by pictures or by their accompanying files.
fn check_outputs(request: &Request) -> Result<(), Failure> {
    let beside = |picture: PathBuf| {
        let sidecar = request.sidecar.then(|| sidecar::beside(&picture));
        let arrays = match request.encoding {
            Encoding::Npy(options) => names_beside(&picture, options, request.centers.is_some()),
            _ => Vec::new(),
        };
        arrays.into_iter().chain(sidecar).chain([picture])
    };
    let pictures = request.frames.iter().flat_map(|frame| {
        let parts = 0..request.parts.len();
        parts.map(move |part| request.path(frame, part))
    });
    let inputs = Inputs::of(&request.scene_path, &request.scene);
    inputs.refuse(pictures.flat_map(beside))
}

/// Prints how a run ended, and returns its exit code.
pub(super) fn conclusion(outcome: &Outcome, noun: &str, console: &Console) -> u8 {
    if outcome.interrupted {
        console.warn(&format!("interrupted: {}", messages::counts(outcome, noun)));
        status::INTERRUPTED
    } else if !outcome.failed.is_empty() {
        if outcome.pictures > 1 {
            console.warn(&messages::counts(outcome, noun));
        }
        status::FAILURE
    } else if outcome.is_over_tolerance() {
        console.reason("some pixels are over the tolerance");
        status::OVER_TOLERANCE
    } else {
        status::SUCCESS
    }
}
