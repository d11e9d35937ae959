//! The world in the frame of a camera.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};

use super::classify::patch::Patch;
use super::parallel_begin::moved_ahead;
use crate::edges::cell::Ball;
use crate::edges::shadow::{Caster, Cone};
use crate::edges::terminator::Plane;
use crate::light::lobe::Lobe;
use crate::light::near_light::NearLight;
use crate::model::camera::Projection;
use crate::model::color::Color;
use crate::model::light::Light as WorldLight;
use crate::model::outline::OutlineView;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::rounding::{GEOMETRY_SLACK, WIDER};
use crate::picture::image::Channels;
use crate::search::point_occluders::enclosing;
use crate::search::visibility::Visibility;

/// Lights that are integrated at a time, further ones in further groups: as many as cosines are kept of for
/// each sample (see `interior::light_cosines`). Few scenes have more.
pub(crate) const MOST_LIGHTS: usize = 8;

/// A world in the frame of a camera, under one group of its lights.
#[derive(Clone, Debug)]
pub(crate) struct InCamera<'scene> {
    pub(crate) world: &'scene World,
    /// The number of channels of light that are computed: 1 in a world without color, whose channels are
    /// the same.
    pub(crate) channels: usize,
    pub(crate) visibility: Visibility<'scene>,
    pub(crate) world_from_camera: DMat3,
    pub(crate) viewpoint: DVec3,
    pub(crate) projection: Projection,
    camera_from_world: DMat3,
    /// All spheres; none in a world of very many, of which a view sees few.
    balls: Arc<[Ball]>,
    /// True if the eye is inside a sphere that casts shadows: so is all that it sees, and no directional light
    /// gets there.
    pub(crate) is_enclosed: bool,
    /// Whether some lights of the group are point lights, which not all rungs know.
    pub(crate) has_near_lights: bool,
    /// Whether some of them send light in few directions only.
    pub(crate) has_narrow_lamps: bool,
    /// The lights of the group.
    pub(crate) lights: Vec<Light>,
    /// The light of the surroundings, which counts with the first group.
    pub(crate) ambient: Color,
    /// Whether the light of spheres is their normals: see [`Self::of_normals`].
    pub(crate) is_of_normals: bool,
    /// The view of outlines, where any are seen.
    outlines: Option<OutlineView>,
    /// Whether outlines are black, as in all groups but the first.
    are_outlines_black: bool,
    /// The unit of their colors.
    outline_unit: f64,
}

/// The number of spheres up to which all are brought into the camera's frame once for a view: they take
/// 10 MB. Of more, each tile takes those that it sees. Where a hundred thousand nearly coincide, hundreds of tiles see all
/// of them: without this such a picture takes a fifth longer.
const MOST_KEPT: usize = 1 << 17;

/// The least number of spheres that a task takes: fewer are hardly worth its start. Not tuned.
const FEWEST_TO_SHARE: usize = 4096;

/// A light in the camera's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Light {
    /// Its number in the world.
    pub(crate) index: usize,
    pub(crate) intensity: Color,
    /// Unit vector toward it.
    pub(crate) toward: DVec3,
    /// Unit vectors across.
    pub(crate) right: DVec3,
    pub(crate) up: DVec3,
    /// The place of a point light, whose vectors mean nothing.
    pub(crate) near: Option<NearLight>,
    /// Whether the light gets nowhere that the eye sees, as spheres are around one of them alone.
    pub(crate) is_shut_off: bool,
}

impl Light {
    /// A ball as the light sees it.
    pub(crate) fn caster(&self, center: DVec3, radius: f64) -> Caster {
        Caster {
            center,
            radius,
            right: self.right,
            up: self.up,
            cone: self
                .near
                .map(|near| Cone::new(near.position, center, radius)),
        }
    }

    /// The same light that sends as much in all directions as in the one that it faces.
    pub(crate) fn in_all_directions(&self) -> Self {
        Self {
            near: self.near.map(NearLight::in_all_directions),
            ..*self
        }
    }

    /// The plane of the cutoff on a ball, with its axis on the side that the light faces; none of a light that sends as
    /// much in all directions.
    pub(crate) fn cutoff(&self, ball: &Ball) -> Option<Plane> {
        let near = self.near.as_ref()?;
        let axis = near.lobe.as_ref()?.direction;
        let offset = (near.position - ball.center).dot(axis);
        Some(Plane { axis, offset })
    }

