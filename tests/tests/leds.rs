//! Lamps that send light in some directions more than in others, by plain geometry and by plain sampling.

use glam::DVec3;
use marbles_core::{
    Color, Emission, Image, Light, LightFalloff, Material, PointLight, Sphere, View, World,
};

use marbles_tests::reference::Reference;

use crate::studio::{exact_picture, looking_forward, picture, pixels};

fn led(position: DVec3, reference: f64, direction: DVec3, mu: f64) -> Light {
    let lamp = PointLight::new(position, Color::ONE, LightFalloff::InverseSquare, reference);
    let emission = Emission::new(direction, mu).unwrap();
    lamp.unwrap().with_emission(emission).into()
}

fn world(spheres: &[(DVec3, f64)], exponent: f64, lights: &[Light]) -> World {
    let mut world = World::new();
    let white = world.add_material(Material {
        exponent,
        ..Material::MATTE_WHITE
    });
    for &(center, radius) in spheres {
        world.add_sphere(Sphere::new(center, radius).unwrap(), white);
    }
    world.lights.extend(lights);
    world
}

/// The radius of a floor one below the viewpoint.
const RADIUS: f64 = 1e6;
const FLOOR: (DVec3, f64) = (DVec3::new(0.0, -1.0 - RADIUS, 0.0), RADIUS);

/// The point of the floor in a direction. K is that of the viewpoint: (1 + R)² − R².
fn on_floor(direction: DVec3) -> DVec3 {
    let outside = 1.0 + 2.0 * RADIUS;
    let along = direction.dot(FLOOR.0);
    let root = (along * along - direction.length_squared() * outside).sqrt();
    direction * (outside / (along + root))
}

/// Gauss's rule with five points on −½ to ½.
const RULE: [(f64, f64); 5] = [
    (-0.453_089_922_969_332, 0.118_463_442_528_094_54),
    (-0.269_234_655_052_841_55, 0.239_314_335_249_683_23),
    (0.0, 0.284_444_444_444_444_44),
    (0.269_234_655_052_841_55, 0.239_314_335_249_683_23),
    (0.453_089_922_969_332, 0.118_463_442_528_094_54),
];

/// Parts of a side of a pixel.
const PARTS: u32 = 6;

/// E = I cosᵘ(θ) cos(φ) / r², with θ the angle at the lamp and φ that at the floor, averaged over pixels.
#[test]
fn a_plane_under_an_led_has_the_known_irradiance() {
    let (position, reference) = (DVec3::new(0.4, 0.6, 3.0), 1.5);
    let view = looking_forward(40, 40, 30.0);
    for (direction, mu) in [
        (DVec3::new(0.0, -1.0, 0.0), 1.0),
        (DVec3::new(0.3, -1.0, 0.4), 0.3),
        (DVec3::new(0.3, -2.0, -0.4), 2.5),
        (DVec3::new(-0.5, -1.0, 0.1), 20.0),
        (DVec3::new(-0.2, -1.0, 0.1), 80.0),
        (DVec3::new(-0.5, -1.0, 0.1), 0.0),
    ] {
        let unit = direction.normalize();
        let light_at = |x: f64, y: f64| {
            let point = on_floor(DVec3::new(x, y, 30.0));
            let normal = (point - FLOOR.0) / RADIUS;
            let way = point - position;
            let distance = way.length();
            let cosine = way.dot(unit) / distance;
            let facing = -way.dot(normal) / distance;
            (
                way.dot(unit),
                (reference / distance).powi(2) * cosine.max(0.0).powf(mu) * facing,
            )
        };
        let image = exact_picture(
            &world(&[FLOOR], 1.0, &[led(position, reference, direction, mu)]),
            &view,
            1e-7,
            false,
        );
        let mut count = 0;
        for (col, row) in pixels(&image).filter(|&(_, row)| row >= 24) {
            let (x, y) = (f64::from(col) - 19.5, 19.5 - f64::from(row));
            let corners = [(-0.5, -0.5), (-0.5, 0.5), (0.5, -0.5), (0.5, 0.5)];
            let is_ahead = corners.iter().all(|(u, v)| light_at(x + u, y + v).0 > 0.3);
            if !is_ahead {
                continue;
            }
            let mut mean = 0.0;
            for part in 0..PARTS * PARTS {
                let corner = [part % PARTS, part / PARTS].map(f64::from);
                let at =
                    |index: usize, node: f64| (corner[index] + 0.5 + node) / f64::from(PARTS) - 0.5;
                for (u, along) in RULE {
                    for (v, across) in RULE {
                        mean += along * across * light_at(x + at(0, u), y + at(1, v)).1;
                    }
                }
            }
            mean /= f64::from(PARTS * PARTS);
            let found = image.rgba(col, row)[0];
            assert!(
                (found - mean).abs() < 2e-7,
                "{mu} {col} {row}: {found} {mean}"
            );
            count += 1;
        }
        assert!(count > 200, "{mu}: {count}");
    }
}

