use std::path::Path;

mod lights;
mod opencv;
mod other_files;
mod series;
mod steps;

use glam::{DVec2, DVec3};
use marbles_core::{
    Angle, Camera, Channels, Grain, Highlight, Light, Material, Outline, OutlineWidth, Roughness,
    Sky,
};

use super::*;

const PATH: &str = "scene.ron";

/// The scene with these fields besides an image, a lens and a camera that matter to no test.
fn scene(fields: &str) -> Scene {
    parse(&format!(
        "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(), {fields})"
    ))
}

/// The scene with this camera and these further fields.
fn filmed(camera: &str, fields: &str) -> Scene {
    parse(&format!(
        "(image: (width: 6, height: 4), lens: Fov(90), camera: {camera}, {fields})"
    ))
}

fn parse(text: &str) -> Scene {
    Scene::parse(text, Path::new(PATH)).unwrap_or_else(|error| panic!("{error}"))
}

fn refusal(text: &str) -> String {
    let error = Scene::parse(text, Path::new(PATH)).unwrap_err();
    let fault = &error.faults()[0];
    format!("{}:{}: {}", fault.line, fault.column, fault.message)
}

fn camera(scene: &Scene, frame: i32) -> Camera {
    scene.view(frame).unwrap().camera
}

fn free(position: DVec3, pan: f64, tilt: f64, roll: f64) -> Camera {
    let angle = Angle::from_degrees;
    Camera::free(position, angle(pan), angle(tilt), angle(roll))
}

/// The same camera, whose axis is measured from its target.
fn toward(target: DVec3, camera: Camera) -> Camera {
    Camera {
        on_axis: target,
        ..camera
    }
}

#[test]
fn what_is_left_out_has_its_default() {
    let scene = scene("");
    let world = scene.world();
    assert_eq!(
        (world.background, world.ambient),
        (DVec3::ZERO, DVec3::ZERO)
    );
    assert!(world.shadows && world.lights.is_empty() && world.spheres().is_empty());
    let view = scene.view(5).unwrap();
    assert_eq!(
        (view.width, view.height, view.frame, view.zoom),
        (6, 4, 5, 1.0)
    );
    assert_eq!(view.camera, free(DVec3::ZERO, 0.0, 0.0, 0.0));
    assert_eq!((scene.frames(), scene.frames_per_second()), (None, None));
    assert_eq!(
        *scene.description(),
        Description {
            materials: Vec::new(),
            lights: Vec::new(),
            camera: "Free",
            animation: None,
            lens: String::from("Fov(90)"),
            unit: None,
        }
    );
}

