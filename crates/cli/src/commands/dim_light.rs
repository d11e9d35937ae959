//! Warns if light is not much brighter than the tolerance: pixels may then have a visible error.

use marbles_core::{Color, Light, World, parallel};

use crate::base::numbers::{bound, counted, short};

/// The largest tolerance without a warning, as a fraction of the brightest light.
pub(super) const LARGEST_PART: f64 = 0.02;
/// The tolerance that the warning proposes, as a fraction of the brightest light, before it is rounded to a power of
/// ten.
const GOOD_PART: f64 = 1e-3;

/// A warning if the light in some pictures is not much brighter than the tolerance. There is one world per picture;
/// `option` is the source of the tolerance. Works on the threads of the current rayon pool.
pub(super) fn warning(
    worlds: impl IntoIterator<Item = World>,
    tolerance: f64,
    option: &str,
) -> Option<String> {
    let (mut pictures, mut dim, mut dimmest) = (0, 0, f64::INFINITY);
    for world in worlds {
        pictures += 1;
        let spheres = world.spheres().len();
        let is_bright = |sphere| tolerance <= LARGEST_PART * brightest(&world, sphere);
        if parallel::any_index(spheres, is_bright) {
            continue;
        }
        let of_ranges = parallel::map_ranges(spheres, |range| {
            range
                .map(|sphere| brightest(&world, sphere))
                .fold(0.0, f64::max)
        });
        let most = of_ranges.into_iter().fold(0.0, f64::max);
        // Black is meant to be black.
        if most > 0.0 {
            dim += 1;
            dimmest = dimmest.min(most);
        }
    }
    let better = libm::exp10((GOOD_PART * dimmest).log10().floor());
    let tolerance = bound(tolerance);
    let cure = format!("use `--tolerance {better:e}` or brighter lights");
    let most = short(dimmest);
    match (dim, pictures) {
        (0, _) => None,
        (_, 1) => Some(format!(
            "no sphere is brighter than {most}, and with {option} pixels may have errors of {tolerance}: {cure}"
        )),
        _ => Some(format!(
            "in {dim} of {} no sphere is much brighter than {most}, and with {option} pixels may have errors of \
             {tolerance}: {cure}",
            counted(pictures, "picture")
        )),
    }
}

/// An upper bound of the light that a sphere sends to the camera.
fn brightest(world: &World, sphere: usize) -> f64 {
    let ball = &world.spheres()[sphere];
    let lights = world
        .lights
        .iter()
        .map(|light: &Light| light.brightest_on(ball));
    let lights: Color = lights.sum();
    let highlight = world.material(sphere).highlight;
    let strength = highlight.map_or(0.0, |highlight| highlight.strength);
    let sky = world
        .sky
        .map_or(Color::ZERO, |sky| sky.above().max(sky.below()));
    let light = world.albedo(sphere) * (world.ambient + sky + lights) + lights * strength;
    light.max_element()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use marbles_core::LightPart;
    use marbles_scene::Scene;

    use super::*;

    fn world(fields: &str) -> World {
        let text = format!(
            "(image: (width: 4, height: 2), lens: Fov(90), camera: Free(), {fields}, materials: {{\"m\": (albedo: 0.5)}},
              spheres: [(center: (0, 0, 5), radius: 1, material: \"m\")])"
        );
        let scene = Scene::parse(&text, Path::new("scene.ron")).unwrap();
        scene.world().clone()
    }

    #[test]
    fn tolerances_near_the_brightest_light_are_told() {
        let light = |intensity: f64| {
            let light =
                format!("lights: [Directional(toward: (0, 0, -1), intensity: {intensity})]");
            warning([world(&light)], 1e-3, "--tolerance 1e-3")
        };
        // An albedo of a half leaves 0.05, of which the tolerance is a fiftieth.
        assert_eq!(light(0.11), None);
        assert_eq!(
            light(0.08).unwrap(),
            "no sphere is brighter than 0.04, and with --tolerance 1e-3 pixels may have errors of 1.0e-03: \
             use `--tolerance 1e-5` or brighter lights"
        );
        for (fields, is_told) in [
            ("ambient: 0.01", true),
            ("ambient: 0", false),
            ("sky: 0.01", true),
            ("sky: (above: 0.01, below: 1)", false),
            ("background: 1", false),
            (
                "lights: [Point(position: (0, 0, 2), reference: 0.02)]",
                true,
            ),
            ("lights: [Point(position: (0, 0, 2), reference: 2)]", false),
        ] {
            let found = warning([world(fields)], 1e-3, "");
            assert_eq!(found.is_some(), is_told, "{fields}: {found:?}");
        }
    }

    #[test]
    fn each_picture_of_one_light_is_looked_at() {
        let world = world(
            "lights: [Directional(toward: (0, 0, -1)), Directional(toward: (0, 0, -1), intensity: 1e-3)]",
        );
        assert_eq!(warning([world.clone()], 1e-3, ""), None);
        let each = [0, 1].map(|index| world.under(LightPart::Light(index)));
        let found = warning(each, 1e-3, "").unwrap();
        assert!(
            found.starts_with("in 1 of 2 pictures no sphere is much brighter than 0.0005,"),
            "{found}"
        );
    }
}
