//! A rectangle of the retina, and the spheres that affect it.

use glam::{DVec2, DVec3};
use marbles_core::{OutlineWidth, View, World};

use super::ball::Ball;
use super::beam::{Beam, Cone, Cylinder, SLACK, angle};
use super::lamp::Lamp;
use super::soft::{Softness, Sun};

/// The relative rounding error of a direction or a point: about eight operations.
const ROUNDING: f64 = 8.0 * 0.5 * f64::EPSILON;

/// The allowed error of soft light at a point, as a fraction of the patch's goal.
const FINE_SHARE: f64 = 1e-4;

/// A world from a viewpoint.
pub(crate) struct Stage<'world> {
    pub(crate) world: &'world World,
    pub(crate) view: View,
    /// The direction of parallel rays.
    pub(crate) forward: Option<DVec3>,
    pub(crate) balls: Vec<Ball>,
    pub(crate) lamps: Vec<Lamp>,
    pub(crate) softness: Softness,
}

impl<'world> Stage<'world> {
    pub(crate) fn new(world: &'world World, view: &View) -> Self {
        let eye = view.camera.position;
        let lens = &view.lens;
        let forward = lens.is_parallel().then(|| view.camera.forward());
        let balls = world
            .spheres()
            .iter()
            .map(|sphere| Ball::new(sphere.center(), sphere.radius(), eye, forward))
            .collect();
        Self {
            world,
            view: *view,
            forward,
            balls,
            lamps: world
                .lights
                .iter()
                .map(|light| Lamp::new(light, eye))
                .collect(),
            softness: Softness::of(world),
        }
    }
}

impl Stage<'_> {
    /// A sphere without its outline.
    fn inside_outline(&self, sphere: usize) -> Option<Ball> {
        let outline = self.world.material(sphere).outline?;
        let ball = &self.balls[sphere];
        if ball.has_eye_inside() || ball.cut_radius().is_some() {
            return None;
        }
        // The side of a square with the area of a pixel.
        let [width, height] = sides(&self.view);
        let pixel = (width * height).sqrt() / self.view.zoom;
        let width = match (outline.width, self.forward) {
            (OutlineWidth::Units(width), _) => width,
            (OutlineWidth::Pixels(width), Some(_)) => width * pixel,
            (OutlineWidth::Pixels(width), None) => {
                // At these angles from the center both edges are seen.
                let (distance, ahead) = (ball.center.length(), self.view.camera.forward());
                let outer = (ball.radius / distance).asin();
                let cosine = ball.center.dot(ahead).max(0.0) / distance;
                let across = width * pixel / self.view.lens.distance * cosine;
                let inner = (outer.tan() - across).atan();
                ball.radius - distance * inner.sin()
            }
        };
        self.smaller(sphere, width)
    }

    /// A ball whose radius is smaller by this amount.
    fn smaller(&self, sphere: usize, width: f64) -> Option<Ball> {
        let sphere = &self.world.spheres()[sphere];
        let radius = (sphere.radius() - width).max(0.0);
        Some(Ball::new(
            sphere.center(),
            radius,
            self.view.camera.position,
            self.forward,
        ))
    }
}

/// The width and the height of a pixel on the retina.
fn sides(view: &View) -> [f64; 2] {
    let width = view.lens.width / f64::from(view.width);
    [width, width / view.lens.pixel_aspect]
}

/// A part of a pixel: the directions `origin + s · right + t · up` for s and t in the given ranges, which are within
/// [−½, ½]. Parallel rays are given by their origins instead, relative to the viewpoint.
pub(crate) struct Patch<'stage> {
    pub(crate) stage: &'stage Stage<'stage>,
    pub(crate) key: (u32, u32, i64),
    pub(crate) origin: DVec3,
    pub(crate) right: DVec3,
    pub(crate) up: DVec3,
    pub(crate) low: DVec2,
    pub(crate) high: DVec2,
    /// The effect of rounding: the error of places along lines, in pixels, and of light. Lines of both directions share
    /// it.
    pub(crate) noise: f64,
    /// The allowed error of the integral. Lines and their parts get fractions of it.
    pub(crate) goal: f64,
    /// The allowed error of soft light at a point.
    pub(crate) fine: f64,
    /// The spheres that may be visible in it.
    pub(crate) candidates: Vec<Candidate>,
}

