//! Tests of the camera that goes around a point.

use std::path::Path;

use glam::{DVec2, DVec3};
use marbles_core::Light;

use super::*;

/// Three balls around (1, 2, 10), one of them large and behind.
const BALLS: &str = "spheres: [(center: (1, 2, 10), radius: 1), (center: (3, 2, 10), radius: 0.5),
        (center: (1, 2, 18), radius: 3)]";

/// Cameras of every kind that see the balls.
const CAMERAS: [&str; 6] = [
    "Frame()",
    "Frame(azimuth: 25, elevation: 15.5, roll: 3, fill: 0.8)",
    "Orbit(target: (1, 2, 10), radius: 9, azimuth: -30)",
    "LookAt(position: (5, 5, -3), target: (1, 2, 10), roll: 7)",
    "Free(position: (1, 2, 0), pan: 2, tilt: -1, roll: -4)",
    "Pose(rotation: [1, 0, 0, 0, -1, 0, 0, 0, -1], translation: (-1, 2, 0.5), axes: OpenCV)",
];
const LENSES: [&str; 3] = [
    "Fov(40)",
    "Parallel(width: 12)",
    "Retina(width: 2, distance: 3)",
];

fn text(camera: &str, lens: &str, more: &str) -> String {
    format!(
        "(image: (width: 64, height: 48), lens: {lens}, // the lens
    camera: {camera}, // the camera
    {more}{BALLS})"
    )
}

fn parse(text: &str) -> Scene {
    Scene::parse(text, Path::new("scene.ron")).unwrap()
}

/// The largest distance between the places of the balls in two pictures, in pixels.
fn moved(one: &View, other: &View) -> f64 {
    let centers = [[1.0, 2.0, 10.0], [3.0, 2.0, 10.0], [1.0, 2.0, 18.0]].map(DVec3::from);
    let places = centers.map(|center| {
        let place = |view: &View| view.project(center).unwrap();
        place(one).distance(place(other))
    });
    places.into_iter().fold(0.0, f64::max)
}

#[test]
fn a_camera_that_is_not_turned_sees_the_same() {
    for lens in LENSES {
        for camera in CAMERAS {
            let mut scene = parse(&text(camera, lens, ""));
            let before = scene.view(1).unwrap();
            let orbit = scene.orbit_camera(1).unwrap();
            scene.set_orbit_camera(&orbit).unwrap();
            let moved = moved(&before, &scene.view(1).unwrap());
            assert!(moved < 1e-3, "{camera} {lens}: {moved}");
        }
    }
}

#[test]
fn what_the_camera_goes_around_stays_in_the_middle() {
    for lens in LENSES {
        for camera in CAMERAS {
            let mut scene = parse(&text(camera, lens, ""));
            let start = scene.orbit_camera(1).unwrap();
            // The middle of the box around all balls, from -2 to 4, from -1 to 5 and from 9 to 21.
            let target = match start.center {
                OrbitCenter::Framed => DVec3::new(1.0, 2.0, 15.0),
                OrbitCenter::At { target, .. } => target,
            };
            for (azimuth, elevation) in [(10.0, 0.0), (200.0, 80.0), (-90.0, -90.0)] {
                let camera = OrbitCamera {
                    azimuth,
                    elevation,
                    ..start
                };
                scene.set_orbit_camera(&camera).unwrap();
                let middle = scene.view(1).unwrap().project(target).unwrap();
                assert!(middle.distance(DVec2::new(32.0, 24.0)) < 1e-9, "{middle}");
            }
        }
    }
}

