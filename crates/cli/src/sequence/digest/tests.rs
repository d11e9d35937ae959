use std::num::NonZeroU32;
use std::path::Path;

use marbles_core::Sphere;
use marbles_scene::Scene;

use super::*;
use crate::formats::center_channels::{AxesForm, CenterChannel, DepthForm};
use crate::formats::tests::PNG as PLAIN;

const SCENE: &str = "(
    image: (width: 60, height: 40),
    lens: Retina(width: 60, distance: 100, shift: (1, 2)),
    camera: Free(position: (0, 1, 2), pan: 3),
    zoom: 1.5,
    background: 0.25,
    ambient: 0.125,
    shadows: true,
    lights: [Directional(toward: (-1, 1, -1), intensity: 0.5)],
    materials: {
        \"candy\": (albedo: 0.5, exponent: 2, highlight: (strength: 0.6, shininess: 40),
                  rough: (amplitude: 0.5, grain: Surface(12), seed: 1)),
    },
    spheres: [(center: (0, 0, 400), radius: 300, material: \"candy\"),
              (center: (9, 0, 400), radius: 30)],
    animation: Keyframes(frames: (1, 9), fps: 24, keys: [(frame: 1, tilt: 0), (frame: 9, tilt: 5)]),
)";

const SETTINGS: Settings = Settings {
    method: Method::Tolerance(1e-3),
    alpha: false,
};
const PNG: Encoding = Encoding::Png(PLAIN);

fn digest_with(centers: Option<&CenterChannels>) -> Hash {
    let scene = Scene::parse(SCENE, Path::new("a.ron")).unwrap();
    let digests = Input::new(scene.world(), &hashes_of_spheres(scene.world()), &SETTINGS)
        .digests(PNG, centers);
    digests.of(&Shot {
        exposure: &scene.exposure(&scene.view(2).unwrap()),
        frame: 2,
        frames_per_second: scene.frames_per_second(),
    })
}

#[test]
fn channels_change_the_digest() {
    let centers = |groups: &[CenterChannel], depth, axes| {
        let centers = CenterChannels::new(groups, depth, axes, true, 1e-3);
        digest_with(Some(&centers))
    };
    let (axis, ray) = (DepthForm::Axis, DepthForm::Ray);
    let (world, camera) = (AxesForm::World, AxesForm::CameraOpenCv);
    let depth = &[CenterChannel::Depth][..];
    let digests = [
        digest_with(None),
        centers(depth, axis, world),
        centers(depth, ray, world),
        centers(depth, axis, camera),
        centers(&[CenterChannel::Id], axis, world),
        centers(&[CenterChannel::Id, CenterChannel::Depth], axis, world),
    ];
    for (index, digest) in digests.iter().enumerate() {
        assert!(!digests[..index].contains(digest), "{index}");
    }
    // The order of their names does not matter.
    let turned = centers(&[CenterChannel::Depth, CenterChannel::Id], axis, world);
    assert_eq!(digests[5], turned);
}

fn digest(text: &str, settings: &Settings, encoding: Encoding, frame: i32) -> Hash {
    let scene = Scene::parse(text, Path::new("a.ron")).unwrap();
    let digests = Input::new(scene.world(), &hashes_of_spheres(scene.world()), settings)
        .digests(encoding, None);
    let digests = digests.with_names(&scene.description().lights);
    digests.of(&Shot {
        exposure: &scene.exposure(&scene.view(frame).unwrap()),
        frame,
        frames_per_second: scene.frames_per_second(),
    })
}

