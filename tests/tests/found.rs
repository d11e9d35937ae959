//! Pixels that a hunt found over their tolerance without a report, or with false claims.
//!
//! `cargo truth hunt --write` wrote the scenes of `tests/truth/found`. Their first lines name the pixels, and their
//! errors at that time.

use std::path::Path;

use marbles_core::Status;
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

/// Colored scenes without lights, of which pixels had larger errors than they claimed at these tolerances: slivers between
/// balls of one color, and balls that are taken to fill a box that they do not.
const SLIVERS: [&str; 4] = [
    "sliver_between_balls_of_one_color",
    "tip_in_a_sliver",
    "sphere_that_seems_to_fill_a_box",
    "seam_beside_a_sphere_that_seems_to_fill_a_box",
];
const TOLERANCES_OF_SLIVERS: [f64; 4] = [1e-2, 1e-3, 3e-4, 1e-4];

#[test]
fn slivers_are_off_by_no_more_than_they_claim() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("truth/found");
    for name in SLIVERS {
        let path = folder.join(name).with_extension("ron");
        let text = std::fs::read_to_string(&path).unwrap();
        let (col, row) = place(text.lines().next().unwrap_or_default());
        let scene = Scene::parse(&text, &path).unwrap_or_else(|error| panic!("{error}"));
        let view = scene.view(1).unwrap();
        let world = scene.world();
        let truth = Reference::new(world, &view).pixel(col, row);
        let exact = truth.value.truncate() + world.background * (1.0 - truth.value.w);
        let view = single_pixel(&view, col, row);
        for tolerance in TOLERANCES_OF_SLIVERS {
            let image = exact_picture(world, &view, tolerance, false);
            let claimed = image.error(0, 0);
            for (channel, value) in exact.to_array().into_iter().enumerate() {
                let off = (image.rgba(0, 0)[channel] - value).abs() - truth.error;
                assert!(off <= claimed, "{name} {tolerance:e}: {off:e} {claimed:e}");
            }
        }
    }
}

#[test]
fn found_pixels_are_within_their_tolerance_or_say_so() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("truth/found");
    let mut count = 0;
    for file in std::fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let (col, row) = place(text.lines().next().unwrap_or_default());
        let scene = Scene::parse(&text, &path).unwrap_or_else(|error| panic!("{error}"));
        let view = scene.view(1).unwrap();
        let world = scene.world();
        let truth = Reference::new(world, &view).pixel(col, row);
        let exact = truth.value.truncate() + world.background * (1.0 - truth.value.w);
        let view = single_pixel(&view, col, row);
        for tolerance in TOLERANCES {
            let image = exact_picture(world, &view, tolerance, false);
            let claimed = image.error(0, 0);
            let is_met = image.status(0, 0) == Status::Met;
            let most = if is_met { tolerance } else { claimed };
            let rgba = image.rgba(0, 0);
            for (channel, value) in exact.to_array().into_iter().enumerate() {
                let off = (rgba[channel] - value).abs() - truth.error;
                assert!(off <= most, "{path:?} {tolerance:e}: {off:e} {claimed:e}");
                let most = (FALSE * claimed).max(FALSE_OF_TOLERANCE * tolerance);
                assert!(off <= most, "{path:?} {tolerance:e}: {off:e} {claimed:e}");
            }
        }
        count += 1;
    }
    assert!(count >= 52, "{count}");
}
