//! Writes and checks the files of exact pixels.

use std::collections::HashSet;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use glam::DVec3;
use marbles_core::{Light, View, World};
use rayon::prelude::*;

use marbles_tests::numbers::Numbers;
use marbles_tests::promise::pixels::{self, ExactPixel};
use marbles_tests::reference::Reference;

/// The number of pixels of a file with edges, and of pixels without.
const EDGES: usize = 120;
const SMOOTH: usize = 20;
/// The largest number of pixels that are tried, and the number tried at a time.
const TRIES: usize = 20_000;
const BATCH: usize = 500;

/// Writes the files of all scenes whose names contain `part`.
pub(crate) fn write(part: &str) -> Result<String, String> {
    each(part, |scene| {
        let pixels = choose(scene)?;
        let path = scene.with_extension("csv");
        std::fs::write(path, pixels::format(&pixels)).map_err(|error| error.to_string())?;
        let worst = pixels.iter().map(|pixel| pixel.error).fold(0.0, f64::max);
        let edges = pixels.iter().filter(|pixel| pixel.has_edge).count();
        Ok(format!(
            "{edges} with edges of {}, stated error at most {worst:.1e}",
            pixels.len()
        ))
    })
}

/// Computes the pixels of the files again, and compares them.
pub(crate) fn check(part: &str) -> Result<String, String> {
    each(part, |path| {
        let scene = pixels::load(path);
        let view = scene.view(1).map_err(|error| error.to_string())?;
        let reference = Reference::new(scene.world(), &view);
        let differing = pixels::read(path)
            .par_iter()
            .filter(|pixel| {
                let truth = reference.pixel(pixel.col, pixel.row);
                let apart = (truth.value - pixel.value).abs().max_element();
                apart > truth.error + pixel.error + 1e-13
            })
            .count();
        if differing > 0 {
            return Err(format!("{}: {differing} pixels differ", path.display()));
        }
        Ok("agrees".to_owned())
    })
}

fn each(part: &str, work: impl Fn(&Path) -> Result<String, String>) -> Result<String, String> {
    let mut report = String::new();
    for scene in pixels::scenes() {
        let name = pixels::name(&scene);
        if name.contains(part) {
            let start = Instant::now();
            let result = work(&scene)?;
            let seconds = start.elapsed().as_secs_f64();
            // Writing to a string does not fail.
            let _ = writeln!(report, "{name}: {result}, {seconds:.1} s");
        }
    }
    Ok(report)
}

/// Chooses the same pixels in every run. Half of the candidates are anywhere; the other half show a random point of a
/// random sphere, or its shadow.
fn choose(path: &Path) -> Result<Vec<ExactPixel>, String> {
    let scene = pixels::load(path);
    let view = scene.view(1).map_err(|error| error.to_string())?;
    let world = scene.world();
    let reference = Reference::new(world, &view);
    let mut numbers = Numbers(1);
    let mut seen = HashSet::new();
    let mut chosen: Vec<ExactPixel> = Vec::new();
    for _ in 0..TRIES / BATCH {
        let places: Vec<(u32, u32)> = (0..BATCH)
            .filter_map(|index| match index % 2 {
                0 => Some(anywhere(&view, &mut numbers)),
                _ => near_something(world, &view, &mut numbers),
            })
            .filter(|place| seen.insert(*place))
            .collect();
        let exact = places.par_iter().map(|&(col, row)| {
            let truth = reference.pixel(col, row);
            ExactPixel {
                col,
                row,
                has_edge: truth.has_edge,
                value: truth.value,
                error: truth.error,
            }
        });
        for pixel in exact.collect::<Vec<_>>() {
            let alike = |other: &&ExactPixel| other.has_edge == pixel.has_edge;
            let room = if pixel.has_edge { EDGES } else { SMOOTH };
            let is_empty = !pixel.has_edge && pixel.value.w == 0.0;
            if !is_empty && chosen.iter().filter(alike).count() < room {
                chosen.push(pixel);
            }
        }
        let edges = chosen.iter().filter(|pixel| pixel.has_edge).count();
        if edges == EDGES {
            break;
        }
    }
    Ok(chosen)
}

fn anywhere(view: &View, numbers: &mut Numbers) -> (u32, u32) {
    let mut below = |bound: u32| (numbers.uniform() * f64::from(bound)) as u32;
    (below(view.width), below(view.height))
}

/// The pixel that shows a random point of a random sphere, or its shadow on the next sphere.
fn near_something(world: &World, view: &View, numbers: &mut Numbers) -> Option<(u32, u32)> {
    let index = (numbers.uniform() * world.spheres().len() as f64) as usize;
    let sphere = world.spheres()[index];
    let mut direction = || {
        let mut part = || 2.0 * numbers.uniform() - 1.0;
        DVec3::new(part(), part(), part()).normalize_or_zero()
    };
    let mut point = sphere.center() + sphere.radius() * direction();
    let lights = world.lights.len();
    let choice = (numbers.uniform() * (lights + 1) as f64) as usize;
    if let Some(light) = world.lights.get(choice) {
        let away = match light {
            Light::Directional(light) => -light.toward(),
            Light::Point(light) => (point - light.position()).normalize_or_zero(),
        };
        let others = world.spheres().iter().enumerate();
        let landing = others
            .filter(|(other, _)| *other != index)
            .filter_map(|(_, other)| {
                let to_center = other.center() - point;
                let along = to_center.dot(away);
                let chord_sq = other.radius().powi(2) - (to_center - along * away).length_squared();
                let t = along - chord_sq.max(0.0).sqrt();
                (chord_sq > 0.0 && t > 0.0).then_some(t)
            })
            .fold(f64::INFINITY, f64::min);
        point += away * if landing.is_finite() { landing } else { 0.0 };
    }
    let place = view.project(point)?.floor();
    let size = (f64::from(view.width), f64::from(view.height));
    let inside = place.x >= 0.0 && place.y >= 0.0 && place.x < size.0 && place.y < size.1;
    inside.then_some((place.x as u32, place.y as u32))
}
