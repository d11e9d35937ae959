//! The loop over the tiles of a picture.

use crate::picture::pixel::Cancelled;
use crate::picture::pixel::Method;
use std::ops::ControlFlow;
use std::sync::Arc;

use rayon::iter::{IndexedParallelIterator, ParallelIterator};

use crate::exact::Exact;
use crate::model::exposure::{Exposure, Motion};
use crate::model::view::View;
use crate::model::world::World;
use crate::picture::image::{Channels, Image};
use crate::picture::image::{Form, Prospect};
use crate::picture::integrator::Integrator;
use crate::picture::pixel::Work;
use crate::picture::tile::Tile;
use crate::sampling::Supersampling;
use crate::search::Visibility;
use crate::search::seen::Seen;
use crate::time::exact::ExactOverTime;
use crate::time::instants::Instants;
use crate::time::sampled::SampledOverTime;

/// How a picture is rendered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How pixels are averaged.
    pub method: Method,
    /// Whether the background is left out and coverage kept as an alpha channel.
    pub alpha: bool,
}

/// A world that is ready to be rendered: what does not depend on the view is done once.
#[derive(Clone, Debug)]
pub struct Renderer<'world> {
    world: &'world World,
    visibility: Visibility<'world>,
}

impl<'world> Renderer<'world> {
    /// Prepares a world.
    pub fn new(world: &'world World) -> Self {
        Self {
            world,
            visibility: Visibility::new(world),
        }
    }

    /// Renders what a view sees of the world, or a camera that moves while the shutter is open, on the
    /// threads of the current rayon pool.
    ///
    /// The picture does not depend on the number of threads. `progress` is called, from any of
    /// them, with the number of pixels that were just finished; when it breaks, the rendering ends
    /// soon. A world without color makes a picture with one channel.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` broke.
    pub fn render<'motion>(
        &self,
        exposure: impl Into<Exposure<'motion>>,
        settings: &Settings,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Image, Cancelled> {
        self.render_over(None, exposure, settings, progress)
    }

    /// Renders as [`Self::render`] does, in the memory of a picture that nobody needs any more:
    /// memory that was just written is several times as quick as what the system hands out.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` broke.
    pub fn render_over<'motion>(
        &self,
        spent: Option<Image>,
        exposure: impl Into<Exposure<'motion>>,
        settings: &Settings,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Image, Cancelled> {
        self.picture(spent, &exposure.into(), settings, progress)
    }

    /// What [`Self::render_over`] does: not generic, so that integrators are compiled here, once.
    fn picture(
        &self,
        spent: Option<Image>,
        exposure: &Exposure<'_>,
        settings: &Settings,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Image, Cancelled> {
        self.run(exposure, settings, Whole { spent, progress })
    }

    /// Prepares the integrator that `settings` ask for, and has the job done with it.
    pub(crate) fn run<'a, J: Job<'a>>(
        &'a self,
        exposure: &Exposure<'a>,
        settings: &Settings,
        job: J,
    ) -> J::Output {
        let view = exposure.view();
        if let Some(motion) = exposure.motion() {
            return self.run_over_time(view, motion, settings, job);
        }
        let visibility = &self.visibility;
        let seen = match settings.method {
            Method::Samples(samples) => Seen::by_samples(visibility, view, Tile::SIDE, samples),
            Method::Tolerance(_) => Seen::new(visibility, view, Tile::SIDE),
        };
        let world = self.world;
        let alpha = settings.alpha;
        let form = self.form(view, settings);
        match settings.method {
            Method::Samples(samples) => {
                let integrator = Supersampling::new(world, view, &seen, samples, alpha);
                job.run(form, integrator)
            }
            Method::Tolerance(tolerance) => {
                let integrator = Exact::new(world, view, &seen, tolerance, alpha);
                job.run(form, integrator)
            }
        }
    }

    /// Has the job done with what a moving camera sees.
    fn run_over_time<'a, J: Job<'a>>(
        &'a self,
        view: &View,
        motion: Arc<dyn Motion + 'a>,
        settings: &Settings,
        job: J,
    ) -> J::Output {
        let (world, alpha) = (self.world, settings.alpha);
        let form = self.form(view, settings);
        let instants = Instants::new(&self.visibility, view, motion, settings.method);
        match settings.method {
            Method::Samples(samples) => {
                let integrator = SampledOverTime::new(world, instants, samples, alpha);
                job.run(form, integrator)
            }
            Method::Tolerance(tolerance) => {
                let integrator = ExactOverTime::new(world, instants, tolerance, alpha);
                job.run(form, integrator)
            }
        }
    }

    fn form(&self, view: &View, settings: &Settings) -> Form {
        Form {
            size: (view.width, view.height),
            channels: Channels::of(self.world, settings.alpha),
            alpha: settings.alpha,
            prospect: match settings.method {
                Method::Samples(samples) => Supersampling::prospect(samples),
                Method::Tolerance(_) => Prospect {
                    error: None,
                    ending: None,
                },
            },
        }
    }
}

/// What is done with an integrator.
pub(crate) trait Job<'a> {
    type Output;

