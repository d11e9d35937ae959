//! `marbles check`: validates a scene file, prints its contents, and warns about expensive settings.

mod columns;
mod contents;
mod costs;
mod tables;

use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};
use marbles_core::{Channels, Color, Light, LightFalloff, Sky, Sphere, View, World, parallel};
use marbles_scene::{CellDescription, CloudDescription, FrameError, Scene};
use serde_json::json;

use super::args::{CheckArguments, DEFAULT_TOLERANCE};
use super::{dim_light, oversights, scene};
use crate::base::failure::Failure;
use crate::base::numbers::{counted, degrees, range, short};
use crate::base::shown::Shown;
use crate::base::{status, threads};
use crate::formats::sidecar::{Sidecar, turns};
use crate::sequence::frames::frames_of;
use crate::terminal::console::Console;

/// The most frames that are checked; of longer animations, evenly spread ones.
const FRAMES_LOOKED_AT: i64 = 100_000;
/// The most lights that are listed.
const LIGHTS_LISTED: usize = 8;
/// What a sky means for the time of rendering.
const SKY_COSTS: &str =
    "a sky takes more time than any other light: every sphere near a point may hide a part of it";
/// Width of the column with the names of things.
const NAMES: usize = 12;

pub(crate) fn run(arguments: &CheckArguments, console: &Console) -> Result<u8, Failure> {
    parallel::install(&threads::start(None)?, || check(arguments, console))
}

fn check(arguments: &CheckArguments, console: &Console) -> Result<u8, Failure> {
    let scene = scene::load(&arguments.scene, &arguments.options, console, false)?;
    if arguments.json {
        return print_json(&scene, arguments, console);
    }
    let world = scene::world(&scene, None)?;
    let frames = frames_of(&scene);
    let (views, errors) = views(&scene, &frames);

    let mut rows = vec![("scene", arguments.scene.shown())];
    if let Some(view) = views.first() {
        rows.push(("image", format!("{} x {} pixels", view.width, view.height)));
        let written = &scene.description().lens;
        rows.push(("lens", format!("{written}: {}", lens(view))));
    }
    rows.extend(self::world(&scene, &world));
    rows.push(("frames", duration(&scene)));
    let (count, looked_at) = (count(&frames), views.len() + errors.len());
    if looked_at as i64 != count {
        rows.push(("", format!("{looked_at} of {count} were checked")));
    }
    rows.extend(cameras(scene.description().camera, &views));
    for (name, text) in rows {
        console.result(format!("{name:NAMES$}{text}").trim_end());
    }

    let lights_move = scene.has_moving_lights();
    let warnings = warnings(world, &views, *frames.start(), lights_move);
    scene::warn(&warnings, &arguments.scene, &arguments.options, console)?;
    match errors.first() {
        None => Ok(status::SUCCESS),
        Some(error) => {
            let mut message = format!("{}: {error}", arguments.scene.shown());
            if errors.len() > 1 {
                message.push_str(&format!(
                    ", and {} more of the {looked_at} checked frames have no view",
                    errors.len() - 1
                ));
            }
            Err(Failure::Usage(message))
        }
    }
}

/// Warnings about the views of a world in some frames; `frame` is the first of these frames.
fn warnings(world: World, views: &[View], frame: i32, lights_move: bool) -> Vec<String> {
    let mut warnings = costs::warnings(&world, views);
    warnings.extend(oversights::warnings(&world, views, frame, lights_move));
    if !lights_move || views.len() == 1 {
        warnings.extend(oversights::too_weak(&world, DEFAULT_TOLERANCE));
    }
    let default = format!("the default `--tolerance {DEFAULT_TOLERANCE:e}`");
    warnings.extend(dim_light::warning([world], DEFAULT_TOLERANCE, &default));
    warnings
}