#[test]
fn whatever_changes_a_picture_changes_its_digest() {
    let mut seen = vec![digest(SCENE, &SETTINGS, PNG, 2)];
    let mut add = |what: &str, digest: Hash| {
        assert!(!seen.contains(&digest), "{what}");
        seen.push(digest);
    };
    for (old, new) in [
        ("width: 60, height", "width: 61, height"),
        ("height: 40", "height: 41"),
        ("width: 60, d", "width: 61, d"),
        ("distance: 100", "distance: 101"),
        ("(1, 2)", "(0, 2)"),
        ("(1, 2)", "(1, 3)"),
        (
            "Retina(width: 60, distance: 100, shift: (1, 2))",
            "Matrix(fx: 90, fy: 90, cx: 9, cy: 9)",
        ),
        (
            "Retina(width: 60, distance: 100, shift: (1, 2))",
            "Matrix(fx: 90, fy: 91, cx: 9, cy: 9)",
        ),
        ("(0, 1, 2)", "(0, 1, 3)"),
        ("pan: 3", "pan: 4"),
        ("zoom: 1.5", "zoom: 1.25"),
        ("background: 0.25", "background: 0.5"),
        ("ambient: 0.125", "ambient: 0.5"),
        ("ambient: 0.125", "ambient: 0.125, sky: 0"),
        ("ambient: 0.125", "ambient: 0.125, sky: 0.5"),
        (
            "ambient: 0.125",
            "ambient: 0.125, sky: (above: 0.5, below: 0.25)",
        ),
        (
            "ambient: 0.125",
            "ambient: 0.125, sky: (above: 0.5, below: 0.25, up: (0, 1, 1))",
        ),
        ("shadows: true", "shadows: false"),
        ("toward: (-1", "toward: (-2"),
        (
            "Directional(toward: (-1, 1, -1)",
            "Point(reference: 2, position: (-1, 1, -1)",
        ),
        (
            "Directional(toward: (-1, 1, -1)",
            "Point(reference: 2, position: (-1, 1, -1), direction: (0, 0, 1)",
        ),
        (
            "Directional(toward: (-1, 1, -1)",
            "Point(reference: 2, position: (-1, 1, -1), direction: (0, 0, 1), mu: 2",
        ),
        (
            "Directional(toward: (-1, 1, -1)",
            "Point(reference: 2, position: (-1, 1, -1), direction: (0, 1, 1), mu: 2",
        ),
        ("intensity: 0.5", "intensity: 0.25"),
        ("intensity: 0.5", "intensity: 0.5, diameter: 0.5"),
        ("intensity: 0.5", "intensity: 0.5, diameter: 2"),
        ("intensity: 0.5", "intensity: 0.5, name: \"key\""),
        ("intensity: 0.5", "intensity: 0.5, name: \"rim\""),
        ("intensity: 0.5", "intensity: 0.5, attached: Camera"),
        ("albedo: 0.5", "albedo: (0.5, 0.5, 0.25)"),
        ("exponent: 2", "exponent: 3"),
        ("strength: 0.6", "strength: 0.7"),
        ("shininess: 40", "shininess: 41"),
        ("highlight: (strength: 0.6, shininess: 40),", ""),
        ("amplitude: 0.5", "amplitude: 0.25"),
        ("Surface(12)", "Surface(13)"),
        ("Surface(12)", "Pixel"),
        ("seed: 1", "seed: 2"),
        ("radius: 300", "radius: 301"),
        ("(0, 0, 400)", "(0, 0, 401)"),
        (", material: \"candy\"", ""),
        ("radius: 30)", "radius: 30, material: \"candy\")"),
        (", (frame: 9, tilt: 5)", ", (frame: 9, tilt: 6)"),
        ("fps: 24", "fps: 25"),
        ("fps: 24", "fps: 24, shutter: 0.5"),
        ("fps: 24", "fps: 24, shutter: 0.25"),
    ] {
        assert!(SCENE.contains(old), "{old}");
        let scene = SCENE.replacen(old, new, 1);
        add(new, digest(&scene, &SETTINGS, PNG, 2));
    }
    add("frame", digest(SCENE, &SETTINGS, PNG, 3));
    for (method, alpha) in [
        (Method::Tolerance(1e-3), true),
        (Method::Tolerance(1e-4), false),
        (Method::Samples(NonZeroU32::MIN), false),
        (Method::Samples(NonZeroU32::MAX), false),
    ] {
        let settings = Settings { method, alpha };
        add("settings", digest(SCENE, &settings, PNG, 2));
    }
    for (one, other) in [(false, true), (true, false), (true, true)] {
        let (deep, rgb) = (one, other);
        let encoding = Encoding::Png(PngOptions { deep, rgb, ..PLAIN });
        add("PNG", digest(SCENE, &SETTINGS, encoding, 2));
    }
    for (linear, gain) in [(true, 1.0), (false, 0.5), (false, 2.0), (true, 2.0)] {
        let encoding = Encoding::Png(PngOptions {
            linear,
            gain,
            ..PLAIN
        });
        add("PNG", digest(SCENE, &SETTINGS, encoding, 2));
    }
    for error in [false, true] {
        let encoding = Encoding::Npy(NpyOptions {
            error,
            archive: false,
            evidence: false,
        });
        add("NPY", digest(SCENE, &SETTINGS, encoding, 2));
    }
    for (float, error) in [(false, false), (false, true), (true, false), (true, true)] {
        let encoding = Encoding::Exr(ExrOptions { float, error });
        add("EXR", digest(SCENE, &SETTINGS, encoding, 2));
    }
}

