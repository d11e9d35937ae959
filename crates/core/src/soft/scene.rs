//! What soft light needs to know of a view of a world.

use glam::{DMat3, DVec2, DVec3};

use super::candidate::Candidate;
use super::doubt::Extent;
use super::edges::Edge;
use super::light::SoftLight;
use super::point::{Occluders, SurfacePoint};
use super::rectangle::Cell;
use super::sun::Sun;
use crate::hit::outcome::Hit;
use crate::light::shading_normal::ShadingNormal;
use crate::model::camera::Projection;
use crate::model::ray::Ray;
use crate::model::roughness::PixelKey;
use crate::model::roughness::noise::NoiseCells;
use crate::model::view::View;
use crate::model::world::World;
use crate::picture::pixel::Method;
use crate::picture::tile::Tile;
use crate::search::beyond::Beyond;
use crate::search::view_index::ViewIndex;

/// The soft light of a view of a world.
#[derive(Clone, Debug)]
pub(crate) struct Soft<'scene> {
    pub(super) world: &'scene World,
    pub(super) view: View,
    pub(super) index: ViewIndex<'scene>,
    pub(super) lights: Vec<SoftLight>,
    pub(super) method: Method,
}

impl<'scene> Soft<'scene> {
    /// The share of a tolerance that all other light has. What it leaves is for soft light.
    pub(crate) const SHARE: f64 = 0.5;

    /// The soft light of a world in a view, by samples or to a tolerance; none if no soft light shines.
    pub(crate) fn new(
        world: &'scene World,
        view: &View,
        index: &ViewIndex<'scene>,
        method: Method,
    ) -> Option<Self> {
        let suns = index
            .visibility
            .all_lights()
            .iter()
            .filter_map(|light| light.sun());
        let lights = suns
            .map(SoftLight::sun)
            .chain(index.visibility.sky().map(SoftLight::Sky));
        let lights: Vec<SoftLight> = lights.filter(SoftLight::is_bright).collect();
        (!lights.is_empty()).then(|| Self {
            world,
            view: *view,
            index: index.clone(),
            lights,
            method,
        })
    }

