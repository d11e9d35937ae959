//! Families of small random scenes, each difficult in its own way.

use super::colors::colored;
use super::draft::Draft;
use super::extremes::{brightness, far_parallel_lenses, huge_floors, near_eyes, nearly_coincident};
use super::leds::{leds, leds_together};
use super::outlines::outlined;
use super::parallel::{parallel_lenses, planes_that_cut};
use super::point_lights::{grazing_cones, lights_between_spheres, lights_inside, near_lights};
use super::rectangles::rectangular_pixels;
use super::scenes::{
    aligned_grids, coincident, crowds, exponents, far_away, far_bumps, floors, grazing_shadows,
    highlights, long_lenses, many_lights, ordinary, overlapping_crowds, rough, seams, shutters,
    slivers, surface_bumps, terminator_at_rim, touching, triple_points, wide_lenses,
};
use super::soft::{
    soft_bumps, soft_contacts, soft_crowds, soft_horizons, soft_outlines, soft_skies, soft_suns,
};
use super::together::together;
use marbles_tests::numbers::Numbers;

/// The function that makes a scene: from random numbers alone, or also from the number of the scene.
#[derive(Clone, Copy)]
pub(super) enum Maker {
    Random(fn(&mut Numbers) -> Draft),
    Row(fn(&mut Numbers, u64) -> Draft),
}

/// A family, and the function that makes its scenes.
pub(super) struct Family {
    pub(super) name: &'static str,
    pub(super) draft: Maker,
    /// The family has one scene for this many scenes of ordinary families, because its scenes are expensive.
    pub(super) rarity: u64,
}

pub(super) const FAMILIES: [Family; 41] = [
    Family {
        name: "ordinary",
        draft: Maker::Random(ordinary),
        rarity: 1,
    },
    Family {
        name: "touching",
        draft: Maker::Random(touching),
        rarity: 1,
    },
    Family {
        name: "coincident",
        draft: Maker::Random(coincident),
        rarity: 1,
    },
    Family {
        name: "triple points",
        draft: Maker::Random(triple_points),
        rarity: 1,
    },
    Family {
        name: "grazing shadows",
        draft: Maker::Random(grazing_shadows),
        rarity: 1,
    },
    Family {
        name: "terminator at the rim",
        draft: Maker::Random(terminator_at_rim),
        rarity: 1,
    },
    Family {
        name: "exponents",
        draft: Maker::Random(exponents),
        rarity: 1,
    },
    Family {
        name: "highlights",
        draft: Maker::Random(highlights),
        rarity: 1,
    },
    Family {
        name: "long lenses",
        draft: Maker::Random(long_lenses),
        rarity: 1,
    },
    Family {
        name: "far away",
        draft: Maker::Random(far_away),
        rarity: 1,
    },
    Family {
        name: "wide lenses",
        draft: Maker::Random(wide_lenses),
        rarity: 1,
    },
    Family {
        name: "floors",
        draft: Maker::Random(floors),
        rarity: 1,
    },
    Family {
        name: "crowds",
        draft: Maker::Random(crowds),
        rarity: 1,
    },
    Family {
        name: "slivers",
        draft: Maker::Random(slivers),
        rarity: 1,
    },
    Family {
        name: "aligned grids",
        draft: Maker::Random(aligned_grids),
        rarity: 1,
    },
    Family {
        name: "many lights",
        draft: Maker::Random(many_lights),
        rarity: 1,
    },
    Family {
        name: "near lights",
        draft: Maker::Random(near_lights),
        rarity: 1,
    },
    Family {
        name: "lights between spheres",
        draft: Maker::Random(lights_between_spheres),
        rarity: 1,
    },
    Family {
        name: "lights inside",
        draft: Maker::Random(lights_inside),
        rarity: 1,
    },
    Family {
        name: "grazing cones",
        draft: Maker::Random(grazing_cones),
        rarity: 1,
    },
    Family {
        name: "seams",
        draft: Maker::Random(seams),
        rarity: 1,
    },
    Family {
        name: "parallel lenses",
        draft: Maker::Random(parallel_lenses),
        rarity: 1,
    },
    Family {
        name: "planes that cut",
        draft: Maker::Random(planes_that_cut),
        rarity: 1,
    },
    Family {
        name: "shutters",
        draft: Maker::Random(shutters),
        rarity: 10,
    },
    Family {
        name: "bumps larger than pixels",
        draft: Maker::Random(|numbers| surface_bumps(numbers, [0.5, 2.0])),
        rarity: 20,
    },
    Family {
        name: "bumps far away",
        draft: Maker::Random(far_bumps),
        rarity: 20,
    },
    Family {
        name: "bumps like pixels",
        draft: Maker::Random(|numbers| surface_bumps(numbers, [-0.3, 0.5])),
        rarity: 20,
    },
    Family {
        name: "bumps finer than pixels",
        draft: Maker::Random(|numbers| surface_bumps(numbers, [-2.0, -0.3])),
        rarity: 20,
    },
    Family {
        name: "bumps of pixels",
        draft: Maker::Random(|numbers| rough(numbers, "Pixel")),
        rarity: 20,
    },
    Family {
        name: "outlines",
        draft: Maker::Random(outlined),
        rarity: 1,
    },
    Family {
        name: "overlapping crowds",
        draft: Maker::Random(overlapping_crowds),
        rarity: 10,
    },
    Family {
        name: "huge floors",
        draft: Maker::Random(huge_floors),
        rarity: 1,
    },
    Family {
        name: "near eyes",
        draft: Maker::Random(near_eyes),
        rarity: 1,
    },
    Family {
        name: "far parallel lenses",
        draft: Maker::Random(far_parallel_lenses),
        rarity: 1,
    },
    Family {
        name: "nearly coincident crowds",
        draft: Maker::Random(nearly_coincident),
        rarity: 4,
    },
    Family {
        name: "brightness",
        draft: Maker::Random(brightness),
        rarity: 2,
    },
    Family {
        name: "rectangular pixels",
        draft: Maker::Random(rectangular_pixels),
        rarity: 1,
    },
    Family {
        name: "together",
        draft: Maker::Row(together),
        rarity: 2,
    },
    Family {
        name: "LEDs",
        draft: Maker::Random(leds),
        rarity: 1,
    },
    Family {
        name: "LED mixtures",
        draft: Maker::Row(leds_together),
        rarity: 2,
    },
    Family {
        name: "colors",
        draft: Maker::Random(colored),
        rarity: 1,
    },
];

/// Families under soft light, which takes long: they take part only if they are asked for.
pub(super) const SOFT_FAMILIES: [Family; 7] = [
    Family {
        name: "soft suns",
        draft: Maker::Random(soft_suns),
        rarity: 1,
    },
    Family {
        name: "soft skies",
        draft: Maker::Random(soft_skies),
        rarity: 1,
    },
    Family {
        name: "soft contacts",
        draft: Maker::Random(soft_contacts),
        rarity: 1,
    },
    Family {
        name: "soft horizons",
        draft: Maker::Random(soft_horizons),
        rarity: 1,
    },
    Family {
        name: "soft outlines",
        draft: Maker::Random(soft_outlines),
        rarity: 1,
    },
    Family {
        name: "soft bumps",
        draft: Maker::Random(soft_bumps),
        rarity: 5,
    },
    Family {
        name: "soft crowds",
        draft: Maker::Random(soft_crowds),
        rarity: 5,
    },
];
