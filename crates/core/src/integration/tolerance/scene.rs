//! The world in the frame of a camera.

use glam::{DMat3, DVec3};
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};

use crate::edges::{Ball, Caster};
use crate::visibility::Visibility;
use crate::{Color, View, World};

/// Lights that are integrated at a time: further ones in further groups.
pub(super) const MOST_LIGHTS: usize = 8;

/// What integration needs of world and view.
#[derive(Clone, Debug)]
pub(super) struct InCamera<'scene> {
    pub(super) world: &'scene World,
    pub(super) visibility: &'scene Visibility<'scene>,
    pub(super) world_from_camera: DMat3,
    pub(super) viewpoint: DVec3,
    pub(super) balls: Vec<Ball>,
    /// Whether the eye is inside a sphere that casts shadows: so is all that it sees, and no light
    /// gets there.
    pub(super) is_enclosed: bool,
    /// Those of one group.
    pub(super) lights: Vec<Light>,
    /// What spheres send without a light; nothing but for the first group.
    pub(super) ambient: Color,
}

/// Threads share the work on no fewer spheres than this.
pub(super) const FEWEST_TO_SHARE: usize = 4096;

/// A light in the camera's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Light {
    /// Its number in the world.
    pub(super) index: usize,
    pub(super) intensity: Color,
    /// Unit vector toward it.
    pub(super) toward: DVec3,
    /// Unit vectors across.
    right: DVec3,
    up: DVec3,
}

impl Light {
    /// A ball as the light sees it.
    pub(super) fn caster(&self, ball: &Ball) -> Caster {
        Caster {
            center: ball.center,
            radius: ball.radius,
            right: self.right,
            up: self.up,
        }
    }
}

impl<'scene> InCamera<'scene> {
    pub(super) fn new(
        world: &'scene World,
        visibility: &'scene Visibility<'scene>,
        view: &View,
        group: usize,
    ) -> Self {
        let world_from_camera = view.camera.world_from_camera;
        let camera_from_world = world_from_camera.transpose();
        let viewpoint = view.camera.position;
        let spheres = world.spheres().par_iter().with_min_len(FEWEST_TO_SHARE);
        let balls = spheres.map(|sphere| Ball {
            center: camera_from_world * (sphere.center() - viewpoint),
            radius: sphere.radius(),
            outside: sphere.relative_to(viewpoint).outside(),
        });
        let of_group = world.lights.iter().enumerate();
        let of_group = of_group.skip(group * MOST_LIGHTS).take(MOST_LIGHTS);
        let lights = of_group.map(|(index, light)| {
            let toward = camera_from_world * light.toward();
            let (right, up) = toward.any_orthonormal_pair();
            Light {
                index,
                intensity: light.intensity(),
                toward,
                right,
                up,
            }
        });
        let balls: Vec<Ball> = balls.collect();
        Self {
            world,
            visibility,
            world_from_camera,
            viewpoint,
            is_enclosed: world.shadows && balls.iter().any(|ball| ball.outside <= 0.0),
            balls,
            lights: lights.collect(),
            ambient: if group == 0 {
                world.ambient
            } else {
                Color::ZERO
            },
        }
    }

    pub(super) fn in_world(&self, point: DVec3) -> DVec3 {
        self.viewpoint + self.world_from_camera * point
    }
}
