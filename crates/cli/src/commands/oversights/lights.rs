//! Lights that add nothing to see.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use marbles_core::{Color, Light, LightFalloff, Sphere, View, World, parallel};

use super::sight::may_be_seen;
use crate::base::numbers::short;
use crate::commands::dim_light::LARGEST_PART;

/// A light that adds no more than this makes no difference that anybody sees: white is 1.
const WEAK: f64 = 0.004;
/// A crescent that covers no more than this part of a sphere's picture is not what a light is for.
const THIN: f64 = 0.01;

/// A warning about each light that adds very little, or nothing, to every sphere. A light of intensity 0 is meant to be off, and a
/// tolerance far below what it adds tells that so little light is meant.
pub(in super::super) fn too_weak(world: &World, tolerance: f64) -> Vec<String> {
    let weak = WEAK.min(tolerance / LARGEST_PART);
    let lights = world.lights.iter().enumerate();
    let warnings = lights.filter_map(|(index, light)| {
        let is_averted = averted(index + 1, light, world.spheres());
        if is_averted.is_some() {
            return is_averted;
        }
        let spheres = world.spheres().len();
        let is_bright = |sphere: usize| added(world, light, sphere) > weak;
        if parallel::any_index(spheres, is_bright) {
            return None;
        }
        let (most, sphere) = largest(spheres, |sphere| added(world, light, sphere))?;
        (most > 0.0).then(|| told(index + 1, light, most, &world.spheres()[sphere]))
    });
    warnings.collect()
}

/// A warning about a lamp that faces away from all spheres, and lights none of them.
fn averted(number: usize, light: &Light, spheres: &[Sphere]) -> Option<String> {
    let lamp = light.point()?;
    let direction = lamp.emission()?.direction();
    let ahead = |sphere: usize| ahead(&spheres[sphere], lamp.position(), direction);
    let (most, nearest) = largest(spheres.len(), ahead)?;
    if most > 0.0 || light.intensity() == Color::ZERO {
        return None;
    }
    let way = spheres[nearest].center() - lamp.position();
    let [x, y, z] = (way / way.abs().max_element())
        .to_array()
        .map(|part| short(part + 0.0));
    Some(format!(
        "light {number} faces away from all spheres: `direction` points from the lamp to what it lights, so try \
         `direction: ({x}, {y}, {z})`"
    ))
}

/// The largest number of those of `count` spheres, and the index of its sphere.
fn largest(count: usize, of: impl Fn(usize) -> f64 + Sync) -> Option<(f64, usize)> {
    let of_numbers = |numbers: &mut dyn Iterator<Item = (f64, usize)>| {
        numbers.max_by(|one, other| one.0.total_cmp(&other.0))
    };
    let of_ranges = parallel::map_ranges(count, |range| {
        of_numbers(&mut range.map(|sphere| (of(sphere), sphere)))
    });
    of_numbers(&mut of_ranges.into_iter().flatten())
}

/// How far a sphere reaches ahead of the plane through a point across a unit vector.
fn ahead(sphere: &Sphere, point: DVec3, direction: DVec3) -> f64 {
    (sphere.center() - point).dot(direction) + sphere.radius()
}

fn told(number: usize, light: &Light, most: f64, brightest: &Sphere) -> String {
    let start = format!("light {number} adds at most {} to any sphere", short(most));
    let falling = light
        .point()
        .filter(|point| point.falloff() == LightFalloff::InverseSquare);
    let Some(point) = falling else {
        return format!("{start}: raise its `intensity`");
    };
    let apart = (brightest.center() - point.position()).length() - brightest.radius();
    let factor = apart / point.reference();
    format!(
        "{start}: it is {} away, and its `intensity` is the light at the distance `reference: {}`; write \
         `reference: {}`, or an intensity {} times as large",
        short(apart),
        short(point.reference()),
        short(apart),
        short(factor * factor)
    )
}

