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

/// The diameters of a frame's lights, in degrees.
fn diameters(scene: &Scene, frame: i32) -> Vec<f64> {
    let lights = scene.lights(&scene.view(frame).unwrap());
    let directional = lights.iter().map(|light| match light {
        Light::Directional(light) => light.diameter().to_degrees(),
        Light::Point(_) => f64::NAN,
    });
    directional.collect()
}

#[test]
fn a_light_is_a_sun_where_it_has_a_diameter() {
    let scene = scene(
        "lights: [Directional(toward: (0, 1, 0)), Directional(toward: (0, 1, 0), diameter: 0.5),
            Directional(toward: (0, 1, 0), diameter: 179.99999999999997)]",
    );
    let found = diameters(&scene, 1);
    assert_eq!(found[..2], [0.0, 0.5]);
    assert!((found[2] - 180.0).abs() < 1e-12);
    let suns = scene
        .world()
        .lights
        .iter()
        .map(|light| light.sun().is_some());
    assert_eq!(suns.collect::<Vec<_>>(), [false, true, true]);
}

#[test]
fn keys_change_the_diameter_and_attached_lights_keep_theirs() {
    let scene = scene(
        r#"lights: [Directional(name: "a", toward: (0, 1, 0)), Directional(toward: (1, 0, 0), diameter: 3, attached: Camera)],
        animation: Keyframes(keys: [
            (frame: 1, light: "a", diameter: 0, ease: Linear),
            (frame: 5, light: "a", diameter: 2),
            (frame: 5, pan: 20),
        ])"#,
    );
    for (frame, expected) in [(1, 0.0), (2, 0.5), (3, 1.0), (5, 2.0)] {
        let found = diameters(&scene, frame);
        for (found, expected) in found.iter().zip([expected, 3.0]) {
            assert!((found - expected).abs() < 1e-15, "{frame}: {found}");
        }
    }
}

#[test]
fn the_sky_is_a_color_or_two_halves() {
    let sky = |text: &str| scene(&format!("sky: {text}")).world().sky;
    let color = DVec3::new(0.25, 0.5, 1.0);
    for text in [
        "(0.25, 0.5, 1)",
        "[0.25, 0.5, 1]",
        "( /* a: */ 0.25, 0.5, 1,)",
    ] {
        assert_eq!(sky(text), Some(Sky::uniform(color)), "{text}");
    }
    assert_eq!(sky("0.5"), Some(Sky::uniform(DVec3::splat(0.5))));
    assert_eq!(sky("\"#fff\""), Some(Sky::uniform(DVec3::ONE)));
    let halves = |up| Sky::in_halves(color, DVec3::ZERO, up).ok();
    for text in [
        "(above: (0.25, 0.5, 1), below: 0)",
        "Sky(below: \"black\", above: (0.25, 0.5, 1))",
        "( // of day\n above /* . */ : (0.25, 0.5, 1), below: 0)",
    ] {
        assert_eq!(sky(text), halves(DVec3::Y), "{text}");
    }
    let tilted = sky("(above: (0.25, 0.5, 1), below: 0, up: (0, 3, -4))").unwrap();
    assert!((tilted.up() - DVec3::new(0.0, 0.6, -0.8)).length() < 1e-15);
    assert_eq!(scene("").world().sky, None);
    assert_eq!(Channels::of(scene("sky: 1").world(), false), Channels::Grey);
    assert_eq!(
        Channels::of(scene("sky: \"tan\"").world(), false),
        Channels::Rgb
    );
}

/// The sky of a frame.
fn sky(scene: &Scene, frame: i32) -> Sky {
    let view = scene.view(frame).unwrap();
    let sky = scene.sky(&view).unwrap();
    assert_eq!(scene.exposure(&view).sky(), Some(sky));
    sky
}

#[test]
fn keys_change_the_sky() {
    let scene = scene(
        "sky: 0.5,
        animation: Keyframes(keys: [
            (frame: 1, sky: 0, pan: 3, ease: Linear),
            (frame: 5, sky: (above: (1, 1, 0), below: 0), ease: Linear),
            (frame: 7, sky: (above: 1, below: 0, up: (1, 0, 0)), ease: Hold),
        ])",
    );
    assert!(scene.has_moving_lights());
    let black = Sky::in_halves(DVec3::ZERO, DVec3::ZERO, DVec3::X).unwrap();
    assert_eq!(scene.world().sky, Some(black));
    assert_eq!(sky(&scene, 1), black);
    let halfway = Sky::in_halves(DVec3::new(0.5, 0.5, 0.0), DVec3::ZERO, DVec3::X);
    assert_eq!(sky(&scene, 3), halfway.unwrap());
    let last = Sky::in_halves(DVec3::ONE, DVec3::ZERO, DVec3::X);
    assert_eq!(sky(&scene, 7), last.unwrap());
    assert_eq!(scene.exposure(&scene.view(7).unwrap()).lights(), None);
    // All frames have three channels, whatever their own skies are.
    assert_eq!(Channels::of(scene.world(), false), Channels::Rgb);
}

