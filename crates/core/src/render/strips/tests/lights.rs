//! Pictures under one light each, rendered together.

use super::*;
use crate::model::light::Light;
use crate::model::material::{Grain, Highlight, Roughness};
use crate::model::world::LightPart;

/// Balls in color on a floor, one with bumps, under twelve lights, one of which is too faint to be seen.
fn scene() -> (World, View) {
    let (mut world, view) = ball(45, 35);
    let floor = world.add_material(Material {
        albedo: Color::new(0.8, 0.5, 0.25),
        highlight: Some(Highlight {
            strength: 0.25,
            shininess: 12.0,
        }),
        ..Material::MATTE_WHITE
    });
    let rough = world.add_material(Material {
        roughness: Some(Roughness {
            amplitude: 0.25,
            grain: Grain::Surface(0.5),
            seed: 1,
        }),
        ..Material::MATTE_WHITE
    });
    for (center, radius, material) in [
        (DVec3::new(0.0, -31.0, 5.0), 30.0, floor),
        (DVec3::new(0.75, -0.5, 4.0), 0.5, floor),
        (DVec3::new(-0.75, -0.25, 4.25), 0.5, rough),
    ] {
        world.add_sphere(Sphere::new(center, radius).unwrap(), material);
    }
    world.lights.clear();
    for number in 0..12 {
        let angle = f64::from(number);
        let toward = DVec3::new(angle.sin(), 0.75, angle.cos() - 0.5);
        let faint = if number == 4 { 1e-6 } else { 0.125 };
        let intensity = faint * Color::new(1.0, 1.0, if number == 7 { 0.5 } else { 1.0 });
        world.lights.extend(Light::directional(toward, intensity));
    }
    world.ambient = Color::splat(0.0625);
    world.background = Color::new(0.25, 0.25, 0.5);
    (world, view)
}

/// The pictures under all parts of the light, and what they cost together.
fn together(world: &World, view: &View, settings: &Settings) -> (Vec<Vec<String>>, Work) {
    let renderer = Renderer::new(world);
    let renderers: Vec<Renderer<'_>> = world
        .light_parts()
        .map(|part| renderer.under(part))
        .collect();
    let renderers: Vec<&Renderer<'_>> = renderers.iter().collect();
    let (exposure, window) = (view.into(), Window::whole(view));
    let rendering = Rendering::of_each(
        &renderers,
        exposure,
        window,
        settings,
        Rendering::ROW_STEP,
        None,
    );
    let pictures: Vec<Collector> = renderers
        .iter()
        .map(|_| Collector::new(*view, Rendering::ROW_STEP))
        .collect();
    let sinks: Vec<&dyn Sink> = pictures
        .iter()
        .map(|picture| picture as &dyn Sink)
        .collect();
    let done = AtomicU64::new(0);
    let progress = |pixels| {
        done.fetch_add(pixels, Ordering::Relaxed);
        ControlFlow::Continue(())
    };
    let mut sum = Work::default();
    for work in rayon::broadcast(|_| rendering.help_each(&sinks, &progress)) {
        sum += work.unwrap();
    }
    let pixels = u64::from(view.width) * u64::from(view.height);
    assert_eq!(done.into_inner(), pixels * pictures.len() as u64);
    let pixels = pictures.into_iter();
    let pixels = pixels.map(|picture| picture.pixels.into_inner().unwrap());
    (pixels.collect(), sum)
}

fn alone(world: &World, view: &View, settings: &Settings) -> Image {
    let go = |_| ControlFlow::Continue(());
    Renderer::new(world)
        .render_with_progress(view, settings, &go)
        .unwrap()
}

fn places(view: &View) -> impl Iterator<Item = (u32, u32)> + use<> {
    let (width, height) = (view.width, view.height);
    (0..height).flat_map(move |row| (0..width).map(move |col| (col, row)))
}

#[test]
fn a_picture_under_one_light_is_that_of_the_world_with_this_light() {
    let (world, view) = scene();
    for settings in settings() {
        let (found, shared) = together(&world, &view, &settings);
        assert_eq!(found.len(), 13);
        let mut apart = Work::default();
        for (part, found) in world.light_parts().zip(found) {
            let mut only = world.clone();
            only.lights.clear();
            match part {
                LightPart::Light(index) => {
                    only.lights.push(world.lights[index]);
                    (only.ambient, only.background) = (Color::ZERO, Color::ZERO);
                }
                LightPart::Ambient | LightPart::Sky => {}
            }
            let image = alone(&only, &view, &settings);
            apart += image.work();
            let expected = places(&view).map(|(col, row)| pixel(&image, col, row));
            assert!(found.into_iter().eq(expected), "{part:?}, {settings:?}");
        }
        if matches!(settings.method, Method::Samples(_)) {
            assert_eq!(shared.samples, apart.samples);
        } else {
            // Mean normals of plain pixels are found once.
            assert!(shared.samples < apart.samples && shared.lines <= apart.lines);
            // The pixels' own spheres are sought once, their occluders under each light.
            let (shared, apart) = (shared.candidate_tests, apart.candidate_tests);
            assert!(4 * shared < 3 * apart, "{shared} of {apart}");
        }
    }
}

#[test]
fn pictures_under_one_light_each_add_up_to_the_picture() {
    let (world, view) = scene();
    for settings in settings() {
        let whole = alone(&world, &view, &settings);
        let parts = world.light_parts();
        let parts: Vec<Image> = parts
            .map(|part| alone(&world.under(part), &view, &settings))
            .collect();
        for (col, row) in places(&view) {
            let mut sum = [0.0; 3];
            let mut error = 1e-12;
            for image in parts.iter().chain([&whole]) {
                if matches!(settings.method, Method::Tolerance(_)) {
                    error += image.error(col, row);
                }
            }
            for image in &parts {
                for (sum, value) in sum.iter_mut().zip(image.rgba(col, row)) {
                    *sum += value;
                }
            }
            for (sum, expected) in sum.iter().zip(whole.rgba(col, row)) {
                assert!(
                    (sum - expected).abs() <= error,
                    "({col}, {row}): {sum}, {expected}"
                );
            }
        }
    }
}

/// Takes nothing.
struct Unwilling;

impl Sink for Unwilling {
    fn begin(&self, _index: u32) -> Option<Box<dyn Strip + '_>> {
        None
    }
}

#[test]
fn a_picture_that_is_not_wanted_ends_no_other() {
    let (world, view) = scene();
    let settings = settings()[2];
    let renderer = Renderer::new(&world);
    let parts = [LightPart::Light(2), LightPart::Light(3)].map(|part| renderer.under(part));
    let renderers = [&parts[0], &parts[1]];
    let begin = || {
        Rendering::of_each(
            &renderers,
            (&view).into(),
            Window::whole(&view),
            &settings,
            Rendering::ROW_STEP,
            None,
        )
    };
    let go = |_| ControlFlow::Continue(());
    let wanted = Collector::new(view, Rendering::ROW_STEP);
    begin().help_each(&[&Unwilling, &wanted], &go).unwrap();
    let expected = alone(&world.under(LightPart::Light(3)), &view, &settings);
    let expected = places(&view).map(|(col, row)| pixel(&expected, col, row));
    assert!(wanted.pixels.into_inner().unwrap().into_iter().eq(expected));
    assert_eq!(
        begin().help_each(&[&Unwilling, &Unwilling], &go),
        Err(Cancelled)
    );
}
