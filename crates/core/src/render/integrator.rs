//! The ways to average light over pixels, for a band of a picture at a time.

use super::approach::Approach;
use super::settings::Settings;
use crate::exact::areas;
use crate::exact::integrator::{Exact, GroupScratch, paint_each};
use crate::model::exposure::Exposure;
use crate::model::view::View;
use crate::model::world::World;
use crate::picture::band::Band;
use crate::picture::geometry::Written;
use crate::picture::pixel::{Method, Work};
use crate::picture::progress::{Cancelled, Progress};
use crate::picture::tile::Tile;
use crate::sampling::{self, Supersampling};
use crate::search::grid::RayPoints;
use crate::search::view_index::ViewIndex;
use crate::search::visibility::Visibility;
use crate::time::exact::ExactOverTime;
use crate::time::instants::Instants;
use crate::time::sampled::SampledOverTime;

/// An average of the light over pixels: to a tolerance or by samples, of one view or of a moving
/// camera.
pub(super) enum Integrator<'scene> {
    Exact(Box<Exact<'scene>>),
    Sampled(Box<Supersampling<'scene>>),
    ExactOverTime(Box<ExactOverTime<'scene>>),
    SampledOverTime(Box<SampledOverTime<'scene>>),
}

/// Memory that a thread works in, for band after band.
#[derive(Default)]
pub(super) struct Scratch {
    pub(super) exact: GroupScratch,
    pub(super) areas: areas::Scratch,
    pub(super) sampled: sampling::Scratch,
}

/// Facts about the spheres of a view, for others with the same view.
#[derive(Default)]
pub(super) struct Indices<'scene>(Vec<(RayPoints, ViewIndex<'scene>)>);

impl<'scene> Indices<'scene> {
    /// The index of a view for rays through such points; all views that are asked for are the same, and so are the
    /// spheres.
    fn of(
        &mut self,
        visibility: &Visibility<'scene>,
        view: &View,
        points: RayPoints,
    ) -> ViewIndex<'scene> {
        if let Some((_, known)) = self.0.iter().find(|(known, _)| *known == points) {
            return known.of(visibility);
        }
        let index = ViewIndex::new(visibility, view, points);
        self.0.push((points, index.clone()));
        index
    }
}

impl<'scene> Integrator<'scene> {
    /// The integrator that `settings` ask for.
    pub(super) fn new(
        world: &'scene World,
        visibility: &Visibility<'scene>,
        exposure: &Exposure<'scene>,
        settings: &Settings,
        indices: &mut Indices<'scene>,
    ) -> Self {
        let light = (visibility.all_lights(), visibility.sky());
        let method = Approach::of(world, light, exposure, settings).method;
        let alpha = settings.alpha;
        let view = exposure.view();
        if let Method::Samples(side) = method {
            let pixels = u64::from(view.width) * u64::from(view.height);
            let rows = pixels.saturating_mul(side.get().into());
            visibility.of_view(view).expect_rows(rows);
        }
        if let Some(motion) = exposure.motion() {
            let instants = Instants::new(visibility, view, motion, method);
            return match method {
                Method::Tolerance(tolerance) => {
                    let exact = ExactOverTime::new(world, instants, tolerance, alpha);
                    Self::ExactOverTime(Box::new(exact))
                }
                Method::Samples(samples) => {
                    let sampled = SampledOverTime::new(world, instants, samples, alpha);
                    Self::SampledOverTime(Box::new(sampled))
                }
            };
        }
        let index = indices.of(visibility, view, method.into());
        match method {
            Method::Tolerance(tolerance) => {
                let exact = Exact::of_all_light(world, view, &index, tolerance, alpha);
                exact.prepare();
                Self::Exact(Box::new(exact))
            }
            Method::Samples(samples) => {
                let sampled = Supersampling::of_all_light(world, view, &index, samples, alpha);
                Self::Sampled(Box::new(sampled))
            }
        }
    }

    /// Writes all pixels of a band, and what samples see that tell it; returns what they cost.
    pub(super) fn paint_band(
        &self,
        band: &mut Band<'_>,
        scratch: &mut Scratch,
        progress: &Progress<'_>,
        mut geometry: Option<Written<'_>>,
    ) -> Result<Work, Cancelled> {
        let Scratch { exact, sampled, .. } = scratch;
        match self {
            Self::Exact(integrator) => paint_exact(&mut [(integrator, band)], exact, progress),
            Self::Sampled(integrator) => {
                let paint = |tile, band: &mut _| {
                    let work = integrator.paint(tile, sampled, band);
                    if let Some((first, geometry)) = &mut geometry {
                        integrator.write_geometry(tile, sampled, (*first, geometry));
                    }
                    work
                };
                paint_tiles(band, progress, paint)
            }
            Self::ExactOverTime(integrator) => integrator.paint_band(band, exact, progress),
            Self::SampledOverTime(integrator) => integrator.paint_band(band, sampled, progress),
        }
    }
}

/// Writes the same band of several pictures that have the view in common, and what samples of the last one see that
/// tell it; returns what they cost.
pub(super) fn paint_bands<'scene>(
    pictures: Vec<(&Integrator<'scene>, &mut Band<'_>)>,
    scratch: &mut Scratch,
    progress: &Progress<'_>,
    mut geometry: Option<Written<'_>>,
) -> Result<Work, Cancelled> {
    let mut work = Work::default();
    let mut together: Vec<(&Exact<'_>, &mut Band<'_>)> = Vec::new();
    let last = pictures.len().saturating_sub(1);
    for (number, (integrator, band)) in pictures.into_iter().enumerate() {
        match integrator {
            Integrator::Exact(exact)
                if together
                    .first()
                    .is_none_or(|(one, _)| one.shares_index(exact)) =>
            {
                together.push((exact, band));
            }
            _ => {
                let geometry = if number == last {
                    geometry.take()
                } else {
                    None
                };
                work += integrator.paint_band(band, scratch, progress, geometry)?;
            }
        }
    }
    work += paint_exact(&mut together, &mut scratch.exact, progress)?;
    Ok(work)
}

/// Writes the same band of several pictures that have the view and its index in common, tile by tile.
fn paint_exact(
    pictures: &mut [(&Exact<'_>, &mut Band<'_>)],
    scratch: &mut GroupScratch,
    progress: &Progress<'_>,
) -> Result<Work, Cancelled> {
    let mut work = Work::default();
    let Some(area) = pictures.first().map(|(_, band)| band.area) else {
        return Ok(work);
    };
    for tile in area.tiles() {
        work += paint_each(pictures, tile, scratch);
        if progress(tile.count() * pictures.len() as u64).is_break() {
            return Err(Cancelled);
        }
    }
    Ok(work)
}

/// Writes a band tile by tile.
fn paint_tiles<'image>(
    band: &mut Band<'image>,
    progress: &Progress<'_>,
    mut paint: impl FnMut(Tile, &mut Band<'image>) -> Work,
) -> Result<Work, Cancelled> {
    let mut work = Work::default();
    for tile in band.area.tiles() {
        work += paint(tile, band);
        if progress(tile.count()).is_break() {
            return Err(Cancelled);
        }
    }
    Ok(work)
}
