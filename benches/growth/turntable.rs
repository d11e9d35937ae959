//! A turntable around a million spheres, from reading the table to writing the last picture.

use std::fmt::Write as _;
use std::fs;
use std::time::Instant;

use marbles_benches::process::marbles;
use marbles_benches::{Folder, even_cloud, median};

const SPHERES: u32 = 1_000_000;
const RADIUS: f64 = 0.6;
const FRAMES: usize = 120;
const THREADS: &str = "2";
const ROUNDS: usize = 3;

/// The times of a run, in seconds.
struct Run {
    whole: f64,
    /// The rendering time of each frame.
    frames: Vec<f64>,
}

/// Measures without and with shadows, in turns, and returns the table.
pub(crate) fn measure() -> String {
    let folder = Folder::new();
    let world = even_cloud(SPHERES, RADIUS);
    let mut rows = String::from("x,y,z,radius\n");
    for sphere in world.spheres() {
        let center = sphere.center();
        let [x, y, z] = [center.x, center.y, center.z];
        let _ = writeln!(rows, "{x:.5},{y:.5},{z:.5},{}", sphere.radius());
    }
    fs::write(folder.0.join("million.csv"), rows).expect("a table can be written");
    for shadows in [false, true] {
        let scene = format!(
            "(image: (width: 600, height: 600), lens: Retina(width: 600, distance: 700), \
             camera: Frame(elevation: 20), shadows: {shadows}, \
             lights: [Directional(toward: (-1, 1, -1))], \
             clouds: [(file: \"million.csv\")], animation: Turntable(frames: {FRAMES}))"
        );
        fs::write(folder.0.join(scene_name(shadows)), scene).expect("a scene can be written");
    }
    let mut runs = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        for (shadows, runs) in [false, true].into_iter().zip(&mut runs) {
            runs.push(run(&folder, shadows));
        }
    }
    let mut table = String::from(
        "| | 120 frames, with reading and writing | frames per second | first frame | median frame |\n\
         |---|--:|--:|--:|--:|\n",
    );
    for (name, runs) in ["without shadows", "with shadows"].into_iter().zip(runs) {
        let of = |time: fn(&Run) -> f64| median(runs.iter().map(time).collect());
        let whole = of(|run| run.whole);
        let first = of(|run| run.frames[0]);
        let middle = of(|run| median(run.frames.clone()));
        let rate = FRAMES as f64 / whole;
        let _ = writeln!(
            table,
            "| {name} | {whole:.1} s | {rate:.0} | {first:.3} s | {middle:.3} s |"
        );
    }
    table
}

fn scene_name(shadows: bool) -> &'static str {
    if shadows {
        "shadows.ron"
    } else {
        "million.ron"
    }
}

/// Renders all frames to files.
fn run(folder: &Folder, shadows: bool) -> Run {
    let start = Instant::now();
    let words = [
        "render",
        scene_name(shadows),
        "--samples",
        "1",
        "--threads",
        THREADS,
    ];
    let words = words
        .into_iter()
        .chain(["--progress=none", "-o", "frames/million.####.png"]);
    let lines = marbles(&folder.0, &words.collect::<Vec<_>>());
    let whole = start.elapsed().as_secs_f64();
    let frames = lines.lines().filter(|line| line.starts_with("frames/"));
    let frames: Vec<f64> = frames.map(seconds_of).collect();
    assert_eq!(frames.len(), FRAMES, "{lines}");
    Run { whole, frames }
}

/// The time at the end of a line of results, in seconds.
fn seconds_of(line: &str) -> f64 {
    let seconds = line
        .strip_suffix(" s")
        .and_then(|line| line.rsplit(' ').next());
    let seconds = seconds.and_then(|seconds| seconds.parse().ok());
    seconds.unwrap_or_else(|| panic!("no seconds: {line}"))
}
