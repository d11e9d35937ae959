//! Measures how the rendering time grows with the number of spheres, nearly all of them hidden, and with the number of pixels.
//!
//! However many spheres there are, they fill the same fraction of the same volume. Prints tables in Markdown; with
//! `-- --write` they become the measured parts of docs/growth.md, and the plot is drawn.

mod turntable;

use std::fmt::Write as _;
use std::process::ExitCode;

use marbles_benches::chart::{Panel, svg};
use marbles_benches::page::Page;
use marbles_benches::process::main as run;
use marbles_benches::{
    Case, by_samples, cloud, in_repository, is_to_write, load, mean, medians, seconds, square_view,
    to_tolerance,
};
use marbles_core::{Image, Renderer, View, World};

const COUNTS: [u32; 4] = [10_000, 100_000, 1_000_000, 10_000_000];
/// The index of the count that is rendered in several sizes.
const SIZED: usize = 2;
const SIDES: [u32; 3] = [600, 1200, 2400];
const TOLERANCE: f64 = 1e-2;
const ROUNDS: usize = 3;
/// The time for a row, unless its rounds take longer.
const SECONDS: u64 = 6;
/// The largest relative difference of the means of two pictures. Clouds have few large spheres, so
/// their pictures differ.
const ALIKE: f64 = 0.1;

/// The measurement of a row of the tables.
struct Setting {
    name: &'static str,
    /// None for one sample per pixel.
    tolerance: Option<f64>,
    shadows: bool,
}

const SETTINGS: [Setting; 4] = [
    Setting {
        name: "one sample",
        tolerance: None,
        shadows: false,
    },
    Setting {
        name: "one sample, shadows",
        tolerance: None,
        shadows: true,
    },
    Setting {
        name: "1e-2",
        tolerance: Some(TOLERANCE),
        shadows: false,
    },
    Setting {
        name: "1e-2, shadows",
        tolerance: Some(TOLERANCE),
        shadows: true,
    },
];

#[expect(clippy::print_stdout, reason = "the table is what a benchmark is for")]
fn main() -> ExitCode {
    run(|| {
        let parts = ["spheres", "pixels", "turntable"];
        let mut page = is_to_write().then(|| Page::open("docs/growth.md", &parts));
        let (tables, panels) = measure();
        let [spheres, pixels] = tables;
        for (part, table) in parts
            .into_iter()
            .zip([spheres, pixels, turntable::measure()])
        {
            println!("{table}");
            if let Some(page) = &mut page {
                page.write(part, &table);
            }
        }
        if page.is_some() {
            let names = ["preparation"].into_iter();
            let names: Vec<_> = names.chain(SETTINGS.map(|setting| setting.name)).collect();
            let path = in_repository("docs/growth/growth.svg");
            let written = std::fs::write(path, svg(&names, &panels));
            written.unwrap_or_else(|error| panic!("growth.svg: {error}"));
        }
    })
}

/// Measures pictures with several numbers of spheres and of several sizes. Returns the tables and the drawings.
fn measure() -> ([String; 2], [Panel; 2]) {
    let scene = load("tests/truth/pixels/cloud1k");
    let views = SIDES.map(|side| square_view(&scene, side));
    let shaded = COUNTS.map(cloud);
    let plain = shaded.each_ref().map(|world| {
        let mut world = world.clone();
        world.shadows = false;
        world
    });

    // By the number of spheres.
    let counts = ["10⁴", "10⁵", "10⁶", "10⁷"].map(str::to_owned);
    let mut spheres = head("spheres, with 600² pixels", &counts);
    let cases: Vec<_> = shaded.iter().map(preparation).collect();
    let (preparing, shaded) = row(&mut spheres, "preparation", &cases);
    let plain: Vec<_> = plain.iter().map(Renderer::new).collect();
    let of = |setting: &Setting| if setting.shadows { &shaded } else { &plain };
    let mut by_count = vec![preparing];
    by_count.extend(SETTINGS.iter().map(|setting| {
        let frames = of(setting).iter().map(|renderer| (renderer, &views[0]));
        pictures(&mut spheres, setting, frames)
    }));

    // By the number of pixels.
    let sides = SIDES.map(|side| format!("{side}²"));
    let mut pixels = head(&format!("pixels, with {} spheres", counts[SIZED]), &sides);
    let by_side = SETTINGS.iter().map(|setting| {
        let frames = views.iter().map(|view| (&of(setting)[SIZED], view));
        pictures(&mut pixels, setting, frames)
    });
    let by_side = [Vec::new()].into_iter().chain(by_side).collect();

    let by_count = Panel {
        title: "Seconds by spheres, 600² pixels".to_owned(),
        steps: counts.to_vec(),
        factor: 10.0,
        width: 420.0,
        times: by_count,
    };
    let by_side = Panel {
        title: "Seconds by pixels, 10⁶ spheres".to_owned(),
        steps: sides.to_vec(),
        factor: 4.0,
        width: 280.0,
        times: by_side,
    };
    ([spheres, pixels], [by_count, by_side])
}

fn preparation(world: &World) -> Case<'_, Renderer<'_>> {
    Case {
        name: String::new(),
        millions: 0.0,
        run: Box::new(move |_| Renderer::new(world)),
    }
}

/// Adds the row of a setting to a table; returns its seconds.
fn pictures<'scene>(
    table: &mut String,
    setting: &Setting,
    frames: impl Iterator<Item = (&'scene Renderer<'scene>, &'scene View)>,
) -> Vec<f64> {
    let tolerance = setting.tolerance;
    let case = |(renderer, view): (&'scene Renderer<'scene>, &'scene View)| Case {
        name: String::new(),
        millions: 0.0,
        run: Box::new(move |spent: Option<Image>| match tolerance {
            Some(tolerance) => to_tolerance(renderer, view, tolerance, spent),
            None => by_samples(renderer, view, 1, spent),
        }),
    };
    let cases: Vec<_> = frames.map(case).collect();
    let (seconds, images) = row(table, setting.name, &cases);
    // The pictures look alike from a distance, whatever the numbers of spheres and pixels.
    let means: Vec<f64> = images.iter().map(mean).collect();
    let alike = means
        .iter()
        .all(|mean| (mean / means[0] - 1.0).abs() < ALIKE);
    assert!(means[0] > 0.1 && alike, "{means:?}");
    seconds
}

/// The first lines of a table.
fn head(title: &str, steps: &[String]) -> String {
    let cells = steps.join(" | ");
    let rule = "--:|".repeat(steps.len());
    format!("| {title} | {cells} | last / previous | last / first |\n|---|{rule}--:|--:|\n")
}

/// Measures a row and adds it to a table. Returns its times in seconds, and the results of the cases.
fn row<T>(table: &mut String, name: &str, cases: &[Case<'_, T>]) -> (Vec<f64>, Vec<T>) {
    let timed = medians(ROUNDS, SECONDS, cases).1.into_iter();
    let (times, made): (Vec<f64>, Vec<T>) = timed.map(|it| (it.median, it.result)).unzip();
    let cells: Vec<_> = times.iter().copied().map(seconds).collect();
    let cells = cells.join(" | ");
    let last = times[times.len() - 1];
    let [before, first] = [times[times.len() - 2], times[0]].map(|time| last / time);
    // Writing into a string cannot fail.
    let _ = writeln!(table, "| {name} | {cells} | {before:.1} × | {first:.1} × |");
    (times, made)
}
