//! Measures the primary rays per second of supersampling.

use marbles_benches::{Case, by_samples, load, main as run, mean, square_view, table};
use marbles_core::{Renderer, World};

const SIDE: u32 = 600;

fn main() {
    run(|| {
        for name in ["tests/truth/pixels/seed1", "tests/truth/pixels/cloud1k"] {
            let scene = load(name);
            let view = square_view(&scene, SIDE);
            let worlds = [true, false].map(|shadows| {
                let mut world = scene.world().clone();
                world.shadows = shadows;
                world
            });
            let renderers = worlds.each_ref().map(Renderer::new);
            let mut cases = Vec::new();
            for (renderer, world) in renderers.iter().zip(&worlds) {
                let shadows = if world.shadows { "with" } else { "without" };
                for samples in [1, 4] {
                    let view = &view;
                    cases.push(Case {
                        name: format!("{samples} x {samples}, {shadows} shadows"),
                        millions: f64::from(SIDE * SIDE * samples * samples) * 1e-6,
                        run: Box::new(move |spent| by_samples(renderer, view, samples, spent)),
                    });
                }
            }
            let means: Vec<f64> = table(name, "rays", 6, &cases).iter().map(mean).collect();
            // More samples change little, shadows take light away, unless there is one ball only.
            let [dark, fine_dark, bright, fine_bright] = means[..] else {
                panic!("four means")
            };
            assert!((dark - fine_dark).abs() < 1e-3 && (bright - fine_bright).abs() < 1e-3);
            assert!(0.01 < dark && dark <= bright, "{means:?}");
        }
        // The degenerate case: rays that meet nothing.
        let view = square_view(&load("tests/truth/pixels/seed1"), SIDE);
        let world = World::new();
        let renderer = Renderer::new(&world);
        let cases = [1, 4].map(|samples| Case {
            name: format!("{samples} x {samples}"),
            millions: f64::from(SIDE * SIDE * samples * samples) * 1e-6,
            run: Box::new({
                let (renderer, view) = (&renderer, &view);
                move |spent| by_samples(renderer, view, samples, spent)
            }),
        });
        let images = table("empty", "rays", 1, &cases);
        assert!(images.iter().all(|image| mean(image) == 0.0));
    });
}
