use super::*;
use crate::model::material::{Highlight, Material};
use crate::model::roughness::PixelKey;
use crate::model::sphere::Sphere;
use crate::search::hierarchy::Hierarchy;
use crate::soft::cap::Cap;
use crate::soft::edges::Edge;
use crate::soft::visible::Hidden;

/// What is in doubt on 80 units of a huge floor with a ball on it, if a part of the cell sees the floor below the ball.
fn doubt_seen(ball: DVec3, radius: f64, part: f64) -> f64 {
    const FLOOR: f64 = 1e5;
    let spheres = [
        Sphere::new(DVec3::new(0.0, -FLOOR, 0.0), FLOOR).unwrap(),
        Sphere::new(ball, radius).unwrap(),
    ];
    let occluders = Occluders {
        spheres: &spheres,
        hierarchy: &Hierarchy::new(&spheres),
    };
    let of = Neighborhood {
        middle: DVec3::ZERO,
        around: 40.0,
        normal: DVec3::Y,
        turn: 40.0 / FLOOR,
    };
    of_shadows(&of, 0.25, 0, Some(&occluders), &|_| part)
}

fn doubt(ball: DVec3, radius: f64) -> f64 {
    doubt_seen(ball, radius, 0.0)
}

/// A part of a unit sphere around a point of it.
fn around(middle: DVec3) -> Extent {
    Extent {
        middle,
        around: 0.1,
        across: 0.1,
        turn: 0.0,
        to_eye: middle,
        eye_turn: 0.0,
        normal: middle,
    }
}

#[test]
fn spheres_hide_no_more_of_a_sun_than_the_bound_says() {
    let mut state = 7_u64;
    let mut next = || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 11) as f64 * 2_f64.powi(-52) - 1.0
    };
    let mut hidden = Hidden::default();
    let mut largest = 0.0_f64;
    for number in 0..2000 {
        let mut vector = || DVec3::new(next(), next(), next());
        let axis = (DVec3::Y + vector() * 0.3).normalize();
        let sun = Sun {
            disc: Cap::within(axis, 0.05 + f64::from(number % 15) * 0.1),
            intensity: DVec3::ONE,
        };
        let extent = around(DVec3::Y);
        let place = SurfacePoint {
            position: DVec3::Y + vector() * 0.05,
            shading: DVec3::Y,
            ..extent.point(0)
        };
        let (center, radius) = (DVec3::Y * (2.0 + vector().x) + vector(), 0.3);
        let edge = Edge::Sphere { center, radius };
        let received = sun.received(&place, &[edge], &mut hidden);
        let part = received.whole * (1.0 - received.share);
        let most = most_hidden(&sun, &extent, (center, radius));
        assert!(part <= most, "{number}: {part} {most}");
        largest = largest.max(part / most);
    }
    assert!(largest > 0.3, "{largest}");
}

#[test]
fn spheres_that_are_mostly_inside_cast_narrow_shadows() {
    let ball = |center: DVec3, radius: f64| {
        let candidate = Candidate {
            number: 0,
            sphere: 0,
            center: DVec3::ZERO,
            radius: 10.0,
            outside: 1.0,
            inner: None,
            hides_light: true,
        };
        shadow_half_width(&candidate, (center, radius))
    };
    assert_eq!(ball(DVec3::Y * 12.0, 2.0), 2.0);
    assert_eq!(ball(DVec3::Y * 10.0, 2.0), 2.0);
    assert!((ball(DVec3::Y * 8.4, 2.0) - 1.2).abs() < 1e-12);
    assert_eq!(ball(DVec3::Y * 7.0, 2.0), 0.0);
}

/// What is in doubt of light that is narrower than a cell, where its middle is so far from the cell's middle normal: of a
/// highlight, and of a large exponent.
fn doubt_of_lobes(aside: f64) -> [f64; 2] {
    const NARROW: f64 = 1e4;
    let mut world = World::new();
    let shiny = world.add_material(Material {
        highlight: Some(Highlight {
            strength: 1.0,
            shininess: NARROW,
        }),
        ..Material::default()
    });
    world.add_sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap(), shiny);
    let key = PixelKey {
        col: 0,
        row: 0,
        frame: 1,
    };
    let shading = ShadingNormal::new(&world, 0, key);
    let extent = Extent {
        turn: 0.2,
        ..around(DVec3::NEG_Z)
    };
    let sun = |angle: f64| Sun {
        disc: Cap::within(DVec3::new(libm::sin(angle), 0.0, -libm::cos(angle)), 0.01),
        intensity: DVec3::ONE,
    };
    let cell = (&extent, 0.25);
    [
        of_highlight(&sun(2.0 * aside), cell, (&world, 0), &shading),
        of_exponent(&sun(aside), cell, NARROW, &shading),
    ]
}

#[test]
fn narrow_lobes_anywhere_in_a_cell_are_noticed() {
    for aside in [0.0, 0.1, 0.19] {
        let doubt = doubt_of_lobes(aside);
        assert!(doubt.into_iter().all(|one| one > 0.2), "{aside}: {doubt:?}");
    }
    let beside = doubt_of_lobes(0.3);
    assert!(beside.into_iter().all(|one| one < 1e-12), "{beside:?}");
}

#[test]
fn balls_that_lie_between_points_are_noticed() {
    assert!(doubt(DVec3::new(12.0, 8.0, 18.0), 8.0) > 0.1);
    // Beside the piece, and above it.
    assert!(doubt(DVec3::new(30.0, 8.0, 40.0), 8.0) > 1e-2);
    assert!(doubt(DVec3::new(0.0, 30.0, 0.0), 8.0) > 1e-3);
    // Points tell of large ones, and of those that are far away.
    assert_eq!(doubt(DVec3::new(12.0, 30.0, 18.0), 30.0), 0.0);
    assert!(doubt(DVec3::new(300.0, 8.0, 0.0), 8.0) < 1e-6);
    // One that is small beside all of the piece, in a large part of the picture of it.
    let small = DVec3::new(12.0, 0.5, 18.0);
    assert!(doubt(small, 0.5) < 0.03);
    assert!(doubt_seen(small, 0.5, 0.4) > 0.3);
}
