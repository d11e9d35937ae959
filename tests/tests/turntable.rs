//! A turntable is a closed loop: the frame after the last one is the first.

use std::path::Path;

use marbles_scene::Scene;

use crate::studio::picture;

fn turntable(turns: &str, azimuth: &str, grain: &str) -> Scene {
    let text = format!(
        r##"(
            image: (width: 40, height: 30),
            lens: Fov(40),
            camera: Orbit(target: (1, 2, 3), radius: 10, azimuth: {azimuth}, elevation: 20, roll: 7),
            lights: [Directional(toward: (-1, 1, -1), intensity: "#ffcc88")],
            materials: {{ "rough": (rough: (amplitude: 0.5, grain: {grain}, seed: 3)) }},
            spheres: [
                (center: (1, 2, 3), radius: 2, material: "rough"),
                (center: (3, 2, 2), radius: 1),
            ],
            animation: Turntable(frames: 7, turns: {turns}),
        )"##
    );
    Scene::parse(&text, Path::new("turntable.ron")).unwrap()
}

#[test]
fn frame_after_the_last_is_the_first_to_the_bit() {
    for turns in ["1", "-2", "3"] {
        for azimuth in ["0", "0.1", "-77.7", "1e6"] {
            for grain in ["Pixel", "Surface(0.3)"] {
                let scene = turntable(turns, azimuth, grain);
                let frame = |number| picture(scene.world(), &scene.view(number).unwrap(), 2, true);
                let first = frame(1);
                assert_eq!(first, frame(8), "turns {turns}, azimuth {azimuth}, {grain}");
                assert_eq!(
                    first,
                    frame(1 - 70),
                    "turns {turns}, azimuth {azimuth}, {grain}"
                );
                assert_ne!(first, frame(2));
            }
        }
    }
}

#[test]
fn quarter_turn_is_exact() {
    let text = "(
        image: (width: 1, height: 1), lens: Fov(40),
        camera: Orbit(target: (0, 0, 0), radius: 10, azimuth: 90),
        animation: Turntable(frames: 4),
    )";
    let scene = Scene::parse(text, Path::new("turntable.ron")).unwrap();
    let position = |frame| scene.view(frame).unwrap().camera.position.to_array();
    assert_eq!(position(1), [-10.0, 0.0, 0.0]);
    assert_eq!(position(2), [0.0, 0.0, 10.0]);
    assert_eq!(position(3), [10.0, 0.0, 0.0]);
    assert_eq!(position(4), [0.0, 0.0, -10.0]);
}
