//! Worlds, views and pictures for the tests.

use std::num::NonZeroU32;
use std::ops::ControlFlow;

use glam::{DVec2, DVec3};
use marbles_core::{
    Angle, Camera, Color, Image, Lens, Light, Material, Method, Renderer, Settings, Sphere, View,
    World,
};

pub(crate) const GREY_HALF: Color = Color::splat(0.5);

/// A matte material.
pub(crate) fn matte(albedo: Color) -> Material {
    Material {
        albedo,
        ..Material::MATTE_WHITE
    }
}

/// A world of matte balls, each with its albedo, under the given lights.
pub(crate) fn world_of(balls: &[(DVec3, f64, Color)], towards: &[DVec3]) -> World {
    let mut world = World::new();
    for &(center, radius, albedo) in balls {
        let material = world.add_material(matte(albedo));
        world.add_sphere(Sphere::new(center, radius).unwrap(), material);
    }
    let lights = towards
        .iter()
        .map(|&toward| Light::directional(toward, Color::ONE).unwrap());
    world.lights.extend(lights);
    world
}

/// Balls with their albedo as uniform light, from every side.
pub(crate) fn glowing(balls: &[(DVec3, f64, Color)]) -> World {
    let mut world = world_of(balls, &[]);
    world.ambient = Color::ONE;
    world
}

/// A camera at the origin that looks along z, with a retina of unit pixels at `distance`.
pub(crate) fn looking_forward(width: u32, height: u32, distance: f64) -> View {
    View {
        camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
        lens: Lens {
            width: f64::from(width),
            distance,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0,
        width,
        height,
        frame: 1,
    }
}

/// The view whose only pixel is pixel (col, row) of `view`.
pub(crate) fn single_pixel(view: &View, col: u32, row: u32) -> View {
    let center = view.cell_center(u64::from(col), u64::from(row), 1);
    around_retina_point(view, center, view.pixel_size().x)
}

/// The view whose only pixel is the square of side `size` around a point of `view`'s retina.
pub(crate) fn around_retina_point(view: &View, center: DVec2, size: f64) -> View {
    let lens = Lens {
        width: size,
        shift: center,
        ..view.lens
    };
    View {
        lens,
        width: 1,
        height: 1,
        ..*view
    }
}

/// The picture with `samples` × `samples` samples per pixel.
pub(crate) fn picture(world: &World, view: &View, samples: u32, alpha: bool) -> Image {
    let samples = NonZeroU32::new(samples).unwrap();
    let settings = Settings {
        method: Method::Samples(samples),
        alpha,
    };
    Renderer::new(world)
        .render_with_progress(view, &settings, &|_| ControlFlow::Continue(()))
        .unwrap()
}

/// All pixels (column, row) of an image.
pub(crate) fn pixels(image: &Image) -> impl Iterator<Item = (u32, u32)> {
    let (width, height) = (image.width(), image.height());
    (0..height).flat_map(move |row| (0..width).map(move |col| (col, row)))
}

/// The picture at a tolerance.
pub(crate) fn exact_picture(world: &World, view: &View, tolerance: f64, alpha: bool) -> Image {
    let settings = Settings {
        method: Method::Tolerance(tolerance),
        alpha,
    };
    Renderer::new(world)
        .render_with_progress(view, &settings, &|_| ControlFlow::Continue(()))
        .unwrap()
}
