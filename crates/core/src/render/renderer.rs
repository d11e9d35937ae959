//! A picture in one piece.

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use rayon::iter::{IndexedParallelIterator, ParallelIterator};

use super::approach::Approach;
use super::integrator::{Indices, Integrator, Scratch};
use super::settings::Settings;
use crate::model::exposure::Exposure;
use crate::model::light::Light;
use crate::model::world::{LightPart, World};
use crate::picture::image::{Channels, Image, Layout};
use crate::picture::pixel::Work;
use crate::picture::progress::{Cancelled, Progress};
use crate::picture::tile::Tile;
use crate::search::visibility::Visibility;

/// A world that is ready to be rendered. The work that is the same for all views is done once.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Angle, Camera, Lens, Material, Renderer, Settings, Sphere, View, World};
///
/// let mut world = World::new();
/// let white = world.add_material(Material::default());
/// world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
/// world.ambient = DVec3::splat(0.5);
/// let lens = Lens::from_field_of_view(Angle::from_degrees(40.0))?;
/// let view = View::new(Camera::default(), lens, 16, 16);
/// let image = Renderer::new(&world).render(&view, &Settings::default());
/// assert_eq!(image.rgba(8, 8)[0], 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Renderer<'world> {
    /// A copy that shares the spheres, for its light may be a part of theirs.
    pub(super) world: World,
    pub(super) visibility: Visibility<'world>,
    /// The part of the light that it renders; none where it is all.
    part: Option<LightPart>,
    /// Worlds whose light is the normals, where somebody asks for their means.
    normals: OnceLock<[World; 2]>,
}

impl<'world> Renderer<'world> {
    /// Estimates the bytes that [`Renderer::new`] takes at most, besides the memory of the world.
    ///
    /// If the system has less, `new` aborts the process, as any allocation does. A program with millions of spheres can ask
    /// the system first.
    pub fn memory_needed(world: &World) -> u64 {
        Visibility::most_bytes(world)
    }

    /// Prepares a world.
    pub fn new(world: &'world World) -> Self {
        Self {
            world: world.clone(),
            visibility: Visibility::new(world),
            part: None,
            normals: OnceLock::new(),
        }
    }

    /// Prepares the same world under a part of its light, with the spheres that this renderer prepared.
    ///
    /// Its pictures are those of [`World::under`].
    ///
    /// # Panics
    /// When there is no light with that index.
    #[must_use]
    pub fn under(&self, part: LightPart) -> Self {
        Self {
            world: self.world.under(part),
            visibility: self.visibility.under(part),
            part: Some(part),
            normals: OnceLock::new(),
        }
    }

