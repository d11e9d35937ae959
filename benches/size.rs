//! Measures how the time grows with the size of the picture.

use marbles_benches::{Case, load, main as run, mean, square_view, table, to_tolerance};
use marbles_core::{Renderer, View, World};

const SIDES: [u32; 5] = [150, 300, 600, 1200, 2400];
const TOLERANCE: f64 = 1e-3;

fn case<'scene>(renderer: &'scene Renderer<'_>, view: View) -> Case<'scene, f64> {
    Case {
        name: format!("{} x {}", view.width, view.height),
        millions: f64::from(view.width) * f64::from(view.height) * 1e-6,
        run: Box::new(move |_| {
            let image = to_tolerance(renderer, &view, TOLERANCE, None);
            assert_eq!(image.summary().over_tolerance, 0);
            mean(&image)
        }),
    }
}

fn main() {
    run(|| {
        for name in ["tests/truth/pixels/seed1", "tests/truth/pixels/cloud1k"] {
            let scene = load(name);
            let renderer = Renderer::new(scene.world());
            let cases = SIDES.map(|side| case(&renderer, square_view(&scene, side)));
            // All are averages over the same square.
            let means = table(name, "pixels", 12, &cases);
            for mean in &means {
                assert!((mean - means[0]).abs() <= 2.0 * TOLERANCE, "{means:?}");
            }
        }
        let scene = load("tests/truth/pixels/seed1");
        let world = World::new();
        let renderer = Renderer::new(&world);
        let cases = SIDES.map(|side| case(&renderer, square_view(&scene, side)));
        assert_eq!(table("empty", "pixels", 1, &cases), [0.0; SIDES.len()]);
    });
}
