//! Averages over what pixels see of spheres: which one they see most of, and its mean normal.

use glam::{DMat3, DVec3};

use super::integrator::Scratch;
use super::renderer::Renderer;
use crate::exact::areas::Areas;
use crate::exact::integrator::Exact;
use crate::model::view::View;
use crate::numeric::pair::both;
use crate::picture::averages::Coverage;
use crate::picture::geometry::{Geometry, Written};
use crate::picture::pixel::{Method, Pixel, Work};
use crate::picture::quantities::{Axes, GeometrySettings};
use crate::picture::tile::Tile;
use crate::search::view_index::ViewIndex;

/// Averages over the pixels of a view, as far as they are wanted.
pub(super) struct Averager<'scene> {
    normals: Option<Box<MeanNormals<'scene>>>,
    areas: Option<Box<Areas<'scene>>>,
}

/// The means of normals.
///
/// A component of a normal is what a matte white surface reflects of a light in the direction of that axis, less what
/// it reflects of one in the other direction. So these means are pictures, which the integrator makes.
struct MeanNormals<'scene> {
    /// Toward the axes of the world, and away from them.
    sides: [Exact<'scene>; 2],
    /// The wanted axes from the world's.
    axes: DMat3,
    /// The factor by which errors may be larger in them.
    spread: f64,
}

/// A mean is the quotient of three integrals, each of which has this share of the error: it is within the tolerance
/// divided by the part of the pixel that is seen.
const SHARE: f64 = 1.0 / 3.0;

/// The greatest sum of the components of a unit vector: errors may add up to so many times as much in turned axes.
const TURNED: f64 = 1.7320508075688774;

impl<'scene> Averager<'scene> {
    pub(super) fn new(
        renderer: &'scene Renderer<'_>,
        view: &View,
        settings: &GeometrySettings,
    ) -> Self {
        let wanted = &settings.averages;
        let (world, visibility) = renderer.parts();
        let index = || ViewIndex::new(visibility, view, Method::Tolerance(wanted.tolerance).into());
        let normals = wanted.normal.then(|| {
            let spread = match settings.axes {
                Axes::World => 1.0,
                Axes::CameraOpenCv | Axes::CameraOpenGl => TURNED,
            };
            let tolerance = wanted.tolerance * SHARE / spread;
            let [above, below] = renderer.normals();
            let sides = both([above, below], |side| {
                let visibility = visibility.with_lights(side, side.lights.as_slice().into());
                let index = index().of(&visibility);
                Exact::new(side, view, &index, tolerance, true)
            });
            let axes = axes(view, settings.axes);
            Box::new(MeanNormals {
                sides,
                axes,
                spread,
            })
        });
        let areas = wanted.coverage.then(|| {
            let areas = Areas::new(world, visibility, view, index(), wanted.tolerance);
            Box::new(areas)
        });
        Self { normals, areas }
    }

    /// Writes the averages over the pixels of a rectangle as high as a tile; returns what they cost.
    pub(super) fn see(
        &self,
        area: Tile,
        scratch: &mut Scratch,
        (first, geometry): Written<'_>,
    ) -> Work {
        let mut work = Work::default();
        let averages = geometry.averages_mut();
        for tile in area.tiles() {
            if let Some(normals) = &self.normals {
                let [forth, back] = &normals.sides;
                let mut seen: Vec<Pixel> = Vec::new();
                let write = |side: usize, pixels: &[Pixel]| {
                    if side == 0 {
                        seen.extend_from_slice(pixels);
                        return;
                    }
                    for (place, (forth, back)) in seen.iter().zip(pixels).enumerate() {
                        let normal = normals.mean(forth, back);
                        averages.put_normal((tile, place), first, normal);
                    }
                };
                work += Exact::integrate_all(&[forth, back], tile, &mut scratch.exact, write);
            }
            if let Some(areas) = &self.areas {
                areas.see_most(tile, &mut scratch.areas, |place, sphere, seen| {
                    let coverage = Coverage {
                        id: match seen.area > 0.0 {
                            true => sphere as u32,
                            false => Geometry::NOTHING,
                        },
                        share: [seen.area, seen.error],
                    };
                    averages.put_coverage((tile, place), first, coverage);
                });
            }
        }
        work
    }
}

impl MeanNormals<'_> {
    /// The mean normal of a pixel, and the error of each of its components.
    fn mean(&self, forth: &Pixel, back: &Pixel) -> [f64; 4] {
        let part = forth.alpha;
        if part <= 0.0 {
            let is_empty = forth.error == 0.0 && back.error == 0.0;
            return [0.0, 0.0, 0.0, if is_empty { 0.0 } else { 1.0 }];
        }
        let mean = (forth.value - back.value) / part;
        // Of the integral, and of the part by which it is divided; no mean is longer than 1.
        let error = (2.0 * forth.error + back.error) / part * self.spread;
        let DVec3 { x, y, z } = self.axes * mean;
        [x, y, z, error.min(2.0)]
    }
}

/// The matrix that leads from vectors of the world to those of some axes.
fn axes(view: &View, axes: Axes) -> DMat3 {
    let camera = view.camera.world_from_camera.transpose();
    let signs = match axes {
        Axes::World => return DMat3::IDENTITY,
        Axes::CameraOpenCv => DVec3::new(1.0, -1.0, 1.0),
        Axes::CameraOpenGl => DVec3::new(1.0, 1.0, -1.0),
    };
    DMat3::from_diagonal(signs) * camera
}
