//! A rough ball keeps its bumps while the camera moves around it.

use glam::DVec3;
use marbles_core::{Angle, Camera, Color, Grain, Light, Material, Roughness, Sphere, View, World};

use crate::studio::{around_retina_point, looking_forward, picture};

const CENTER: DVec3 = DVec3::new(30.0, -20.0, 400.0);
const RADIUS: f64 = 100.0;

/// A ball that shows its shading normal as a color: under three colored lights along the axes, matte white reflects the
/// positive parts of the normal's components.
fn ball_of_normals(grain: Grain, sign: f64) -> World {
    let mut world = World::new();
    let roughness = Some(Roughness {
        amplitude: 0.5,
        grain,
        seed: 3,
    });
    let material = world.add_material(Material {
        roughness,
        ..Material::MATTE_WHITE
    });
    world.add_sphere(Sphere::new(CENTER, RADIUS).unwrap(), material);
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        world
            .lights
            .extend(Light::directional(sign * axis, Color::from(axis)));
    }
    world
}

fn seen_from(azimuth: f64, frame: i64) -> View {
    let degrees = Angle::from_degrees;
    let camera = Camera::orbit(
        CENTER,
        500.0,
        degrees(azimuth),
        degrees(15.0),
        degrees(azimuth / 3.0),
    );
    View {
        camera,
        frame,
        ..looking_forward(100, 100, 90.0)
    }
}

/// The shading normal that a camera sees exactly at a surface point.
fn normal_seen(grain: Grain, view: &View, point: DVec3) -> DVec3 {
    let in_camera = view.camera.world_from_camera.transpose() * (point - view.camera.position);
    let on_retina = in_camera.truncate() * (view.lens.distance / in_camera.z);
    let aimed = around_retina_point(view, on_retina, 1e-6);
    let [positive, negative] = [1.0, -1.0].map(|sign| {
        let [red, green, blue, _] =
            picture(&ball_of_normals(grain, sign), &aimed, 1, false).rgba(0, 0);
        DVec3::new(red, green, blue)
    });
    positive - negative
}

/// Points of the surface that are visible to both cameras of the tests.
fn shared_points() -> impl Iterator<Item = DVec3> {
    (0..200).map(|index| {
        let (across, up) = (
            f64::from(index % 20) / 20.0 - 0.5,
            f64::from(index / 20) / 10.0 - 0.3,
        );
        CENTER + RADIUS * DVec3::new(across, up, -1.0).normalize()
    })
}

#[test]
fn corresponding_surface_points_have_equal_normals() {
    let grain = Grain::Surface(12.0);
    let mut perturbed = 0;
    for point in shared_points() {
        let first = normal_seen(grain, &seen_from(-20.0, 1), point);
        let later = normal_seen(grain, &seen_from(25.0, 31), point);
        assert!((first.length() - 1.0).abs() < 1e-12);
        // Rounding moves the point by some 1e-13 of the distance; the bumps' slope is moderate.
        assert!((first - later).length() < 1e-11, "{first} became {later}");
        let smooth = (point - CENTER) / RADIUS;
        perturbed += u32::from((first - smooth).length() > 0.01);
    }
    assert!(perturbed > 180, "the ball is smooth");
}

#[test]
fn grain_of_pixels_is_drawn_anew_in_every_frame() {
    let point = CENTER + RADIUS * DVec3::new(1.0, 1.0, -2.0).normalize();
    let normal_in = |frame| normal_seen(Grain::Pixel, &seen_from(5.0, frame), point);
    assert_eq!(normal_in(1), normal_in(1));
    assert!((normal_in(1) - normal_in(2)).length() > 1e-3);
}