    /// A bound of the factor by which intensity is larger anywhere on a ball's patch, which may seem to reach around the
    /// light where the ball does not.
    pub(crate) fn most_on(&self, ball: &Ball, patch: &Patch) -> f64 {
        self.near.map_or(1.0, |near| {
            let apart = (ball.center - near.position).length();
            let size = ball.center.length() + near.position.length() + ball.radius;
            let of_ball = (apart - ball.radius).abs() - GEOMETRY_SLACK * size;
            near.most_from(patch.distance_from(near.position).max(of_ball))
        })
    }
}

impl<'scene> InCamera<'scene> {
    pub(crate) fn new(
        world: &'scene World,
        visibility: &Visibility<'scene>,
        view: &View,
        channels: Channels,
        group: usize,
    ) -> Self {
        let world_from_camera = view.camera.world_from_camera;
        let camera_from_world = world_from_camera.transpose();
        let projection = view.lens.projection();
        let viewpoint = match projection {
            Projection::Central => view.camera.position,
            Projection::Parallel => moved_ahead(world, &view.camera),
        };
        let in_camera =
            |sphere: &Sphere| in_camera(sphere, viewpoint, &camera_from_world, projection);
        let spheres = world.spheres().par_iter().with_min_len(FEWEST_TO_SHARE);
        let balls: Vec<Ball> = if world.spheres().len() <= MOST_KEPT {
            spheres.clone().map(in_camera).collect()
        } else {
            Vec::new()
        };
        let balls = Arc::from(balls);
        let encloses = |sphere: &Sphere| {
            let distance_sq = (sphere.center() - viewpoint).length_squared();
            let radius_sq = sphere.radius() * sphere.radius();
            // What is not a number may be anything.
            let is_far = distance_sq > radius_sq * WIDER && radius_sq > 0.0;
            !is_far && sphere.outside(viewpoint) <= 0.0
        };
        let of_group = visibility.lights().iter().enumerate();
        let of_group = of_group.skip(group * MOST_LIGHTS).take(MOST_LIGHTS);
        // Of parallel rays some may begin inside of a sphere, and others not.
        let has_point_lights = visibility.lights().iter().any(|it| it.point().is_some());
        let around_eye = if has_point_lights && projection == Projection::Central {
            enclosing(world.spheres(), viewpoint)
        } else {
            Vec::new()
        };
        let is_enclosed =
            world.shadows && projection == Projection::Central && spheres.any(encloses);
        let lights = of_group.map(|(index, light)| match light {
            WorldLight::Directional(light) => {
                let toward = camera_from_world * light.toward();
                let (right, up) = toward.any_orthonormal_pair();
                Light {
                    index,
                    intensity: light.intensity(),
                    toward,
                    right,
                    up,
                    near: None,
                    is_shut_off: is_enclosed,
                }
            }
            WorldLight::Point(light) => {
                let position = camera_from_world * (light.position() - viewpoint);
                let lobe = light.emission();
                let lobe = lobe.map(|emission| Lobe::new(emission, &camera_from_world));
                let around_light = visibility.point_light(index);
                let around_light = around_light.map(|occluders| occluders.enclosing());
                Light {
                    index,
                    intensity: light.intensity(),
                    toward: DVec3::Z,
                    right: DVec3::X,
                    up: DVec3::Y,
                    near: Some(NearLight::new(light, position, lobe)),
                    is_shut_off: around_light.is_some_and(|around| around != around_eye),
                }
            }
        });
        let lights: Vec<Light> = lights.collect();
        Self {
            world,
            channels: channels.count(),
            visibility: visibility.clone(),
            world_from_camera,
            viewpoint,
            projection,
            is_enclosed,
            has_near_lights: lights.iter().any(|light| light.near.is_some()),
            has_narrow_lamps: lights.iter().any(|light| {
                let lobe = light.near.and_then(|near| near.lobe);
                lobe.is_some_and(|lobe| lobe.is_narrow())
            }),
            camera_from_world,
            balls,
            lights,
            ambient: if group == 0 {
                world.ambient
            } else {
                Color::ZERO
            },
            is_of_normals: false,
            outlines: world.has_outlines().then(|| view.outline_view()),
            are_outlines_black: group > 0,
            outline_unit: 1.0,
        }
    }

    /// The same, whose light is in multiples of a unit.
    pub(crate) fn in_units_of(mut self, unit: f64) -> Self {
        for light in &mut self.lights {
            light.intensity /= unit;
        }
        self.ambient /= unit;
        self.outline_unit = unit;
        self
    }

