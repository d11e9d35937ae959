//! Compares edges of penumbrae with what is visible of the disc, by the arcs of its circle.

use glam::DVec3;

use super::{Break, Edge, HIGHLIGHT, Height, KNOTS, Sought, add_breaks};
use crate::model::color::Color;
use crate::soft::cap::Cap;
use crate::soft::point::SurfacePoint;
use crate::soft::sun::Sun;
use crate::soft::visible::Hidden;

/// A point of a floor, and a sun half of whose diameter is `angle`, above it.
fn on_floor(position: DVec3) -> SurfacePoint {
    SurfacePoint {
        position,
        normal: DVec3::Y,
        shading: DVec3::Y,
        to_eye: DVec3::Y,
        sphere: 0,
    }
}

fn sun(toward: DVec3, angle: f64) -> Sun {
    Sun {
        disc: Cap::within(toward.normalize(), angle),
        intensity: Color::ONE,
    }
}

/// A sphere above the floor, and the way of its shadow's middle for a sun.
const CENTER: DVec3 = DVec3::new(0.3, 2.0, -0.4);
const RADIUS: f64 = 0.7;

fn share(sun: &Sun, edge: &Edge, place: &SurfacePoint) -> f64 {
    // Not by heights: the cap is hidden whatever they are.
    let mut hidden = Hidden::default();
    edge.hide(place, &mut hidden);
    let seen = hidden.seen_of(&sun.disc).dot(sun.disc.axis);
    seen / Hidden::default().seen_of(&sun.disc).dot(sun.disc.axis)
}

#[test]
fn the_disc_is_partly_hidden_between_both_edges() {
    let edge = Edge::Sphere {
        center: CENTER,
        radius: RADIUS,
    };
    let mut found = [0; 3];
    for (toward, angle) in [
        (DVec3::new(0.2, 1.0, 0.1), 0.004),
        (DVec3::new(-0.5, 0.6, 0.3), 0.05),
        (DVec3::new(0.1, 1.0, 0.0), 0.6),
    ] {
        let sun = sun(toward, angle);
        for step in 0..4000 {
            let (x, z) = (f64::from(step % 80), f64::from(step / 80));
            let place = on_floor(DVec3::new(x * 0.05 - 2.0, 0.0, z * 0.08 - 2.0));
            let Height { outer, inner, .. } = edge.height(&place, &sun.disc);
            let share = share(&sun, &edge, &place);
            if outer > 1e-9 {
                assert!((share - 1.0).abs() < 1e-9, "{place:?}: {share}");
                found[0] += 1;
            } else if inner < -1e-9 {
                assert!(share.abs() < 1e-9, "{place:?}: {share}");
                found[1] += 1;
            } else if outer < -1e-3 && inner > 1e-3 {
                assert!(share > 0.0 && share < 1.0, "{place:?}: {share}");
                found[2] += 1;
            }
        }
    }
    assert!(found.iter().all(|&count| count > 100), "{found:?}");
}

#[test]
fn heights_change_by_no_more_than_the_point_moves() {
    let edge = Edge::Sphere {
        center: CENTER,
        radius: RADIUS,
    };
    let sun = sun(DVec3::new(-0.5, 0.6, 0.3), 0.3);
    let mut before: Option<(DVec3, Height)> = None;
    for step in 0..2000 {
        let turn = f64::from(step) * 0.01;
        let position = DVec3::new(
            libm::cos(turn),
            0.3 * libm::sin(0.7 * turn),
            0.1 * turn - 1.0,
        );
        let height = edge.height(&on_floor(position * 3.0), &sun.disc);
        if let Some((place, of_before)) = before {
            let moved = (position * 3.0 - place).length() * (1.0 + 1e-9);
            assert!((height.outer - of_before.outer).abs() <= moved);
            assert!((height.inner - of_before.inner).abs() <= moved);
        }
        before = Some((position * 3.0, height));
    }
}

const SOUGHT: Sought = Sought {
    has_highlight: false,
    is_exact: false,
    number: 0,
};

