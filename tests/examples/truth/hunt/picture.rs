//! Pictures of a scene's light, in the unit in which judges have it.

use std::ops::ControlFlow;

use glam::{DVec3, DVec4};
use marbles_core::{Image, LightPart, Method, Renderer, Settings, View, Work, World};
use marbles_scene::Scene;

/// The part of a scene that a picture shows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mode {
    /// True for alpha in place of the background.
    pub(super) alpha: bool,
    /// True for the first light alone.
    pub(super) per_light: bool,
    /// The brightness of the light, in multiples of that of the judges' scene.
    pub(super) light: f64,
    /// An error of alpha counts as so many times as much light, in the unit of judges.
    pub(super) of_alpha: f64,
}

/// A picture; light and claims are told in the unit that judges have.
pub(super) struct Picture {
    image: Image,
    mode: Mode,
}

impl Picture {
    /// The picture by a method whose tolerance is in the unit of judges.
    pub(super) fn of(scene: &Scene, view: &View, mode: Mode, method: Method) -> Option<Self> {
        let settings = Settings {
            method: match method {
                Method::Tolerance(tolerance) => Method::Tolerance(tolerance * mode.light),
                method @ Method::Samples(_) => method,
            },
            alpha: mode.alpha,
        };
        let go = |_| ControlFlow::Continue(());
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

    /// The light of a pixel with its background; or its spheres' light, and its alpha as light.
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

    /// True if a pixel says that it is over its tolerance.
    pub(super) fn is_over(&self, col: u32, row: u32) -> bool {
        self.image.status(col, row).is_over_tolerance()
    }
}

impl Mode {
    /// The part of the light that is shown, if it is not all of it.
    pub(super) fn part(self, world: &World) -> Option<LightPart> {
        match world.lights.is_empty() {
            _ if !self.per_light => None,
            true => Some(LightPart::Ambient),
            false => Some(LightPart::Light(0)),
        }
    }

    /// The mode of a scene whose light is so many times as bright as that of judges.
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

/// The least power of two that is not below the contrast of a world: an error of alpha counts as so much light.
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