    /// Renders a picture of this form.
    fn run<I: Integrator + 'a>(self, form: Form, integrator: I) -> Self::Output;
}

/// A picture in one piece.
struct Whole<'a> {
    /// A picture in whose memory it may be.
    spent: Option<Image>,
    progress: &'a (dyn Fn(u64) -> ControlFlow<()> + Sync),
}

impl<'a> Job<'a> for Whole<'_> {
    type Output = Result<Image, Cancelled>;

    fn run<I: Integrator + 'a>(self, form: Form, integrator: I) -> Self::Output {
        let mut image = Image::new(form, self.spent);
        // One by one: bands differ in what they cost, and threads that wait for the last take longer than
        // all handing over.
        let bands = image.bands_mut(Tile::SIDE).with_max_len(1);
        let bands = bands.map(|mut band| {
            integrator.paint_band(&mut band, &mut I::Room::default(), self.progress)
        });
        let add = |mut sum: Work, work| {
            sum += work;
            Ok(sum)
        };
        let work = bands.try_reduce(Work::default, add)?;
        image.set_work(work);
        Ok(image)
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;
    use std::sync::atomic::{AtomicU64, Ordering};

    use glam::{DVec2, DVec3};

    use super::*;
    use crate::model::camera::{Camera, Lens};
    use crate::model::color::Color;
    use crate::model::light::DirectionalLight;
    use crate::model::material::Material;
    use crate::model::sphere::Sphere;
    use crate::numeric::angle::Angle;
    use crate::picture::pixel::Status;

    fn ball() -> (World, View, Settings) {
        let mut world = World::new();
        let white = world.add_material(Material::MATTE_WHITE);
        world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0).unwrap(), white);
        world
            .lights
            .extend(DirectionalLight::new(-DVec3::Z, Color::ONE));
        let view = View {
            camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
            lens: Lens {
                width: 3.0,
                distance: 5.0,
                shift: DVec2::ZERO,
            },
            zoom: 1.0,
            width: 37,
            height: 21,
            frame: 1,
        };
        let samples = NonZeroU32::new(2).unwrap();
        (
            world,
            view,
            Settings {
                method: Method::Samples(samples),
                alpha: false,
            },
        )
    }

    #[test]
    fn progress_counts_every_pixel_once() {
        let (world, view, settings) = ball();
        let done = AtomicU64::new(0);
        let count = |pixels| {
            done.fetch_add(pixels, Ordering::Relaxed);
            ControlFlow::Continue(())
        };
        let image = Renderer::new(&world)
            .render(&view, &settings, &count)
            .unwrap();
        assert_eq!(done.into_inner(), 37 * 21);
        assert_eq!(image.summary().pixels, 37 * 21);
        assert_eq!(image.status(36, 20), Status::NoTolerance);
    }

    #[test]
    fn breaking_progress_cancels() {
        let (world, view, settings) = ball();
        assert_eq!(
            Renderer::new(&world).render(&view, &settings, &|_| ControlFlow::Break(())),
            Err(Cancelled)
        );
    }

    #[test]
    fn nothing_of_a_spent_picture_shows() {
        let (mut world, view, settings) = ball();
        world.background = Color::new(0.5, 0.25, 0.125);
        let go = |_| ControlFlow::Continue(());
        let tolerance = Settings {
            method: Method::Tolerance(1e-3),
            alpha: true,
        };
        let small = View {
            width: 12,
            height: 9,
            ..view
        };
        let grey = World::new();
        let orders = [(&world, settings), (&grey, settings), (&world, tolerance)];
        let mut spent = None;
        for (first, second) in [(0, 1), (1, 2), (2, 0), (0, 2), (2, 1), (1, 0)] {
            for view in [view, small] {
                for (world, settings) in [orders[first], orders[second]] {
                    let renderer = Renderer::new(world);
                    let fresh = renderer.render(&view, &settings, &go).unwrap();
                    let image = renderer.render_over(spent, &view, &settings, &go).unwrap();
                    assert_eq!(image, fresh);
                    spent = Some(image);
                }
            }
        }
    }

    #[test]
    fn grey_and_colored_rendering_agree_to_the_bit() {
        let (mut world, view, settings) = ball();
        let go = |_| ControlFlow::Continue(());
        let grey = Renderer::new(&world).render(&view, &settings, &go).unwrap();
        // A second light behind the ball adds color to the world, but none to the picture.
        world
            .lights
            .extend(DirectionalLight::new(DVec3::Z, Color::X));
        let colored = Renderer::new(&world).render(&view, &settings, &go).unwrap();
        assert_eq!(
            (grey.channels(), colored.channels()),
            (Channels::Grey, Channels::Rgb)
        );
        for row in 0..view.height {
            for col in 0..view.width {
                assert_eq!(grey.rgba(col, row), colored.rgba(col, row));
            }
        }
    }

    #[test]
    fn albedos_of_their_own_look_as_those_of_materials() {
        let (_, view, mut settings) = ball();
        let (mut painted, mut plain) = (World::new(), World::new());
        let shiny = |albedo| Material {
            albedo,
            highlight: Some(crate::Highlight {
                strength: 0.5,
                shininess: 20.0,
            }),
            ..Material::MATTE_WHITE
        };
        let white = painted.add_material(shiny(Color::ONE));
        let (mut spheres, mut albedos) = (Vec::new(), Vec::new());
        for index in 0..7_u8 {
            let place = f64::from(index) - 3.0;
            let center = DVec3::new(0.4 * place, 0.2 * place, 5.0);
            let albedo = [0.125 * f32::from(index), 0.5, 1.0];
            let sphere = Sphere::new(center, 0.3).unwrap();
            spheres.push(sphere);
            albedos.push(albedo);
            let material = plain.add_material(shiny(DVec3::from_array(albedo.map(f64::from))));
            plain.add_sphere(sphere, material);
        }
        painted.add_spheres(spheres, white, Some(crate::Albedos::Each(albedos)));
        for world in [&mut painted, &mut plain] {
            world.ambient = Color::new(0.1, 0.2, 0.3);
            let light = DirectionalLight::new(DVec3::new(-1.0, 1.0, -1.0), Color::ONE);
            world.lights.extend(light);
        }
        let go = |_| ControlFlow::Continue(());
        for method in [settings.method, Method::Tolerance(1e-3)] {
            settings.method = method;
            let [one, other] = [&painted, &plain]
                .map(|world| Renderer::new(world).render(&view, &settings, &go).unwrap());
            for row in 0..view.height {
                for col in 0..view.width {
                    assert_eq!(one.rgba(col, row), other.rgba(col, row), "{method:?}");
                }
            }
        }
    }
}
