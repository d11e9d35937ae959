//! Pixels whose errors once were larger than claimed, compared with their exact averages in `tests/truth/known`.

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::path::Path;

use marbles_core::{Image, Method, Renderer, Settings};
use marbles_scene::Scene;

/// Renders the first frame of a scene.
fn image(path: &Path, tolerance: f64, alpha: bool) -> Image {
    let scene = Scene::load(path).unwrap_or_else(|error| panic!("{error}"));
    let view = scene.view(1).unwrap();
    let settings = Settings {
        method: Method::Tolerance(tolerance),
        alpha,
    };
    Renderer::new(scene.world())
        .render_with_progress(scene.exposure(&view), &settings, &|_| {
            ControlFlow::Continue(())
        })
        .unwrap()
}

#[test]
fn known_pixels_are_within_what_they_claim() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("truth/known");
    let table = std::fs::read_to_string(folder.join("pixels.csv")).unwrap();
    let mut images = HashMap::new();
    let mut count = 0;
    for line in table.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |index: usize| fields[index].parse::<f64>().unwrap();
        let [name, _, _, tolerance, alpha, ..] = fields[..] else {
            panic!("{line}");
        };
        let image = images
            .entry((name, tolerance, alpha))
            .or_insert_with(|| image(&folder.join(name), number(3), alpha == "true"));
        let (col, row) = (number(1) as u32, number(2) as u32);
        let claimed = image.error(col, row);
        for channel in 0..3 {
            let off = (image.rgba(col, row)[channel] - number(5 + channel)).abs();
            assert!(off <= claimed + number(8), "{line}: {off:e} {claimed:e}");
        }
        let is_over = image.status(col, row).is_over_tolerance();
        assert_eq!(is_over, claimed > number(3), "{line}: {claimed:e}");
        count += 1;
    }
    assert!(count >= 21, "{count}");
}
