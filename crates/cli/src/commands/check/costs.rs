//! Warnings about settings that are expensive, or with which small tolerances cannot be met.

use glam::DVec2;
use marbles_core::{Grain, Sphere, View, World};

use crate::base::numbers::short;

/// The most views that are checked; of longer animations, evenly spread ones.
const VIEWS: usize = 5;

/// The smallest effect of rounding on edges that causes a warning, as a fraction of a pixel.
const COARSE: f64 = 1e-6;

/// A bound of the effect of rounding on edges, relative to the numbers that they are computed from; the same as in the
/// core.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

/// Warnings as plain sentences: the expensive setting and its place, the consequence, and the remedy.
pub(super) fn warnings(world: &World, views: &[View]) -> Vec<String> {
    let step = views.len().div_ceil(VIEWS).max(1);
    let views: Vec<&View> = views.iter().step_by(step).collect();
    let (grains, highlights) = (fine_grains(world, &views), narrow_highlights(world, &views));
    let all = [grains, highlights, coarse_lens(&views)];
    all.into_iter().flatten().collect()
}

/// Finds bumps that are smaller than a pixel even at the point of their sphere that is nearest to the viewpoint.
fn fine_grains(world: &World, views: &[&View]) -> Option<String> {
    let (place, grain, pixel) = smaller_than_pixels(world, views, |index, _| {
        let roughness = world.material(index).roughness.as_ref()?;
        match roughness.grain {
            Grain::Surface(size) if roughness.amplitude > 0.0 => Some(size),
            Grain::Surface(_) | Grain::Pixel => None,
        }
    })?;
    Some(format!(
        "{place}: bumps with a grain of {grain} are smaller than a pixel, which is {pixel} wide there: such \
         pixels cost hundreds of times as much as smooth ones, and pixels with many bumps stay over small \
         tolerances; choose a larger grain, or render more pixels"
    ))
}

/// Finds highlights whose width at half maximum is less than a pixel.
fn narrow_highlights(world: &World, views: &[&View]) -> Option<String> {
    let (place, width, pixel) = smaller_than_pixels(world, views, |index, sphere| {
        let highlight = world.material(index).highlight?;
        // cos(θ) to the power of s is a half at about θ = √(2 ln 2 / s).
        let angle = (2.0 * std::f64::consts::LN_2 / highlight.shininess).sqrt();
        (highlight.strength > 0.0).then(|| 2.0 * angle.min(1.0) * sphere.radius())
    })?;
    Some(format!(
        "{place}: a highlight {width} wide is narrower than a pixel, which is {pixel} wide there: such pixels \
         cost tens of times as much as others; choose a smaller shininess, or render more pixels"
    ))
}

/// Finds a lens so long that rounding moves edges by a noticeable fraction of a pixel.
fn coarse_lens(views: &[&View]) -> Option<String> {
    let pixels = views.iter().map(|view| pixel_at_one(view).min_element());
    let moved = ROUNDINGS / pixels.fold(f64::INFINITY, f64::min);
    (moved > COARSE).then(|| {
        format!(
            "lens: the angle of a pixel is so small that rounding moves edges by up to {} of a pixel: at edges, \
             tolerances below about this cannot be met; move the camera closer and use a shorter lens",
            short(moved)
        )
    })
}

/// The first sphere with details smaller than a pixel in all views, the number of other such spheres, the size of the
/// details, and the longer side of the pixel there.
fn smaller_than_pixels(
    world: &World,
    views: &[&View],
    size: impl Fn(usize, &Sphere) -> Option<f64>,
) -> Option<(String, String, String)> {
    let mut first = None;
    let mut others = 0;
    for (index, sphere) in world.spheres().iter().enumerate() {
        let Some(size) = size(index, sphere) else {
            continue;
        };
        let pixels = views.iter().filter_map(|view| pixel_on(view, sphere));
        let pixel = pixels.fold(f64::INFINITY, f64::min);
        if pixel.is_infinite() || size >= pixel {
            continue;
        }
        match first {
            None => first = Some((index + 1, size, pixel)),
            Some(_) => others += 1,
        }
    }
    let (number, size, pixel) = first?;
    let place = match others {
        0 => format!("sphere {number}"),
        _ => format!("sphere {number} and {others} more"),
    };
    Some((place, short(size), short(pixel)))
}

/// The longer side of a pixel at the nearest point of a sphere. `None` if the sphere is behind the viewpoint or contains it.
/// Through a parallel lens it is the same everywhere.
fn pixel_on(view: &View, sphere: &Sphere) -> Option<f64> {
    let from_eye = sphere.center() - view.camera.position;
    let ahead = from_eye.dot(view.camera.forward());
    let distance = if view.lens.is_parallel() {
        1.0
    } else {
        from_eye.length() - sphere.radius()
    };
    (ahead > -sphere.radius() && distance > 0.0)
        .then(|| distance * pixel_at_one(view).max_element())
}

/// The width and the height of a pixel at a distance of 1, or through a parallel lens at any distance.
fn pixel_at_one(view: &View) -> DVec2 {
    view.pixel_size() / view.magnification()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use marbles_scene::Scene;

    use super::*;

    /// The warnings for a scene with a ball of this material, seen through this lens from this distance.
    fn of(material: &str, distance: f64) -> Vec<String> {
        let text = format!(
            "(image: (width: 100, height: 100), lens: Retina(width: 2, distance: {distance:e}),
            camera: Free(position: (0, 0, -{distance:e})), lights: [Directional(toward: (0, 1, -1))],
            materials: {{ \"m\": ({material}) }},
            spheres: [(center: (0, 0, 1), radius: 1), (center: (0, 0, 1), radius: 1, material: \"m\"),
                (center: (0, 0, 2), radius: 1, material: \"m\")])"
        );
        let scene = Scene::parse(&text, Path::new("scene.ron")).unwrap();
        let view = scene.view(1).unwrap();
        warnings(scene.world(), &[view])
    }

    #[test]
    fn ordinary_scenes_have_no_warnings() {
        let material = "highlight: (strength: 1, shininess: 2000),
            rough: (amplitude: 0.5, grain: Surface(0.03))";
        assert_eq!(of(material, 10.0), Vec::<String>::new());
        // Without an amplitude there are no bumps, and without a strength no highlight.
        let material = "highlight: (strength: 0, shininess: 1e9),
            rough: (amplitude: 0, grain: Surface(1e-3))";
        assert_eq!(of(material, 10.0), Vec::<String>::new());
    }

    #[test]
    fn grain_below_a_pixel_is_told() {
        let found = of("rough: (amplitude: 0.5, grain: Surface(0.01))", 10.0);
        assert_eq!(found.len(), 1, "{found:?}");
        let expected = "sphere 2 and 1 more: bumps with a grain of 0.01 are smaller than a pixel, which is 0.02 wide";
        assert!(found[0].starts_with(expected), "{found:?}");
    }

    #[test]
    fn highlights_below_a_pixel_are_told() {
        let found = of("highlight: (strength: 1, shininess: 1e5)", 10.0);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].contains("narrower than a pixel"), "{found:?}");
    }

    #[test]
    fn a_lens_too_long_for_doubles_is_told() {
        let found = of("exponent: 1", 1e12);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(
            found[0].starts_with("lens: the angle of a pixel is so small"),
            "{found:?}"
        );
        assert_eq!(of("exponent: 1", 1e6), Vec::<String>::new());
    }
}