/// Prints the properties of a frame that are known before rendering, and the warnings about it.
fn print_json(scene: &Scene, arguments: &CheckArguments, console: &Console) -> Result<u8, Failure> {
    let view = scene::view(scene, &arguments.scene, arguments.frame)?;
    let frame = arguments.frame.unwrap_or(*frames_of(scene).start());
    let sidecar = Sidecar::of(scene, &arguments.scene, frame, &view);
    let text = sidecar.text().map_err(Failure::Work)?;
    let world = scene::world_of(scene, frame)?;
    let mut more = format!(",\n{}", contents::json(scene, &world)?);
    if !scene.clouds().is_empty() {
        more.push_str(&format!(",\n  \"clouds\": {}", tables::json(scene)?));
    }
    let warnings = warnings(world, &[view], frame, scene.has_moving_lights());
    let all: Vec<&String> = scene.warnings().iter().chain(&warnings).collect();
    more.push_str(&format!(",\n  \"warnings\": {}", json!(all)));
    // For programs: as it is.
    let text = text.trim_end();
    let inside = text.strip_suffix('}').unwrap_or(text).trim_end();
    console.print(&format!("{inside}{more}\n}}\n"));
    scene::warn(&warnings, &arguments.scene, &arguments.options, console)?;
    Ok(status::SUCCESS)
}

fn count(frames: &RangeInclusive<i32>) -> i64 {
    i64::from(*frames.end()) - i64::from(*frames.start()) + 1
}

/// Views of evenly spread frames, including the first and the last, and the errors of frames without a view.
fn views(scene: &Scene, frames: &RangeInclusive<i32>) -> (Vec<View>, Vec<FrameError>) {
    let (first, last) = (i64::from(*frames.start()), i64::from(*frames.end()));
    let steps = (last - first).clamp(0, FRAMES_LOOKED_AT - 1);
    let mut views = Vec::new();
    let mut errors = Vec::new();
    for step in 0..=steps {
        let frame = first + (last - first) * step / steps.max(1);
        match scene.view(frame as i32) {
            Ok(view) => views.push(view),
            Err(error) => errors.push(error),
        }
    }
    (views, errors)
}

fn lens(view: &View) -> String {
    let lens = view.lens;
    let mut text = if lens.is_parallel() {
        let (_, size) = view.screen_window();
        format!("parallel rays, {} across", short(size.x))
    } else {
        let half_angle = libm::atan(0.5 * lens.width / (lens.distance * view.zoom));
        format!(
            "retina {} wide at distance {}, {}° across",
            short(lens.width),
            short(lens.distance),
            short(2.0 * half_angle.to_degrees())
        )
    };
    if lens.shift != DVec2::ZERO {
        let (right, up) = (short(lens.shift.x), short(lens.shift.y));
        text.push_str(&format!(", shifted by ({right}, {up})"));
    }
    if lens.pixel_aspect != 1.0 {
        let aspect = short(lens.pixel_aspect);
        text.push_str(&format!(", pixels {aspect} times as wide as high"));
    }
    text
}

fn world(scene: &Scene, world: &World) -> Vec<(&'static str, String)> {
    let mut rows = vec![("spheres", spheres(world.spheres()))];
    rows.extend(bounds(world.spheres()));
    for (index, cloud) in scene.clouds().iter().enumerate() {
        rows.extend(self::cloud(scene, world, (index, cloud)));
    }
    let materials = scene.description().materials.len();
    rows.push(("materials", materials.to_string()));
    rows.push(("lights", lights(&world.lights)));
    let names = &scene.description().lights;
    for (light, name) in world.lights.iter().zip(names).take(LIGHTS_LISTED) {
        let name = name.as_ref().map(|name| format!("{name:?} "));
        rows.push(("", name.unwrap_or_default() + &placed(light)));
    }
    if world.lights.len() > LIGHTS_LISTED {
        rows.push(("", "…".to_owned()));
    }
    if scene.has_moving_lights() {
        rows.push((
            "",
            "animated; these are the values of the first frame".to_owned(),
        ));
    }
    let shadows = if world.shadows { "on" } else { "off" };
    rows.push(("shadows", shadows.to_owned()));
    rows.push(("ambient", color(world.ambient)));
    if let Some(sky) = &world.sky {
        rows.push(("sky", self::sky(sky)));
        rows.push(("", SKY_COSTS.to_owned()));
    }
    rows.push(("background", color(world.background)));
    let channels = match Channels::of(world, false) {
        Channels::Grey => "none: pictures have a single channel",
        Channels::Rgb => "red, green, blue",
    };
    rows.push(("color", channels.to_owned()));
    rows
}

