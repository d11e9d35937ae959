//! Lights over time.

use super::*;

fn directions(scene: &Scene, frame: i32) -> Vec<DVec3> {
    let lights = scene.lights(&scene.view(frame).unwrap());
    lights.iter().filter_map(Light::toward).collect()
}

#[test]
fn lights_have_names_where_the_file_gives_them_any() {
    let lights =
        r#"lights: [Directional(toward: (0, 1, 0), name: "key"), Directional(toward: (1, 0, 0))]"#;
    let scene = scene(lights);
    let names = &scene.description().lights;
    assert_eq!(*names, [Some(String::from("key")), None]);
    assert!(!scene.has_moving_lights());
    let view = scene.view(1).unwrap();
    assert_eq!(scene.exposure(&view).lights(), None);
}

#[test]
fn an_attached_light_moves_with_the_camera() {
    let fields = "lights: [Directional(toward: (0, 0, -1), attached: Camera)],
        animation: Turntable(frames: 8)";
    let scene = filmed("Orbit(target: (1, 2, 3), radius: 4, elevation: 20)", fields);
    for frame in 1..=8 {
        let backward = -camera(&scene, frame).forward();
        let [toward] = directions(&scene, frame)[..] else {
            panic!("one light");
        };
        assert!((toward - backward).length() < 1e-15, "{frame}");
    }
    let toward = scene.world().lights[0].toward();
    assert_eq!(toward, Some(directions(&scene, 1)[0]));
}

#[test]
fn keys_name_lights_as_they_name_the_camera() {
    let scene = scene(
        r#"lights: [Directional(name: "a", toward: (0, 1, 0)), Directional(name: "b", toward: (1, 0, 0))],
        animation: Keyframes(keys: [
            (frame: 1, light: "a", toward: (0, 1, 0), ease: Linear),
            (frame: 3, pan: 7),
            (frame: 2, light: "b", intensity: (0.5, 0, 0)),
            (frame: 5, light: "a", toward: (4, 1, 0)),
        ])"#,
    );
    assert_eq!(scene.frames(), Some(1..=5));
    let middle = DVec3::new(2.0, 1.0, 0.0).normalize();
    let [a, b] = directions(&scene, 3)[..] else {
        panic!("two lights");
    };
    assert!((a - middle).length() < 1e-15);
    assert_eq!(b, DVec3::X);
    let exposure = scene.exposure(&scene.view(3).unwrap());
    let lights = exposure.lights().unwrap();
    assert_eq!(lights[0].intensity(), DVec3::ONE);
    assert_eq!(lights[1].intensity(), DVec3::new(0.5, 0.0, 0.0));
    // All frames have three channels, whatever their own lights are.
    assert_eq!(Channels::of(scene.world(), false), Channels::Rgb);
}

#[test]
fn a_turntable_turns_lights_about_the_vertical() {
    let lights = "lights: [Directional(toward: (0, 1, 1)), Directional(toward: (1, 0, 0), attached: Camera)],
        animation: Turntable(frames: 4, what: Lights)";
    let scene = scene(lights);
    // As the view of an orbit turns: from z over x.
    let root = 0.5_f64.sqrt();
    for (frame, x, z) in [(1, 0.0, 1.0), (2, 1.0, 0.0), (3, 0.0, -1.0), (4, -1.0, 0.0)] {
        let expected = DVec3::new(x * root, root, z * root);
        let found = directions(&scene, frame);
        assert!((found[0] - expected).length() < 1e-15, "{frame}: {found:?}");
        assert_eq!(found[1], DVec3::X);
        assert_eq!(camera(&scene, frame), camera(&scene, 1));
    }
    assert_eq!(directions(&scene, 5), directions(&scene, 1));
}

#[test]
fn a_light_that_passes_the_zero_vector_has_no_direction_there() {
    let scene = scene(
        r#"lights: [Directional(name: "a", toward: (0, 1, 0))],
        animation: Keyframes(keys: [
            (frame: 1, light: "a", toward: (0, 1, 0), ease: Linear),
            (frame: 3, light: "a", toward: (0, -1, 0)),
        ])"#,
    );
    let error = scene.view(2).unwrap_err();
    assert_eq!(error.to_string(), "frame 2: light 1 has no direction");
    assert!(scene.view(3).is_ok());
}
