//! `--scale-bar`: a drawing that shows a length of the scene and its length in pixels.

use std::path::Path;

use marbles_core::View;
use marbles_scene::Scene;

use super::legend::{round_step, scale_for};
use super::svg::{Anchor, Style, Svg};
use crate::base::failure::Failure;
use crate::base::numbers::short;

const MARGIN: f64 = 16.0;

/// Draws the scale bar for a view of a frame: a round length that takes at most a quarter of the width of the picture.
///
/// Through a parallel lens the length is valid at all distances, else in the plane through the camera's target: the
/// title of the drawing says so. The text is the length with the scene's unit.
///
/// # Errors
/// Refuses a camera with perspective that has no target in front of it.
pub(super) fn draw(scene: &Scene, frame: i32, view: &View, path: &Path) -> Result<Svg, Failure> {
    let (pixels, place) = if view.lens.is_parallel() {
        (view.pixels_per_unit().x, String::new())
    } else {
        let target = scene.target_at(frame).ok_or_else(|| {
            let why = "--scale-bar: with perspective, the bar is valid at the distance of the camera's target, \
                 but this camera has no target: use `LookAt`, `Orbit` or `Frame`, or a `Parallel` lens";
            Failure::unusable(path, why)
        })?;
        let distance = (target - view.camera.position).dot(view.camera.forward());
        if distance <= 0.0 {
            let why = "--scale-bar: the camera's target is not in front of the camera";
            return Err(Failure::unusable(path, why));
        }
        let place = format!(" at the target, {} away", short(distance));
        (view.pixels_per_unit().x / distance, place)
    };
    let when = match scene.frames() {
        Some(frames) if changes(scene, &frames, pixels, view) => format!(", frame {frame}"),
        _ => String::new(),
    };
    let length = round_step(0.25 * f64::from(view.width) / pixels);
    let scale = scale_for(view.width);
    let width = length * pixels / scale;
    let note = match &scene.description().unit {
        Some(unit) => format!("{} {unit}", short(length)),
        None => short(length),
    };
    let whole = width.max(7.0 * note.chars().count() as f64) + 2.0 * MARGIN;
    let title = format!("Scale bar: {note}{place}{when}");
    let mut svg = Svg::scaled(whole, 52.0, scale, &title);
    svg.rectangle((MARGIN, 14.0), (width, 4.0), "#000000");
    let style = Style {
        anchor: Anchor::Start,
        size: 13.0,
        is_bold: false,
        color: "#000000",
    };
    svg.text((MARGIN, 36.0), style, &note);
    Ok(svg)
}

/// Returns whether the same length has a different number of pixels in the first or the last frame.
fn changes(
    scene: &Scene,
    frames: &std::ops::RangeInclusive<i32>,
    pixels: f64,
    shown: &View,
) -> bool {
    let of = |frame: i32| {
        let view = scene.view(frame).ok()?;
        let size = f64::from(shown.width) / f64::from(view.width);
        let pixels = size * view.pixels_per_unit().x;
        if view.lens.is_parallel() {
            return Some(pixels);
        }
        let to_target = scene.target_at(frame)? - view.camera.position;
        Some(pixels / to_target.dot(view.camera.forward()))
    };
    let ends = [*frames.start(), *frames.end()];
    let differs = |other: f64| (other - pixels).abs() > 1e-9 * pixels;
    ends.into_iter().filter_map(of).any(differs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(fields: &str) -> String {
        let text = format!("(image: (width: 1280, height: 20), {fields})");
        let path = Path::new("scene.ron");
        let scene = Scene::parse(&text, path).unwrap();
        draw(&scene, 1, &scene.view(1).unwrap(), path)
            .unwrap()
            .finish()
    }

    /// A quarter of the width is 12.5, and 10 of 50 are 256 of 1280 pixels.
    #[test]
    fn the_text_is_a_length_with_its_unit() {
        let parallel = drawn("lens: Parallel(width: 50), camera: Free(), unit: \"nm\"");
        assert!(parallel.contains(">10 nm</text>"), "{parallel}");
        // In a drawing that is shown at twice its size.
        assert!(
            parallel.contains("width=\"128\" height=\"4\" fill=\"#000000\""),
            "{parallel}"
        );
        assert!(
            parallel.contains("height=\"104\" viewBox=\"0 0 160 52\""),
            "{parallel}"
        );
        let far = drawn(
            "lens: Retina(width: 5, distance: 1), camera: Orbit(target: (0, 0, 0), radius: 10)",
        );
        assert!(far.contains(">10</text>"), "{far}");
        assert!(
            far.contains("<title>Scale bar: 10 at the target, 10 away</title>"),
            "{far}"
        );
    }
}
