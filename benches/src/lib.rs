//! The parts that benchmarks share: scenes, and timing of settings that take turns.
//!
//! Every benchmark answers one question, asserts that its pictures are right, and prints a table of
//! median times. Pictures are rendered on one thread.

pub mod chart;
pub mod page;
pub mod process;

use std::num::NonZeroU32;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use glam::DVec3;
use marbles_core::{
    Color, Image, Light, Material, Method, Renderer, Settings, Sphere, View, World,
};
use marbles_scene::Scene;

/// Work to be timed.
pub struct Case<'scene, T> {
    /// Its name in the table.
    pub name: String,
    /// The amount of work, in millions of the table's unit.
    pub millions: f64,
    /// The work. It gets its last result, whose memory it may reuse.
    pub run: Box<dyn Fn(Option<T>) -> T + Send + Sync + 'scene>,
}

const USAGE: &str = "\
cargo bench --package marbles-benches --bench NAME [-- --write]
    Runs a benchmark, and prints its tables.
    --write    also write the results into the pages of docs: report, loose, growth, memory, sequence, compile
    --lines    compile only counts the lines of code that the compiler generates for the core
";

/// Prints the usage if `--help` asks for it. Returns whether it did.
#[expect(clippy::print_stdout, reason = "the usage is what was asked for")]
pub fn helps() -> bool {
    let helps = std::env::args().any(|argument| matches!(&*argument, "--help" | "-h"));
    if helps {
        print!("{USAGE}");
    }
    helps
}

/// Runs all benchmarks of a file on one thread, but only if `cargo bench` started the process: `cargo test` and other commands
/// also start it.
pub fn main(benchmarks: impl FnOnce() + Send) {
    if helps() {
        return;
    }
    if std::env::args().any(|argument| argument == "--bench") {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        pool.expect("a thread can be had").install(benchmarks);
    }
}

/// Returns whether the benchmark should write its results into the documentation: `-- --write`.
pub fn is_to_write() -> bool {
    std::env::args().any(|argument| argument == "--write")
}

/// Formats seconds in a suitable unit.
pub fn seconds(seconds: f64) -> String {
    match seconds {
        1.0.. => format!("{seconds:.2} s"),
        0.01.. => format!("{:.0} ms", 1e3 * seconds),
        _ => format!("{:.1} ms", 1e3 * seconds),
    }
}

/// The median. For an even number of values, the upper one of the two in the middle.
pub fn median(mut times: Vec<f64>) -> f64 {
    times.sort_unstable_by(f64::total_cmp);
    times[times.len() / 2]
}

/// The result of measuring a case.
pub struct Timed<T> {
    /// The median of its times, in seconds.
    pub median: f64,
    /// The last result of the case.
    pub result: T,
}