/// A sphere that may be visible, and for every light the spheres that may block it for the visible part.
pub(crate) struct Candidate {
    pub(crate) sphere: usize,
    pub(crate) ball: Ball,
    /// The smaller ball that rays miss if they show the outline of the sphere.
    pub(crate) inside: Option<Ball>,
    pub(crate) casters: Vec<Vec<usize>>,
    /// The spheres that may hide the sky.
    pub(crate) sky_casters: Vec<usize>,
}

impl Candidate {
    /// The balls whose contours are edges.
    pub(crate) fn contours(&self) -> impl Iterator<Item = &Ball> {
        [&self.ball].into_iter().chain(&self.inside)
    }
}

impl<'stage> Patch<'stage> {
    pub(crate) fn of_pixel(stage: &'stage Stage<'stage>, col: u32, row: u32, goal: f64) -> Self {
        let view = &stage.view;
        let mut pixel = DVec2::from_array(sides(view));
        let from_middle = DVec2::new(
            f64::from(col) + 0.5 - 0.5 * f64::from(view.width),
            0.5 * f64::from(view.height) - 0.5 - f64::from(row),
        );
        let center = view.lens.shift + from_middle * pixel;
        let axes = view.camera.world_from_camera;
        let mut origin = axes * center.extend(view.lens.distance * view.zoom);
        if stage.forward.is_some() {
            pixel /= view.zoom;
            let DVec2 { x, y } = center / view.zoom;
            origin = axes.x_axis * x + axes.y_axis * y;
        }
        let (right, up) = (axes.x_axis * pixel.x, axes.y_axis * pixel.y);
        let key = (col, row, view.frame);
        let half = DVec2::splat(0.5);
        Self::new(stage, key, [origin, right, up], (-half, half), goal)
    }

