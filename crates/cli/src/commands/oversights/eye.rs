//! A camera inside a sphere, or on its surface.

use glam::DVec3;
use marbles_core::{Sphere, View, World, parallel};

use crate::base::numbers::short;

/// The distance from a surface that rounding may leave, as a fraction of the numbers that are subtracted.
const ROUNDING: f64 = 1e-14;

/// The place of a viewpoint whose rays meet the inner side of a sphere.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Place {
    Inside,
    OnSurface,
}

/// The warning about a viewpoint in frame `frame` from which the inner side of a sphere hides the others.
pub(super) fn warning(world: &World, view: &View, frame: i32) -> Option<String> {
    if view.lens.is_parallel() {
        return None;
    }
    let spheres = world.spheres();
    let is_met = |sphere: &Sphere| place(sphere, view).is_some();
    if !parallel::any(spheres, is_met) {
        return None;
    }
    let index = spheres.iter().position(is_met)?;
    let (number, radius) = (index + 1, short(spheres[index].radius()));
    Some(match place(&spheres[index], view)? {
        Place::Inside => format!(
            "frame {frame}: the camera is inside sphere {number}, whose radius is {radius}: the inner side of the \
             sphere hides everything outside"
        ),
        Place::OnSurface => format!(
            "frame {frame}: the camera is exactly on the surface of sphere {number}, whose radius is {radius}, and \
             looks into it: it sees the inner side, which no light reaches; move it back"
        ),
    })
}

fn place(sphere: &Sphere, view: &View) -> Option<Place> {
    let eye = view.camera.position;
    let to_center = sphere.center() - eye;
    let radius = sphere.radius();
    let rounding = ROUNDING * (eye.length() + sphere.center().length() + radius);
    let above = to_center.length() - radius;
    if above.abs() <= rounding {
        let looks_in = corners(view).any(|ray| ray.dot(to_center) > rounding * ray.length());
        return looks_in.then_some(Place::OnSurface);
    }
    (above < 0.0).then_some(Place::Inside)
}

/// The rays through the corners of a picture, in the world frame.
fn corners(view: &View) -> impl Iterator<Item = DVec3> {
    let (middle, size) = view.screen_window();
    let signs = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    signs.into_iter().map(move |(x, y)| {
        let ray = DVec3::new(middle.x + x * size.x, middle.y + y * size.y, 1.0);
        view.camera.world_from_camera * ray
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use marbles_scene::Scene;

    use super::*;

    fn of(camera: &str) -> Option<Place> {
        let text = format!(
            "(image: (width: 40, height: 20), lens: Fov(90), {camera}, spheres: [(center: (0, 0, 400), radius: 300)])"
        );
        let scene = Scene::parse(&text, Path::new("scene.ron")).unwrap();
        let world = scene.world();
        let view = scene.view(1).unwrap();
        let found = place(&world.spheres()[0], &view);
        assert_eq!(found.is_some(), warning(world, &view, 1).is_some());
        found
    }

    #[test]
    fn viewpoints_on_a_surface_are_told_if_they_look_into_the_sphere() {
        for (camera, expected) in [
            ("camera: Free()", None),
            ("camera: Free(position: (0, 0, 99.999999))", None),
            (
                "camera: Free(position: (0, 0, 100))",
                Some(Place::OnSurface),
            ),
            // The picture is 90 degrees wide: to one side of 134 degrees it still looks in, beyond 136 it does not.
            (
                "camera: Free(position: (0, 0, 100), pan: 134)",
                Some(Place::OnSurface),
            ),
            ("camera: Free(position: (0, 0, 100), pan: 136)", None),
            ("camera: Free(position: (0, 0, 101))", Some(Place::Inside)),
            (
                "camera: Free(position: (0, 0, 101), pan: 180)",
                Some(Place::Inside),
            ),
            // 180 and 240 of 300, which is exact.
            (
                "camera: Free(position: (180, 240, 400), pan: 0, tilt: -30)",
                Some(Place::OnSurface),
            ),
        ] {
            assert_eq!(of(camera), expected, "{camera}");
        }
    }
}