#[test]
fn a_sky_whose_up_passes_the_zero_vector_has_none_there() {
    let scene = scene(
        "sky: (above: 1, below: 0),
        animation: Keyframes(keys: [
            (frame: 1, sky: (above: 1, below: 0, up: (0, 1, 0)), ease: Linear),
            (frame: 3, sky: (above: 1, below: 0, up: (0, -1, 0))),
        ])",
    );
    let error = scene.view(2).unwrap_err();
    assert_eq!(error.to_string(), "frame 2: the sky has no direction `up`");
    assert!(scene.view(3).is_ok());
}

/// The directions in which the lamps of a frame face, and their powers.
fn emissions(scene: &Scene, frame: i32) -> Vec<(DVec3, f64)> {
    let lights = scene.lights(&scene.view(frame).unwrap());
    let lamps = lights.iter().filter_map(Light::point);
    let emissions = lamps.filter_map(|lamp| lamp.emission());
    emissions
        .map(|emission| (emission.direction(), emission.mu()))
        .collect()
}

#[test]
fn a_lamp_with_a_direction_has_lambert_s_law_by_default() {
    let scene = scene(
        "lights: [Point(position: (0, 1, 0), direction: (0, 3, -4)), Point(position: (0, 1, 0)),
            Point(position: (0, 1, 0), direction: (0, 0, 2), mu: 0)]",
    );
    let [(direction, mu), half_space] = emissions(&scene, 1)[..] else {
        panic!("two lamps with directions");
    };
    assert!((direction - DVec3::new(0.0, 0.6, -0.8)).length() < 1e-15);
    assert_eq!(mu, 1.0);
    assert_eq!(half_space, (DVec3::Z, 0.0));
}

#[test]
fn an_attached_lamp_turns_with_the_camera() {
    let fields = "lights: [Point(position: (1, 0, 0), direction: (0, 0, 1), attached: Camera)],
        animation: Turntable(frames: 8)";
    let scene = filmed("Orbit(target: (1, 2, 3), radius: 4, elevation: 20)", fields);
    for frame in 1..=8 {
        let [(direction, mu)] = emissions(&scene, frame)[..] else {
            panic!("one lamp");
        };
        let forward = camera(&scene, frame).forward();
        assert!((direction - forward).length() < 1e-15, "{frame}");
        assert_eq!(mu, 1.0);
    }
}

#[test]
fn keys_turn_lamps_and_narrow_them() {
    let scene = scene(
        r#"lights: [Point(name: "a", position: (0, 1, 0), direction: (0, 0, 1), mu: 3)],
        animation: Keyframes(keys: [
            (frame: 1, light: "a", direction: (0, 0, 1), mu: 1, ease: Linear),
            (frame: 5, light: "a", direction: (2, 0, 1), mu: 9),
            (frame: 7, light: "a", direction: (-2, 0, -1)),
        ])"#,
    );
    let middle = DVec3::new(1.0, 0.0, 1.0).normalize();
    let [(direction, mu)] = emissions(&scene, 3)[..] else {
        panic!("one lamp");
    };
    assert!((direction - middle).length() < 1e-15);
    assert_eq!(mu, 5.0);
    assert_eq!(emissions(&scene, 7)[0].1, 9.0);
    // Half-way between opposite directions it has none.
    let error = scene.view(6).unwrap_err();
    assert_eq!(error.to_string(), "frame 6: light 1 has no direction");
}

#[test]
fn a_turntable_turns_lamps_with_what_they_face() {
    let scene = scene(
        "lights: [Point(position: (0, 1, 5), direction: (0, -1, -1))],
        animation: Turntable(frames: 4, what: Lights)",
    );
    let root = 0.5_f64.sqrt();
    for (frame, x, z) in [(1, 0.0, -1.0), (2, -1.0, 0.0), (3, 0.0, 1.0), (4, 1.0, 0.0)] {
        let expected = DVec3::new(x * root, -root, z * root);
        let (found, _) = emissions(&scene, frame)[0];
        assert!((found - expected).length() < 1e-15, "{frame}: {found}");
    }
}
