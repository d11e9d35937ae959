//! Visible areas against closed forms and against exact samples.

use std::ops::ControlFlow;

use glam::{DVec2, DVec3};

use super::*;
use crate::model::camera::{Camera, Lens};
use crate::model::material::Material;
use crate::model::sphere::Sphere;
use crate::model::world::World;
use crate::numeric::angle::Angle;
use crate::search::tests::Random;

fn view(width: u32, height: u32) -> View {
    View {
        camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
        lens: Lens {
            width: f64::from(width),
            distance: 40.0,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0,
        width,
        height,
        frame: 1,
    }
}

fn world(spheres: &[(DVec3, f64)]) -> World {
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    for &(center, radius) in spheres {
        world.add_sphere(Sphere::new(center, radius).unwrap(), white);
    }
    world
}

fn areas(world: &World, view: &View, tolerance: f64) -> Vec<VisibleArea> {
    let go_on = |_| ControlFlow::Continue(());
    let renderer = Renderer::new(world);
    renderer.visible_areas(view, tolerance, &go_on).unwrap()
}

#[test]
fn what_nothing_hides_is_seen_as_its_ellipse() {
    let view = view(40, 30);
    let spheres = [
        (DVec3::new(-6.0, 3.0, 50.0), 5.0),
        (DVec3::new(9.0, 0.0, 40.0), 0.3),
        (DVec3::new(19.0, -11.0, 45.0), 4.0),
        (DVec3::new(60.0, 0.0, 45.0), 4.0),
    ];
    let world = world(&spheres);
    for tolerance in [1e-3, 1e-5] {
        for (found, sphere) in areas(&world, &view, tolerance).iter().zip(world.spheres()) {
            let ellipse = view.contour(sphere).ellipse.unwrap();
            let off = (found.area - view.area_of(&ellipse)).abs();
            assert!(off <= found.error + 1e-9, "{off:e} {:e}", found.error);
            assert!(found.error < 200.0 * tolerance, "{:e}", found.error);
        }
    }
}

#[test]
fn areas_agree_with_exact_samples() {
    const SIDE: u32 = 16;
    let view = view(32, 32);
    let mut random = Random(5);
    for count in [3, 12, 60] {
        let mut place = |radius: f64| {
            let at = random.point() * 14.0;
            (at + DVec3::Z * 60.0, radius * (0.2 + random.number()))
        };
        let spheres: Vec<_> = (0..count)
            .map(|_| place(24.0 / f64::from(count).sqrt()))
            .collect();
        let world = world(&spheres);
        let found = areas(&world, &view, 1e-4);
        let visible: f64 = found.iter().map(|found| found.area).sum();
        assert!(visible <= 1024.0 + 1e-6 && visible > 100.0, "{visible}");
        let index = Renderer::new(&world);
        let index = ViewIndex::new(&index.visibility, &view, Method::Tolerance(1e-4).into());
        let mut counts = vec![0_u32; spheres.len()];
        for row in (0..32).step_by(8) {
            for tile in (Tile {
                col: 0,
                row,
                width: 32,
                height: 8,
            })
            .tiles()
            {
                for (col, row) in tile.pixels() {
                    for part in 0..SIDE * SIDE {
                        let col = u64::from(col * SIDE + part % SIDE);
                        let row = u64::from(row * SIDE + part / SIDE);
                        let ray = view.ray(view.cell_center(col, row, SIDE));
                        if let Some((sphere, _)) = index.nearest(tile, &ray) {
                            counts[sphere] += 1;
                        }
                    }
                }
            }
        }
        for (sphere, (found, points)) in found.iter().zip(&counts).enumerate() {
            let by_points = f64::from(*points) / f64::from(SIDE * SIDE);
            let around = 8.0 * spheres[sphere].1;
            let doubt = 0.1 * around.sqrt() / f64::from(SIDE) + found.error + 0.02;
            let off = (found.area - by_points).abs();
            assert!(
                off < doubt,
                "{sphere} of {count}: {} {by_points} {doubt}",
                found.area
            );
            assert!(found.error < 0.1, "{sphere} of {count}: {:e}", found.error);
        }
    }
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let view = view(40, 30);
    let spheres: Vec<_> = (0..20)
        .map(|index| (DVec3::new(f64::from(index) - 10.0, 0.3, 40.0), 1.3))
        .collect();
    let world = world(&spheres);
    let with_threads = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| areas(&world, &view, 1e-4))
    };
    assert_eq!(with_threads(1), with_threads(3));
}
