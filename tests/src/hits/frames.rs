//! Ordinary frames: the rays of a camera at the origin, and the spheres that each ray is tested against.

use glam::DVec3;
use marbles_core::{Ray, Sphere};

use super::families::Random;

/// Spheres, and the rays that are tested against each of them.
pub struct Frame {
    /// The name in tables.
    pub name: &'static str,
    /// The spheres.
    pub spheres: Vec<Sphere>,
    /// The rays.
    pub rays: Vec<Ray>,
}

/// One ball and 600 × 600 rays; one ray in nine hits.
pub fn ball() -> Frame {
    Frame {
        name: "one ball",
        spheres: vec![Sphere::new(DVec3::Z * 400.0, 300.0).unwrap()],
        rays: rays(600, 1.0, 100.0),
    }
}

/// A thousand spheres in a cube of side 200, seen through every tenth pixel in both directions. Nearly every test is a
/// miss.
pub fn cloud() -> Frame {
    let mut random = Random::new(1_000);
    let mut sphere = || {
        let center = DVec3::Z * 400.0 + random.in_cube(100.0);
        Sphere::new(center, random.between(3.0, 12.0)).unwrap()
    };
    Frame {
        name: "a thousand spheres",
        spheres: (0..1_000).map(|_| sphere()).collect(),
        rays: rays(60, 10.0, 700.0),
    }
}

/// Rays through the centers of `side` × `side` squares of a retina.
fn rays(side: u32, pixel: f64, distance: f64) -> Vec<Ray> {
    let middle = |index: u32| (f64::from(index) + 0.5 - f64::from(side) / 2.0) * pixel;
    let ray = |index: u32| Ray {
        origin: DVec3::ZERO,
        direction: DVec3::new(middle(index % side), -middle(index / side), distance),
    };
    (0..side * side).map(ray).collect()
}