#[test]
fn what_the_camera_does_around_the_frame_counts() {
    let digest = |tilts: [f64; 2], zooms: [f64; 2]| {
        let keys = format!(
            "(frame: 1, tilt: {}, zoom: {}, ease: Linear), (frame: 3, tilt: {}, zoom: {})",
            tilts[0], zooms[0], tilts[1], zooms[1]
        );
        let scene = SCENE
            .replace("(frame: 1, tilt: 0), (frame: 9, tilt: 5)", &keys)
            .replace("fps: 24", "fps: 24, shutter: 0.5");
        let view = Scene::parse(&scene, Path::new("a.ron")).unwrap();
        let view = view.view(2).unwrap();
        (view, digest(&scene, &SETTINGS, PNG, 2))
    };
    // The same in the middle of the frame.
    let (view, reference) = digest([0.0, 4.0], [1.0, 2.0]);
    for (tilts, zooms) in [([1.0, 3.0], [1.0, 2.0]), ([0.0, 4.0], [0.5, 2.5])] {
        let (same_view, other) = digest(tilts, zooms);
        assert_eq!(same_view, view);
        assert_ne!(other, reference, "{tilts:?} {zooms:?}");
    }
}

#[test]
fn frames_that_are_seen_from_the_same_place_differ() {
    let scene = |animation: &str| {
        let (start, _) = SCENE.split_once("    animation").unwrap();
        let start = start.replace(
            "Free(position: (0, 1, 2), pan: 3)",
            "Orbit(target: (0, 0, 400), radius: 400)",
        );
        format!("{start}    animation: {animation},\n)")
    };
    let digest = |scene: &str, frame| digest(scene, &SETTINGS, PNG, frame);
    // A turn later it is the same picture, and an EXR tells another number.
    let once = scene("Turntable(frames: 9)");
    assert_ne!(digest(&once, 1), digest(&once, 10));
    // In the middle of a loop of two turns grains of pixels are other ones than at the start.
    let twice = scene("Turntable(frames: 18, turns: 2)");
    let [one, two] = [&once, &twice].map(|scene| {
        let scene = Scene::parse(scene, Path::new("a.ron")).unwrap();
        scene.view(10).unwrap()
    });
    assert_eq!((one.camera, one.frame, two.frame), (two.camera, 1, 10));
    assert_ne!(digest(&once, 10), digest(&twice, 10));
}

#[test]
fn how_a_scene_is_written_does_not_matter() {
    let reference = digest(SCENE, &SETTINGS, PNG, 2);
    for (old, new) in [
        ("(\n    image", "// A comment.\n(image"),
        ("candy", "sweets"),
        ("    shadows: true,\n", ""),
        ("0.125", "(0.125, 0.125, 0.125)"),
    ] {
        let scene = SCENE.replace(old, new);
        assert_ne!(scene, SCENE, "{old}");
        assert_eq!(digest(&scene, &SETTINGS, PNG, 2), reference, "{new}");
    }
    let pool = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| digest(SCENE, &SETTINGS, PNG, 2))
    };
    assert_eq!([pool(1), pool(3)], [reference; 2]);
}

#[test]
fn every_sphere_of_many_counts() {
    let world = |changed: Option<usize>, palette: Option<usize>| {
        let mut world = World::new();
        let white = world.add_material(Material::MATTE_WHITE);
        let count = 2 * SPHERES + 5;
        let sphere = |index| {
            let x = if changed == Some(index) {
                -1.0
            } else {
                index as f64
            };
            Sphere::new(DVec3::new(x, 0.0, 0.0), 1.0).unwrap()
        };
        let albedos = palette.map(|colored| marbles_core::Albedos::Palette {
            colors: vec![DVec3::ONE, DVec3::X],
            indices: (0..count).map(|index| u8::from(index == colored)).collect(),
        });
        world.add_spheres((0..count).map(sphere).collect(), white, albedos);
        hashes_of_spheres(&world)
    };
    let last = 2 * SPHERES + 4;
    let mut all = vec![world(None, None)];
    for place in [0, SPHERES - 1, SPHERES, last] {
        all.push(world(Some(place), None));
        all.push(world(None, Some(place)));
    }
    for (index, one) in all.iter().enumerate() {
        assert!(!all[..index].contains(one), "{index}");
    }
}
