//! The reference, compared with exact pixels computed by others and with closed forms.

use std::path::Path;

use marbles_scene::Scene;
use rayon::prelude::*;

use marbles_tests::reference::Reference;

/// The largest error of the numbers in the files.
const FILES: f64 = 1e-11;

/// All pixels of `tests/truth/pixels`.
#[test]
fn agrees_with_the_exact_pixels() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("truth/pixels");
    for name in ["seed1", "ground", "cloud1k"] {
        let scene = Scene::load(&folder.join(format!("{name}.ron"))).unwrap();
        let view = scene.view(1).unwrap();
        let reference = Reference::new(scene.world(), &view);
        let text = std::fs::read_to_string(folder.join(format!("{name}.csv"))).unwrap();
        let lines: Vec<&str> = text.lines().skip(1).collect();
        assert_eq!(lines.len(), 400);
        lines.par_iter().for_each(|line| {
            let fields: Vec<f64> = line
                .split(',')
                .map(|field| field.parse().unwrap())
                .collect();
            let truth = reference.pixel(fields[1] as u32, fields[0] as u32);
            let off = (truth.value.x - fields[3])
                .abs()
                .max((truth.value.w - fields[4]).abs());
            assert!(
                off <= truth.error + FILES,
                "{name}: {line} is off by {off:e}"
            );
            assert!(
                truth.error <= 1e-9,
                "{name}: {line} states {:e}",
                truth.error
            );
        });
    }
}

/// Sums over points need no edges; their error decreases with the distance of the points. And the sum of the quarters
/// is the whole.
#[test]
fn midpoints_approach_it_and_quarters_sum_up_to_it() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("truth/pixels");
    let scene = Scene::load(&folder.join("cloud1k.ron")).unwrap();
    let view = scene.view(1).unwrap();
    let reference = Reference::new(scene.world(), &view);
    let mut edges = 0;
    for step in 0..60 {
        let (col, row) = (120 + 6 * step, 140 + 5 * step);
        if !reference.sees_anything(col, row) {
            continue;
        }
        let truth = reference.pixel(col, row);
        edges += u32::from(truth.has_edge);
        // The points may miss an edge, but invent none.
        assert!(truth.has_edge || !reference.seems_to_change(col, row));
        let parts = reference.pixel_by_quarters(col, row);
        let apart = (parts.value - truth.value).abs().max_element();
        assert!(
            apart <= parts.error + truth.error,
            "column {col}, row {row}: {apart:e}"
        );
        let off = (reference.midpoints(col, row, 100) - truth.value).abs();
        // Measured: 3e-4; an edge along the grid may cost half a row of points.
        assert!(off.max_element() < 5e-3, "column {col}, row {row}: {off}");
    }
    assert!(edges >= 8);
}

/// In a world with the same light everywhere on the balls, pixels show their areas: of discs around the center of the
/// view, which are circles, of specks, and of a ball that fills the corner of the pixel.
#[test]
fn areas_of_circles_are_exact() {
    for (radius_px, width) in [(0.4, 1), (0.003, 1), (7.3, 15), (1.5, 3)] {
        // A ball on the axis of view: its contour on the retina has the radius
        // distance · r / √(c² − r²).
        let (center, distance) = (10.0, 50.0);
        let ratio = radius_px / distance;
        let radius = center * ratio / f64::hypot(1.0, ratio);
        let text = format!(
            "(image: (width: {width}, height: {width}), lens: Retina(width: {width}, \
             distance: {distance}), camera: Free(), ambient: 1, \
             spheres: [(center: (0, 0, {center}), radius: {radius:?})])"
        );
        let scene = Scene::parse(&text, Path::new("disc.ron")).unwrap();
        let view = scene.view(1).unwrap();
        let reference = Reference::new(scene.world(), &view);
        let (mut area, mut error) = (0.0, 0.0);
        for (col, row) in (0..width).flat_map(|col| (0..width).map(move |row| (col, row))) {
            let truth = reference.pixel(col, row);
            assert!((truth.value.x - truth.value.w).abs() < 1e-14);
            area += truth.value.w;
            error += truth.error;
        }
        let expected = std::f64::consts::PI * radius_px * radius_px;
        assert!(
            (area - expected).abs() <= error,
            "{area} instead of {expected} ± {error:e}"
        );
        assert!(error <= 1e-10 * f64::from(width * width));
    }
}