    /// The same scene whose smooth spheres send their normals, in the camera's frame, as red, green and blue: three
    /// lights along the axes that go on, with the other sign, where a surface turns from them. What no sphere covers
    /// sends nothing.
    pub(crate) fn of_normals(&self) -> Self {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let lights = axes.into_iter().enumerate().map(|(index, axis)| Light {
            index,
            intensity: axis,
            toward: axis,
            right: axes[(index + 1) % 3],
            up: axes[(index + 2) % 3],
            near: None,
            is_shut_off: false,
        });
        Self {
            channels: axes.len(),
            has_near_lights: false,
            has_narrow_lamps: false,
            lights: lights.collect(),
            ambient: Color::ZERO,
            is_of_normals: true,
            outlines: None,
            ..self.clone()
        }
    }

    /// The only light of the group, if it is directional.
    pub(crate) fn single_light(&self) -> Option<&Light> {
        match &self.lights[..] {
            [light] if light.near.is_none() => Some(light),
            _ => None,
        }
    }

    /// The same without lights and outlines.
    pub(crate) fn without_lights(
        world: &'scene World,
        visibility: &Visibility<'scene>,
        view: &View,
        channels: Channels,
    ) -> Self {
        // A group after the last one.
        let group = visibility.lights().len() / MOST_LIGHTS + 1;
        Self {
            outlines: None,
            ..Self::new(world, visibility, view, channels, group)
        }
    }

    /// Whether some spheres may have outlines.
    pub(crate) fn has_outlines(&self) -> bool {
        self.outlines.is_some()
    }

    /// The visible part of a sphere inside of its outline: a ball with the same center; none for a sphere without an outline.
    pub(crate) fn inside_outline(&self, sphere: usize, ball: &Ball) -> Option<Ball> {
        let view = self.outlines?;
        let outline = self.world.material(sphere).outline?;
        // The ball may be one that a cell sees of a sphere that the plane of parallel rays cuts.
        if ball.outside <= 0.0 || self.ball(sphere).outside <= 0.0 {
            return None;
        }
        let radius = outline.width.inner_radius(view, ball.center, ball.radius);
        let power = ball.power + (ball.radius - radius) * (ball.radius + radius);
        let outside = match ball.projection {
            Projection::Central => power,
            Projection::Parallel => ball.outside,
        };
        Some(Ball {
            radius,
            outside,
            power,
            ..*ball
        })
    }

    /// The light of a sphere's outline.
    pub(crate) fn outline_color(&self, sphere: usize) -> Color {
        let outline = self.world.material(sphere).outline;
        match outline {
            Some(outline) if !self.are_outlines_black => outline.color / self.outline_unit,
            _ => Color::ZERO,
        }
    }

    /// A sphere in the camera's frame.
    pub(crate) fn ball(&self, sphere: usize) -> Ball {
        match self.balls.get(sphere) {
            Some(ball) => *ball,
            None => in_camera(
                &self.world.spheres()[sphere],
                self.viewpoint,
                &self.camera_from_world,
                self.projection,
            ),
        }
    }

    /// The center of a sphere in the camera's frame, and its radius.
    pub(crate) fn center(&self, sphere: usize) -> (DVec3, f64) {
        match self.balls.get(sphere) {
            Some(ball) => (ball.center, ball.radius),
            None => {
                let sphere = &self.world.spheres()[sphere];
                let center = self.camera_from_world * (sphere.center() - self.viewpoint);
                (center, sphere.radius())
            }
        }
    }

    /// A color of which only the channels that are computed are known.
    pub(crate) fn spread(&self, color: Color) -> Color {
        if self.channels == 1 {
            Color::splat(color.x)
        } else {
            color
        }
    }

    pub(crate) fn in_world(&self, point: DVec3) -> DVec3 {
        self.viewpoint + self.world_from_camera * point
    }
}

fn in_camera(
    sphere: &Sphere,
    viewpoint: DVec3,
    camera_from_world: &DMat3,
    projection: Projection,
) -> Ball {
    let (center, radius) = (
        *camera_from_world * (sphere.center() - viewpoint),
        sphere.radius(),
    );
    let power = sphere.outside(viewpoint);
    Ball {
        center,
        radius,
        power,
        outside: match projection {
            Projection::Central => power,
            Projection::Parallel if center.z >= radius => center.z,
            Projection::Parallel => -1.0,
        },
        projection,
    }
}