/// Runs all cases in turns for `seconds`, but at least once. Prints the median times and the units per second. Returns the
/// last result of each case.
pub fn table<T>(title: &str, unit: &str, seconds: u64, cases: &[Case<'_, T>]) -> Vec<T> {
    let timed = timed_table(title, unit, seconds, cases).1;
    timed.into_iter().map(|timed| timed.result).collect()
}

/// Like [`table`], but returns the number of rounds and the measurement of each case.
#[expect(clippy::print_stdout, reason = "the table is what a benchmark is for")]
pub fn timed_table<T>(
    title: &str,
    unit: &str,
    seconds: u64,
    cases: &[Case<'_, T>],
) -> (usize, Vec<Timed<T>>) {
    let (rounds, timed) = medians(1, seconds, cases);
    println!("\n{title}, medians of {rounds}");
    for (case, timed) in cases.iter().zip(&timed) {
        let (milliseconds, rate) = (1e3 * timed.median, case.millions / timed.median);
        println!(
            "{:>24} {milliseconds:>12.3} ms {rate:>10.2} M {unit}/s",
            case.name
        );
    }
    (rounds, timed)
}

/// Runs all cases in turns for `seconds`, but at least `least` times. Returns the number of rounds and the measurement of each
/// case.
///
/// # Panics
/// If `least` is 0.
pub fn medians<T>(least: usize, seconds: u64, cases: &[Case<'_, T>]) -> (usize, Vec<Timed<T>>) {
    const MOST_ROUNDS: usize = 25;
    let start = Instant::now();
    let mut times = vec![Vec::new(); cases.len()];
    let mut results: Vec<Option<T>> = cases.iter().map(|_| None).collect();
    let mut rounds = 0;
    while rounds < least || rounds < MOST_ROUNDS && start.elapsed() < Duration::from_secs(seconds) {
        for ((case, times), result) in cases.iter().zip(&mut times).zip(&mut results) {
            let spent = result.take();
            let start = Instant::now();
            *result = Some((case.run)(spent));
            times.push(start.elapsed().as_secs_f64());
        }
        rounds += 1;
    }
    let timed = |(times, result): (Vec<f64>, Option<T>)| Timed {
        median: median(times),
        result: result.expect("every case has run"),
    };
    (rounds, times.into_iter().zip(results).map(timed).collect())
}

/// A temporary folder, which is removed when it is dropped.
pub struct Folder(pub PathBuf);

impl Folder {
    /// An empty folder.
    ///
    /// # Panics
    /// If it cannot be made.
    #[expect(clippy::new_without_default, reason = "it is made on a disk")]
    pub fn new() -> Self {
        let name = format!("marbles-bench-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).expect("a folder can be made");
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // What cannot be removed is left to the system.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A scene of the repository, by its path without the extension.
///
/// # Panics
/// If it cannot be read.
pub fn load(name: &str) -> Scene {
    let path = in_repository(&format!("{name}.ron"));
    Scene::load(&path).unwrap_or_else(|error| panic!("{error}"))
}

/// A path in the repository, whatever the current folder.
pub fn in_repository(path: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .join(path)
}

/// The first view of a scene, as a square with this side.
///
/// # Panics
/// If the scene has no frame 1.
pub fn square_view(scene: &Scene, side: u32) -> View {
    let view = scene.view(1).expect("scenes begin with frame 1");
    View {
        width: side,
        height: side,
        ..view
    }
}

/// A cloud of random balls, the same in every run, in a cube with a side of 200 around (0, 0, 400). Whatever their number, they
/// fill as much of it as a thousand balls with radii from 3 to 12.
pub fn cloud(count: u32) -> World {
    let scale = (1e3 / f64::from(count)).cbrt();
    scattered(count, |random| scale * (3.0 + 9.0 * random))
}

/// A cloud of balls of one radius in the same cube.
pub fn even_cloud(count: u32, radius: f64) -> World {
    scattered(count, |_| radius)
}

/// A million balls in the same cube, each about two pixels wide in a picture of 600 × 600 pixels.
pub fn million() -> World {
    even_cloud(1_000_000, 0.6)
}

fn scattered(count: u32, radius: impl Fn(f64) -> f64) -> World {
    let mut state = u64::from(count);
    let mut random = || {
        // Knuth's linear congruential generator, whose upper bits are good.
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    for _ in 0..count {
        let point = DVec3::new(random(), random(), random()) - 0.5;
        let sphere = Sphere::new(200.0 * point + 400.0 * DVec3::Z, radius(random()));
        world.add_sphere(sphere.expect("radii are positive"), white);
    }
    let light = Light::directional(DVec3::new(-1.0, 1.0, -1.0), Color::ONE);
    world.lights.extend(light);
    world
}

/// The picture at a tolerance, in the memory of another picture.
pub fn to_tolerance(
    renderer: &Renderer<'_>,
    view: &View,
    tolerance: f64,
    spent: Option<Image>,
) -> Image {
    render(renderer, view, Method::Tolerance(tolerance), spent)
}

/// The picture with N × N samples per pixel, in the memory of another picture.
///
/// # Panics
/// If there are no samples.
pub fn by_samples(
    renderer: &Renderer<'_>,
    view: &View,
    samples: u32,
    spent: Option<Image>,
) -> Image {
    let samples = NonZeroU32::new(samples).expect("at least one sample");
    render(renderer, view, Method::Samples(samples), spent)
}

/// The picture by a method, in the memory of another picture.
pub fn render(renderer: &Renderer<'_>, view: &View, method: Method, spent: Option<Image>) -> Image {
    let settings = Settings {
        method,
        alpha: false,
    };
    let image = renderer.render_over(spent, view, &settings, &|_| ControlFlow::Continue(()));
    image.expect("nobody stops it")
}

/// The mean of a picture's first channel.
pub fn mean(image: &Image) -> f64 {
    let pixels = f64::from(image.width()) * f64::from(image.height());
    places(image)
        .map(|(col, row)| image.rgba(col, row)[0])
        .sum::<f64>()
        / pixels
}

/// The largest difference between the first channels of two pictures of the same size.
pub fn largest_difference(one: &Image, other: &Image) -> f64 {
    let difference = |(col, row)| (one.rgba(col, row)[0] - other.rgba(col, row)[0]).abs();
    places(one).map(difference).fold(0.0, f64::max)
}

/// The columns and rows of all pixels, row by row.
pub fn places(image: &Image) -> impl Iterator<Item = (u32, u32)> {
    let width = image.width();
    (0..image.height()).flat_map(move |row| (0..width).map(move |col| (col, row)))
}