#[test]
fn surfaces_have_their_defaults() {
    let scene = scene(
        r#"materials: {"plain": (), "shiny": (highlight: ()), "rough": (rough: ())},
           lights: [Directional(toward: (0, 2, 0))],
           spheres: [(center: (1, 2, 3), radius: 4),
                     (center: (0, 0, 0), radius: 1, material: "plain"),
                     (center: (0, 0, 0), radius: 1, material: "shiny"),
                     (center: (0, 0, 0), radius: 1, material: "rough")]"#,
    );
    let world = scene.world();
    assert_eq!(world.spheres()[0].center(), DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(world.spheres()[0].radius(), 4.0);
    assert_eq!(*world.material(0), Material::MATTE_WHITE);
    assert_eq!(*world.material(1), Material::MATTE_WHITE);
    let highlight = Some(Highlight {
        strength: 0.5,
        shininess: 40.0,
    });
    assert_eq!(world.material(2).highlight, highlight);
    let roughness = Some(Roughness {
        amplitude: 0.5,
        grain: Grain::Pixel,
        seed: 0,
    });
    assert_eq!(world.material(3).roughness, roughness);
    assert_eq!(world.lights[0].toward(), Some(DVec3::Y));
    assert_eq!(world.lights[0].intensity(), DVec3::ONE);
    assert_eq!(scene.description().materials.len(), 3);
}

#[test]
fn every_field_of_a_surface_is_read() {
    let scene = scene(
        r##"background: (0.1, 0.2, 0.3), ambient: "#ffffff", shadows: false,
           lights: [Directional(toward: (1, 0, 0), intensity: (1, 2, 3))],
           materials: {"candy": (albedo: 0.25, exponent: 2, highlight: (strength: 0.6, shininess: 8),
                       rough: (amplitude: 0.1, grain: Surface(12), seed: 18446744073709551615),
                       outline: (width: Units(0.25), color: (1, 0, 0)))},
           spheres: [(center: (0, 0, 0), radius: 1, material: "candy")]"##,
    );
    let world = scene.world();
    assert_eq!(world.background, DVec3::new(0.1, 0.2, 0.3));
    assert_eq!(world.ambient, DVec3::ONE);
    assert!(!world.shadows);
    assert_eq!(world.lights[0].intensity(), DVec3::new(1.0, 2.0, 3.0));
    let expected = Material {
        albedo: DVec3::splat(0.25),
        exponent: 2.0,
        highlight: Some(Highlight {
            strength: 0.6,
            shininess: 8.0,
        }),
        roughness: Some(Roughness {
            amplitude: 0.1,
            grain: Grain::Surface(12.0),
            seed: u64::MAX,
        }),
        outline: Some(Outline {
            width: OutlineWidth::Units(0.25),
            color: DVec3::X,
        }),
    };
    assert_eq!(*world.material(0), expected);
}

#[test]
fn outlines_are_black_and_in_pixels_by_default() {
    let outline = |written: &str| {
        let material = format!(
            r#"materials: {{"a": (outline: ({written}))}}, spheres: [(center: (0, 0, 3), radius: 1, material: "a")]"#
        );
        scene(&material).world().material(0).outline
    };
    for (written, width, color) in [
        ("", 1.5, DVec3::ZERO),
        ("width: 2", 2.0, DVec3::ZERO),
        ("color: 0.5", 1.5, DVec3::splat(0.5)),
    ] {
        let width = OutlineWidth::Pixels(width);
        assert_eq!(outline(written), Some(Outline { width, color }));
    }
}

#[test]
fn lenses_are_read() {
    let with_lens = |lens: &str| {
        parse(&format!(
            "Scene(image: (width: 65536, height: 65536), lens: {lens}, camera: Free())"
        ))
    };
    let retina = with_lens("Retina(width: 600, distance: 100.5)");
    let lens = retina.view(1).unwrap().lens;
    assert_eq!(
        (lens.width, lens.distance, lens.shift),
        (600.0, 100.5, DVec2::ZERO)
    );
    assert_eq!(
        retina.description().lens,
        "Retina(width: 600, distance: 100.5)"
    );
    let shifted = with_lens("Retina(width: 600, distance: 100, shift: (1, -2))");
    assert_eq!(shifted.view(1).unwrap().lens.shift, DVec2::new(1.0, -2.0));
    assert_eq!(
        shifted.description().lens,
        "Retina(width: 600, distance: 100, shift: (1, -2))"
    );
    let right_angle = with_lens("Fov(90)").view(1).unwrap().lens;
    assert!((right_angle.width / right_angle.distance - 2.0).abs() < 1e-15);
    for extreme in ["5e-324", "1e-300", "179.9999999", "179.99999999999997"] {
        let lens = with_lens(&format!("Fov({extreme})")).view(1).unwrap().lens;
        assert!(lens.width > 0.0 && lens.width.is_finite(), "{extreme}");
    }
}

#[test]
fn numbers_may_be_written_in_every_way_of_the_format() {
    let scene = filmed(
        "Free(position: (+1_000, 1e-3, 16.), pan: 90.0f64)",
        "zoom: .5",
    );
    let view = scene.view(1).unwrap();
    assert_eq!(view.camera.position, DVec3::new(1000.0, 0.001, 16.0));
    assert_eq!(view.camera.forward(), DVec3::X);
    assert_eq!(view.zoom, 0.5);
}

#[test]
fn a_byte_order_mark_is_skipped() {
    parse("\u{feff}(image: (width: 6, height: 4), lens: Fov(90), camera: Free())");
    assert!(refusal("\u{feff}(image: 3)").starts_with("1:9: "));
}

#[test]
fn a_look_at_camera_looks_at_its_target() {
    let scene = filmed(
        "LookAt(position: (1, 2, 3), target: (1, 2, 7), roll: 90)",
        "",
    );
    assert_eq!(
        camera(&scene, 1),
        toward(
            DVec3::new(1.0, 2.0, 7.0),
            free(DVec3::new(1.0, 2.0, 3.0), 0.0, 0.0, 90.0)
        )
    );
    assert_eq!(scene.description().camera, "LookAt");
    for (target, direction, tilt) in [
        ("(0, 9, 0)", DVec3::Y, 90.0),
        ("(0, -9, 0)", -DVec3::Y, -90.0),
    ] {
        let scene = filmed(
            &format!("LookAt(position: (0, 0, 0), target: {target})"),
            "",
        );
        assert_eq!(camera(&scene, 1).forward(), direction);
        let expected = free(DVec3::ZERO, 0.0, tilt, 0.0);
        assert_eq!(camera(&scene, 1), toward(9.0 * direction, expected));
    }
    let far = filmed(
        "LookAt(position: (-1e308, 0, 0), target: (1e308, 0, 0))",
        "",
    );
    assert_eq!(camera(&far, 1).forward(), DVec3::X);
}

#[test]
fn an_orbit_is_the_free_camera_behind_its_target() {
    let scene = filmed(
        "Orbit(target: (10, 20, 30), radius: 900, azimuth: 40, elevation: 15, roll: 5)",
        "",
    );
    let turned = free(DVec3::ZERO, 40.0, -15.0, 5.0);
    let target = DVec3::new(10.0, 20.0, 30.0);
    let position = target - 900.0 * turned.forward();
    assert_eq!(
        camera(&scene, 1),
        toward(target, free(position, 40.0, -15.0, 5.0))
    );
    let plain = filmed("Orbit(target: (0, 0, 4), radius: 4)", "");
    let behind = free(DVec3::ZERO, 0.0, 0.0, 0.0);
    assert_eq!(camera(&plain, 1), toward(DVec3::new(0.0, 0.0, 4.0), behind));
    assert_eq!(plain.description().camera, "Orbit");
}

#[test]
fn keys_lead_each_channel_on_its_own() {
    let scene = filmed(
        "Free(position: (5, 0, 0), tilt: 45)",
        "zoom: 3, animation: Keyframes(frames: (1, 120), fps: 25, keys: [
            (frame: 1, pan: 0, ease: Linear),
            (frame: 31, zoom: 2),
            (frame: 61, pan: 60, ease: Hold),
            (frame: 120, position: (1, 2, 3)),
        ])",
    );
    assert_eq!(scene.frames(), Some(1..=120));
    assert_eq!(scene.frames_per_second(), Some(25.0));
    assert_eq!(scene.description().animation, Some("Keyframes"));
    let position = DVec3::new(1.0, 2.0, 3.0);
    assert_eq!(camera(&scene, 1), free(position, 0.0, 45.0, 0.0));
    assert_eq!(camera(&scene, 31), free(position, 30.0, 45.0, 0.0));
    assert_eq!(camera(&scene, 500), free(position, 60.0, 45.0, 0.0));
    assert_eq!(scene.view(-7).unwrap().zoom, 2.0);
    assert_eq!(scene.view(17).unwrap().frame, 17);
}

