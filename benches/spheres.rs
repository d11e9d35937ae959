//! Measures how the time grows with the number of spheres, which always fill the same fraction of a volume.

use marbles_benches::{Case, cloud, load, main as run, mean, square_view, table, to_tolerance};
use marbles_core::{Renderer, World};

const COUNTS: [u32; 5] = [10, 100, 1000, 10_000, 100_000];
const TOLERANCE: f64 = 1e-2;
const SIDE: u32 = 300;

fn main() {
    run(|| {
        // The view of the cloud of a thousand.
        let view = square_view(&load("tests/truth/pixels/cloud1k"), SIDE);
        let worlds = COUNTS.map(cloud);
        let empty = World::new();
        let mut cases = Vec::new();
        let all = [&empty].into_iter().chain(&worlds);
        for (count, world) in [0].into_iter().chain(COUNTS).zip(all) {
            cases.push(Case {
                name: format!("{count} spheres"),
                millions: f64::from(count) * 1e-6,
                run: Box::new(move |_| Renderer::new(world)),
            });
        }
        let renderers = table("to prepare", "spheres", 3, &cases);
        let mut cases = Vec::new();
        for (count, renderer) in [0].into_iter().chain(COUNTS).zip(&renderers) {
            let view = &view;
            cases.push(Case {
                name: format!("{count} spheres"),
                millions: f64::from(SIDE * SIDE) * 1e-6,
                run: Box::new(move |spent| to_tolerance(renderer, view, TOLERANCE, spent)),
            });
        }
        let images = table("to render", "pixels", 15, &cases);
        // Without a sphere it is dark; with more there is light, and not all of it.
        assert_eq!(mean(&images[0]), 0.0);
        for image in &images[1..] {
            let mean = mean(image);
            assert!(0.001 < mean && mean < 1.0, "{mean}");
        }
    });
}
