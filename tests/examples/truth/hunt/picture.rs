//! Pictures of the light of a scene, in the unit of the reference pictures.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use glam::{DVec3, DVec4};
use marbles_core::{Image, LightPart, Method, Renderer, Settings, View, Work, World};
use marbles_scene::Scene;

/// The part of a scene that a picture shows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mode {
    /// Whether there is alpha instead of a background.
    pub(super) alpha: bool,
    /// Whether it shows only the first light.
    pub(super) per_light: bool,
    /// The brightness of the light, as a multiple of that in the reference scene.
    pub(super) light: f64,
    /// The factor by which an error of alpha counts as an error of light, in the unit of reference pictures.
    pub(super) of_alpha: f64,
}

/// A picture whose light and claims are in the unit of reference pictures.
pub(super) struct Picture {
    image: Image,
    mode: Mode,
}

impl Picture {
    /// The picture by a method whose tolerance is in the unit of reference pictures.
    /// `None` if it takes longer than `patience`.
    pub(super) fn of(
        scene: &Scene,
        view: &View,
        mode: Mode,
        method: Method,
        patience: Option<Duration>,
    ) -> Option<Self> {
        let settings = Settings {
            method: match method {
                Method::Tolerance(tolerance) => Method::Tolerance(tolerance * mode.light),
                method @ Method::Samples(_) => method,
            },
            alpha: mode.alpha,
        };
        let start = Instant::now();
        let go = |_| match patience {
            Some(patience) if start.elapsed() > patience => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        };
        let mut renderer = Renderer::new(scene.world());
        if let Some(part) = mode.part(scene.world()) {
            renderer = renderer.under(part);
        }
        let image = renderer
            .render_with_progress(scene.exposure(view), &settings, &go)
            .ok()?;
        Some(Self { image, mode })
    }

    /// The work of rendering it.
    pub(super) fn work(&self) -> Work {
        self.image.work()
    }

    pub(super) fn columns(&self) -> u32 {
        self.image.width()
    }

    pub(super) fn rows(&self) -> u32 {
        self.image.height()
    }

    /// All columns and rows.
    pub(super) fn places(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let (columns, rows) = (self.columns(), self.rows());
        (0..columns * rows).map(move |place| (place % columns, place / columns))
    }

    /// The light of a pixel with its background; or the light of its spheres, and its alpha as light.
    pub(super) fn value(&self, col: u32, row: u32) -> DVec4 {
        let value = DVec4::from_array(self.image.rgba(col, row));
        let alpha = if self.mode.alpha {
            value.w * self.mode.of_alpha
        } else {
            0.0
        };
        (value.truncate() / self.mode.light).extend(alpha)
    }

    /// The error that a pixel claims.
    pub(super) fn claimed(&self, col: u32, row: u32) -> f64 {
        self.image.error(col, row) / self.mode.light
    }

    /// Returns whether a pixel is reported as over its tolerance.
    pub(super) fn is_over(&self, col: u32, row: u32) -> bool {
        self.image.status(col, row).is_over_tolerance()
    }
}

impl Mode {
    /// The part of the light that the picture shows, if it is not all of it.
    pub(super) fn part(self, world: &World) -> Option<LightPart> {
        match world.lights.is_empty() {
            _ if !self.per_light => None,
            true => Some(LightPart::Ambient),
            false => Some(LightPart::Light(0)),
        }
    }

    /// The mode of a scene whose light is brighter than that of the reference scene by this factor.
    pub(super) fn of(scene: &Scene, alpha: bool, per_light: bool, light: f64) -> Self {
        let mut mode = Self {
            alpha,
            per_light,
            light,
            of_alpha: 1.0,
        };
        let part = mode.part(scene.world());
        let part = part.map(|part| scene.world().under(part));
        mode.of_alpha = unit(part.as_ref().unwrap_or(scene.world())) / light;
        mode
    }
}

/// The smallest power of two that is not below the contrast of a world: the factor on errors of alpha.
fn unit(world: &World) -> f64 {
    let lights = world.lights.iter().map(marbles_core::Light::intensity);
    let outlines = world
        .materials()
        .iter()
        .filter_map(|it| Some(it.outline?.color));
    let largest = |sum: f64, light: DVec3| sum + light.max_element();
    let contrast = lights
        .chain([world.ambient, world.background])
        .fold(0.0, largest)
        + outlines.map(DVec3::max_element).fold(0.0, f64::max);
    if contrast > 0.0 {
        libm::exp2(libm::ceil(libm::log2(contrast)))
    } else {
        1.0
    }
}