/// Only the value of the camera changes, and the file then gives the picture that was seen.
#[test]
fn a_camera_is_written_as_it_is_seen() {
    let light = "lights: [Point(position: (0, 0, 0), attached: Camera)],
    ";
    for more in ["", light, "animation: Turntable(frames: 7),\n    "] {
        for lens in LENSES {
            for kind in CAMERAS {
                if more.contains("Turntable") && !kind.starts_with(['F', 'O'])
                    || kind.starts_with("Free") && more.contains("Turntable")
                {
                    continue;
                }
                let before = text(kind, lens, more);
                let mut scene = parse(&before);
                let start = scene.orbit_camera(1).unwrap();
                let camera = OrbitCamera {
                    azimuth: start.azimuth + 35.0,
                    elevation: start.elevation - 0.3,
                    roll: 2.5,
                    ..start
                };
                scene.set_orbit_camera(&camera).unwrap();
                let after = camera.put_into(&before).unwrap();
                let [old, new] = [&before, &after].map(|text| text.lines().collect::<Vec<_>>());
                assert_eq!(old.len(), new.len());
                for (index, (old, new)) in old.iter().zip(&new).enumerate() {
                    assert_eq!(old == new, index != 1, "{new}");
                }
                assert!(new[1].ends_with("), // the camera"), "{}", new[1]);
                let read = parse(&after);
                for frame in [1, 3] {
                    assert_eq!(read.view(frame), scene.view(frame), "{kind} {lens} {more}");
                }
                let lights =
                    |scene: &Scene| -> Vec<Light> { scene.lights(&scene.view(1).unwrap()) };
                assert_eq!(lights(&read), lights(&scene));
                assert_eq!(read.world().lights, scene.world().lights);
                // What is written is not written again.
                assert_eq!(camera.put_into(&after).unwrap(), after);
            }
        }
    }
}

#[test]
fn the_camera_of_the_file_comes_back() {
    for lens in LENSES {
        for camera in CAMERAS {
            let mut scene = parse(&text(camera, lens, ""));
            let before = scene.view(1).unwrap();
            let start = scene.orbit_camera(1).unwrap();
            let turned = OrbitCamera {
                azimuth: 77.0,
                zoom: 3.0,
                ..start
            };
            scene.set_orbit_camera(&turned).unwrap();
            scene
                .set_orbit_camera(&OrbitCamera {
                    roll: 1.0,
                    ..turned
                })
                .unwrap();
            assert_ne!(scene.view(1).unwrap(), before);
            scene.reset_camera();
            assert_eq!(scene.view(1).unwrap(), before);
            assert_eq!(scene.orbit_camera(1), Ok(start));
            scene.set_zoom(2.0);
            assert_eq!(
                scene.view(1).unwrap(),
                View {
                    zoom: 2.0,
                    ..before
                }
            );
            scene.reset_camera();
            assert_eq!(scene.view(1).unwrap(), before);
        }
    }
}

#[test]
fn words_of_the_file_stay() {
    let camera = OrbitCamera {
        center: OrbitCenter::Framed,
        azimuth: -35.0,
        elevation: 12.5,
        roll: 0.0,
        zoom: 1.0,
    };
    let put = |camera: OrbitCamera, text: &str| camera.put_into(text).unwrap();
    let text = "(camera: Frame(elevation: 12.50, // up\r\n azimuth: 3, fill: 1),\r\n lens: Fov(1))";
    assert_eq!(
        put(camera, text),
        text.replace("azimuth: 3", "azimuth: -35")
    );
    assert_eq!(
        put(camera, "(camera: Frame( ))"),
        "(camera: Frame(azimuth: -35, elevation: 12.5 ))"
    );
    assert_eq!(
        put(
            OrbitCamera {
                zoom: 1.5,
                ..camera
            },
            "(camera: Frame(azimuth: -35, elevation: 12.5),\n)"
        ),
        "(camera: Frame(azimuth: -35, elevation: 12.5), zoom: 1.5,\n)"
    );
    assert_eq!(
        put(camera, "(zoom: 2 /* two */, camera: Free(pan: 3))"),
        "(zoom: 1 /* two */, camera: Frame(azimuth: -35, elevation: 12.5))"
    );
    let at = OrbitCamera {
        center: OrbitCenter::At {
            target: DVec3::new(-0.0, 0.25, 1e-9),
            radius: 3e20,
        },
        roll: 4.0,
        zoom: 1.25,
        ..camera
    };
    let line = "camera: Orbit(target: (0, 0.25, 1e-9), radius: 3e20, azimuth: -35, elevation: 12.5, roll: 4), zoom: 1.25,";
    assert_eq!(at.line(), line);
    assert_eq!(OrbitCamera::line_of(&put(at, "(camera: Free())")), line);
    assert_eq!(
        camera.line(),
        "camera: Frame(azimuth: -35, elevation: 12.5),"
    );
    assert_eq!(
        camera.put_into("(lens: Fov(3))"),
        Err("expected a field `camera`, found none".to_owned())
    );
}

