//! Judges random pixels of any scene.

use std::collections::HashSet;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use glam::DVec4;
use marbles_core::{Image, Method, Renderer, Settings, Status, View};
use marbles_scene::Scene;
use rayon::prelude::*;

use marbles_tests::numbers::Numbers;
use marbles_tests::promise::measure::single_pixel;
use marbles_tests::reference::{Reference, Truth};

/// The options of a judge.
struct Options {
    tolerance: f64,
    pixels: usize,
    seed: u64,
    size: Option<(u32, u32)>,
    single: bool,
    edges: bool,
}

impl Options {
    fn parse(arguments: &[&str]) -> Result<Self, String> {
        let mut options = Self {
            tolerance: 1e-4,
            pixels: 2000,
            seed: 1,
            size: None,
            single: false,
            edges: false,
        };
        let mut rest = arguments.iter();
        while let Some(&name) = rest.next() {
            match name {
                "--single" => options.single = true,
                "--edges" => options.edges = true,
                _ => {}
            }
            if matches!(name, "--single" | "--edges") {
                continue;
            }
            let value = *rest.next().ok_or(format!("{name} needs a value"))?;
            match name {
                "--tolerance" => options.tolerance = number(value)?,
                "--pixels" => options.pixels = number(value)?,
                "--seed" => options.seed = number(value)?,
                "--size" => {
                    let (width, height) = value.split_once('x').ok_or("a size is 120x80")?;
                    options.size = Some((number(width)?, number(height)?));
                }
                _ => return Err(format!("unknown option {name}")),
            }
        }
        Ok(options)
    }

    fn view(&self, scene: &Scene) -> Result<View, String> {
        let mut view = scene.view(1).map_err(|error| error.to_string())?;
        if let Some((width, height)) = self.size {
            (view.width, view.height) = (width, height);
        }
        Ok(view)
    }
}

fn number<T: std::str::FromStr>(text: &str) -> Result<T, String> {
    text.parse().map_err(|_| format!("{text} is not a number"))
}

fn load(path: &str) -> Result<Scene, String> {
    Scene::load(Path::new(path)).map_err(|error| error.to_string())
}

/// A pixel, its true value, and the result of the renderer.
struct Judged {
    col: u32,
    row: u32,
    truth: Truth,
    seconds: f64,
    error: f64,
    claimed: f64,
    status: Status,
}

pub(crate) fn judge(path: &str, arguments: &[&str]) -> Result<String, String> {
    let options = Options::parse(arguments)?;
    let scene = load(path)?;
    let view = options.view(&scene)?;
    let world = scene.world();
    let renderer = Renderer::new(world);
    let settings = Settings {
        method: Method::Tolerance(options.tolerance),
        alpha: true,
    };
    let start = Instant::now();
    let render = |view: &View| {
        let go = |_| ControlFlow::Continue(());
        let image = renderer.render_with_progress(view, &settings, &go);
        image.map_err(|error| error.to_string())
    };
    let whole = if options.single {
        None
    } else {
        Some(render(&view)?)
    };
    let seconds = start.elapsed().as_secs_f64();
    let reference = Reference::new(world, &view);
    let mut numbers = Numbers(options.seed);
    let mut below = |bound: u32| (numbers.uniform() * f64::from(bound)) as u32;
    let mut taken = HashSet::new();
    // Where nothing is in sight there is nothing to judge; but do not seek for ever.
    let places: Vec<(u32, u32)> = (0..200 * options.pixels)
        .map(|_| (below(view.width), below(view.height)))
        .filter(|&(col, row)| match options.edges {
            true => reference.seems_to_change(col, row),
            false => reference.sees_anything(col, row),
        })
        .filter(|place| taken.insert(*place))
        .take(options.pixels)
        .collect();
    let judged: Vec<Judged> = places
        .par_iter()
        .map(|&(col, row)| {
            let start = Instant::now();
            let truth = reference.pixel(col, row);
            let seconds = start.elapsed().as_secs_f64();
            let (found, claimed, status) = match &whole {
                Some(image) => of_image(image, col, row),
                None => of_image(&render(&single_pixel(&view, col, row))?, 0, 0),
            };
            let error = (found - truth.value).abs().max_element();
            Ok(Judged {
                col,
                row,
                truth,
                seconds,
                error,
                claimed,
                status,
            })
        })
        .collect::<Result<_, String>>()?;
    Ok(report(&judged, options.tolerance, seconds))
}

