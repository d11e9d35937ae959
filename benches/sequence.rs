//! Measures how much longer a sequence takes than its pictures by themselves, on two threads.
//!
//! Encoding and writing happen during rendering, and slow it down if all cores are busy. With `-- --write`, the table
//! becomes the measured part of docs/sequences.md.

use std::ffi::OsString;
use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::{fs, process};

use marbles_benches::page::Page;
use marbles_benches::{Case, Folder, is_to_write, load, main as run, seconds, timed_table};
use marbles_core::{Image, Method, Renderer, Rendering, Settings, Sink, Strip, Window};
use marbles_scene::Scene;

const FRAMES: u32 = 60;
const THREADS: usize = 2;

fn main() {
    run(|| {
        let mut page = is_to_write().then(|| Page::open("docs/sequences.md", &["files"]));
        let mut rows = String::from(
            "| frames | rendering alone, one frame after another | to PNG | to half-float ZIP EXR |\n\
             |---|--:|--:|--:|\n",
        );
        let folder = Folder::new();
        let path = turntable(&folder.0);
        let scene = Scene::load(&path).unwrap_or_else(|error| panic!("{error}"));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(THREADS).build();
        let pool = pool.expect("threads can be had");
        for side in [600, 40] {
            let millions = 1e-6 * f64::from(FRAMES) * f64::from(side * side);
            let files = |ending: &'static str| Case {
                name: ending.to_owned(),
                millions,
                run: Box::new({
                    let (path, folder) = (&path, &folder.0);
                    move |_| write(path, &folder.join(format!("turn.####.{ending}")), side)
                }),
            };
            let alone = Case {
                name: "pictures alone".to_owned(),
                millions,
                run: Box::new(|_| pool.install(|| render(&scene, side))),
            };
            let title = format!("{FRAMES} frames of {side} x {side} pixels");
            let cases = [alone, files("png"), files("exr")];
            let (rounds, timed) = timed_table(&title, "pixels", 60, &cases);
            let _ = write!(rows, "| {side} × {side}, medians of {rounds} rounds |");
            let alone = timed[0].median;
            for (index, median) in timed.iter().map(|timed| timed.median).enumerate() {
                let _ = write!(rows, " {}", seconds(median));
                let _ = match index {
                    0 => write!(rows, " |"),
                    _ => write!(rows, " ({:.2} ×) |", median / alone),
                };
            }
            rows.push('\n');
        }
        if let Some(page) = &mut page {
            page.write("files", &rows);
        }
    });
}

/// Renders all frames to files.
fn write(scene: &Path, pattern: &Path, side: u32) {
    let threads = THREADS.to_string();
    let size = format!("{side}x{side}");
    let words = ["marbles", "render", "--quiet", "--threads", &threads];
    let words = words.into_iter().chain(["--size", &size, "--output"]);
    let words = words.map(OsString::from);
    let paths = [pattern, scene].map(|path| path.as_os_str().to_owned());
    let code = marbles_cli::run(words.chain(paths));
    assert_eq!(
        format!("{code:?}"),
        format!("{:?}", process::ExitCode::SUCCESS)
    );
}

/// Renders all frames one by one, without output.
fn render(scene: &Scene, side: u32) {
    let renderer = Renderer::new(scene.world());
    let settings = Settings {
        method: Method::Tolerance(1e-3),
        alpha: false,
    };
    for frame in 1..=FRAMES as i32 {
        let mut view = scene.view(frame).expect("the scene has this frame");
        (view.width, view.height) = (side, side);
        let rendering = renderer.begin(&view, Window::whole(&view), &settings, Rendering::ROW_STEP);
        for work in rayon::broadcast(|_| rendering.help(&Nobody, &|_| ControlFlow::Continue(()))) {
            work.expect("nobody stops it");
        }
    }
}

struct Nobody;

impl Sink for Nobody {
    fn begin(&self, _: u32) -> Option<Box<dyn Strip + '_>> {
        Some(Box::new(Self))
    }
}

impl Strip for Nobody {
    fn add(&mut self, _: u32, _: &Image) {}

    fn end(self: Box<Self>) {}
}

/// Writes a turntable of a thousand spheres; returns its path.
fn turntable(folder: &Path) -> PathBuf {
    let mut rows = String::from("x,y,z,radius\n");
    for sphere in load("tests/truth/pixels/cloud1k").world().spheres() {
        let (center, radius) = (sphere.center(), sphere.radius());
        let _ = writeln!(rows, "{},{},{},{radius}", center.x, center.y, center.z);
    }
    fs::write(folder.join("cloud.csv"), rows).expect("a table can be written");
    let scene = format!(
        "(image: (width: 600, height: 600), lens: Retina(width: 600, distance: 700), \
         camera: Frame(elevation: 20), lights: [Directional(toward: (-1, 1, -1))], \
         clouds: [(file: \"cloud.csv\")], animation: Turntable(frames: {FRAMES}))"
    );
    let path = folder.join("turn.ron");
    fs::write(&path, scene).expect("a scene can be written");
    path
}
