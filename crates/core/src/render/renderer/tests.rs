//! The same picture whatever it is rendered over, gray or colored.

use std::num::NonZeroU32;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec2, DVec3};

use super::*;
use crate::model::camera::{Camera, Lens};
use crate::model::color::Color;
use crate::model::light::Light;
use crate::model::material::Material;
use crate::model::sky::Sky;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::numeric::angle::Angle;
use crate::picture::pixel::{Method, Status};

fn ball() -> (World, View, Settings) {
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0).unwrap(), white);
    world
        .lights
        .extend(Light::directional(-DVec3::Z, Color::ONE));
    let view = View {
        camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
        lens: Lens {
            width: 3.0,
            distance: 5.0,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
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
        .render_with_progress(&view, &settings, &count)
        .unwrap();
    assert_eq!(done.into_inner(), 37 * 21);
    assert_eq!(image.summary().pixels, 37 * 21);
    assert_eq!(image.status(36, 20), Status::NoTolerance);
}

#[test]
fn breaking_progress_cancels() {
    let (world, view, settings) = ball();
    assert_eq!(
        Renderer::new(&world).render_with_progress(&view, &settings, &|_| ControlFlow::Break(())),
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
    let gray = World::new();
    let orders = [(&world, settings), (&gray, settings), (&world, tolerance)];
    let mut spent = None;
    for (first, second) in [(0, 1), (1, 2), (2, 0), (0, 2), (2, 1), (1, 0)] {
        for view in [view, small] {
            for (world, settings) in [orders[first], orders[second]] {
                let renderer = Renderer::new(world);
                let fresh = renderer
                    .render_with_progress(&view, &settings, &go)
                    .unwrap();
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
    let gray = Renderer::new(&world)
        .render_with_progress(&view, &settings, &go)
        .unwrap();
    // A second light behind the ball adds color to the world, but none to the picture.
    world.lights.extend(Light::directional(DVec3::Z, Color::X));
    let colored = Renderer::new(&world)
        .render_with_progress(&view, &settings, &go)
        .unwrap();
    assert_eq!(
        (gray.channels(), colored.channels()),
        (Channels::Grey, Channels::Rgb)
    );
    for row in 0..view.height {
        for col in 0..view.width {
            assert_eq!(gray.rgba(col, row), colored.rgba(col, row));
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
        let light = Light::directional(DVec3::new(-1.0, 1.0, -1.0), Color::ONE);
        world.lights.extend(light);
    }
    let go = |_| ControlFlow::Continue(());
    for method in [settings.method, Method::Tolerance(1e-3)] {
        settings.method = method;
        let [one, other] = [&painted, &plain].map(|world| {
            Renderer::new(world)
                .render_with_progress(&view, &settings, &go)
                .unwrap()
        });
        for row in 0..view.height {
            for col in 0..view.width {
                assert_eq!(one.rgba(col, row), other.rgba(col, row), "{method:?}");
            }
        }
    }
}

#[test]
fn the_sky_of_an_exposure_is_as_good_as_the_world_s() {
    let (mut world, view, settings) = ball();
    let white = world.add_material(Material::default());
    let beside = Sphere::new(DVec3::new(1.5, -0.5, 4.0), 0.6).unwrap();
    world.add_sphere(beside, white);
    let halves = |up| Sky::in_halves(DVec3::splat(0.75), DVec3::splat(0.25), up).unwrap();
    world.sky = Some(Sky::uniform(DVec3::ONE));
    let to_a_tolerance = Settings {
        method: Method::Tolerance(1e-2),
        alpha: false,
    };
    let assert_same = |found: &Image, expected: &Image| {
        for row in 0..view.height {
            for col in 0..view.width {
                assert_eq!(found.rgba(col, row), expected.rgba(col, row));
                assert_eq!(found.error(col, row), expected.error(col, row));
            }
        }
    };
    for settings in [settings, to_a_tolerance] {
        let renderer = Renderer::new(&world);
        let alone = renderer.under(LightPart::Sky);
        for sky in [
            Sky::uniform(DVec3::splat(0.5)),
            halves(DVec3::Y),
            halves(DVec3::X),
            Sky::uniform(DVec3::ONE),
        ] {
            let exposure = Exposure::from(&view).with_sky(sky);
            let mut own = world.clone();
            own.sky = Some(sky);
            let own = Renderer::new(&own);
            let pairs = [(&renderer, &own), (&alone, &own.under(LightPart::Sky))];
            for (changed, own) in pairs {
                let found = changed.render(&exposure, &settings);
                assert_same(&found, &own.render(&view, &settings));
            }
        }
        let without = world.under(LightPart::Ambient);
        let without = Renderer::new(&without);
        let exposure = Exposure::from(&view).with_sky(halves(DVec3::Y));
        let found = without.render(&exposure, &settings);
        assert_same(&found, &without.render(&view, &settings));
    }
}
