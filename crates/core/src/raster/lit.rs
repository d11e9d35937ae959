//! The lights of a raster.

use glam::DVec3;

use crate::model::color::Color;
use crate::model::light::Light;
use crate::model::view::View;
use crate::search::visibility::Visibility;

/// A light from far away.
#[derive(Clone, Debug)]
pub(super) struct Sun {
    /// Its number among the lights.
    pub(super) light: usize,
    /// Directions toward the light and across it, in the camera's frame.
    pub(super) toward: [f32; 3],
    pub(super) right: [f32; 3],
    pub(super) up: [f32; 3],
    /// The same in the world's frame.
    pub(super) in_world: DVec3,
    pub(super) across: (DVec3, DVec3),
    /// In units.
    pub(super) intensity: Color,
    /// Whether spheres keep it from others.
    pub(super) has_shadows: bool,
}

impl Sun {
    /// The lights of a world, all of which are directional, with or without shadows; light has this unit.
    pub(super) fn all(
        lights: &[Light],
        unit: f64,
        view: &View,
        visibility: &Visibility<'_>,
        has_shadows: bool,
    ) -> Vec<Self> {
        let from_world = view.camera.world_from_camera.transpose();
        let in_camera = |direction: DVec3| (from_world * direction).as_vec3().to_array();
        let of_light = |(light, sun): (usize, &Light)| {
            let Light::Directional(sun) = sun else {
                return None;
            };
            let across = if has_shadows {
                visibility.light(light).axes()
            } else {
                (DVec3::ZERO, DVec3::ZERO)
            };
            Some(Self {
                light,
                toward: in_camera(sun.toward()),
                right: in_camera(across.0),
                up: in_camera(across.1),
                in_world: sun.toward(),
                across,
                intensity: sun.intensity() / unit,
                has_shadows,
            })
        };
        lights.iter().enumerate().filter_map(of_light).collect()
    }

    /// A way in the world: to the right and up across the light, and toward it.
    pub(super) fn project(&self, way: DVec3) -> DVec3 {
        let (right, up) = self.across;
        DVec3::new(way.dot(right), way.dot(up), way.dot(self.in_world))
    }
}