    /// Renders a [`View`](crate::View) of the world, or an [`Exposure`] with a camera that moves while the shutter is open, on
    /// the threads of the current rayon pool.
    ///
    /// The picture does not depend on the number of threads. A world without color makes a picture with one channel.
    pub fn render<'motion>(
        &self,
        exposure: impl Into<Exposure<'motion>>,
        settings: &Settings,
    ) -> Image {
        let go_on = |_| ControlFlow::Continue(());
        match self.picture(None, &exposure.into(), settings, &go_on) {
            Ok(image) => image,
            Err(Cancelled) => unreachable!("nothing cancels it"),
        }
    }

    /// Renders as [`Self::render`] does, and reports progress.
    ///
    /// marbles calls `progress`, from any thread, with the number of pixels that it just finished. If `progress` breaks, the
    /// rendering ends soon.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` broke.
    pub fn render_with_progress<'motion>(
        &self,
        exposure: impl Into<Exposure<'motion>>,
        settings: &Settings,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Image, Cancelled> {
        self.render_over(None, exposure, settings, progress)
    }

    /// Renders as [`Self::render_with_progress`] does, in the memory of a picture that is no longer needed. This memory is
    /// several times as fast as new memory from the system.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` broke.
    pub fn render_over<'motion>(
        &self,
        spent: Option<Image>,
        exposure: impl Into<Exposure<'motion>>,
        settings: &Settings,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Image, Cancelled> {
        self.picture(spent, &exposure.into(), settings, progress)
    }

    /// Renders for [`Self::render_over`]: not generic, so that integrators are compiled here, once.
    fn picture(
        &self,
        spent: Option<Image>,
        exposure: &Exposure<'_>,
        settings: &Settings,
        progress: &Progress<'_>,
    ) -> Result<Image, Cancelled> {
        let integrator = self.integrator(exposure, settings);
        let mut image = Image::new(self.layout(exposure, settings), spent);
        // One by one: bands differ in what they cost, and threads that wait for the last take longer than
        // all handing over.
        let bands = image.bands_mut(Tile::SIDE).with_max_len(1);
        // What a band found out may serve the next one.
        let spare = Mutex::new(Vec::new());
        let bands = bands.map(|mut band| {
            let lock = || spare.lock().unwrap_or_else(PoisonError::into_inner);
            let mut scratch: Scratch = lock().pop().unwrap_or_default();
            let work = integrator.paint_band(&mut band, &mut scratch, progress, None);
            lock().push(scratch);
            work
        });
        let add = |mut sum: Work, work| {
            sum += work;
            Ok(sum)
        };
        let work = bands.try_reduce(Work::default, add)?;
        image.set_work(work);
        Ok(image)
    }

    /// The integrator that `settings` ask for.
    pub(super) fn integrator<'a>(
        &'a self,
        exposure: &Exposure<'a>,
        settings: &Settings,
    ) -> Integrator<'a> {
        self.integrator_with(exposure, settings, &mut Indices::default())
    }

    /// The same, with what was found out of this view.
    pub(super) fn integrator_with<'a>(
        &'a self,
        exposure: &Exposure<'a>,
        settings: &Settings,
        indices: &mut Indices<'a>,
    ) -> Integrator<'a> {
        let mut visibility = Cow::Borrowed(&self.visibility);
        if let Some(lights) = self.lights_of(exposure) {
            visibility = Cow::Owned(visibility.with_lights(&self.world, lights));
        }
        if let Some(sky) = exposure.sky() {
            visibility = Cow::Owned(visibility.with_sky(sky));
        }
        Integrator::new(&self.world, &visibility, exposure, settings, indices)
    }

    /// The lights of an exposure that take the place of the world's: those of the part of the light that this renders.
    fn lights_of(&self, exposure: &Exposure<'_>) -> Option<Arc<[Light]>> {
        let lights = exposure.lights()?;
        Some(match self.part {
            None => lights.into(),
            Some(LightPart::Ambient | LightPart::Sky) => Arc::new([]),
            Some(LightPart::Light(index)) => Arc::new([lights[index]]),
        })
    }

    /// The world, and what is known of it.
    pub(super) fn parts(&self) -> (&World, &Visibility<'world>) {
        (&self.world, &self.visibility)
    }

    /// The worlds whose light is how far normals turn toward the axes of the world, and away from them.
    pub(super) fn normals(&self) -> &[World; 2] {
        let of = |sign| self.world.of_normals(sign);
        self.normals.get_or_init(|| [of(1.0), of(-1.0)])
    }

    /// The picture of an exposure, without its pixels.
    pub(super) fn layout(&self, exposure: &Exposure<'_>, settings: &Settings) -> Layout {
        let view = exposure.view();
        let of_frame = self.lights_of(exposure);
        let lights = of_frame.as_deref().unwrap_or(self.visibility.all_lights());
        let sky = self.world.sky.map(|own| exposure.sky().unwrap_or(own));
        Layout {
            size: (view.width, view.height),
            channels: Channels::of(&self.world, settings.alpha),
            alpha: settings.alpha,
            uniform: Approach::of(&self.world, (lights, sky), exposure, settings).uniform,
        }
    }
}

#[cfg(test)]
mod tests;