#[test]
fn some_cameras_cannot_be_turned() {
    let keys = |key: &str| format!("animation: Keyframes(frames: (1, 3), keys: [({key})]),\n    ");
    for (key, expected) in [
        ("frame: 1, azimuth: 3", Err(Unturnable::Keyed)),
        ("frame: 1, zoom: 2", Err(Unturnable::Keyed)),
        ("frame: 1", Ok(())),
        ("frame: 1, light: \"a\", intensity: 2", Ok(())),
    ] {
        let light = "lights: [Directional(name: \"a\", toward: (0, 1, 0))],\n    ";
        let scene = parse(&text("Frame()", "Fov(40)", &(keys(key) + light)));
        assert_eq!(scene.orbit_camera(1).map(|_| ()), expected, "{key}");
    }
    let away = parse(&text("Free(pan: 180)", "Fov(40)", ""));
    assert_eq!(away.orbit_camera(1), Err(Unturnable::NothingSeen));
}

#[test]
fn cameras_are_written_into_scenes_in_ron_only() {
    let json = r#"{"image": {"width": 9, "height": 9}, "lens": {"Fov": 40}, "camera": {"Frame": {}},
        "spheres": [{"center": [0, 0, 0], "radius": 1}]}"#;
    let camera = parse(json).orbit_camera(1).unwrap();
    let refused = Err("expected a scene in RON, found one in JSON".to_owned());
    assert_eq!(camera.put_into(json), refused);
    assert_eq!(camera.put_zoom_into(json), refused);
}

/// Around a ball in the middle of the picture, a wall behind it fills most of the picture. A ball at the edge is what is
/// seen if there is nothing else.
#[test]
fn the_middle_of_the_picture_counts_first() {
    let radius = |spheres: &str| {
        let text = format!(
            "(image: (width: 90, height: 90), lens: Fov(90), camera: Free(), spheres: [{spheres}])"
        );
        match parse(&text).orbit_camera(1).unwrap().center {
            OrbitCenter::At { target, radius } => {
                assert!(target.distance(radius * DVec3::Z) < 1e-5 * radius);
                radius
            }
            OrbitCenter::Framed => panic!("the camera is free"),
        }
    };
    // Its surface is from 4 to 6.93 away, of which the median is nearer to the middle.
    let near = "(center: (0, 0, 8), radius: 4)";
    let wall = "(center: (0, 0, 1000), radius: 900)";
    let aside = "(center: (40, 0, 50), radius: 6)";
    assert!((4.0..6.0).contains(&radius(near)));
    assert!((4.0..6.9).contains(&radius(&format!("{near}, {wall}"))));
    assert!((44.0..50.0).contains(&radius(aside)));
}

/// All steps of a table would have to be read again for each angle.
#[test]
fn a_camera_of_steps_keeps_its_distance() {
    let name = format!("marbles orbit {}", std::process::id());
    let folder = std::env::temp_dir().join(name);
    std::fs::create_dir_all(&folder).unwrap();
    let table = "1\n\nO 0 0 0\n1\n\nO 4 1 2\n";
    std::fs::write(folder.join("steps.xyz"), table).unwrap();
    let text = "(image: (width: 64, height: 48), lens: Fov(40), camera: Frame(azimuth: 10),
        clouds: [(file: \"steps.xyz\", frames: All)])";
    let path = folder.join("scene.ron");
    let mut scene = Scene::parse(text, &path).unwrap();
    let before = scene.view(2).unwrap();
    let start = scene.orbit_camera(2).unwrap();
    scene.set_orbit_camera(&start).unwrap();
    let seen = scene.view(2).unwrap();
    let center = DVec3::new(4.0, 1.0, -2.0);
    let [one, other] = [before, seen].map(|view| view.project(center).unwrap());
    assert!(one.distance(other) < 1e-3, "{one} {other}");
    let turned = OrbitCamera {
        azimuth: 30.0,
        ..start
    };
    scene.set_orbit_camera(&turned).unwrap();
    let after = turned.put_into(text).unwrap();
    // The middle of both places, with z negated.
    assert!(
        after.contains("camera: Orbit(target: (2, 0.5, -1), radius: "),
        "{after}"
    );
    let read = Scene::parse(&after, &path).unwrap();
    assert_eq!(read.view(2), scene.view(2));
    let parallel = text.replace("Fov(40)", "Parallel(width: 9)");
    let scene = Scene::parse(&parallel, &path).unwrap();
    assert_eq!(scene.orbit_camera(1), Err(Unturnable::ScaledByAllSteps));
    std::fs::remove_dir_all(folder).unwrap();
}