#[test]
fn keys_move_the_other_cameras_too() {
    let orbit = filmed(
        "Orbit(target: (0, 0, 0), radius: 1)",
        "animation: Keyframes(keys: [
            (frame: 0, radius: 2, azimuth: 0, elevation: 0, ease: Linear),
            (frame: 10, radius: 4, azimuth: 180, elevation: 0, target: (0, 0, 1), roll: 7),
        ])",
    );
    assert_eq!(camera(&orbit, 5), {
        let turned = free(DVec3::ZERO, 90.0, 0.0, 7.0);
        let position = DVec3::Z - 3.0 * turned.forward();
        toward(DVec3::Z, free(position, 90.0, 0.0, 7.0))
    });
    let look_at = filmed(
        "LookAt(position: (0, 0, 0), target: (0, 0, 9))",
        "animation: Keyframes(keys: [
            (frame: 0, position: (0, 0, 0), target: (0, 0, 9), ease: Linear),
            (frame: 10, position: (8, 0, 0), target: (8, 0, -9)),
        ])",
    );
    assert_eq!(camera(&look_at, 0).forward(), DVec3::Z);
    assert_eq!(camera(&look_at, 10).forward(), -DVec3::Z);
    let fault = FrameError {
        frame: 5,
        fault: crate::FrameFault::LooksNowhere,
    };
    assert_eq!(look_at.view(5), Err(fault));
    assert_eq!(
        fault.to_string(),
        "frame 5: the camera is at its target, and has no direction of view"
    );
}

