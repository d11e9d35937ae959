//! The scenes of `tests/truth/promise`, and the files with their exact pixels.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use glam::DVec4;
use marbles_scene::Scene;

/// The first line of the files.
const HEAD: &str = "row,col,edge,red,green,blue,alpha,error";

/// A pixel with its exact value.
#[derive(Clone, Copy, Debug)]
pub struct ExactPixel {
    /// Column, from the left.
    pub col: u32,
    /// Row, from the top.
    pub row: u32,
    /// Whether the pixel contains an edge.
    pub has_edge: bool,
    /// The spheres' light without the background, and the covered fraction.
    pub value: DVec4,
    /// The largest error of any of these.
    pub error: f64,
}

/// All scenes, sorted.
pub fn scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("truth/promise");
    let files = std::fs::read_dir(folder).expect("the folder of the scenes");
    let mut scenes: Vec<PathBuf> = files
        .filter_map(|file| Some(file.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending == "ron"))
        .collect();
    scenes.sort();
    scenes
}

/// The name of a scene.
pub fn name(scene: &Path) -> &str {
    let stem = scene.file_stem().and_then(|stem| stem.to_str());
    stem.expect("names of scenes are ASCII")
}

/// A scene of the folder; it must be valid.
pub fn load(scene: &Path) -> Scene {
    Scene::load(scene).unwrap_or_else(|error| panic!("{error}"))
}

/// The exact pixels of a scene.
pub fn read(scene: &Path) -> Vec<ExactPixel> {
    let path = scene.with_extension("csv");
    let text = std::fs::read_to_string(&path).unwrap_or_default();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(HEAD), "{}", path.display());
    lines.map(parse).collect()
}

fn parse(line: &str) -> ExactPixel {
    let fields: Vec<&str> = line.split(',').collect();
    let number = |index: usize| fields[index].parse::<f64>().expect("a number");
    ExactPixel {
        row: number(0) as u32,
        col: number(1) as u32,
        has_edge: fields[2] == "1",
        value: DVec4::new(number(3), number(4), number(5), number(6)),
        error: number(7),
    }
}

/// The text of a file of pixels; values are rounded to 10⁻¹³, far below their errors.
pub fn format(pixels: &[ExactPixel]) -> String {
    let mut text = format!("{HEAD}\n");
    for pixel in pixels {
        let (row, col, edge) = (pixel.row, pixel.col, u32::from(pixel.has_edge));
        // Writing to a string does not fail.
        let _ = write!(text, "{row},{col},{edge}");
        for value in pixel.value.to_array() {
            let rounded = format!("{value:.13}");
            let short = rounded.trim_end_matches('0').trim_end_matches('.');
            let _ = write!(text, ",{short}");
        }
        let _ = writeln!(text, ",{:.1e}", pixel.error);
    }
    text
}
