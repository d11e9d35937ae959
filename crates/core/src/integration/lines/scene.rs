//! The world in the frame of a camera.

use glam::{DMat3, DVec3};

use crate::{View, World};

/// A sphere in the camera's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    pub(super) center: DVec3,
    pub(super) radius: f64,
    /// |center|² − radius².
    pub(super) outside: f64,
}

/// What lines need of world and view.
#[derive(Clone, Debug)]
pub(super) struct InCamera {
    pub(super) world_from_camera: DMat3,
    pub(super) viewpoint: DVec3,
    /// Distance of the retina.
    pub(super) distance: f64,
    pub(super) balls: Vec<Ball>,
    /// Unit vectors toward the lights.
    pub(super) lights: Vec<DVec3>,
}

impl InCamera {
    pub(super) fn new(world: &World, view: &View) -> Self {
        let world_from_camera = view.camera.world_from_camera;
        let camera_from_world = world_from_camera.transpose();
        let viewpoint = view.camera.position;
        let balls = world.spheres().iter().map(|sphere| Ball {
            center: camera_from_world * (sphere.center() - viewpoint),
            radius: sphere.radius(),
            outside: sphere.relative_to(viewpoint).outside(),
        });
        Self {
            world_from_camera,
            viewpoint,
            distance: view.lens.distance * view.zoom,
            balls: balls.collect(),
            lights: world
                .lights
                .iter()
                .map(|light| camera_from_world * light.toward())
                .collect(),
        }
    }
}