/// A table, and a camera that shows all of it.
fn cloud(
    scene: &Scene,
    world: &World,
    (index, cloud): (usize, &CloudDescription),
) -> Vec<(&'static str, String)> {
    const ELEVATION: f64 = 15.0;
    let all = &world.spheres()[cloud.spheres.clone()];
    let file = cloud.file.shown();
    let mut rows = vec![("cloud", format!("{file}: {}", spheres(all)))];
    rows.extend(bounds(all));
    let hands = match cloud.is_right_handed {
        true => "right-handed",
        false => "left-handed, like the scene",
    };
    rows.push(("  axes", hands.to_owned()));
    if let Some(steps) = cloud.steps {
        rows.push(("  steps", steps.to_string()));
    }
    if cloud.rows != cloud.kept {
        let told = format!("{} of {} rows", cloud.kept, cloud.rows);
        rows.push(("  kept", told));
    }
    if let Some(cell) = &cloud.cell {
        rows.push(("  cell", self::cell(cell)));
    }
    let columns = scene.columns(index).unwrap_or_default();
    let name = |first: usize| if first == 0 { "  columns" } else { "" };
    rows.extend(
        (0..)
            .zip(&columns)
            .map(|(place, column)| (name(place), columns::told(column, cloud))),
    );
    if let Some((target, radius)) = scene.orbit_around(all, ELEVATION) {
        let (target, radius) = (vector(target), short(radius));
        let camera = format!("Orbit(target: {target}, radius: {radius}, elevation: {ELEVATION})");
        rows.push(("  seen by", camera));
    }
    rows
}

/// The cell of a table: its lengths and angles, and how often it is shown.
fn cell(cell: &CellDescription) -> String {
    let [a, b, c] = cell.lengths.map(short);
    let [alpha, beta, gamma] = cell.angles.map(short);
    let repeated = match cell.repeat {
        [1, 1, 1] => String::new(),
        [i, j, k] => format!("; repeated {i} x {j} x {k}"),
    };
    format!("{a} x {b} x {c}, angles {alpha}, {beta}, {gamma} degrees{repeated}")
}

fn spheres(spheres: &[Sphere]) -> String {
    let radii = spheres.iter().map(Sphere::radius);
    let radii = range(radii);
    match spheres.len() {
        0 => "none".to_owned(),
        1 => format!("1, radius {radii}"),
        count => format!("{count}, radius {radii}"),
    }
}

/// The corners of the box around all spheres.
fn bounds(spheres: &[Sphere]) -> Vec<(&'static str, String)> {
    let boxes = spheres.iter().map(|sphere| {
        let reach = DVec3::splat(sphere.radius());
        (sphere.center() - reach, sphere.center() + reach)
    });
    let around = boxes.reduce(|one, other| (one.0.min(other.0), one.1.max(other.1)));
    let rows = around.map(|(low, high)| [("  from", vector(low)), ("  to", vector(high))]);
    rows.into_iter().flatten().collect()
}

/// The number of lights, and of those that are suns.
fn lights(lights: &[Light]) -> String {
    let suns = lights.iter().filter(|light| light.sun().is_some()).count();
    match suns {
        0 => lights.len().to_string(),
        _ => format!(
            "{}, {} among them",
            lights.len(),
            counted(suns as u64, "sun")
        ),
    }
}

