//! Supersampling, compared with exact pixels that were computed independently, in `tests/truth/pixels`.

use std::path::PathBuf;

use marbles_core::Status;
use marbles_scene::Scene;

use crate::studio::{exact_picture, picture, single_pixel};

/// A pixel of the files.
struct ExactPixel {
    row: u32,
    col: u32,
    has_edge: bool,
    value: f64,
    alpha: f64,
}

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("truth/pixels")
}

fn exact_pixels(name: &str) -> Vec<ExactPixel> {
    let text = std::fs::read_to_string(folder().join(format!("{name}.csv"))).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("row,col,edge,value,alpha"));
    let pixel = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        ExactPixel {
            row: fields[0].parse().unwrap(),
            col: fields[1].parse().unwrap(),
            has_edge: fields[2] == "1",
            value: fields[3].parse().unwrap(),
            alpha: fields[4].parse().unwrap(),
        }
    };
    lines.map(pixel).collect()
}

/// The results of supersampling on the pixels of a file.
#[derive(Debug, Default)]
struct Score {
    pixels: u32,
    edge_pixels: u32,
    /// Root mean square error of the pixels with edges, and the largest error of the others.
    edge_rmse: f64,
    worst_smooth: f64,
    /// The number of edge pixels whose error exceeds its estimate, and the largest such error.
    over_estimate: u32,
    largest_missed: f64,
    largest_error: f64,
    largest_estimate: f64,
}

fn score(name: &str, samples: u32) -> Score {
    let scene = Scene::load(&folder().join(format!("{name}.ron"))).unwrap();
    let view = scene.view(1).unwrap();
    let mut score = Score::default();
    for exact in exact_pixels(name) {
        let image = picture(
            scene.world(),
            &single_pixel(&view, exact.col, exact.row),
            samples,
            true,
        );
        let [value, _, _, alpha] = image.rgba(0, 0);
        let error = (value - exact.value).abs().max((alpha - exact.alpha).abs());
        let estimate = image.error(0, 0);
        score.pixels += 1;
        score.largest_error = score.largest_error.max(error);
        score.largest_estimate = score.largest_estimate.max(estimate);
        if exact.has_edge {
            score.edge_pixels += 1;
            score.edge_rmse += error * error;
            if error > estimate {
                score.over_estimate += 1;
                score.largest_missed = score.largest_missed.max(error);
            }
        } else {
            score.worst_smooth = score.worst_smooth.max(error);
        }
    }
    score.edge_rmse = (score.edge_rmse / f64::from(score.edge_pixels)).sqrt();
    score
}

/// Supersampling converges to the exact pixels like a grid should: inside surfaces with N⁻², at edges with N^-1.5, but
/// only with N⁻¹ if many edges run along the grid, like the horizon of the ground.
#[test]
fn supersampling_converges_to_the_exact_pixels() {
    for (name, finest, power) in [
        ("seed1", 64, 1.3),
        ("ground", 32, 1.0),
        ("cloud1k", 16, 1.3),
    ] {
        let coarse = score(name, 4);
        let fine = score(name, finest);
        assert_eq!((coarse.pixels, coarse.edge_pixels), (400, 320));
        let ratio = f64::from(finest) / 4.0;
        let measured = (coarse.edge_rmse / fine.edge_rmse).ln() / ratio.ln();
        assert!(
            measured > power,
            "{name}: error falls with the power {measured} of N"
        );
        assert!(coarse.edge_rmse < 0.05, "{name}: {coarse:?}");
        assert!(
            fine.worst_smooth < coarse.worst_smooth / (0.8 * ratio * ratio) + 1e-12,
            "{name}"
        );
    }
}

/// The claim in the documentation of `Supersampling`: in one edge pixel of five the estimate misses an edge between the
/// samples and the border of the pixel. Its error then stays below the cost of an edge along the grid. The largest
/// estimate covers the largest error.
#[test]
fn the_error_estimate_holds_but_for_edges_that_no_sample_saw() {
    for (name, samples) in [("seed1", 4), ("seed1", 16), ("ground", 4), ("cloud1k", 4)] {
        let score = score(name, samples);
        assert!(
            score.over_estimate <= score.edge_pixels / 5,
            "{name} by {samples}: {score:?}"
        );
        assert!(
            score.largest_missed < 0.5 / f64::from(samples),
            "{name} by {samples}: {score:?}"
        );
        assert!(
            score.largest_error <= score.largest_estimate,
            "{name} by {samples}: {score:?}"
        );
        // Nor is the largest estimate idle.
        assert!(
            score.largest_estimate <= 10.0 * score.largest_error,
            "{name}: {score:?}"
        );
    }
}

/// Every pixel of every file is within the tolerance, and claims to be.
#[test]
fn tolerances_are_met() {
    for name in ["seed1", "ground", "cloud1k"] {
        let scene = Scene::load(&folder().join(format!("{name}.ron"))).unwrap();
        let view = scene.view(1).unwrap();
        for tolerance in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
            for exact in exact_pixels(name) {
                let pixel = single_pixel(&view, exact.col, exact.row);
                let image = exact_picture(scene.world(), &pixel, tolerance, true);
                let [value, _, _, alpha] = image.rgba(0, 0);
                let error = (value - exact.value).abs().max((alpha - exact.alpha).abs());
                let place = format!("{name}, row {}, column {}", exact.row, exact.col);
                assert!(
                    error <= tolerance,
                    "{place}: off by {error:e} at {tolerance:e}"
                );
                assert!(
                    image.error(0, 0) <= tolerance,
                    "{place}: claims {}",
                    image.error(0, 0)
                );
                assert_eq!(image.status(0, 0), Status::Met, "{place}");
            }
        }
    }
}
