use std::path::Path;

use glam::DVec2;
use marbles_core::View;

use super::*;
use crate::Scene;

/// Numbers from 0 to 1, at random but always the same.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        // Knuth's linear congruence, of which the upper bits are good.
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// The largest value of a function around a circle that rises and falls once on it.
fn largest(value: impl Fn(f64) -> f64) -> f64 {
    const STEPS: i32 = 16;
    const STEP: f64 = std::f64::consts::TAU / STEPS as f64;
    let angles = (0..STEPS).map(|step| f64::from(step) * STEP);
    let best = angles.max_by(|one, other| value(*one).total_cmp(&value(*other)));
    let best = best.expect("there are steps");
    // The part between the neighbors of the best step is divided by the golden section, to less than 1e-8 of the circle:
    // what a smooth function has there differs by its square.
    let (mut low, mut high) = (best - STEP, best + STEP);
    let part = 0.5 * (5.0_f64.sqrt() - 1.0);
    while high - low > 1e-8 {
        let (one, other) = (high - part * (high - low), low + part * (high - low));
        match value(one) < value(other) {
            true => low = one,
            false => high = other,
        }
    }
    value(0.5 * (low + high))
}

/// The reach of contours from the middle of the picture, in halves of its sides: 1 at its edge.
///
/// Not by planes, but by points on the contours, which a view projects.
fn reach(scene: &Scene, view: &View) -> f64 {
    let eye = view.camera.position;
    let size = DVec2::new(f64::from(view.width), f64::from(view.height));
    let mut reach = 0.0_f64;
    for sphere in scene.world().spheres() {
        if view.lens.is_parallel() {
            let ahead = (sphere.center() - eye).dot(view.camera.forward());
            assert!(ahead > sphere.radius(), "the plane cuts a sphere");
            let pixel = view.project(sphere.center()).expect("it is ahead");
            let aside = (pixel - 0.5 * size).abs() + sphere.radius() * view.pixels_per_unit();
            reach = reach.max((aside / (0.5 * size)).max_element());
            continue;
        }
        let to_center = sphere.center() - eye;
        let distance = to_center.length();
        assert!(distance > sphere.radius(), "an eye inside a sphere");
        // The circle of tangent points, as seen from the eye.
        let axis = to_center / distance;
        let sine = sphere.radius() / distance;
        let (right, up) = axis.any_orthonormal_pair();
        let at = |angle: f64| {
            let across = right * angle.cos() + up * angle.sin();
            let toward = axis * (1.0 - sine * sine).sqrt() + across * sine;
            let pixel = view.project(eye + toward);
            let pixel = pixel.expect("all is before the camera");
            (pixel - 0.5 * size) / (0.5 * size)
        };
        for side in [DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y] {
            reach = reach.max(largest(|angle| at(angle).dot(side)));
        }
    }
    reach
}

fn scene(random: &mut Random, lens: &str, camera: &str, animation: &str) -> Scene {
    let stretch = DVec3::new(random.between(0.1, 9.0), random.between(0.1, 9.0), 1.0);
    let spheres: Vec<String> = (0..7)
        .map(|_| {
            let place = DVec3::new(random.next(), random.next(), random.next()) * 10.0 * stretch;
            let (x, y, z) = (place.x + 30.0, place.y - 500.0, place.z);
            let radius = random.between(0.01, 6.0);
            format!("(center: ({x}, {y}, {z}), radius: {radius})")
        })
        .collect();
    let text = format!(
        "(image: (width: {}, height: {}), lens: {lens}, camera: {camera}, spheres: [{}]{animation})",
        random.between(100.0, 400.0) as u32,
        random.between(100.0, 400.0) as u32,
        spheres.join(", ")
    );
    Scene::parse(&text, Path::new("a.ron")).unwrap_or_else(|error| panic!("{error}"))
}

const LENSES: [&str; 7] = [
    "Parallel(width: 3)",
    "Parallel(width: 200, shift: (40, -90))",
    "Fov(3)",
    "Fov(50)",
    "Fov(130)",
    "Retina(width: 2, distance: 3, shift: (0.5, -0.2))",
    "Retina(width: 2, distance: 0.4, shift: (-1.5, 1.2))",
];

#[test]
fn a_still_has_all_contours_inside_and_touches_a_side() {
    let mut random = Random(1);
    for lens in LENSES {
        for fill in [1.0, 0.9, 0.3] {
            let [azimuth, elevation, roll] =
                [180.0, 90.0, 180.0].map(|most| random.between(-most, most));
            let camera = format!(
                "Frame(azimuth: {azimuth}, elevation: {elevation}, roll: {roll}, fill: {fill})"
            );
            let scene = scene(&mut random, lens, &camera, "");
            let reach = reach(&scene, &scene.view(1).unwrap());
            assert!(reach <= fill * (1.0 + 1e-9), "{lens} {camera}: {reach}");
            assert!(reach >= fill * 0.999, "{lens} {camera}: {reach}");
        }
    }
}

