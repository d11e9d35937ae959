//! The work on pixels whose areas are not found.

use glam::{DVec2, DVec3};

use super::*;
use crate::model::camera::{Camera, Lens};
use crate::model::material::Material;
use crate::model::sphere::Sphere;
use crate::numeric::angle::Angle;
use crate::search::grid::RayPoints;

/// Counts the parts of pixels that are told of.
#[derive(Default)]
struct Count(usize);

impl Found for Count {
    fn add(&mut self, _place: usize, _sphere: usize, _part: [f64; 2]) {
        self.0 += 1;
    }
}

/// The parts that are told of, on average of 6 × 4 pixels filled by spheres.
fn parts(centers: &[DVec3]) -> f64 {
    let mut world = World::new();
    let material = world.add_material(Material::MATTE_WHITE);
    for &center in centers {
        world.add_sphere(Sphere::new(center, 1.0).unwrap(), material);
    }
    let view = View {
        camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
        lens: Lens {
            width: 1.0,
            distance: 3.0,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0,
        width: 6,
        height: 4,
        frame: 1,
    };
    let visibility = Visibility::new(&world);
    let index = ViewIndex::new(&visibility, &view, RayPoints::All);
    let areas = Areas::new(&world, &visibility, &view, index, 1e-3);
    let tile = Tile {
        col: 0,
        row: 0,
        width: 6,
        height: 4,
    };
    let candidates = areas.index.indices(tile);
    assert_eq!(candidates.len(), centers.len());
    let mut count = Count::default();
    let is_measured = areas.measure_all(tile, &candidates, &mut Scratch::default(), &mut count);
    assert!(is_measured);
    count.0 as f64 / 24.0
}

#[test]
fn spheres_that_nearly_coincide_are_given_up_soon() {
    let center = DVec3::new(0.1, 0.2, 5.0);
    let moved = |offset: [f64; 3]| center + DVec3::from(offset);
    let centers = [
        center,
        moved([4e-13, 2e-14, -3e-13]),
        moved([-2e-13, 3e-13, 2e-13]),
    ];
    for count in [2, 3] {
        // Most are quartered three times; without an end to it, two would be told of 3,400 times.
        let told = parts(&centers[..count]);
        let allowed = (64 * count) as f64;
        assert!((allowed / 2.0..2.0 * allowed).contains(&told), "{told}");
    }
}
