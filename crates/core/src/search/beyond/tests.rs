//! Compares what the hierarchy finds with all spheres, one by one.

use glam::DVec3;

use super::*;
use crate::model::sphere::Sphere;

fn spheres() -> Vec<Sphere> {
    let mut state = 7_u64;
    let mut next = || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 11) as f64 * 2_f64.powi(-52) - 1.0
    };
    let sphere = |_| {
        Sphere::new(
            DVec3::new(next(), next(), next()) * 10.0,
            0.01 + next().abs(),
        )
    };
    (0..700).map(sphere).collect::<Result<_, _>>().unwrap()
}

/// Points within the distance `around` of the origin from which some direction meets a sphere.
#[test]
fn every_sphere_that_a_direction_meets_is_found() {
    let spheres = spheres();
    let hierarchy = Hierarchy::new(&spheres);
    let apex = DVec3::new(0.5, -0.25, 1.0);
    let axis = DVec3::new(0.6, 0.0, 0.8);
    for degrees in [0.005, 0.25, 5.0, 45.0, 85.0] {
        let (sine, cosine) = (
            f64::sin(f64::to_radians(degrees)),
            f64::cos(f64::to_radians(degrees)),
        );
        let cone = Beyond::Cone {
            apex,
            around: 0.0,
            axis,
            sine,
            cosine,
        };
        let mut found = vec![false; spheres.len()];
        hierarchy.for_each_beyond(&spheres, &cone, &mut |index| found[index] = true);
        let meets = |sphere: &Sphere| {
            let to_center = sphere.center() - apex;
            let distance = to_center.length();
            let angle = to_center.angle_between(axis);
            distance <= sphere.radius()
                || angle <= f64::to_radians(degrees) + f64::asin(sphere.radius() / distance)
        };
        let expected: Vec<bool> = spheres.iter().map(meets).collect();
        assert_eq!(found, expected, "{degrees}");
        assert!(degrees < 1.0 || found.iter().any(|&found| found));
    }
}
