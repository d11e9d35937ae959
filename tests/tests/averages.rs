//! Averages over pixels, compared with closed forms and with many center rays.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use marbles_core::{
    Angle, Average, AverageSettings, Axes, Camera, Color, Depth, Geometry, GeometrySettings, Grain,
    Lens, Material, Precision, Quantities, Quantity, Renderer, Roughness, Sphere, View, World,
};

use crate::studio::world_of;

const SIDE: u32 = 32;

fn settings(axes: Axes, tolerance: f64) -> GeometrySettings {
    GeometrySettings {
        quantities: Quantities::default(),
        depth: Depth::Axis,
        axes,
        precision: Precision::Double,
        averages: AverageSettings {
            normal: true,
            coverage: true,
            tolerance,
        },
    }
}

/// The averages in a geometry, row by row: mean normals and their errors, coverages and their errors, indices.
struct Means {
    normals: Vec<DVec3>,
    normal_errors: Vec<f64>,
    shares: Vec<f64>,
    share_errors: Vec<f64>,
    ids: Vec<u32>,
}

fn means(world: &World, view: &View, settings: &GeometrySettings) -> Means {
    let geometry = Renderer::new(world).geometry(view, settings);
    let all = |average, component| -> Vec<f64> {
        let rows = 0..geometry.height();
        rows.flat_map(|row| geometry.averages(average, component, row).unwrap())
            .collect()
    };
    let [x, y, z, normal_errors] = [0, 1, 2, 3].map(|number| all(Average::Normal, number));
    let rows = 0..geometry.height();
    Means {
        normals: (0..x.len())
            .map(|pixel| DVec3::new(x[pixel], y[pixel], z[pixel]))
            .collect(),
        normal_errors,
        shares: all(Average::Coverage, 0),
        share_errors: all(Average::Coverage, 1),
        ids: rows
            .flat_map(|row| geometry.coverage_ids(row).unwrap())
            .collect(),
    }
}

/// Parallel rays along +z; the normal of a ball then changes linearly from side to side.
#[test]
fn the_normals_of_a_ball_have_closed_means() {
    let radius = 1.25;
    let world = world_of(&[(DVec3::new(0.1, -0.2, 9.0), radius, Color::ONE)], &[]);
    let view = View {
        camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
        lens: Lens::parallel(3.0, DVec2::ZERO),
        zoom: 1.0,
        width: SIDE,
        height: SIDE,
        frame: 1,
    };
    for tolerance in [1e-2, 1e-4, 1e-7] {
        let found = means(&world, &view, &settings(Axes::World, tolerance));
        let pixel = view.pixel_size().x;
        let (mut area, mut normal, mut claimed) = (0.0, DVec3::ZERO, 0.0);
        let mut filled = 0;
        for place in 0..(SIDE * SIDE) as usize {
            let (col, row) = (
                place as u64 % u64::from(SIDE),
                place as u64 / u64::from(SIDE),
            );
            let share = found.shares[place];
            assert!(found.share_errors[place] <= tolerance);
            area += share;
            claimed += found.share_errors[place];
            if share == 0.0 {
                assert_eq!(found.ids[place], Geometry::NOTHING);
                continue;
            }
            assert_eq!(found.ids[place], 0);
            assert!(found.normal_errors[place] * share <= tolerance * 1.01);
            normal += found.normals[place] * share;
            claimed += found.normal_errors[place] * share;
            if share == 1.0 {
                filled += 1;
                let center = view.cell_center(col, row, 1);
                let expected = (center - DVec2::new(0.1, -0.2)) / radius;
                let off = (found.normals[place].truncate() - expected)
                    .abs()
                    .max_element();
                let error = found.normal_errors[place] + 1e-14;
                assert!(off <= error, "{place}: {off:e} {error:e}");
            }
        }
        assert!(filled > 450, "{filled}");
        let disc = PI * (radius / pixel).powi(2);
        assert!((area - disc).abs() <= claimed + 1e-9, "{area} {disc}");
        let expected = DVec3::new(0.0, 0.0, -2.0 / 3.0 * disc);
        let off = (normal - expected).abs().max_element();
        assert!(off <= claimed + 1e-9, "{normal} {expected}");
    }
}

