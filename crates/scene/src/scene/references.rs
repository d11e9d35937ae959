//! The reference distance of point lights that name none.
//!
//! A light of intensity 1 then makes white of what is in the middle of the scene, whatever the unit of length. The
//! distance is the median of those from the light to the surfaces of all spheres: a floor as large as a planet, whose
//! center is far away, counts as no more than one of them.

use glam::DVec3;
use marbles_core::{Sphere, parallel};

use super::Scene;
use crate::report::SceneError;

impl Scene {
    /// Chooses the reference distances that the file does not name, by the lights and spheres of the first frame.
    pub(super) fn choose_references(&mut self) -> Result<(), SceneError> {
        if !self.lights.lack_references() {
            return Ok(());
        }
        let first = self.frames().map_or(1, |frames| *frames.start());
        let placed = self.first_lights();
        let stepped = match self.has_steps() {
            true => Some(self.world_at(first)?),
            false => None,
        };
        let spheres = stepped.as_ref().unwrap_or(&self.world).spheres();
        self.lights
            .choose_references(&placed, |position| median_distance(spheres, position));
        Ok(())
    }
}

/// The median of the distances from a point to the surfaces of spheres, the lower one of two; `None` where all are 0.
fn median_distance(spheres: &[Sphere], point: DVec3) -> Option<f64> {
    let distance = |sphere: &Sphere| ((sphere.center() - point).length() - sphere.radius()).abs();
    let mut distances = parallel::map_each(spheres, distance);
    distances.retain(|&distance| distance > 0.0 && distance.is_finite());
    let middle = distances.len().checked_sub(1)? / 2;
    let (_, median, _) = distances.select_nth_unstable_by(middle, f64::total_cmp);
    Some(*median)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use marbles_core::Light;

    use super::*;

    /// The reference distances of the lights of a scene, in its first frame.
    fn references(lights: &str, more: &str) -> Vec<f64> {
        let text =
            format!("(image: (width: 6, height: 4), lens: Fov(40), lights: [{lights}], {more})");
        let scene = Scene::parse(&text, Path::new("scene.ron")).unwrap();
        let reference = |light: &Light| match light {
            Light::Point(light) => light.reference(),
            Light::Directional(_) => panic!("only points"),
        };
        scene.world().lights.iter().map(reference).collect()
    }

    const BALLS: &str =
        "spheres: [(center: (0, 0, 200), radius: 20), (center: (0, 0, 300), radius: 10),
                                   (center: (0, -1e6, 0), radius: 999990)]";

    #[test]
    fn lights_have_their_intensity_in_the_middle_of_the_scene() {
        let camera = format!("camera: Free(position: (0, 0, 100)), {BALLS}");
        let lights = "Point(position: (0, 0, 0)), Point(position: (0, 0, 100), reference: 7),
                      Point(position: (0, 0, 0), attached: Camera)";
        // The floor is 10 below the first one, and the balls begin 180 and 290 from it.
        assert_eq!(references(lights, &camera), [180.0, 7.0, 80.0]);
    }

    #[test]
    fn lengths_have_no_unit() {
        let scene = |unit: f64| {
            let ball = format!("(center: (0, 0, {}), radius: {})", 3.0 * unit, unit);
            let light = format!("Point(position: (0, {unit}, 0))");
            references(&light, &format!("camera: Free(), spheres: [{ball}]"))[0] / unit
        };
        assert_eq!(scene(1.0), 10.0_f64.sqrt() - 1.0);
        assert_eq!(scene(1024.0), scene(1.0));
    }

    #[test]
    fn a_light_that_moves_keeps_the_distance_of_the_first_frame() {
        let lights = "Point(name: \"a\", position: (0, 0, 0))";
        let keys = "keys: [(light: \"a\", frame: 1, position: (0, 0, 50)), (light: \"a\", frame: 9, position: (0, 0, 0))]";
        let more = format!("camera: Free(), animation: Keyframes(frames: (1, 9), {keys}), {BALLS}");
        assert_eq!(references(lights, &more), [130.0]);
    }

    #[test]
    fn lights_of_nothing_have_some_distance() {
        assert_eq!(
            references("Point(position: (1, 2, 3))", "camera: Free()"),
            [1.0]
        );
    }
}