    pub(super) fn occluders(&self) -> Option<Occluders<'_>> {
        let hierarchy = self
            .index
            .visibility
            .hierarchy()
            .filter(|_| self.world.shadows)?;
        Some(Occluders {
            spheres: self.world.spheres(),
            hierarchy,
        })
    }

    pub(super) fn key(&self, col: u32, row: u32) -> PixelKey {
        PixelKey {
            col,
            row,
            frame: self.view.frame,
        }
    }

    /// The point that a ray meets; none inside of a sphere, which no light reaches, and on outlines.
    pub(super) fn point(
        &self,
        sphere: usize,
        ray: &Ray,
        hit: &Hit,
        key: PixelKey,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> Option<SurfacePoint> {
        if hit.inner_side {
            return None;
        }
        let normal = hit.normal;
        let shading = ShadingNormal::new(self.world, sphere, key).of(normal, noise);
        Some(SurfacePoint {
            position: ray.at(hit.t),
            normal,
            shading,
            to_eye: -ray.direction.normalize(),
            sphere,
        })
    }

    /// The radius of the sphere that a ray has to meet to miss the outline, in the units of a candidate's radius.
    pub(super) fn inner_radius(&self, sphere: usize, center: DVec3, radius: f64) -> Option<f64> {
        let outline = self.world.material(sphere).outline?;
        let view = self.view.outline_view();
        if view.projection == Projection::Parallel && center.z < radius {
            return None;
        }
        Some(outline.width.inner_radius(view, center, radius))
    }

    /// True if a ray meets the outline of a sphere that it hits.
    pub(super) fn is_outline(&self, sphere: usize, ray: &Ray, hit: &Hit) -> bool {
        let of = &self.world.spheres()[sphere];
        let center = self.camera_from_world() * (of.center() - self.view.camera.position);
        let Some(inner) = self.inner_radius(sphere, center, of.radius()) else {
            return false;
        };
        let limit = (of.radius() - inner) * (of.radius() + inner) / (of.radius() * of.radius());
        let along = hit.normal.dot(ray.direction);
        along * along < ray.direction.length_squared() * limit
    }

    pub(super) fn camera_from_world(&self) -> DMat3 {
        self.view.camera.world_from_camera.transpose()
    }

    /// For each candidate of a tile what may hide a sun from what the tile sees of it, in the camera's frame.
    pub(super) fn casters(
        &self,
        tile: Tile,
        sun: &Sun,
        candidates: &[Candidate],
    ) -> Vec<Vec<Edge>> {
        let Some(occluders) = self.occluders() else {
            return vec![Vec::new(); candidates.len()];
        };
        let scale = libm::scalbn(1.0, self.index.length_exponent());
        let axes = &self.view.camera.world_from_camera;
        let (eye, camera_from_world) = (self.view.camera.position, self.camera_from_world());
        let [first, last] = [
            self.cell(tile.col, tile.row + tile.height - 1),
            self.cell(tile.col + tile.width - 1, tile.row),
        ];
        let cell = [[first.u[0], last.u[1]], [first.v[0], last.v[1]]];
        let of = candidates.iter().map(|candidate| {
            let extent = Extent::new(candidate, cell, self.view.lens.projection());
            let extent = extent.in_world(axes, eye, scale);
            let toward = Beyond::Cone {
                apex: extent.middle,
                around: extent.around,
                axis: *axes * sun.disc.axis,
                sine: sun.disc.sine,
                cosine: sun.disc.cosine,
            };
            let mut casters = Vec::new();
            occluders.for_each_sphere(candidate.sphere, &toward, |sphere| {
                casters.push(Edge::Sphere {
                    center: camera_from_world * (sphere.center() - eye) / scale,
                    radius: sphere.radius() / scale,
                });
            });
            casters
        });
        of.collect()
    }

    /// The spheres that a tile may see; none if numbers are too extreme for doubles.
    pub(super) fn candidates(&self, tile: Tile) -> Option<Vec<Candidate>> {
        let camera_from_world = self.camera_from_world();
        let scale = libm::scalbn(1.0, -self.index.length_exponent());
        self.index
            .balls(tile)
            .enumerate()
            .map(|(number, ball)| {
                let index = ball.index as usize;
                let center = camera_from_world * ball.to_center / scale;
                let inner = self.inner_radius(index, center, ball.radius / scale);
                let inner = inner.map(|inner| inner * scale);
                let hides_light = self.world.shadows;
                (!ball.is_odd())
                    .then(|| Candidate::new(ball, number, &camera_from_world, inner, hides_light))
            })
            .collect()
    }

    /// The cell of a pixel. Pixels beside each other have the numbers of their edge in common.
    pub(super) fn cell(&self, col: u32, row: u32) -> Cell {
        let size = self.view.pixel_size();
        let edge = |index: u32, pixels: u32| (2.0 * f64::from(index) - f64::from(pixels)) * 0.5;
        let scale = self.unit_of_cells();
        let u = [col, col + 1]
            .map(|col| (edge(col, self.view.width) * size.x + self.view.lens.shift.x) * scale);
        let v = [row + 1, row]
            .map(|row| (self.view.lens.shift.y - edge(row, self.view.height) * size.y) * scale);
        Cell { u, v }
    }

    /// What lengths on the retina are multiplied by in a cell: for parallel rays cells have the units of candidates.
    pub(super) fn unit_of_cells(&self) -> f64 {
        match self.view.lens.projection() {
            Projection::Central => 1.0 / self.view.magnification(),
            Projection::Parallel => libm::scalbn(
                1.0 / self.view.magnification(),
                -self.index.length_exponent(),
            ),
        }
    }

    pub(super) fn ray(&self, place: DVec2) -> Ray {
        self.view.ray(place / self.unit_of_cells())
    }
}