/// The light of the sky.
fn sky(sky: &Sky) -> String {
    let [above, below] = [sky.above(), sky.below()].map(color);
    match above == below {
        true => format!("{above} from everywhere"),
        false => format!(
            "{above} from above, {below} from below; up is {}",
            vector(sky.up())
        ),
    }
}

fn placed(light: &Light) -> String {
    let intensity = color(light.intensity());
    match light {
        Light::Directional(light) => {
            let mut text = format!("toward {}, intensity {intensity}", vector(light.toward()));
            if light.diameter() > 0.0 {
                let diameter = short(degrees(light.diameter()));
                text.push_str(&format!(", a disc {diameter}° across: soft shadows"));
            }
            text
        }
        Light::Point(light) => {
            let position = vector(light.position());
            let reference = short(light.reference());
            let mut text = match light.falloff() {
                LightFalloff::InverseSquare => {
                    format!("at {position}, intensity {intensity} at distance {reference}")
                }
                LightFalloff::None => format!("at {position}, intensity {intensity} everywhere"),
            };
            if let Some(emission) = light.emission() {
                let direction = vector(emission.direction());
                text.push_str(&format!(", faces {direction}, mu {}", short(emission.mu())));
            }
            text
        }
    }
}

fn duration(scene: &Scene) -> String {
    let Some(frames) = scene.frames() else {
        return "a still".to_owned();
    };
    let (first, last) = (*frames.start(), *frames.end());
    let count = count(&frames);
    let mut text = if count == 1 {
        format!("{first}")
    } else {
        format!("{first} to {last}, {count} in all")
    };
    if let Some(kind) = scene.description().animation {
        text = format!("{kind}: {text}");
    }
    if let Some(rate) = scene.frames_per_second() {
        let seconds = short(count as f64 / rate);
        text.push_str(&format!(", {} per second, {seconds} s", short(rate)));
    }
    if let Some(shutter) = scene.shutter() {
        let shutter = short(shutter);
        text.push_str(&format!(", the shutter open for {shutter} of a frame"));
    }
    text
}

/// The positions and directions of the camera.
fn cameras(kind: &str, views: &[View]) -> Vec<(&'static str, String)> {
    let along = |axis: fn(DVec3) -> f64| range(views.iter().map(|v| axis(v.camera.position)));
    let angles = |index: usize| {
        let angle = move |view: &View| turns(&view.camera)[index];
        format!("{}°", range(unwound(views.iter().map(angle))))
    };
    if views.is_empty() {
        return Vec::new();
    }
    let (x, y, z) = (along(|p| p.x), along(|p| p.y), along(|p| p.z));
    let mut rows = vec![
        ("camera", format!("{kind}: x {x}, y {y}, z {z}")),
        ("  pan", angles(0)),
        ("  tilt", angles(1)),
        ("  roll", angles(2)),
    ];
    if views.iter().any(|view| view.zoom != 1.0) {
        rows.push(("  zoom", range(views.iter().map(|view| view.zoom))));
    }
    rows
}

/// Continuous angles in degrees: each differs from the previous one by less than half a turn.
fn unwound(angles: impl Iterator<Item = f64>) -> impl Iterator<Item = f64> {
    const TURN: f64 = 360.0;
    let mut before = None;
    angles.map(move |angle| {
        let turns = before.map_or(0.0, |before: f64| ((before - angle) / TURN).round());
        let angle = angle + turns * TURN;
        before = Some(angle);
        angle
    })
}

fn vector(vector: DVec3) -> String {
    let [x, y, z] = vector.to_array().map(short);
    format!("({x}, {y}, {z})")
}

/// A color in the form of scene files: a single number if it is gray.
fn color(color: Color) -> String {
    if color.x == color.y && color.y == color.z {
        short(color.x)
    } else {
        vector(color)
    }
}
