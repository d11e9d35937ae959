//! `--scale-bar`: a drawing that shows a length of the scene and its length in pixels.

use std::path::Path;

use marbles_core::View;
use marbles_scene::Scene;

use super::legend::round_step;
use super::svg::{Anchor, Style, Svg};
use crate::base::failure::Failure;
use crate::base::numbers::short;

const MARGIN: f64 = 16.0;

/// Draws the scale bar for a view of a frame: a round length that takes at most a quarter of the width of the picture.
///
/// Through a parallel lens the length is valid at all distances, else in the plane through the camera's target.
///
/// # Errors
/// Refuses a camera with perspective that has no target in front of it.
pub(super) fn draw(scene: &Scene, frame: i32, view: &View, path: &Path) -> Result<String, Failure> {
    let (pixels, place) = if view.lens.is_parallel() {
        (view.pixels_per_unit(), String::new())
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
        (view.pixels_per_unit() / distance, place)
    };
    let when = match scene.frames() {
        Some(frames) if changes(scene, &frames, pixels, view) => format!(", frame {frame}"),
        _ => String::new(),
    };
    let length = round_step(0.25 * f64::from(view.width) / pixels);
    let width = length * pixels;
    let note = format!("{}{place}{when}", short(length));
    let whole = (width + 2.0 * MARGIN).max(7.0 * note.len() as f64 + 2.0 * MARGIN);
    let mut svg = Svg::new(whole, 52.0, "Scale bar");
    svg.rectangle((MARGIN, 14.0), (width, 4.0), "#000000");
    let style = Style {
        anchor: Anchor::Start,
        size: 13.0,
        is_bold: false,
        color: "#000000",
    };
    svg.text((MARGIN, 36.0), style, &note);
    Ok(svg.finish())
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
        let pixels = size * view.pixels_per_unit();
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
