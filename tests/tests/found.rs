//! Pixels that a hunt found over their tolerance without a report, or with false claims.
//!
//! `cargo truth hunt --write` wrote the scenes of `tests/truth/found`. Their first lines name the pixels, and their
//! errors at that time.

use std::path::{Path, PathBuf};

use marbles_core::{Status, View};
use marbles_scene::Scene;
use marbles_tests::reference::Reference;

use crate::studio::{exact_picture, single_pixel};

const TOLERANCES: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// A claim is false if the error is this many times as large, and larger than this fraction of the tolerance.
const FALSE: f64 = 20.0;
const FALSE_OF_TOLERANCE: f64 = 0.02;

/// The column and the row in a line such as `// column 9, row 10 at 1e-6: ...`.
fn place(line: &str) -> (u32, u32) {
    let mut words = line.split([' ', ',']);
    let mut after = |name: &str| {
        words.find(|&word| word == name);
        let number = words.next().and_then(|word| word.parse().ok());
        number.unwrap_or_else(|| panic!("no {name} in `{line}`"))
    };
    (after("column"), after("row"))
}

/// Scenes of which pixels had larger errors than they claimed at these tolerances: slivers between balls of one color, balls
/// that are taken to fill a box that they do not, or to lie in shadow, the light of a sky that another sphere begins to hide,
/// and of a sun that rises.
const FALSE_CLAIMS: [&str; 7] = [
    "corner_that_seems_to_lie_in_shadow",
    "sliver_between_balls_of_one_color",
    "tip_in_a_sliver",
    "sphere_that_seems_to_fill_a_box",
    "seam_beside_a_sphere_that_seems_to_fill_a_box",
    "sphere_that_rises_over_a_horizon",
    "small_exponent_under_a_sun",
];
const TOLERANCES_OF_CLAIMS: [f64; 4] = [1e-2, 1e-3, 3e-4, 1e-4];

/// A scene, the view of the pixel that its first line names, and the exact light of that pixel with its error.
struct Found {
    scene: Scene,
    view: View,
    exact: [f64; 3],
    error: f64,
}

impl Found {
    fn load(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap();
        let (col, row) = place(text.lines().next().unwrap_or_default());
        let scene = Scene::parse(&text, path).unwrap_or_else(|error| panic!("{error}"));
        let view = scene.view(1).unwrap();
        let world = scene.world();
        let truth = Reference::new(world, &view).pixel(col, row);
        let exact = truth.value.truncate() + world.background * (1.0 - truth.value.w);
        Self {
            view: single_pixel(&view, col, row),
            exact: exact.to_array(),
            error: truth.error,
            scene,
        }
    }

    /// The pixel at a tolerance: how far each channel is off at least, the claim, and whether it says that it is met.
    fn render(&self, tolerance: f64) -> ([f64; 3], f64, bool) {
        let image = exact_picture(self.scene.world(), &self.view, tolerance, false);
        let rgba = image.rgba(0, 0);
        let off =
            std::array::from_fn(|channel| (rgba[channel] - self.exact[channel]).abs() - self.error);
        let is_met = image.status(0, 0) == Status::Met;
        (off, image.error(0, 0), is_met)
    }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("truth/found")
}

#[test]
fn pixels_are_off_by_no_more_than_they_claim() {
    for name in FALSE_CLAIMS {
        let found = Found::load(&folder().join(name).with_extension("ron"));
        for tolerance in TOLERANCES_OF_CLAIMS {
            let (channels, claimed, _) = found.render(tolerance);
            for off in channels {
                assert!(off <= claimed, "{name} {tolerance:e}: {off:e} {claimed:e}");
            }
        }
    }
}

#[test]
fn found_pixels_are_within_their_tolerance_or_say_so() {
    let mut count = 0;
    for file in std::fs::read_dir(folder()).unwrap() {
        let path = file.unwrap().path();
        let found = Found::load(&path);
        for tolerance in TOLERANCES {
            let (channels, claimed, is_met) = found.render(tolerance);
            let most = if is_met { tolerance } else { claimed };
            let not_false = (FALSE * claimed).max(FALSE_OF_TOLERANCE * tolerance);
            for off in channels {
                assert!(
                    off <= most && off <= not_false,
                    "{path:?} {tolerance:e}: {off:e} {claimed:e}"
                );
            }
        }
        count += 1;
    }
    assert!(count >= 62, "{count}");
}
