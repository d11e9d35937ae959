//! How does the time of a picture grow with spheres of which it hides nearly all, and with its size?
//!
//! The spheres are the same part of the same volume, however many. The tables are Markdown; with
//! `-- docs/growth/growth.svg` they are drawn, too.

use marbles_benches::chart::{Panel, svg};
use marbles_benches::{
    Case, by_samples, cloud, in_repository, load, main as run, mean, medians, square_view,
    to_tolerance,
};
use marbles_core::{Image, Renderer, View, World};

const COUNTS: [u32; 4] = [10_000, 100_000, 1_000_000, 10_000_000];
/// Which of these is seen in pictures of several sizes.
const SIZED: usize = 2;
const SIDES: [u32; 3] = [600, 1200, 2400];
const TOLERANCE: f64 = 1e-2;
const ROUNDS: usize = 3;
/// For a row, if its rounds take less.
const SECONDS: u64 = 6;
/// How far pictures may be apart on average: there are fewer large spheres than small ones.
const ALIKE: f64 = 0.1;

/// What a row of the tables measures.
struct Setting {
    name: &'static str,
    /// None for one sample a pixel.
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

fn main() {
    run(|| {
        let scene = load("tests/truth/pixels/cloud1k");
        let views = SIDES.map(|side| square_view(&scene, side));
        let shaded = COUNTS.map(cloud);
        let plain = shaded.each_ref().map(|world| {
            let mut world = world.clone();
            world.shadows = false;
            world
        });
        let counts = ["10⁴", "10⁵", "10⁶", "10⁷"].map(str::to_owned);
        head("spheres, at 600² pixels", &counts);
        let cases: Vec<_> = shaded.iter().map(preparation).collect();
        let (preparing, shaded) = row("to prepare", &cases);
        let plain: Vec<_> = plain.iter().map(Renderer::new).collect();
        let of = |setting: &Setting| if setting.shadows { &shaded } else { &plain };
        let mut by_count = vec![preparing];
        by_count.extend(SETTINGS.iter().map(|setting| {
            let frames = of(setting).iter().map(|renderer| (renderer, &views[0]));
            pictures(setting, frames)
        }));
        let sides = SIDES.map(|side| format!("{side}²"));
        head(&format!("pixels, of {} spheres", counts[SIZED]), &sides);
        let by_side = SETTINGS.iter().map(|setting| {
            let frames = views.iter().map(|view| (&of(setting)[SIZED], view));
            pictures(setting, frames)
        });
        let by_side = [Vec::new()].into_iter().chain(by_side).collect();
        let by_count = Panel {
            title: "Seconds for spheres, at 600² pixels".to_owned(),
            steps: counts.to_vec(),
            factor: 10.0,
            width: 420.0,
            times: by_count,
        };
        let by_side = Panel {
            title: "Seconds for pixels, of 10⁶ spheres".to_owned(),
            steps: sides.to_vec(),
            factor: 4.0,
            width: 280.0,
            times: by_side,
        };
        if let Some(path) = std::env::args().find(|argument| argument.ends_with(".svg")) {
            let names = ["to prepare"].into_iter();
            let names: Vec<_> = names.chain(SETTINGS.map(|setting| setting.name)).collect();
            let written = std::fs::write(in_repository(&path), svg(&names, &[by_count, by_side]));
            written.unwrap_or_else(|error| panic!("{path}: {error}"));
        }
    });
}

fn preparation(world: &World) -> Case<'_, Renderer<'_>> {
    Case {
        name: String::new(),
        millions: 0.0,
        run: Box::new(move |_| Renderer::new(world)),
    }
}

/// The row of a setting; its seconds.
fn pictures<'scene>(
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
    let (seconds, images) = row(setting.name, &cases);
    // However many spheres and pixels, they look alike from afar.
    let means: Vec<f64> = images.iter().map(mean).collect();
    let alike = means
        .iter()
        .all(|mean| (mean / means[0] - 1.0).abs() < ALIKE);
    assert!(means[0] > 0.1 && alike, "{means:?}");
    seconds
}

#[expect(clippy::print_stdout, reason = "the table is what a benchmark is for")]
fn head(title: &str, steps: &[String]) {
    let cells = steps.join(" | ");
    println!("\n| {title} | {cells} | the last two |");
    println!("|---|{}--:|", "--:|".repeat(steps.len()));
}

/// Measures and prints a row of the table; its seconds, and what was made.
#[expect(clippy::print_stdout, reason = "the table is what a benchmark is for")]
fn row<T>(name: &str, cases: &[Case<'_, T>]) -> (Vec<f64>, Vec<T>) {
    let timed = medians(ROUNDS, SECONDS, cases).1.into_iter();
    let (seconds, made): (Vec<f64>, Vec<T>) = timed.map(|it| (it.median, it.result)).unzip();
    let cells = seconds.iter().map(|&seconds| match seconds {
        1.0.. => format!("{seconds:.2} s"),
        0.01.. => format!("{:.0} ms", 1e3 * seconds),
        _ => format!("{:.1} ms", 1e3 * seconds),
    });
    let cells: Vec<_> = cells.collect();
    let ratio = seconds[seconds.len() - 1] / seconds[seconds.len() - 2];
    println!("| {name} | {} | {ratio:.1} × |", cells.join(" | "));
    (seconds, made)
}