/// An upper bound of what a light adds to a sphere.
fn added(world: &World, light: &Light, sphere: usize) -> f64 {
    let most = light.brightest_on(&world.spheres()[sphere]);
    let highlight = world.material(sphere).highlight;
    let strength = highlight.map_or(0.0, |highlight| highlight.strength);
    (most * (world.albedo(sphere) + Color::splat(strength))).max_element()
}

/// A warning if all lights are behind the spheres that the camera sees, in each of the views. Shadows are not looked
/// at.
pub(super) fn behind(world: &World, views: &[&View]) -> Option<String> {
    // Bumps turn a surface toward lights behind it.
    if world.lights.is_empty() || world.has_bumps() {
        return None;
    }
    let spheres = world.spheres();
    let is_lit = |sphere: &Sphere, view: &View| {
        may_be_seen(sphere, view) && share_lit(world, sphere, view) > THIN
    };
    let any_is_lit = |view: &&View| parallel::any(spheres, |sphere| is_lit(sphere, view));
    if views.iter().any(any_is_lit) {
        return None;
    }
    let most_in = |view: &&View| {
        let of_pieces = parallel::map_pieces(spheres, |piece| {
            let seen = piece.iter().filter(|sphere| may_be_seen(sphere, view));
            let shares = seen.map(|sphere| share_lit(world, sphere, view));
            shares.fold(0.0, f64::max)
        });
        of_pieces.into_iter().fold(0.0, f64::max)
    };
    let percent = 100.0 * views.iter().map(most_in).fold(0.0, f64::max);
    let rest = match (has_bright_sky(world), world.ambient.max_element() > 0.0) {
        (true, _) => "little but the light of the sky shows",
        (false, true) => "only ambient light shows",
        (false, false) => "the spheres are black",
    };
    let is_averted = |light: &Light| averted(0, light, spheres).is_some();
    if world.lights.iter().all(is_averted) {
        // It is told of each of them.
        return None;
    }
    let toward = world.lights.iter().find_map(Light::toward);
    let remedy = toward.map_or_else(
        || "move them to the camera's side".to_owned(),
        |toward| {
            let largest = toward.abs().max_element();
            let [x, y, z] = (-toward / largest).to_array().map(|part| short(part + 0.0));
            format!("`toward` points from the scene to the light, so try `toward: ({x}, {y}, {z})`")
        },
    );
    Some(format!(
        "the lights are behind the spheres, and reach at most {} % of what the camera sees of any: {rest}; {remedy}",
        short((100.0 * percent).ceil() / 100.0)
    ))
}

/// Returns whether the world has a sky that sends light.
pub(super) fn has_bright_sky(world: &World) -> bool {
    let sky = world.sky;
    sky.is_some_and(|sky| sky.above().max(sky.below()).max_element() > 0.0)
}

/// The part of a sphere's picture, across it, that lights reach at most: of a moon, its phase.
///
/// A light reaches a cap of the sphere, and the camera sees a cap, whose half angles are at most 90 degrees. If they
/// overlap by an angle, what is lit and seen is not wider than a crescent of this angle at the limb.
fn share_lit(world: &World, sphere: &Sphere, view: &View) -> f64 {
    let (center, radius) = (sphere.center(), sphere.radius());
    let (to_eye, seen) = match view.lens.is_parallel() {
        true => (-view.camera.forward(), FRAC_PI_2),
        false => cap(view.camera.position - center, radius),
    };
    let shining = world
        .lights
        .iter()
        .filter(|light| light.intensity().max_element() > 0.0);
    let facing = shining.filter(|light| {
        let lamp = light.point();
        let emission = lamp.and_then(|lamp| Some((lamp.position(), lamp.emission()?.direction())));
        emission.is_none_or(|(position, direction)| ahead(sphere, position, direction) > 0.0)
    });
    let overlaps = facing.map(|light| {
        let (to_light, lit) = match light.point() {
            Some(point) => cap(point.position() - center, radius),
            // A part of a sun's disc is above the horizon a little longer.
            None => {
                let radius = light.sun().map_or(0.0, |sun| 0.5 * sun.diameter());
                (light.toward().unwrap_or_default(), FRAC_PI_2 + radius)
            }
        };
        seen + lit - to_eye.angle_between(to_light)
    });
    let overlap = overlaps.fold(0.0, f64::max).min(2.0 * seen);
    // How far from the middle of the picture a point is seen that is this angle from the middle of the cap.
    let nearness = libm::cos(seen);
    let seen_at = |angle: f64| libm::sin(angle) / (1.0 - nearness * libm::cos(angle));
    let limb = seen_at(seen);
    (limb - seen_at(seen - overlap)) / (2.0 * limb)
}