#[test]
fn a_turntable_has_all_contours_inside_in_every_frame() {
    for turning in [
        "",
        ", swing: 35",
        ", axis: (0, 0, 1)",
        ", axis: (1, -2, 0.5), swing: 20",
        ", up: X, swing: 35",
        ", up: Z",
    ] {
        turntables_have_all_contours_inside(turning);
    }
}

fn turntables_have_all_contours_inside(turning: &str) {
    let mut random = Random(2);
    for lens in LENSES {
        let elevation = random.between(-80.0, 80.0);
        let camera = format!("Frame(elevation: {elevation}, fill: 1)");
        let animation = format!(", animation: Turntable(frames: 90{turning})");
        let scene = scene(&mut random, lens, &camera, &animation);
        let reaches: Vec<f64> = (1..=90)
            .map(|frame| reach(&scene, &scene.view(frame).unwrap()))
            .collect();
        let largest = reaches.iter().copied().fold(0.0, f64::max);
        assert!(largest <= 1.0 + 1e-9, "{lens} {camera}{turning}: {largest}");
        assert!(largest >= 0.98, "{lens} {camera}{turning}: {largest}");
        let [first, last] = [1, 91].map(|frame| scene.view(frame).unwrap().camera);
        assert_eq!(first, last);
    }
}

#[test]
fn what_points_up_on_a_turntable_looks_as_in_a_table_with_this_axis_up() {
    let places = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(-4.0, 0.5, 2.0)];
    let scene = |places: [DVec3; 2], up: &str| {
        let [one, two] = places.map(|DVec3 { x, y, z }| format!("({x}, {y}, {z})"));
        let text = format!(
            "(image: (width: 90, height: 60), lens: Fov(40), camera: Frame(elevation: 20, azimuth: 35),
              spheres: [(center: {one}, radius: 1), (center: {two}, radius: 0.5)],
              animation: Turntable(frames: 9{up}))"
        );
        Scene::parse(&text, Path::new("a.ron")).unwrap()
    };
    // The quarter turns of clouds with `up: X` and `up: Z`.
    let x_to_y = places.map(|DVec3 { x, y, z }| DVec3::new(-y, x, z));
    let z_to_y = places.map(|DVec3 { x, y, z }| DVec3::new(x, z, -y));
    for (up, turned) in [
        (", up: X", x_to_y),
        (", up: Y", places),
        (", up: Z", z_to_y),
    ] {
        let (upright, expected) = (scene(places, up), scene(turned, ""));
        for frame in 1..=9 {
            let [view, expected] = [&upright, &expected].map(|scene| scene.view(frame).unwrap());
            for (place, turned) in places.into_iter().zip(turned) {
                let apart = view.project(place).unwrap() - expected.project(turned).unwrap();
                assert!(apart.length() < 1e-9, "{up}, frame {frame}: {apart}");
            }
        }
    }
}

#[test]
fn keys_may_turn_the_camera_in_any_way() {
    let mut random = Random(3);
    let keys = ", animation: Keyframes(keys: [(frame: 1, azimuth: 0), (frame: 20, azimuth: 200, \
                elevation: 70, roll: 30), (frame: 40, elevation: -70)])";
    for lens in LENSES {
        let scene = scene(&mut random, lens, "Frame(fill: 1)", keys);
        for frame in 1..=40 {
            let reach = reach(&scene, &scene.view(frame).unwrap());
            assert!(reach <= 1.0 + 1e-9, "{lens}: {reach}");
        }
    }
}

#[test]
fn zoom_magnifies_what_is_framed() {
    let text = "(image: (width: 90, height: 90), lens: Fov(40), camera: Frame(fill: 0.5), zoom: 2,
                 spheres: [(center: (1, 2, 3), radius: 4)])";
    let scene = Scene::parse(text, Path::new("a.ron")).unwrap();
    let view = scene.view(1).unwrap();
    assert!((reach(&scene, &view) - 1.0).abs() < 1e-5);
    assert_eq!(view.camera.position.truncate(), DVec2::new(1.0, 2.0));
    let framed = View { zoom: 1.0, ..view };
    assert!((reach(&scene, &framed) - 0.5).abs() < 1e-5);
}

#[test]
fn an_orbit_around_all_is_the_frame_of_a_turntable() {
    let mut random = Random(4);
    let animation = ", animation: Turntable()";
    let framed = scene(&mut random, "Fov(40)", "Frame(elevation: 15)", animation);
    let (target, radius) = framed.orbit_around(framed.world().spheres(), 15.0).unwrap();
    let camera = framed.view(1).unwrap().camera;
    let at = target - camera.forward() * radius;
    assert!((camera.position - at).length() < 1e-9 * radius);
    assert_eq!(framed.orbit_around(&[], 15.0), None);
}

#[test]
fn nothing_cannot_be_framed() {
    let text = "(image: (width: 9, height: 9), lens: Fov(40), camera: Frame())";
    let error = Scene::parse(text, Path::new("a.ron")).unwrap_err();
    let expected = "expected spheres for a `Frame` camera, found none";
    assert_eq!(error.faults()[0].message, expected);
    assert_eq!(error.faults()[0].column, 55);
}
