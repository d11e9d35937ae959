//! Scenes of other families whose spheres have colors of their own.

use super::draft::Draft;
use super::outlines::outlined;
use super::scenes::{
    aligned_grids, crowds, highlights, ordinary, overlapping_crowds, seams, slivers, touching,
};
use marbles_tests::numbers::Numbers;

/// Albedos that differ in every channel, and in brightness.
const ALBEDOS: [&str; 5] = [
    "(0.1, 0.9, 0.1)",
    "(0.1, 0.1, 0.9)",
    "(0.9, 0.05, 0.1)",
    "0.9",
    "0.02",
];

/// Spheres of several colors, mostly in ambient light alone: a sliver of one of them beside another is a contrast that no
/// shading softens.
pub(super) fn colored(numbers: &mut Numbers) -> Draft {
    let mut draft = match numbers.below(12) {
        0..=2 => crowds(numbers),
        3..=4 => slivers(numbers),
        5..=6 => touching(numbers),
        7 => seams(numbers),
        8 => aligned_grids(numbers),
        9 => overlapping_crowds(numbers),
        10 => outlined(numbers),
        _ => match numbers.below(2) {
            0 => ordinary(numbers),
            _ => highlights(numbers),
        },
    };
    if numbers.below(4) > 0 {
        draft.lights.clear();
        for field in &mut draft.head {
            if field.starts_with("ambient") {
                *field = "ambient: 0.6".to_owned();
            }
        }
    }
    for (number, albedo) in ALBEDOS.iter().enumerate() {
        let color = format!(", \"{number}\": (albedo: {albedo})");
        draft.more_materials += &color;
    }
    let colors = 1 + numbers.below(ALBEDOS.len());
    for sphere in &mut draft.spheres {
        if numbers.below(8) > 0 {
            let color = format!("\"{}\"", numbers.below(colors));
            *sphere = sphere.replace("\"m\"", &color);
        }
    }
    draft
}
