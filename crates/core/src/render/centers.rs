//! The geometry that the rays through the centers of pixels see, beside the samples of a picture or apart from its light,
//! and averages over what pixels see.

use std::num::NonZeroU32;

use super::averages::Averager;
use super::integrator::{Integrator, Scratch};
use super::renderer::Renderer;
use crate::model::exposure::Exposure;
use crate::model::view::View;
use crate::picture::geometry::{Geometry, Written};
use crate::picture::pixel::Work;
use crate::picture::quantities::GeometrySettings;
use crate::picture::tile::Tile;
use crate::sampling::Supersampling;
use crate::search::grid::RayPoints;
use crate::search::view_index::ViewIndex;

/// The rays through the centers of a picture's pixels.
pub(super) struct Centers<'scene> {
    pub(super) settings: GeometrySettings,
    /// `None` where the picture's own samples are these rays.
    apart: Option<Box<Supersampling<'scene>>>,
    averages: Averager<'scene>,
}

impl<'scene> Centers<'scene> {
    /// An integrator and the center rays of its exposure, which its samples may be.
    pub(super) fn with(
        renderer: &'scene Renderer<'_>,
        exposure: &Exposure<'_>,
        integrator: Integrator<'scene>,
        settings: GeometrySettings,
    ) -> (Integrator<'scene>, Option<Self>) {
        let averages = Averager::new(renderer, exposure.view(), &settings);
        let (integrator, apart) = match integrator {
            Integrator::Sampled(samples) if samples.is_one() => {
                let samples = samples.with_geometry(settings);
                (Integrator::Sampled(Box::new(samples)), None)
            }
            other => {
                let centers = renderer.centers(exposure.view(), settings);
                (other, Some(Box::new(centers)))
            }
        };
        let centers = Self {
            settings,
            apart,
            averages,
        };
        (integrator, Some(centers))
    }

    /// Writes what the pixels of a rectangle as high as a tile see; returns what that costs.
    pub(super) fn see(&self, area: Tile, scratch: &mut Scratch, written: Written<'_>) -> Work {
        let (first, geometry) = written;
        let mut work = Work::default();
        if let Some(apart) = &self.apart {
            for tile in area.tiles() {
                work += apart.see(tile, &mut scratch.sampled, (first, geometry));
            }
        }
        work += self.averages.see(area, scratch, (first, geometry));
        work
    }
}

impl Renderer<'_> {
    /// Renders the geometry that the rays through the centers of a view's pixels see, without its light.
    pub fn geometry(&self, view: &View, settings: &GeometrySettings) -> Geometry {
        let centers = Centers {
            settings: *settings,
            apart: Some(Box::new(self.centers(view, *settings))),
            averages: Averager::new(self, view, settings),
        };
        let mut geometry = Geometry::new((view.width, view.height), settings, None);
        let mut scratch = Scratch::default();
        for row in (0..view.height).step_by(Tile::SIDE as usize) {
            let band = Tile {
                col: 0,
                row,
                width: view.width,
                height: Tile::SIDE.min(view.height - row),
            };
            centers.see(band, &mut scratch, ((0, 0), &mut geometry));
        }
        geometry
    }

    fn centers(&self, view: &View, settings: GeometrySettings) -> Supersampling<'_> {
        let (world, visibility) = self.parts();
        let points = RayPoints::Midpoints(NonZeroU32::MIN);
        let index = ViewIndex::new(visibility, view, points);
        Supersampling::of_centers(world, view, &index, settings)
    }
}