/// A heap of smooth and bumpy spheres, from a camera that is turned.
fn heap() -> (World, View) {
    let mut world = World::new();
    let smooth = world.add_material(Material::MATTE_WHITE);
    let bumpy = world.add_material(Material {
        albedo: Color::splat(0.3),
        exponent: 2.5,
        roughness: Some(Roughness {
            amplitude: 0.4,
            grain: Grain::Surface(0.8),
            seed: 3,
        }),
        ..Material::MATTE_WHITE
    });
    for number in 0..12 {
        let turn = f64::from(number);
        let center = DVec3::new(
            libm::sin(turn * 2.1),
            libm::cos(turn * 1.3),
            6.0 + libm::sin(turn),
        );
        let sphere = Sphere::new(center, 0.5 + 0.05 * turn).unwrap();
        world.add_sphere(sphere, if number % 3 == 0 { bumpy } else { smooth });
    }
    let degrees = |degrees: f64| Angle::from_degrees(degrees);
    let view = View {
        camera: Camera::free(
            DVec3::new(0.2, 0.1, 0.0),
            degrees(7.0),
            degrees(-4.0),
            degrees(20.0),
        ),
        lens: Lens {
            width: 4.0,
            distance: 5.0,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0,
        width: SIDE,
        height: SIDE,
        frame: 1,
    };
    (world, view)
}

/// Rays on a side of a pixel, and the largest error of their means: an edge that crosses a pixel is wrong by less than
/// a row of rays.
const RAYS: u32 = 48;
const NEAR: f64 = 1.0 / RAYS as f64;

#[test]
fn averages_are_those_of_many_rays() {
    let (world, view) = heap();
    let many = View {
        width: SIDE * RAYS,
        height: SIDE * RAYS,
        ..view
    };
    let renderer = Renderer::new(&world);
    for axes in [Axes::World, Axes::CameraOpenCv, Axes::CameraOpenGl] {
        let found = means(&world, &view, &settings(axes, 1e-4));
        let rays = renderer.geometry(
            &many,
            &GeometrySettings {
                quantities: Quantities::default().with(Quantity::Normal),
                averages: AverageSettings::default(),
                ..settings(axes, 1e-4)
            },
        );
        let pixels = (SIDE * SIDE) as usize;
        let mut normals = vec![DVec3::ZERO; pixels];
        let mut counts = vec![[0_u32; 12]; pixels];
        for row in 0..many.height {
            let first = (row / RAYS * SIDE) as usize;
            let place = |col: usize| first + col / RAYS as usize;
            let [x, y, z] = [0, 1, 2].map(|axis| rays.values(Quantity::Normal, axis, row).unwrap());
            for (col, ((x, y), z)) in x.zip(y).zip(z).enumerate() {
                normals[place(col)] += DVec3::new(x, y, z);
            }
            for (col, id) in rays.ids(row).enumerate() {
                if id != Geometry::NOTHING {
                    counts[place(col)][id as usize] += 1;
                }
            }
        }
        let (mut mixed, mut partly) = (0, 0);
        for place in 0..pixels {
            let all = f64::from(RAYS * RAYS);
            let shares = counts[place].map(|count| f64::from(count) / all);
            let seen: f64 = shares.iter().sum();
            let most = shares.iter().copied().fold(0.0, f64::max);
            partly += i32::from(seen > 0.0 && seen < 1.0);
            mixed += i32::from(most < seen);
            let off = (found.shares[place] - most).abs();
            assert!(off <= NEAR, "{place}: share off by {off}");
            match found.ids[place] {
                Geometry::NOTHING => assert_eq!(most, 0.0),
                id => assert!(shares[id as usize] >= most - 2.0 * NEAR, "{place}: {id}"),
            }
            if seen > 0.0 {
                // Both lack the same length where little is seen.
                let off = (found.normals[place] * seen - normals[place] / all)
                    .abs()
                    .max_element();
                assert!(off <= NEAR, "{axes:?} {place}: normal off by {off}");
            }
        }
        assert!(mixed > 50 && partly > 50, "{mixed} {partly}");
    }
}

#[test]
fn what_is_not_wanted_is_not_told() {
    let (world, view) = heap();
    let mut wanted = settings(Axes::World, 1e-3);
    wanted.averages.normal = false;
    let geometry = Renderer::new(&world).geometry(&view, &wanted);
    assert!(geometry.averages(Average::Normal, 0, 0).is_none());
    assert!(geometry.averages(Average::Coverage, 0, 0).is_some());
    wanted.averages.coverage = false;
    let geometry = Renderer::new(&world).geometry(&view, &wanted);
    assert!(geometry.averages(Average::Coverage, 1, 0).is_none());
    assert!(geometry.coverage_ids(0).is_none());
}