#[test]
fn beyond_its_plane_a_lamp_sends_nothing() {
    let ball = (DVec3::new(0.0, 0.0, 5.0), 1.0);
    let view = looking_forward(9, 9, 60.0);
    let middle = |direction: DVec3, mu: f64| {
        let world = world(&[ball], 1.0, &[led(DVec3::ZERO, 4.0, direction, mu)]);
        [
            exact_picture(&world, &view, 1e-6, false).rgba(4, 4)[0],
            picture(&world, &view, 8, false).rgba(4, 4)[0],
        ]
    };
    for mu in [0.0, 0.3, 1.0, 80.0] {
        let [exact, sampled] = middle(DVec3::Z, mu);
        assert!((exact - 1.0).abs() < 2e-2, "{mu}: {exact}");
        assert!((exact - sampled).abs() < 1e-4, "{mu}: {exact} {sampled}");
        assert_eq!(middle(DVec3::NEG_Z, mu), [0.0; 2], "{mu}");
        // Half of the pixel: ∫ (x / 60)^μ from 0 to ½.
        let half = 0.5_f64.powf(mu + 1.0) / (mu + 1.0) / 60.0_f64.powf(mu);
        let [exact, sampled] = middle(DVec3::X, mu);
        assert!(
            (exact - half).abs() < 0.01 * half + 1e-6,
            "{mu}: {exact} {half}"
        );
        assert!(
            (sampled - half).abs() < 0.05 * half + 1e-6,
            "{mu}: {sampled} {half}"
        );
    }
}

/// The largest difference of the exact picture from plain sampling, beyond its claims.
fn apart(world: &World, view: &View) -> f64 {
    let exact: Image = exact_picture(world, view, 1e-4, false);
    let sampled = picture(world, view, 128, false);
    pixels(&exact)
        .map(|(col, row)| {
            let off = (exact.rgba(col, row)[0] - sampled.rgba(col, row)[0]).abs();
            off - exact.error(col, row)
        })
        .fold(0.0, f64::max)
}

#[test]
fn pictures_are_those_of_plain_sampling() {
    let spheres = [
        (DVec3::new(0.1, -0.1, 5.0), 1.0),
        (DVec3::new(-0.7, 0.6, 3.9), 0.3),
        (DVec3::new(0.0, -20.9, 6.0), 20.0),
    ];
    let view = looking_forward(16, 16, 28.0);
    for exponent in [1.0, 0.5] {
        for mu in [0.0, 0.05, 0.3, 1.0, 2.5, 80.0] {
            let lights = [
                // Its plane cuts the ball, and the floor.
                led(
                    DVec3::new(0.5, 0.3, 3.2),
                    1.2,
                    DVec3::new(-1.0, -0.4, 0.35),
                    mu,
                ),
                // It touches the ball, nearly.
                led(
                    DVec3::new(-1.0, 1.2, 4.0),
                    1.0,
                    DVec3::new(0.3, -1.0, 0.9),
                    mu,
                ),
            ];
            let off = apart(&world(&spheres, exponent, &lights), &view);
            // Jumps along lines of samples, of what is at most 1.5.
            assert!(off < 5e-3, "{exponent} {mu}: {off}");
        }
    }
}