#[test]
fn frames_are_those_of_the_keys_unless_given() {
    let frames = |animation: &str| scene(&format!("animation: {animation}")).frames();
    assert_eq!(frames("Keyframes()"), Some(1..=1));
    assert_eq!(
        frames("Keyframes(keys: [(frame: -3), (frame: 8)])"),
        Some(-3..=8)
    );
    assert_eq!(
        frames("Keyframes(frames: (5, 5), keys: [(frame: -3), (frame: 8)])"),
        Some(5..=5)
    );
    assert_eq!(
        scene("animation: Keyframes()").frames_per_second(),
        Some(24.0)
    );
}

#[test]
fn a_turntable_loops_to_the_bit() {
    let scene = filmed(
        "Orbit(target: (3, 2, 400), radius: 900, azimuth: 17.3, elevation: 15)",
        "animation: Turntable(frames: 7)",
    );
    assert_eq!(scene.frames(), Some(1..=7));
    assert_eq!(scene.frames_per_second(), Some(24.0));
    assert_eq!(scene.description().animation, Some("Turntable"));
    for frame in 1..=7 {
        assert_eq!(scene.view(frame).unwrap(), scene.view(frame + 7).unwrap());
        assert_eq!(scene.view(frame).unwrap(), scene.view(frame - 7).unwrap());
    }
    assert_ne!(camera(&scene, 1), camera(&scene, 2));
    let standard = filmed(
        "Orbit(target: (0, 0, 4), radius: 4)",
        "animation: Turntable()",
    );
    assert_eq!(standard.frames(), Some(1..=120));
    assert_eq!(camera(&standard, 31).forward(), DVec3::X);
}

#[test]
fn a_camera_beyond_all_numbers_is_an_error_of_the_frame() {
    let scene = filmed("Orbit(target: (0, 0, -1e308), radius: 1e308)", "");
    assert_eq!(scene.view(1).unwrap_err().fault, crate::FrameFault::TooFar);
}

#[test]
fn places_are_exact_behind_comments_and_wide_characters() {
    let head = "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(), ";
    for before in [
        "",
        " ",
        "\n",
        "/* ä */",
        "// €\n",
        "/* /* 🎱 */ */ /**/ // x\n\t",
    ] {
        for after in ["", " ", "\n", " // ü", "/* - */"] {
            let text = format!("{head}zoom:{before}-3{after}\n)");
            let start = text.rfind("-3").unwrap();
            let line = text[..start].matches('\n').count() + 1;
            let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
            let column = text[line_start..start].chars().count() + 1;
            let expected = format!("{line}:{column}: expected a zoom greater than 0, found -3");
            assert_eq!(refusal(&text), expected, "{text}");
        }
    }
}

#[test]
fn ten_thousand_spheres_are_read() {
    let spheres: String = (0..10_000)
        .map(|i| {
            format!(
                "(center: ({i}.5, -{i}e-3, 400), radius: 3, material: \"m{}\"),\n",
                i % 10
            )
        })
        .collect();
    let materials: String = (0..10)
        .map(|i| format!("\"m{i}\": (albedo: 0.{i}),"))
        .collect();
    let scene = scene(&format!("materials: {{{materials}}}, spheres: [{spheres}]"));
    assert_eq!(scene.world().spheres().len(), 10_000);
    assert_eq!(
        scene.world().spheres()[9_999].center(),
        DVec3::new(9_999.5, -9.999, 400.0)
    );
    assert_eq!(scene.world().material(123).albedo, DVec3::splat(0.3));
}
