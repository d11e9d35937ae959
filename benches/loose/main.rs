//! Compares the times of loose tolerances and of supersampling at the same error.
//!
//! For two errors of whole pictures: the time with the loosest tolerance that reaches the error, and with the smallest number of
//! samples that reaches it. Prints tables in Markdown; with `-- --write` they become the measured parts of docs/loose.md.

mod picture;

use std::fmt::Write as _;

use marbles_benches::page::Page;
use marbles_benches::{is_to_write, load, main as run, million, square_view};
use marbles_core::{Method, Renderer, View, World};

use self::picture::{Picture, SAMPLES, TOLERANCES, by};

const SCENES: [&str; 8] = [
    "c60",
    "first",
    "flight",
    "floor",
    "helix",
    "salt",
    "snowman",
    "turntable",
];
/// The side of pictures of clouds, in pixels.
const SIDE: u32 = 600;

/// RMS errors of pictures, each with the goal for the ratio of times: the time with a tolerance, divided by the time with
/// samples, should be no larger.
const GOALS: [(f64, f64); 2] = [(1e-2, 1.2), (1e-3, 0.5)];

/// The tolerances whose times the second table lists.
const LISTED: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-5];

fn main() {
    run(|| {
        let parts = ["loose", "tolerances"];
        let mut page = is_to_write().then(|| Page::open("docs/loose.md", &parts));
        let (tables, broken) = measure();
        for (part, table) in parts.into_iter().zip(&tables) {
            print(table);
            if let Some(page) = &mut page {
                page.write(part, table);
            }
        }
        // At the end: what was measured is true all the same.
        assert!(
            broken.is_empty(),
            "pixels are broken\n{}",
            broken.join("\n")
        );
    });
}

#[expect(clippy::print_stdout, reason = "the table is what a benchmark is for")]
fn print(table: &str) {
    println!("{table}");
}

/// Measures all pictures: the text of both tables, and the pixels that break their promise.
fn measure() -> ([String; 2], Vec<String>) {
    let (mut tables, mut broken) = (heads(), Vec::new());
    let mut over = GOALS.map(|_| Vec::new());
    let mut add = |name: &str, world: &World, view: &View| {
        let renderer = Renderer::new(world);
        let mut picture = Picture::new(name, &renderer, view);
        let ratios = picture.compare(&mut tables[0]);
        for ((over, ratio), (_, largest)) in over.iter_mut().zip(ratios).zip(GOALS) {
            if ratio > largest {
                over.push(name.to_owned());
            }
        }
        picture.list(&mut tables[1]);
        broken.append(&mut picture.broken);
    };
    for name in SCENES {
        let scene = load(&format!("scenes/{name}"));
        let view = scene.view(1).expect("scenes begin with frame 1");
        add(name, scene.world(), &view);
    }
    let cloud = load("tests/truth/pixels/cloud1k");
    let view = square_view(&cloud, SIDE);
    let clouds = [("cloud1k", cloud.world().clone()), ("a million", million())];
    for (name, mut world) in clouds {
        add(name, &world, &view);
        world.shadows = false;
        add(&format!("{name}, no shadows"), &world, &view);
    }
    for ((goal, largest), over) in GOALS.into_iter().zip(over) {
        let names = match over.as_slice() {
            [] => "none".to_owned(),
            names => names.join("; "),
        };
        // Writing into a string cannot fail.
        let _ = write!(
            tables[0],
            "\nScenes with a ratio above {largest} at an RMSE of {goal:e}: {names}.\n"
        );
    }
    assert_nothing_is_chosen(&view);
    (tables, broken)
}

/// The degenerate case: for an empty world, the first settings are good enough.
fn assert_nothing_is_chosen(view: &View) {
    let world = World::new();
    let renderer = Renderer::new(&world);
    let mut picture = Picture::new("nothing", &renderer, view);
    for (goal, _) in GOALS {
        let [tolerance, samples] = picture.choices(goal);
        assert_eq!(tolerance.run.method, Method::Tolerance(TOLERANCES[0]));
        assert_eq!(samples.run.method, by(SAMPLES[0]));
    }
}

/// The first lines of both tables.
fn heads() -> [String; 2] {
    let mut compared = "| scene |".to_owned();
    for (goal, largest) in GOALS {
        let _ = write!(
            compared,
            " RMSE {goal:e}: by tolerance | by samples | ratio, goal {largest} |"
        );
    }
    let listed = LISTED.map(|tolerance| format!(" {tolerance:e} |")).concat();
    [
        format!("{compared}\n|---|{}\n", "--:|".repeat(3 * GOALS.len())),
        format!("| scene |{listed}\n|---|{}\n", "--:|".repeat(LISTED.len())),
    ]
}