#[test]
fn all_breaks_of_a_line_are_found() {
    let edge = Edge::Sphere {
        center: CENTER,
        radius: RADIUS,
    };
    for angle in [1e-4, 0.01, 0.1] {
        let sun = sun(DVec3::new(0.2, 1.0, 0.1), angle);
        // The shadow's middle is at x = −0.1, z = −0.6; lines cross it, pass beside it, and graze its edge.
        for aside in [0.0, 0.3, 0.6, 0.69, 0.72, 0.9, 1.5] {
            let height = |place: f64| {
                let x = -0.55 + 0.8 * place;
                edge.height(&on_floor(DVec3::new(x, 0.0, aside - 0.6)), &sun.disc)
            };
            let knots: [Height; KNOTS] =
                std::array::from_fn(|index| height(index as f64 / (KNOTS - 1) as f64));
            let mut breaks = Vec::new();
            add_breaks(&knots, &mut { height }, SOUGHT, &mut breaks);
            let signs = |place: f64| {
                let Height { outer, inner, .. } = height(place);
                [outer < 0.0, inner < 0.0]
            };
            let steps = 10_000;
            let mut changes = 0;
            for step in 0..steps {
                let [low, high] = [step, step + 1].map(|step| f64::from(step) / f64::from(steps));
                let [before, after] = [low, high].map(signs);
                let changed = before
                    .iter()
                    .zip(after)
                    .filter(|(one, other)| **one != *other);
                changes += changed.count();
            }
            assert_eq!(breaks.len(), changes, "{angle} {aside}: {breaks:?}");
            for Break { place, .. } in breaks {
                let Height {
                    outer, inner, wide, ..
                } = height(place);
                assert!(outer.abs().min(inner.abs()) <= 0.011 * wide);
            }
        }
    }
}

#[test]
fn a_narrow_shadow_between_knots_is_found() {
    // Where a sphere touches the floor, the upper half of a sun that is setting is hidden along a narrow stripe only.
    let edge = Edge::Sphere {
        center: DVec3::new(0.0, 3.762_770, 0.0),
        radius: 3.762_77,
    };
    let sun = sun(DVec3::new(-1.0, -1e-6, 0.0), 1e-4);
    for aside in 0..40 {
        let height = |place: f64| {
            // Rows of a picture: distances go with 1/place.
            let z = 10.0 / (0.1 + 0.05 * place) - 74.0 - 0.5 * f64::from(aside);
            edge.height(&on_floor(DVec3::new(100.0, 0.0, z)), &sun.disc)
        };
        let knots: [Height; KNOTS] =
            std::array::from_fn(|index| height(index as f64 / (KNOTS - 1) as f64));
        let mut breaks = Vec::new();
        add_breaks(&knots, &mut { height }, SOUGHT, &mut breaks);
        assert_eq!(breaks.len(), 2, "{aside}: {breaks:?}");
    }
}

/// The breaks of a curve on a surface with a highlight, from its points.
fn breaks_of_horizon(sun: &Sun, at: impl Fn(f64) -> SurfacePoint) -> Vec<Break> {
    let edge = Edge::Horizon {
        has_highlight: true,
    };
    let height = |place: f64| edge.height(&at(place), &sun.disc);
    let knots: [Height; KNOTS] =
        std::array::from_fn(|index| height(index as f64 / (KNOTS - 1) as f64));
    let sought = Sought {
        has_highlight: true,
        ..SOUGHT
    };
    let mut breaks = Vec::new();
    add_breaks(&knots, &mut { height }, sought, &mut breaks);
    breaks
}

/// A point with normals that are turned by these angles.
fn turned(normal: f64, shading: f64) -> SurfacePoint {
    let turned = |angle: f64| DVec3::new(0.0, libm::cos(angle), -libm::sin(angle));
    SurfacePoint {
        normal: turned(normal),
        shading: turned(shading),
        ..on_floor(DVec3::ZERO)
    }
}

#[test]
fn the_middle_of_a_disc_is_exact() {
    let sun = sun(DVec3::new(0.0, 0.1, 1.0), 0.1);
    let angle = |place: f64| 0.3 * place - 0.1;
    let breaks = breaks_of_horizon(&sun, |place| turned(angle(place), angle(place)));
    let middle = libm::atan(0.1);
    let at_middle = breaks
        .iter()
        .filter(|one| (angle(one.place) - middle).abs() < 1e-9);
    assert_eq!((breaks.len(), at_middle.count()), (3, 1), "{breaks:?}");
}

#[test]
fn a_highlight_ends_where_its_surface_or_its_bump_turns_away() {
    let sun = sun(DVec3::new(0.0, 0.1, 1.0), 0.1);
    for tilt in [-0.4, -0.15, -0.05, 0.02, 0.15] {
        let at = |place: f64| turned(place - 0.4, place - 0.4 + tilt);
        let breaks = breaks_of_horizon(&sun, at);
        let ends = breaks.iter().filter(|one| one.of == HIGHLIGHT);
        let ends: Vec<f64> = ends.map(|one| one.place).collect();
        let [end] = ends[..] else {
            panic!("{tilt}: {breaks:?}")
        };
        let mut hidden = Hidden::default();
        let mut is_lit = |place: f64| {
            let at = at(place);
            at.shading.dot(sun.disc.axis) > 0.0 && sun.received(&at, &[], &mut hidden).whole > 0.0
        };
        assert!(is_lit(end - 1e-4) && !is_lit(end + 1e-4), "{tilt}: {end}");
    }
}
