//! Mistakes that make a picture black, or a single color.

mod eye;
mod lights;
mod sight;

use marbles_core::{View, World, parallel};

pub(super) use self::lights::too_weak;
use self::sight::may_be_seen;

/// The most views that are checked; of longer animations, evenly spread ones.
const VIEWS: usize = 9;

/// Warnings about views of some frames, the first of which is `frame`: the mistake, and the remedy. Works on the
/// threads of the current rayon pool.
///
/// If `lights_move`, the lights of the world are those of the first view alone.
pub(super) fn warnings(
    world: &World,
    views: &[View],
    frame: i32,
    lights_move: bool,
) -> Vec<String> {
    let spheres = world.spheres();
    let Some(view) = views.first() else {
        return Vec::new();
    };
    let looked_at: Vec<&View> = views.iter().step_by(views.len().div_ceil(VIEWS)).collect();
    if spheres.is_empty() {
        return vec!["the scene has no spheres: the picture shows only the background".to_owned()];
    }
    let mut warnings = Vec::new();
    let is_empty = |view: &&View| !parallel::any(spheres, |sphere| may_be_seen(sphere, view));
    let shows_none = looked_at.iter().all(is_empty);
    if shows_none {
        warnings.push(
            "no sphere is in view: `marbles check` prints where they are, and `camera: Frame()` shows all of them"
                .to_owned(),
        );
    }
    if world.lights.is_empty()
        && world.ambient.max_element() <= 0.0
        && !lights::has_bright_sky(world)
    {
        warnings.push(
            "the scene has no light: add one, such as `lights: [Directional(toward: (1, 2, -1))]`, or ambient \
             light, such as `ambient: 0.2`"
                .to_owned(),
        );
    }
    let inside = eye::warning(world, view, frame);
    let sees_outsides = inside.is_none();
    warnings.extend(inside);
    if (!lights_move || looked_at.len() == 1) && sees_outsides && !shows_none {
        warnings.extend(lights::behind(world, &looked_at));
    }
    warnings
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use marbles_scene::Scene;

    use super::*;

    fn of(fields: &str) -> String {
        let text = format!("(image: (width: 40, height: 20), lens: Fov(90), {fields})");
        let scene = Scene::parse(&text, Path::new("scene.ron")).unwrap();
        let warnings = warnings(scene.world(), &[scene.view(1).unwrap()], 1, false);
        warnings
            .iter()
            .map(|line| &line[..24])
            .collect::<Vec<_>>()
            .join("; ")
    }

    #[test]
    fn oversights_are_told() {
        const LIT: &str = "ambient: 1, camera: Free()";
        let sphere = |x: f64, y: f64, z: f64| {
            format!("{LIT}, spheres: [(center: ({x}, {y}, {z}), radius: 1)]")
        };
        for (fields, expected) in [
            (sphere(0.0, 0.0, 5.0), ""),
            // The picture ends at x = ±5 and y = ±2.5 there; the sphere reaches 1.41 and 1.12 further.
            (sphere(6.4, 0.0, 5.0), ""),
            (sphere(6.5, 0.0, 5.0), "no sphere is in view: `m"),
            (sphere(0.0, -3.6, 5.0), ""),
            (sphere(0.0, -3.7, 5.0), "no sphere is in view: `m"),
            (sphere(0.0, 0.0, -5.0), "no sphere is in view: `m"),
            (sphere(0.0, 0.0, 0.5), "frame 1: the camera is i"),
            (
                sphere(0.0, 0.0, 5.0).replace("ambient: 1", "ambient: 0"),
                "the scene has no light: ",
            ),
            (
                sphere(0.0, 0.0, 5.0).replace("ambient: 1", "sky: 0"),
                "the scene has no light: ",
            ),
            (
                sphere(0.0, 0.0, 5.0).replace("ambient: 1", "sky: (above: 0.5, below: 0)"),
                "",
            ),
            (LIT.to_owned(), "the scene has no spheres"),
        ] {
            assert_eq!(of(&fields), expected, "{fields}");
        }
    }
}
