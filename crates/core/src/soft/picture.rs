//! Pixels under soft light.

use std::num::NonZeroU32;

use glam::{DMat3, DVec2, DVec3};

use super::candidate::Candidate;
use super::cell::Cells;
use super::doubt::{Extent, of_bumps, of_small_spheres};
use super::edges::Edge;
use super::light::SoftLight;
use super::of_sun::{OfSun, SunMemory, strongest_highlight};
use super::point::{Occluders, SurfacePoint};
use super::rectangle::{Cell, Integral, Light};
use super::sun::Sun;
use super::visible::Hidden;
use crate::hit::outcome::Hit;
use crate::light::shading_normal::ShadingNormal;
use crate::model::camera::Projection;
use crate::model::color::Color;
use crate::model::ray::Ray;
use crate::model::roughness::PixelKey;
use crate::model::view::View;
use crate::model::world::World;
use crate::picture::pixel::{Evidence, Method, Pixel, Status, Work};
use crate::picture::tile::Tile;
use crate::search::beyond::Beyond;
use crate::search::view_index::ViewIndex;

/// The soft light of a view of a world.
#[derive(Clone, Debug)]
pub(crate) struct Soft<'scene> {
    world: &'scene World,
    view: View,
    index: ViewIndex<'scene>,
    lights: Vec<SoftLight>,
    method: Method,
}

/// Memory for a thread.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// None before the first tile with soft light: most worlds have none.
    cells: Option<Box<Cells>>,
    of_suns: Option<Box<SunMemory>>,
    hidden: Hidden,
}

/// The points at which the light of a pixel may be computed: of a sun, and of a sky, where a point costs more.
const MOST_POINTS_OF_SUN: u64 = 20_000;
const MOST_POINTS_OF_SKY: u64 = 2_000;

impl<'scene> Soft<'scene> {
    /// The share of a tolerance that soft light has; the rest is for all other light.
    pub(crate) const SHARE: f64 = 0.5;