    /// The quarter on the left (0) or right (1), below (0) or above (1).
    pub(crate) fn quarter(&self, side: DVec2) -> Patch<'stage> {
        let size = 0.5 * (self.high - self.low);
        let low = self.low + size * side;
        let frame = [self.origin, self.right, self.up];
        Patch::new(self.stage, self.key, frame, (low, low + size), self.goal)
    }

    pub(crate) fn direction(&self, point: DVec2) -> DVec3 {
        self.origin + self.right * point.x + self.up * point.y
    }

    /// The point of the pixel's plane in a direction, if it is in front; with parallel rays, the projection of a point.
    pub(crate) fn project(&self, direction: DVec3) -> Option<DVec2> {
        let parts = |offset: DVec3| {
            let [right, up] = [self.right, self.up].map(|side| side / side.length_squared());
            DVec2::new(offset.dot(right), offset.dot(up))
        };
        if self.stage.forward.is_some() {
            return Some(parts(direction - self.origin));
        }
        let normal = self.right.cross(self.up);
        let scale = self.origin.dot(normal) / direction.dot(normal);
        if !(scale > 0.0 && scale.is_finite()) {
            return None;
        }
        Some(parts(direction * scale - self.origin))
    }

    fn new(
        stage: &'stage Stage<'stage>,
        key: (u32, u32, i64),
        [origin, right, up]: [DVec3; 3],
        (low, high): (DVec2, DVec2),
        goal: f64,
    ) -> Self {
        let mut patch = Self {
            stage,
            key,
            origin,
            right,
            up,
            low,
            high,
            noise: 0.0,
            goal,
            fine: FINE_SHARE * goal,
            candidates: Vec::new(),
        };
        let cone = patch.beam();
        let world_has_shadows = stage.world.shadows;
        for (sphere, ball) in stage.balls.iter().enumerate() {
            if cone.may_see(ball) {
                let casters = patch.casters(&cone, sphere);
                let sky_casters = match stage.softness.sky {
                    Some(_) if world_has_shadows => patch.others(sphere).collect(),
                    _ => Vec::new(),
                };
                patch.candidates.push(Candidate {
                    sphere,
                    ball: *ball,
                    inside: stage.inside_outline(sphere),
                    casters,
                    sky_casters,
                });
            }
        }
        // Directions are off in pixels, and normals of small, far balls in radii.
        let size = match stage.forward {
            None => origin.length(),
            Some(_) => {
                let far = |candidate: &Candidate| candidate.ball.center.length();
                let far = patch.candidates.iter().map(far).fold(0.0, f64::max);
                origin.length() + far
            }
        };
        let pixel = right.length().min(up.length()) / size;
        let ratio = |ball: &Ball| ball.center.length() / ball.radius;
        let ratios = patch
            .candidates
            .iter()
            .map(|candidate| ratio(&candidate.ball));
        patch.noise = ROUNDING * (1.0 / pixel + ratios.fold(0.0, f64::max));
        patch
    }

    fn beam(&self) -> Beam {
        let Some(forward) = self.stage.forward else {
            return Beam::Cone(self.cone());
        };
        let size = self.high - self.low;
        let diagonal = self.right * size.x + self.up * size.y;
        Beam::Cylinder(Cylinder {
            middle: self.direction(0.5 * (self.low + self.high)),
            forward,
            radius: 0.5 * diagonal.length() * (1.0 + SLACK),
        })
    }

    fn cone(&self) -> Cone {
        let axis = self.direction(0.5 * (self.low + self.high)).normalize();
        let corners = [
            self.low,
            self.high,
            DVec2::new(self.low.x, self.high.y),
            DVec2::new(self.high.x, self.low.y),
        ];
        let angles = corners.map(|corner| angle(axis, self.direction(corner)));
        let angle = angles.into_iter().fold(0.0, f64::max) * (1.0 + SLACK);
        Cone { axis, angle }
    }

    /// The spheres that reach into the beam from the part of a sphere inside the cone toward a light.
    fn casters(&self, beam: &Beam, sphere: usize) -> Vec<Vec<usize>> {
        let world = self.stage.world;
        let ball = &self.stage.balls[sphere];
        if !world.shadows || ball.has_eye_inside() {
            return vec![Vec::new(); world.lights.len()];
        }
        // The part lies around this segment, within `around` of it.
        let ([start, end], around) = beam.part_of(ball);
        let reaches = |toward: DVec3, caster: &Ball| {
            let flat = |vector: DVec3| vector - toward * vector.dot(toward);
            let (from, way) = (flat(start - caster.center), flat(end - start));
            let along = (-from.dot(way) / way.length_squared()).clamp(0.0, 1.0);
            let along = if along.is_finite() { along } else { 0.0 };
            let distance = (from + way * along).length();
            let lowest = start.dot(toward).min(end.dot(toward)) - around;
            let reach = caster.radius * (1.0 + 1e-12) + around;
            distance <= reach && caster.center.dot(toward) + reach >= lowest
        };
        let of_light = |toward: DVec3| {
            let others = self.stage.balls.iter().enumerate();
            others
                .filter(|(index, caster)| *index != sphere && reaches(toward, caster))
                // A ray that leaves a surface leaves one that coincides with it, too.
                .filter(|(_, caster)| caster.center != ball.center || caster.radius != ball.radius)
                .map(|(index, _)| index)
                .collect()
        };
        let of_sun = |sun: &Sun| {
            let radius = 0.5 * (end - start).length() + around;
            let middle = 0.5 * (start + end);
            let may_hide =
                |caster: &usize| sun.may_be_hidden(&self.stage.balls[*caster], middle, radius);
            self.others(sphere).filter(may_hide).collect()
        };
        let lamps = self.stage.lamps.iter().zip(&self.stage.softness.suns);
        let casters = lamps.map(|lamp| match lamp {
            (_, Some(sun)) => of_sun(sun),
            (Lamp::Far(toward), None) => of_light(*toward),
            // Anything may lie between.
            (Lamp::Near { .. }, None) => self.others(sphere).collect(),
        });
        casters.collect()
    }

    /// All spheres that do not coincide with one.
    fn others(&self, sphere: usize) -> impl Iterator<Item = usize> {
        let ball = &self.stage.balls[sphere];
        let others = self.stage.balls.iter().enumerate();
        others
            .filter(move |(index, _)| *index != sphere)
            .filter(|(_, other)| other.center != ball.center || other.radius != ball.radius)
            .map(|(index, _)| index)
    }
}
