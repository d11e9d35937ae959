//! Measures how the time grows as the tolerance shrinks.

use marbles_benches::{
    Case, largest_difference, load, main as run, mean, square_view, table, to_tolerance,
};
use marbles_core::{Renderer, World};

const TOLERANCES: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];
const SIDE: u32 = 600;

fn main() {
    run(|| {
        for name in [
            "tests/truth/pixels/seed1",
            "tests/truth/pixels/cloud1k",
            "scenes/c60",
        ] {
            let scene = load(name);
            let view = square_view(&scene, SIDE);
            let renderer = Renderer::new(scene.world());
            let case = |tolerance: f64| Case {
                name: format!("{tolerance:e}"),
                millions: f64::from(SIDE * SIDE) * 1e-6,
                run: Box::new({
                    let (renderer, view) = (&renderer, &view);
                    move |spent| to_tolerance(renderer, view, tolerance, spent)
                }),
            };
            let images = table(name, "pixels", 8, &TOLERANCES.map(case));
            let finest = &images[TOLERANCES.len() - 1];
            for (image, tolerance) in images.iter().zip(TOLERANCES) {
                assert_eq!(image.summary().over_tolerance, 0, "{name} at {tolerance:e}");
                assert!(largest_difference(image, finest) <= tolerance + 1e-6);
            }
        }
        // The degenerate case: nothing to see.
        let view = square_view(&load("tests/truth/pixels/seed1"), SIDE);
        let world = World::new();
        let renderer = Renderer::new(&world);
        let empty = Case {
            name: "1e-6".to_owned(),
            millions: f64::from(SIDE * SIDE) * 1e-6,
            run: Box::new(|spent| to_tolerance(&renderer, &view, 1e-6, spent)),
        };
        let images = table("empty", "pixels", 1, &[empty]);
        // A sample a pixel at most, where the tolerance is no less than the contrast.
        let work = images[0].work();
        assert!(work.samples <= u64::from(SIDE * SIDE), "{work:?}");
        assert_eq!((work.lines, work.candidate_tests), (0, 0));
        assert_eq!(mean(&images[0]), 0.0);
    });
}