    /// The soft light of a world in a view, by samples or to a tolerance; none if the world has no soft light.
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
            .chain(world.sky.map(SoftLight::Sky));
        let lights: Vec<SoftLight> = lights.collect();
        (!lights.is_empty()).then(|| Self {
            world,
            view: *view,
            index: index.clone(),
            lights,
            method,
        })
    }

    /// Adds the soft light to the pixels of a tile, in the order of [`Tile::pixels`]; returns what it costs.
    pub(crate) fn add(&self, tile: Tile, scratch: &mut Scratch, pixels: &mut [Pixel]) -> Work {
        match self.method {
            Method::Samples(samples) => self.add_samples(tile, samples, scratch, pixels),
            Method::Tolerance(tolerance) => self.add_averages(tile, tolerance, scratch, pixels),
        }
    }

    fn occluders(&self) -> Option<Occluders<'_>> {
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

    fn key(&self, col: u32, row: u32) -> PixelKey {
        PixelKey {
            col,
            row,
            frame: self.view.frame,
        }
    }

    /// The point that a ray meets; none inside of a sphere, which no light reaches, and on outlines.
    fn point(&self, sphere: usize, ray: &Ray, hit: &Hit, key: PixelKey) -> Option<SurfacePoint> {
        if hit.inner_side {
            return None;
        }
        let normal = hit.normal;
        let shading = ShadingNormal::new(self.world, sphere, key).of(normal);
        Some(SurfacePoint {
            position: ray.at(hit.t),
            normal,
            shading,
            to_eye: -ray.direction.normalize(),
            sphere,
        })
    }

    /// The radius of the sphere that a ray has to meet to miss the outline, in the units of a candidate's radius.
    fn inner_radius(&self, sphere: usize, center: DVec3, radius: f64) -> Option<f64> {
        let outline = self.world.material(sphere).outline?;
        let view = self.view.outline_view();
        if view.projection == Projection::Parallel && center.z < radius {
            return None;
        }
        Some(outline.width.inner_radius(view, center, radius))
    }

    /// True if a ray meets the outline of a sphere that it hits.
    fn is_outline(&self, sphere: usize, ray: &Ray, hit: &Hit) -> bool {
        let of = &self.world.spheres()[sphere];
        let center = self.camera_from_world() * (of.center() - self.view.camera.position);
        let Some(inner) = self.inner_radius(sphere, center, of.radius()) else {
            return false;
        };
        let limit = (of.radius() - inner) * (of.radius() + inner) / (of.radius() * of.radius());
        let along = hit.normal.dot(ray.direction);
        along * along < ray.direction.length_squared() * limit
    }

    fn camera_from_world(&self) -> DMat3 {
        self.view.camera.world_from_camera.transpose()
    }

    fn light_at(&self, point: &SurfacePoint, hidden: &mut Hidden) -> Color {
        let occluders = self.occluders();
        let lights = self.lights.iter();
        lights
            .map(|light| light.at(point, self.world, occluders.as_ref(), hidden))
            .sum()
    }

    /// The mean over N × N samples of each pixel.
    fn add_samples(
        &self,
        tile: Tile,
        samples: NonZeroU32,
        scratch: &mut Scratch,
        pixels: &mut [Pixel],
    ) -> Work {
        let side = u64::from(samples.get());
        let count = (side * side) as f64;
        for ((col, row), pixel) in tile.pixels().zip(pixels) {
            let key = self.key(col, row);
            let (mut sum, mut least, mut most) = (Color::ZERO, Color::INFINITY, Color::ZERO);
            for place in 0..side * side {
                let (x, y) = (place % side, place / side);
                let cell = (u64::from(col) * side + x, u64::from(row) * side + y);
                let ray = self
                    .view
                    .ray(self.view.cell_center(cell.0, cell.1, samples.get()));
                let light = match self.index.nearest(tile, &ray) {
                    Some((sphere, hit)) if !self.is_outline(sphere, &ray, &hit) => {
                        let point = self.point(sphere, &ray, &hit, key);
                        point.map(|point| self.light_at(&point, &mut scratch.hidden))
                    }
                    _ => None,
                };
                let light = light.unwrap_or_default();
                sum += light;
                least = least.min(light);
                most = most.max(light);
            }
            pixel.value += sum / count;
            pixel.error += (most - least).max_element() / (2.0 * side as f64);
            pixel.evidence = Evidence::Estimate;
        }
        Work::default()
    }

    /// The averages over pixels.
    fn add_averages(
        &self,
        tile: Tile,
        tolerance: f64,
        scratch: &mut Scratch,
        pixels: &mut [Pixel],
    ) -> Work {
        let candidates = self.candidates(tile);
        let Scratch {
            cells,
            of_suns,
            hidden,
        } = scratch;
        let of_suns = of_suns.get_or_insert_default();
        let cells = cells.get_or_insert_default();
        let before = cells.points;
        let share = Self::SHARE * tolerance / self.lights.len() as f64;
        let projection = self.view.lens.projection();
        for light in &self.lights {
            cells.begin();
            let in_camera = match light {
                SoftLight::Sun(sun) => Some(sun.turned(&self.camera_from_world())),
                SoftLight::Sky(_) => None,
            };
            let casters = match (&in_camera, &candidates) {
                (Some(sun), Some(candidates)) => self.casters(tile, sun, candidates),
                _ => Vec::new(),
            };
            for ((col, row), pixel) in tile.pixels().zip(&mut *pixels) {
                let key = self.key(col, row);
                let cell = (self.cell(col, row), projection);
                let average = match (&candidates, &in_camera) {
                    // Numbers that are too extreme.
                    (None, _) => Integral {
                        value: Color::ZERO,
                        error: brightest(self.world, light),
                    },
                    (Some(candidates), Some(sun)) => {
                        let mut of_sun = OfSun {
                            world: self.world,
                            sun,
                            world_from_camera: &self.view.camera.world_from_camera,
                            projection,
                            key,
                            casters: &casters,
                            memory: of_suns,
                            hidden,
                        };
                        let most = MOST_POINTS_OF_SUN;
                        cells.average(&mut of_sun, cell, candidates, (share, most))
                    }
                    (Some(candidates), None) => {
                        let mut of_pixel = OfPixel {
                            soft: self,
                            light,
                            key,
                            hidden,
                            projection,
                        };
                        let most = MOST_POINTS_OF_SKY;
                        cells.average(&mut of_pixel, cell, candidates, (share, most))
                    }
                };
                pixel.value += average.value;
                pixel.error += average.error;
                pixel.evidence = pixel.evidence.min(Evidence::Estimate);
            }
        }
        for pixel in pixels {
            if pixel.error <= tolerance {
                pixel.status = Status::Met;
            } else if pixel.status == Status::Met {
                pixel.status = Status::OutOfBudget;
            }
        }
        Work {
            samples: cells.points - before,
            ..Work::default()
        }
    }

    /// For each candidate of a tile what may hide a sun from what the tile sees of it, in the camera's frame.
    fn casters(&self, tile: Tile, sun: &Sun, candidates: &[Candidate]) -> Vec<Vec<Edge>> {
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
    fn candidates(&self, tile: Tile) -> Option<Vec<Candidate>> {
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
                (!ball.is_odd()).then(|| Candidate::new(ball, number, &camera_from_world, inner))
            })
            .collect()
    }

    /// The cell of a pixel. Pixels beside each other have the numbers of their edge in common.
    fn cell(&self, col: u32, row: u32) -> Cell {
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
    fn unit_of_cells(&self) -> f64 {
        match self.view.lens.projection() {
            Projection::Central => 1.0 / self.view.magnification(),
            Projection::Parallel => libm::scalbn(
                1.0 / self.view.magnification(),
                -self.index.length_exponent(),
            ),
        }
    }

    fn ray(&self, place: DVec2) -> Ray {
        self.view.ray(place / self.unit_of_cells())
    }
}

