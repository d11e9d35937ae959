//! Points ask the spheres whose discs they lie in, and few others.

use super::*;
use crate::search::tests::Random;

fn occluders(spheres: &[Sphere], toward: DVec3) -> Occluders<'_> {
    Occluders::new(spheres, Arc::new(Hierarchy::new(spheres)), toward)
}

fn asked(occluders: &Occluders<'_>, point: DVec3, error: f64) -> Vec<usize> {
    let mut asked = Vec::new();
    occluders.any(point, error, |index| {
        asked.push(index);
        false
    });
    asked
}

/// Points at the very edge of discs of all sizes, and within their error of it.
#[test]
fn points_at_the_edge_of_a_disc_ask_its_sphere() {
    let mut random = Random(7);
    for _ in 0..300 {
        let toward = random.point().normalize();
        let spheres: Vec<Sphere> = (0..10)
            .map(|_| {
                let radius = libm::exp10(-4.0 + 8.0 * random.number());
                Sphere::new(random.point() * 3.0, radius).unwrap()
            })
            .collect();
        let occluders = occluders(&spheres, toward);
        for (index, sphere) in spheres.iter().enumerate() {
            let outward = random.point().reject_from_normalized(toward).normalize();
            let below = -20.0 * random.number() * toward;
            let point = sphere.center() + outward * sphere.radius() + below;
            assert!(asked(&occluders, point, 0.0).contains(&index));
            for error in [1e-9, 0.1, 100.0] {
                assert!(asked(&occluders, point + outward * error, error).contains(&index));
            }
        }
    }
}

/// Counted work: neither a floor nor a stray sphere makes points ask more than a few.
#[test]
fn floors_and_outliers_do_not_matter() {
    let mut random = Random(8);
    let balls: Vec<Sphere> = (0..10_000)
        .map(|_| Sphere::new(random.point() * 100.0, 0.9).unwrap())
        .collect();
    let floor = Sphere::new(DVec3::new(0.0, -1e6, 0.0), 1e6).unwrap();
    let speck = Sphere::new(DVec3::splat(1e6), 0.01).unwrap();
    for extra in [vec![], vec![floor], vec![speck], vec![floor, speck]] {
        let spheres = [&balls[..], &extra[..]].concat();
        let occluders = occluders(&spheres, DVec3::new(0.6, 0.64, -0.48));
        let count: usize = balls
            .iter()
            .map(|ball| asked(&occluders, ball.center(), 1e-13).len())
            .sum();
        assert!(count < 4 * balls.len(), "{} a point", count as f64 / 1e4);
    }
}
