//! Families of small random scenes, each hard in its own way.

use super::draft::Draft;
use super::parallel::{parallel_lenses, planes_that_cut};
use super::point_lights::{grazing_cones, lights_between_spheres, lights_inside, near_lights};
use super::scenes::{
    aligned_grids, coincident, crowds, exponents, far_away, far_bumps, floors, grazing_shadows,
    highlights, long_lenses, many_lights, ordinary, overlapping_crowds, rough, seams, shutters,
    slivers, surface_bumps, terminator_at_rim, touching, triple_points, wide_lenses,
};
use super::strokes::outlined;
use marbles_tests::numbers::Numbers;

/// A family, and the way to make one of its scenes.
pub(super) struct Family {
    pub(super) name: &'static str,
    pub(super) draft: fn(&mut Numbers) -> Draft,
    /// A scene for so many of the others: those that cost much.
    pub(super) rarity: u64,
}

pub(super) const FAMILIES: [Family; 31] = [
    Family {
        name: "ordinary",
        draft: ordinary,
        rarity: 1,
    },
    Family {
        name: "touching",
        draft: touching,
        rarity: 1,
    },
    Family {
        name: "coincident",
        draft: coincident,
        rarity: 1,
    },
    Family {
        name: "triple points",
        draft: triple_points,
        rarity: 1,
    },
    Family {
        name: "grazing shadows",
        draft: grazing_shadows,
        rarity: 1,
    },
    Family {
        name: "terminator at the rim",
        draft: terminator_at_rim,
        rarity: 1,
    },
    Family {
        name: "exponents",
        draft: exponents,
        rarity: 1,
    },
    Family {
        name: "highlights",
        draft: highlights,
        rarity: 1,
    },
    Family {
        name: "long lenses",
        draft: long_lenses,
        rarity: 1,
    },
    Family {
        name: "far away",
        draft: far_away,
        rarity: 1,
    },
    Family {
        name: "wide lenses",
        draft: wide_lenses,
        rarity: 1,
    },
    Family {
        name: "floors",
        draft: floors,
        rarity: 1,
    },
    Family {
        name: "crowds",
        draft: crowds,
        rarity: 1,
    },
    Family {
        name: "slivers",
        draft: slivers,
        rarity: 1,
    },
    Family {
        name: "aligned grids",
        draft: aligned_grids,
        rarity: 1,
    },
    Family {
        name: "many lights",
        draft: many_lights,
        rarity: 1,
    },
    Family {
        name: "near lights",
        draft: near_lights,
        rarity: 1,
    },
    Family {
        name: "lights between spheres",
        draft: lights_between_spheres,
        rarity: 1,
    },
    Family {
        name: "lights inside",
        draft: lights_inside,
        rarity: 1,
    },
    Family {
        name: "grazing cones",
        draft: grazing_cones,
        rarity: 1,
    },
    Family {
        name: "seams",
        draft: seams,
        rarity: 1,
    },
    Family {
        name: "parallel lenses",
        draft: parallel_lenses,
        rarity: 1,
    },
    Family {
        name: "planes that cut",
        draft: planes_that_cut,
        rarity: 1,
    },
    Family {
        name: "shutters",
        draft: shutters,
        rarity: 10,
    },
    Family {
        name: "bumps larger than pixels",
        draft: |numbers| surface_bumps(numbers, [0.5, 2.0]),
        rarity: 20,
    },
    Family {
        name: "bumps far away",
        draft: far_bumps,
        rarity: 20,
    },
    Family {
        name: "bumps like pixels",
        draft: |numbers| surface_bumps(numbers, [-0.3, 0.5]),
        rarity: 20,
    },
    Family {
        name: "bumps finer than pixels",
        draft: |numbers| surface_bumps(numbers, [-2.0, -0.3]),
        rarity: 20,
    },
    Family {
        name: "bumps of pixels",
        draft: |numbers| rough(numbers, "Pixel"),
        rarity: 20,
    },
    Family {
        name: "outlines",
        draft: outlined,
        rarity: 1,
    },
    Family {
        name: "overlapping crowds",
        draft: overlapping_crowds,
        rarity: 10,
    },
];