/// The light of one kind in one pixel.
struct OfPixel<'a, 'scene> {
    soft: &'a Soft<'scene>,
    light: &'a SoftLight,
    key: PixelKey,
    hidden: &'a mut Hidden,
    projection: Projection,
}

/// A bound of the light of any surface.
fn brightest(world: &World, light: &SoftLight) -> f64 {
    light.brightest().max_element() * (1.0 + strongest_highlight(world))
}

impl OfPixel<'_, '_> {
    fn brightest_light(&self) -> f64 {
        brightest(self.soft.world, self.light)
    }

    fn point(&self, candidate: &Candidate, place: DVec2) -> Option<SurfacePoint> {
        let ray = self.soft.ray(place);
        let hit = self.soft.world.spheres()[candidate.sphere].hit_from_viewpoint(&ray)?;
        self.soft.point(candidate.sphere, &ray, &hit, self.key)
    }
}

impl Light for OfPixel<'_, '_> {
    fn at(&mut self, candidate: &Candidate, place: DVec2) -> Option<Color> {
        let point = self.point(candidate, place)?;
        let occluders = self.soft.occluders();
        Some(
            self.light
                .at(&point, self.soft.world, occluders.as_ref(), self.hidden),
        )
    }

    fn doubt(&mut self, candidate: &Candidate, cell: &Cell, _spacing: f64) -> f64 {
        let soft = self.soft;
        let scale = libm::scalbn(1.0, soft.index.length_exponent());
        let extent = Extent::new(candidate, [cell.u, cell.v], self.projection);
        let axes = &soft.view.camera.world_from_camera;
        let extent = extent.in_world(axes, soft.view.camera.position, scale);
        let normal = ShadingNormal::new(soft.world, candidate.sphere, self.key);
        let of_spheres = of_small_spheres(&extent, candidate.sphere, soft.occluders().as_ref());
        of_bumps(&extent, &normal).max(of_spheres) * self.brightest_light()
    }

    fn is_shared(&self, candidate: &Candidate) -> bool {
        let normal = ShadingNormal::new(self.soft.world, candidate.sphere, self.key);
        !matches!(normal, ShadingNormal::Factors(_))
    }

    fn brightest(&self) -> f64 {
        self.brightest_light()
    }

    fn may_see(&self, candidate: &Candidate, cell: &Cell) -> bool {
        candidate.may_be_in(cell.u, cell.v, self.projection)
    }
}