fn of_image(image: &Image, col: u32, row: u32) -> (DVec4, f64, Status) {
    let value = DVec4::from_array(image.rgba(col, row));
    (value, image.error(col, row), image.status(col, row))
}

fn report(judged: &[Judged], tolerance: f64, seconds: f64) -> String {
    let mut text = String::new();
    let mut line = |message: String| {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{message}");
    };
    let edges = judged.iter().filter(|pixel| pixel.truth.has_edge).count();
    line(format!(
        "{} pixels, {edges} with edges; rendered in {seconds:.3} s",
        judged.len()
    ));
    let cost = judged.iter().map(|pixel| pixel.seconds).sum::<f64>() / judged.len() as f64;
    let stated = |rank: f64| quantile(judged.iter().map(|pixel| pixel.truth.error), rank);
    line(format!(
        "truth: {:.2} ms a pixel, stated error median {:.1e}, 99 % {:.1e}, worst {:.1e}",
        1e3 * cost,
        stated(0.5),
        stated(0.99),
        stated(1.0)
    ));
    if let Some(slowest) = judged.iter().max_by(|a, b| a.seconds.total_cmp(&b.seconds)) {
        line(format!(
            "slowest: column {}, row {}: {:.0} ms, {} lines",
            slowest.col,
            slowest.row,
            1e3 * slowest.seconds,
            slowest.truth.lines
        ));
    }
    let met = |pixel: &&Judged| !pixel.status.is_over_tolerance();
    let over = |factor: f64| {
        let beyond = |pixel: &&Judged| pixel.error > factor * tolerance + pixel.truth.error;
        judged.iter().filter(met).filter(beyond).count()
    };
    line(format!(
        "over the tolerance and not saying so: {}, over 3 times: {}; saying so: {}",
        over(1.0),
        over(3.0),
        judged.len() - judged.iter().filter(met).count()
    ));
    let unclaimed = judged.iter().filter(met);
    let unclaimed = unclaimed.filter(|pixel| pixel.error > pixel.claimed + pixel.truth.error);
    line(format!("over their own claim: {}", unclaimed.count()));
    // Idle claims show where there is something to estimate, and the truth can tell.
    let ratios: Vec<f64> = judged
        .iter()
        .filter(met)
        .filter(|pixel| pixel.truth.has_edge && pixel.claimed > 1e4 * pixel.truth.error)
        .map(|pixel| pixel.error / pixel.claimed)
        .collect();
    line(format!(
        "true / claimed error at {} edge pixels: median {:.1e}, 90 % {:.1e}, worst {:.1e}",
        ratios.len(),
        quantile(ratios.iter().copied(), 0.5),
        quantile(ratios.iter().copied(), 0.9),
        quantile(ratios.iter().copied(), 1.0)
    ));
    let mut worst: Vec<&Judged> = judged.iter().filter(met).collect();
    worst.sort_by(|a, b| b.error.total_cmp(&a.error));
    for pixel in worst.into_iter().take(5) {
        line(format!(
            "column {}, row {}: off by {:.2e} ± {:.0e}, claims {:.2e}",
            pixel.col, pixel.row, pixel.error, pixel.truth.error, pixel.claimed
        ));
    }
    let beyond = |pixel: &Judged| (pixel.error - pixel.truth.error) / pixel.claimed.max(1e-300);
    let mut rash: Vec<&Judged> = judged.iter().filter(met).collect();
    rash.retain(|pixel| beyond(pixel) > 1.0);
    rash.sort_by(|a, b| beyond(b).total_cmp(&beyond(a)));
    for pixel in rash.into_iter().take(5) {
        line(format!(
            "claims too little: column {}, row {}: off by {:.2e} ± {:.0e}, claims {:.2e}{}",
            pixel.col,
            pixel.row,
            pixel.error,
            pixel.truth.error,
            pixel.claimed,
            if pixel.truth.has_edge { ", edge" } else { "" }
        ));
    }
    text
}

