//! Lines along outlines, compared with closed forms and with the tests' own integrator.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use marbles_core::{
    Angle, Camera, Color, Image, Lens, Light, LightPart, Material, Outline, OutlineWidth, Sphere,
    View, World,
};
use marbles_tests::reference::Reference;

use crate::studio::{exact_picture, looking_forward, picture, pixels};

const SIDE: u32 = 48;

fn outline(width: OutlineWidth) -> Material {
    Material {
        albedo: Color::new(0.9, 0.6, 0.3),
        outline: Some(Outline {
            width,
            color: Color::new(0.1, 0.2, 2.0),
        }),
        ..Material::MATTE_WHITE
    }
}

/// The light of a pixel.
fn light(image: &Image, col: u32, row: u32) -> Color {
    let [red, green, blue, _] = image.rgba(col, row);
    Color::new(red, green, blue)
}

/// Balls that intersect and shade each other, under two lights.
fn balls(width: OutlineWidth) -> World {
    let mut world = World::new();
    let lined = world.add_material(outline(width));
    let plain = world.add_material(Material::MATTE_WHITE);
    for (center, radius, material) in [
        ((0.0, 0.0, 10.0), 1.0, lined),
        ((1.2, 0.5, 9.6), 0.8, lined),
        ((-1.5, -0.4, 11.0), 0.9, plain),
        ((-0.2, 1.4, 9.0), 0.4, lined),
        ((0.4, -0.5, 8.2), 0.04, lined),
    ] {
        let sphere = Sphere::new(DVec3::from(center), radius).unwrap();
        world.add_sphere(sphere, material);
    }
    let lights = [
        (DVec3::new(1.0, 1.5, -1.0), 0.6),
        (DVec3::new(-1.0, 0.2, -0.5), 0.3),
    ];
    let lights =
        lights.map(|(toward, intensity)| Light::directional(toward, Color::splat(intensity)));
    world.lights.extend(lights.into_iter().flatten());
    world.ambient = Color::splat(0.1);
    world
}

/// A parallel lens with a width of one unit per column.
fn parallel(scale: f64) -> View {
    View {
        lens: Lens::parallel(f64::from(SIDE) * scale, DVec2::ZERO),
        ..looking_forward(SIDE, SIDE, 1.0)
    }
}

#[test]
fn a_ring_has_its_area() {
    for (width, ring) in [
        (OutlineWidth::Units(2.5), 15.3 * 15.3 - 12.8 * 12.8),
        (OutlineWidth::Pixels(1.5), 15.3 * 15.3 - 13.8 * 13.8),
        (OutlineWidth::Units(0.001), 15.3 * 15.3 - 15.299 * 15.299),
        (OutlineWidth::Units(99.0), 15.3 * 15.3),
    ] {
        let mut world = World::new();
        let lined = world.add_material(Material {
            albedo: Color::ZERO,
            ..outline(width)
        });
        let center = DVec3::new(0.37, -0.61, 40.0);
        world.add_sphere(Sphere::new(center, 15.3).unwrap(), lined);
        let (mut sum, mut error) = (0.0, 0.0);
        let image = exact_picture(&world, &parallel(1.0), 1e-6, false);
        for (col, row) in pixels(&image) {
            sum += light(&image, col, row).y;
            error += image.error(col, row);
        }
        let expected = 0.2 * PI * ring;
        assert!(
            (sum - expected).abs() <= error + 1e-12,
            "{sum} for {expected}, ± {error}"
        );
        assert!(error < 1e-4, "{error}");
    }
}

#[test]
fn pixels_keep_their_tolerance() {
    let far = looking_forward(SIDE, SIDE, 150.0);
    let turned = View {
        camera: Camera::free(
            DVec3::new(3.0, 0.0, 0.0),
            Angle::from_degrees(-40.0),
            Angle::from_degrees(10.0),
            Angle::ZERO,
        ),
        lens: Lens {
            distance: 40.0,
            shift: DVec2::new(4.0, 2.0),
            ..far.lens
        },
        ..far
    };
    for view in [far, turned, parallel(0.1)] {
        for width in [
            OutlineWidth::Pixels(1.5),
            OutlineWidth::Pixels(0.1),
            OutlineWidth::Units(0.2),
        ] {
            let world = balls(width);
            let reference = Reference::new(&world, &view);
            for tolerance in [1e-2, 1e-3, 1e-6] {
                let image = exact_picture(&world, &view, tolerance, false);
                let mut edges = 0;
                for (col, row) in pixels(&image) {
                    if (3 * col + 5 * row) % 11 != 0 {
                        continue;
                    }
                    let truth = reference.pixel_to(col, row, 0.02 * image.error(col, row));
                    let off = (light(&image, col, row) - truth.value.truncate())
                        .abs()
                        .max_element();
                    let claimed = image.error(col, row);
                    let place = format!("column {col}, row {row}, {width:?} at {tolerance:e}");
                    assert!(
                        off <= claimed + truth.error,
                        "off by {off:e}, claims {claimed:e}: {place}"
                    );
                    assert!(claimed <= tolerance, "claims {claimed:e}: {place}");
                    edges += u32::from(truth.has_edge);
                }
                assert!(edges > 10, "{edges} pixels with edges");
            }
        }
    }
}

#[test]
fn samples_see_the_same_lines() {
    for view in [looking_forward(SIDE, SIDE, 150.0), parallel(0.1)] {
        let world = balls(OutlineWidth::Pixels(2.5));
        let reference = Reference::new(&world, &view);
        let image = picture(&world, &view, 4, false);
        for (col, row) in pixels(&image) {
            let midpoints = reference.midpoints(col, row, 4).truncate();
            let off = (light(&image, col, row) - midpoints).abs().max_element();
            assert!(off < 1e-12, "off by {off:e} in column {col}, row {row}");
        }
    }
}

#[test]
fn lights_alone_leave_lines_black() {
    let world = balls(OutlineWidth::Pixels(2.5));
    let view = looking_forward(SIDE, SIDE, 150.0);
    let pictures: Vec<_> = world
        .light_parts()
        .map(|part| exact_picture(&world.under(part), &view, 1e-5, false))
        .collect();
    assert_eq!(world.light_parts().last(), Some(LightPart::Ambient));
    let all = exact_picture(&world, &view, 1e-5, false);
    for (col, row) in pixels(&all) {
        let sum = pictures
            .iter()
            .map(|picture| light(picture, col, row))
            .sum::<DVec3>();
        let errors = pictures
            .iter()
            .map(|picture| picture.error(col, row))
            .sum::<f64>();
        let off = (sum - light(&all, col, row)).abs().max_element();
        assert!(
            off <= errors + all.error(col, row),
            "off by {off:e} in column {col}, row {row}"
        );
    }
}

#[test]
fn there_are_no_lines_inside_of_spheres() {
    let mut world = World::new();
    let lined = world.add_material(outline(OutlineWidth::Units(0.9)));
    world.add_sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap(), lined);
    world.ambient = Color::splat(0.5);
    for (view, is_parallel) in [(looking_forward(8, 8, 8.0), false), (parallel(0.03), true)] {
        for image in [
            exact_picture(&world, &view, 1e-4, false),
            picture(&world, &view, 2, false),
        ] {
            // What parallel rays see of the sphere's front lies behind them.
            let light = light(&image, 4, 4);
            let expected = Color::new(0.45, 0.3, 0.15);
            assert!(
                (light - expected).length() < 1e-9,
                "{light}, parallel: {is_parallel}"
            );
        }
    }
}