/// The cutoffs of lamps on a panel coincide, as do those of two lamps back to back.
#[test]
fn cutoffs_of_lamps_on_a_panel_are_met() {
    let spheres = [(DVec3::new(0.1, -0.1, 5.0), 1.0)];
    let view = looking_forward(24, 24, 48.0);
    let facing = DVec3::new(0.2, -1.0, 0.1);
    let aside = DVec3::new(1.0, 0.2, 0.0);
    let place = DVec3::new(-0.9, 1.0, 3.0);
    let lamp = |step: f64, sign: f64, mu: f64| led(place + aside * step, 2.0, facing * sign, mu);
    for lights in [
        vec![
            lamp(0.0, 1.0, 1.0),
            lamp(0.7, 1.0, 1.0),
            lamp(1.6, 1.0, 0.3),
        ],
        vec![lamp(0.0, 1.0, 1.0), lamp(0.7, -1.0, 0.0)],
        vec![
            lamp(0.3, -1.0, 2.0),
            lamp(0.7, 1.0, 0.4),
            lamp(1.6, -1.0, 0.0),
        ],
    ] {
        let world = world(&spheres, 1.0, &lights);
        let image = exact_picture(&world, &view, 1e-5, false);
        assert_eq!(image.summary().over_tolerance, 0);
        let reference = Reference::new(&world, &view);
        for (col, row) in pixels(&image).filter(|(col, row)| (col + row) % 5 == 0) {
            let truth = reference.pixel_to(col, row, 1e-7);
            let off = (image.rgba(col, row)[0] - truth.value.x).abs();
            assert!(off <= 1e-5 + truth.error, "{col} {row}: {off:e}");
        }
    }
}

/// A lamp with μ = 0 whose plane nothing lies beyond is a lamp without a direction.
#[test]
fn a_half_space_lamp_lights_what_it_faces_as_any_lamp_does() {
    let spheres = [(DVec3::new(0.1, -0.1, 5.0), 1.0)];
    let position = DVec3::new(1.0, 1.0, 3.0);
    let plain = PointLight::new(position, Color::ONE, LightFalloff::InverseSquare, 2.0).unwrap();
    let half = led(position, 2.0, DVec3::new(-0.3, -0.3, 1.0), 0.0);
    let view = looking_forward(16, 16, 30.0);
    let [one, other] = [plain.into(), half]
        .map(|light| exact_picture(&world(&spheres, 1.0, &[light]), &view, 1e-5, false));
    for (col, row) in pixels(&one) {
        let off = (one.rgba(col, row)[0] - other.rgba(col, row)[0]).abs();
        assert!(off <= 2e-5, "{col} {row}: {off}");
    }
}

/// The ring of lamps around a lens as a laboratory writes it: each lamp faces along the axis, with Lambert's law.
#[test]
fn a_ring_of_leds_lights_a_ball_from_the_lens() {
    let text = "(
        image: (width: 32, height: 32), lens: Fov(40), camera: Free(),
        lights: [
            Point(position: (30, 0, 0), direction: (0, 0, 1), mu: 1, intensity: 1, reference: 150),
            Point(position: (-30, 0, 0), direction: (0, 0, 1), mu: 1, intensity: 1, reference: 150),
        ],
        spheres: [(center: (0, 0, 150), radius: 40)],
    )";
    let scene = marbles_scene::Scene::parse(text, std::path::Path::new("ring.ron")).unwrap();
    let view = scene.view(1).unwrap();
    let image = exact_picture(scene.world(), &view, 1e-6, false);
    assert_eq!(image.summary().over_tolerance, 0);
    // The nearest point, (0, 0, 110), in the light of both: cos² / r² of each.
    let square = 110.0_f64.powi(2) + 30.0 * 30.0;
    let expected = 2.0 * (150.0 * 150.0 / square) * (110.0 * 110.0 / square);
    let four = [(15, 15), (15, 16), (16, 15), (16, 16)];
    let mean = four
        .map(|(col, row)| image.rgba(col, row)[0])
        .iter()
        .sum::<f64>()
        / 4.0;
    assert!(
        (mean - expected).abs() < 0.01 * expected,
        "{mean} {expected}"
    );
    // The plane of the lamps passes the viewpoint: everything lies ahead of it.
    let reference = Reference::new(scene.world(), &view);
    for (col, row) in [(15, 15), (9, 20), (26, 12), (5, 16)] {
        let truth = reference.pixel_to(col, row, 1e-8);
        let off = (image.rgba(col, row)[0] - truth.value.x).abs();
        assert!(off <= 1e-6 + truth.error, "{col} {row}: {off:e}");
    }
}