fn quantile(values: impl Iterator<Item = f64>, rank: f64) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    let index = (rank * last as f64).round() as usize;
    values.get(index).copied().unwrap_or(f64::NAN)
}

/// Finds random pixels whose true value differs from that of their quarters together: the integrator may be wrong
/// there.
pub(crate) fn doubt(path: &str, arguments: &[&str]) -> Result<String, String> {
    let options = Options::parse(arguments)?;
    let scene = load(path)?;
    let view = options.view(&scene)?;
    let reference = Reference::new(scene.world(), &view);
    let mut numbers = Numbers(options.seed);
    let mut below = |bound: u32| (numbers.uniform() * f64::from(bound)) as u32;
    let places: Vec<(u32, u32)> = (0..200 * options.pixels)
        .map(|_| (below(view.width), below(view.height)))
        .filter(|&(col, row)| reference.sees_anything(col, row))
        .take(options.pixels)
        .collect();
    let mut doubts: Vec<(f64, String)> = places
        .par_iter()
        .filter_map(|&(col, row)| {
            let (whole, parts) = (
                reference.pixel(col, row),
                reference.pixel_by_quarters(col, row),
            );
            let apart = (whole.value - parts.value).abs().max_element();
            let stated = (whole.error, parts.error);
            let line = format!(
                "column {col}, row {row}: {apart:.1e} apart, stated {:.1e} and {:.1e}\n",
                stated.0, stated.1
            );
            (apart > stated.0 + stated.1).then_some((apart, line))
        })
        .collect();
    doubts.sort_by(|a, b| b.0.total_cmp(&a.0));
    let head = format!("{} of {} pixels in doubt\n", doubts.len(), places.len());
    let worst = doubts.into_iter().take(5).map(|(_, line)| line);
    Ok([head].into_iter().chain(worst).collect())
}

/// Prints the details of one pixel.
pub(crate) fn pixel(path: &str, col: &str, row: &str, rest: &[&str]) -> Result<String, String> {
    let options = Options::parse(rest)?;
    let scene = load(path)?;
    let view = options.view(&scene)?;
    let (col, row) = (number(col)?, number(row)?);
    let reference = Reference::new(scene.world(), &view);
    let truth = reference.pixel(col, row);
    let mut text = format!(
        "{} ± {:.1e}, edge: {}, {} lines\n",
        truth.value, truth.error, truth.has_edge, truth.lines
    );
    for count in [250, 1000] {
        let mean = reference.midpoints(col, row, count);
        let apart = (mean - truth.value).abs().max_element();
        let _ = writeln!(
            text,
            "{count} by {count} midpoints: {mean}, {apart:.1e} away"
        );
    }
    for tolerance in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        let settings = Settings {
            method: Method::Tolerance(tolerance),
            alpha: true,
        };
        let go = |_| ControlFlow::Continue(());
        let image = Renderer::new(scene.world())
            .render_with_progress(&single_pixel(&view, col, row), &settings, &go)
            .map_err(|error| error.to_string())?;
        let (value, claimed, status) = of_image(&image, 0, 0);
        let error = (value - truth.value).abs().max_element();
        let _ = writeln!(
            text,
            "at {tolerance:.0e}: {value}, off by {error:.2e}, claims {claimed:.2e}, {status:?}"
        );
    }
    Ok(text)
}
