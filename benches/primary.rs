//! Measures the primary rays per second at one sample per pixel, without the preparation of the view.
//!
//! Progress is first reported after the first tile; by then the view is prepared. This tile counts neither as
//! preparation nor as rendering.

use std::num::NonZeroU32;
use std::ops::ControlFlow;
use std::sync::OnceLock;
use std::time::Instant;

use marbles_benches::{load, main as run, mean, median, million, square_view};
use marbles_core::{Method, Renderer, Settings, View, World};

const SIDE: u32 = 600;
const FRAMES: usize = 25;

fn main() {
    run(|| {
        let scene = load("tests/truth/pixels/cloud1k");
        let view = square_view(&scene, SIDE);
        for (name, mut world) in [
            ("cloud1k", scene.world().clone()),
            ("cloud1m", million()),
            ("empty", World::new()),
        ] {
            world.shadows = false;
            let light = time(name, &world, &view);
            assert!(if name == "empty" {
                light == 0.0
            } else {
                0.1 < light && light < 0.9
            });
        }
    });
}

/// Prints the medians of some frames; returns the mean of the picture.
#[expect(clippy::print_stdout, reason = "the table is what a benchmark is for")]
fn time(name: &str, world: &World, view: &View) -> f64 {
    let renderer = Renderer::new(world);
    let settings = Settings {
        method: Method::Samples(NonZeroU32::MIN),
        alpha: false,
    };
    let (mut preparing, mut tracing) = (Vec::new(), Vec::new());
    let (first_tile, mut rays) = (OnceLock::new(), 0);
    let mut spent = None;
    for _ in 0..FRAMES {
        let first = OnceLock::new();
        let start = Instant::now();
        let progress = |pixels| {
            first.get_or_init(Instant::now);
            first_tile.get_or_init(|| pixels);
            ControlFlow::Continue(())
        };
        let image = renderer.render_over(spent.take(), view, &settings, &progress);
        let (first, end) = (*first.get().expect("there are tiles"), Instant::now());
        preparing.push((first - start).as_secs_f64());
        tracing.push((end - first).as_secs_f64());
        spent = image.ok();
        rays = u64::from(SIDE * SIDE) - first_tile.get().expect("there are tiles");
    }
    let [preparing, tracing] = [preparing, tracing].map(median);
    println!(
        "{name:>24} {:>12.3} ms to prepare {:>10.2} M rays/s",
        1e3 * preparing,
        1e-6 * rays as f64 / tracing
    );
    mean(&spent.expect("nobody stops it"))
}
