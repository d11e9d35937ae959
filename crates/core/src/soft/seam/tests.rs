//! Points of seams lie on both spheres.

use glam::DVec3;

use super::Seam;
use crate::model::camera::Projection;
use crate::soft::candidate::Candidate;

fn candidate(center: DVec3, radius: f64) -> Candidate {
    Candidate {
        number: 0,
        sphere: 0,
        center,
        radius,
        outside: center.length_squared() - radius * radius,
        inner: None,
        hides_light: true,
    }
}

#[test]
fn rays_through_the_ends_meet_both_spheres_at_one_place() {
    let pairs = [
        (
            candidate(DVec3::new(0.1, -0.2, 5.0), 1.0),
            candidate(DVec3::new(0.9, 0.3, 4.6), 0.8),
        ),
        (
            candidate(DVec3::new(0.1, -0.2, 5.0), 1.0),
            candidate(DVec3::new(0.0, -1001.0, 5.0), 1000.0),
        ),
        (
            candidate(DVec3::new(0.0, 0.1, 50.0), 2.0),
            candidate(DVec3::new(0.0, -1e6 - 1.0, 20.0), 1e6),
        ),
    ];
    let mut found = 0;
    for projection in [Projection::Central, Projection::Parallel] {
        for (one, other) in pairs {
            let seam = Seam::new(&one, &other).expect("they meet");
            for step in -200..200 {
                let v = f64::from(step) * 0.01;
                let mut ends = Vec::new();
                seam.add_ends(v, projection, &mut ends);
                for u in ends {
                    let ray = match projection {
                        Projection::Central => (DVec3::ZERO, DVec3::new(u, v, 1.0)),
                        Projection::Parallel => (DVec3::new(u, v, 0.0), DVec3::Z),
                    };
                    // The ray is nowhere further from the nearest of its common points with both spheres.
                    let distances = [one, other].map(|of| crossings(ray, &of));
                    let apart = distances[0].iter().flat_map(|&near| {
                        distances[1]
                            .iter()
                            .map(move |&far: &f64| (near - far).abs())
                    });
                    let apart = apart.fold(f64::INFINITY, f64::min);
                    assert!(apart < 1e-6, "{projection:?} {u} {v}: {apart}");
                    found += 1;
                }
            }
        }
    }
    assert!(found > 300, "{found}");
}

/// The distances at which a ray meets a sphere, or comes nearest to it.
fn crossings((origin, direction): (DVec3, DVec3), of: &Candidate) -> [f64; 2] {
    let to_center = of.center - origin;
    let along = to_center.dot(direction) / direction.length_squared();
    let aside_sq = (to_center - direction * along).length_squared();
    let half = ((of.radius * of.radius - aside_sq).max(0.0) / direction.length_squared()).sqrt();
    [along - half, along + half]
}