/// The part of a sphere that a point sees: its middle, as a vector from the center, and its half angle.
fn cap(to_point: DVec3, radius: f64) -> (DVec3, f64) {
    let nearness = (radius / to_point.length()).min(1.0);
    (to_point, libm::acos(nearness))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use marbles_scene::Scene;

    use super::*;

    fn scene(fields: &str) -> Scene {
        let text = format!("(image: (width: 40, height: 20), lens: Fov(90), {fields})");
        Scene::parse(&text, Path::new("scene.ron")).unwrap()
    }

    fn weak(light: &str) -> String {
        let scene = scene(&format!(
            "camera: Free(), lights: [{light}], spheres: [(center: (0, 0, 5), radius: 1), (center: (0, 0, 9), radius: 2)]"
        ));
        too_weak(scene.world(), 1e-3).join("; ")
    }

    #[test]
    fn weak_lights_are_told_with_what_helps() {
        assert_eq!(
            weak("Directional(toward: (0, 0, -1)), Point(position: (0, 0, -16), reference: 1)"),
            "light 2 adds at most 0.0025 to any sphere: it is 20 away, and its `intensity` is the light at the distance \
             `reference: 1`; write `reference: 20`, or an intensity 400 times as large"
        );
        assert_eq!(
            weak("Directional(toward: (0, 0, -1), intensity: (0.001, 0.003, 0))"),
            "light 1 adds at most 0.003 to any sphere: raise its `intensity`"
        );
        for enough in [
            "Point(position: (0, 0, -16))",
            "Point(position: (0, 0, -16), reference: 20)",
            "Point(position: (0, 0, -16), reference: 1, intensity: 2)",
            "Point(position: (0, 0, -900), falloff: None)",
            "Directional(toward: (0, 0, -1), intensity: 0.005)",
            "Directional(toward: (0, 0, -1), intensity: 0)",
            // Inside of a sphere, it shines on no outer side but that of the other.
            "Point(position: (0, 0, 5))",
        ] {
            assert_eq!(weak(enough), "", "{enough}");
        }
        let dim = scene(
            "camera: Free(), lights: [Directional(toward: (0, 0, -1), intensity: 0.001)], \
             spheres: [(center: (0, 0, 5), radius: 1)]",
        );
        for (tolerance, told) in [(1e-3, 1), (3e-5, 1), (1e-5, 0)] {
            let warnings = too_weak(dim.world(), tolerance);
            assert_eq!(warnings.len(), told, "{tolerance}: {warnings:?}");
        }
    }

    #[test]
    fn lamps_that_face_away_from_all_are_told() {
        let toward_lens = "Point(position: (4, 0, 9), direction: (0, 0, 1))";
        let spheres = "camera: Free(), spheres: [(center: (0, 0, 5), radius: 1), (center: (0, 2, 7), radius: 1)]";
        let of = |light: &str| {
            let scene = scene(&format!("lights: [{light}], {spheres}"));
            let view = scene.view(1).unwrap();
            let behind = behind(scene.world(), &[&view]);
            (too_weak(scene.world(), 1e-3).join("; "), behind)
        };
        let told = "light 1 faces away from all spheres: `direction` points from the lamp to what it lights, so try \
                    `direction: (-1, 0.5, -0.5)`";
        assert_eq!(of(toward_lens), (told.to_owned(), None));
        // Its plane touches neither, or cuts one.
        for lamp in [
            "Point(position: (4, 0, 7.9), direction: (0, 0, 1))",
            "Point(position: (4, 0, 9), direction: (0, 0, -1), mu: 80)",
            "Point(position: (4, 0, 9), direction: (0, 0, 1), intensity: 0)",
            "Point(position: (4, 0, 9))",
        ] {
            assert_eq!(of(lamp).0, "", "{lamp}");
        }
    }

    fn dark(fields: &str) -> String {
        let scene = scene(fields);
        behind(scene.world(), &[&scene.view(1).unwrap()]).unwrap_or_default()
    }

    #[test]
    fn lights_behind_all_that_is_seen_are_told() {
        let spheres = "camera: Free(), spheres: [(center: (0, 0, 50), radius: 1), (center: (0, 0, -9), radius: 1)]";
        let lit = |light: &str| dark(&format!("lights: [{light}], {spheres}"));
        assert_eq!(
            lit("Directional(toward: (0.0, 1, 6))"),
            "the lights are behind the spheres, and reach at most 0.53 % of what the camera sees of any: the spheres \
             are black; `toward` points from the scene to the light, so try `toward: (0, -0.166667, -1)`"
        );
        assert!(lit("Directional(toward: (0, 0, 1))").contains("at most 0 %"));
        assert!(lit("Point(position: (0, 0, 60))").ends_with("move them to the camera's side"));
        let ambient = dark(&format!(
            "ambient: 0.1, lights: [Directional(toward: (0, 0, 1))], {spheres}"
        ));
        assert!(ambient.contains("only ambient light shows"));
        for light in [
            "Directional(toward: (0, 1, 4))",
            "Directional(toward: (0, 0, 1)), Directional(toward: (1, 0, 0))",
            "Point(position: (30, 0, 50))",
        ] {
            assert_eq!(lit(light), "", "{light}");
        }
        // One off the axis, that shows more of its side.
        let beside = dark(
            "lights: [Directional(toward: (0, 0, 1))], camera: Free(), spheres: [(center: (5, 0, 9), radius: 1)]",
        );
        assert_eq!(beside, "");
    }

    /// The phase that points of the surface show, counted one by one.
    #[test]
    fn no_more_is_lit_than_the_bound() {
        for (sphere, light) in [
            (
                "center: (0, 0, 3), radius: 2",
                "Directional(toward: (0.4, 0, 1))",
            ),
            (
                "center: (1, 0, 3), radius: 2",
                "Directional(toward: (-0.4, 1, 1))",
            ),
            (
                "center: (0, 1, 9), radius: 2",
                "Point(position: (1, 9, 12))",
            ),
            (
                "center: (0, 1, 9), radius: 2",
                "Point(position: (0, 4, 11))",
            ),
        ] {
            let scene = scene(&format!(
                "camera: Free(), lights: [{light}], spheres: [({sphere})]"
            ));
            let (world, view) = (scene.world(), scene.view(1).unwrap());
            let ball = &world.spheres()[0];
            let to_eye = (view.camera.position - ball.center()).normalize();
            let (mut seen, mut lit) = (0.0, 0.0);
            for index in 0..40_000 {
                // A spiral of points of equal areas.
                let z = 1.0 - (f64::from(index) + 0.5) / 20_000.0;
                let turn = f64::from(index) * 2.399_963;
                let across = (1.0 - z * z).sqrt();
                let normal = DVec3::new(across * turn.cos(), across * turn.sin(), z);
                let point = ball.center() + ball.radius() * normal;
                let from_point = view.camera.position - point;
                let facing = normal.dot(from_point);
                if facing <= 0.0 {
                    continue;
                }
                // The area in a picture around the sphere's center.
                let area = facing / from_point.dot(to_eye).powi(3);
                seen += area;
                let light = &world.lights[0];
                let to_light = light
                    .toward()
                    .unwrap_or_else(|| light.point().unwrap().position() - point);
                lit += if normal.dot(to_light) > 0.0 {
                    area
                } else {
                    0.0
                };
            }
            let bound = share_lit(world, ball, &view);
            assert!(
                lit / seen <= bound + 1e-3,
                "{sphere}, {light}: {} > {bound}",
                lit / seen
            );
        }
    }
}
