//! Tests of `mod.rs` and `stored.rs`.

use std::fs;

use serde_json::{Value, json};

use super::*;
use crate::base::size::Size;
use crate::tests::temporary;

/// A camera that looks along +x from (1, 2, 3).
const SCENE: &str = r#"(
    image: (width: 640, height: 480),
    lens: Retina(width: 32, distance: 25, shift: (1, -2)),
    camera: Free(position: (1, 2, 3), pan: 90),
    zoom: 2,
    ambient: 0.25,
    background: (0, 0.5, 1),
    lights: [Directional(toward: (0, 0, -3), intensity: (1, 0.1, 0))],
    materials: {
        "rock": (rough: (seed: 18446744073709551615)),
        "glass": (),
        "bark": (rough: (grain: Surface(1))),
    },
)"#;

fn scene() -> Scene {
    Scene::parse(SCENE, Path::new("a.ron")).unwrap()
}

/// The fields that are known before rendering.
fn known() -> Value {
    json!({
        "scene": "wall.ron",
        "frame": 7,
        "image": {"width": 640, "height": 480},
        "camera": {
            "kind": "pinhole",
            "K": [[1000.0, 0.0, 299.5], [0.0, 1000.0, 199.5], [0.0, 0.0, 1.0]],
            "pixel_size": 0.05,
            "zoom": 2.0,
            "R": [[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]],
            "t": [3.0, 2.0, -1.0],
            "position": [1.0, 2.0, -3.0],
            "pan": 90.0,
            "tilt": 0.0,
            "roll": 0.0,
            "axes": "opencv",
            "world": "right-handed, z negated",
        },
        "lights": [{
            "name": null,
            "kind": "directional",
            "toward": [0.0, 0.0, 1.0],
            "toward_camera": [1.0, 0.0, 0.0],
            "intensity": [1.0, 0.1, 0.0],
        }],
        "ambient": [0.25, 0.25, 0.25],
        "background": [0.0, 0.5, 1.0],
        "seeds": {"bark": 0, "rock": u64::MAX},
        "version": "0.1.0",
    })
}

/// The text of a file, and its value.
fn written(sidecar: &Sidecar<'_>) -> (String, Value) {
    let text = sidecar.text().unwrap();
    let value = serde_json::from_str(&text).unwrap();
    (text, value)
}

#[test]
fn a_view_has_its_camera_and_lights_in_right_handed_axes() {
    let scene = scene();
    let view = scene.view(7).unwrap();
    let sidecar = Sidecar::of(&scene, Path::new("house/wall.ron"), 7, &view);
    let (text, value) = written(&sidecar);
    assert_eq!(value, known());
    let keys = text.lines().filter_map(|line| line.strip_prefix("  \""));
    let keys: Vec<&str> = keys.filter_map(|line| line.split('"').next()).collect();
    let expected = "scene frame image camera lights ambient background seeds version";
    assert_eq!(keys.join(" "), expected);
    assert!(text.contains("\n    \"t\": [3.0, 2.0, -1.0],\n"), "{text}");
    assert!(!text.contains("-0.0"), "{text}");
}

#[test]
fn soft_light_is_told_where_there_is_some() {
    let text = SCENE
        .replace("toward: (0, 0, -3),", "toward: (0, 0, -3), diameter: 0.53,")
        .replace(
            "ambient: 0.25",
            "ambient: 0.25, sky: (above: 0.5, below: (0, 0.25, 1), up: (0, 0, 2))",
        );
    let scene = Scene::parse(&text, Path::new("a.ron")).unwrap();
    let view = scene.view(7).unwrap();
    let of = |part: Option<LightPart>| {
        let sidecar = Sidecar::of(&scene, Path::new("a.ron"), 7, &view);
        written(&match part {
            Some(part) => sidecar.under(part),
            None => sidecar,
        })
        .1
    };
    let sky = json!({
        "above": [0.5, 0.5, 0.5],
        "below": [0.0, 0.25, 1.0],
        "up": [0.0, 0.0, -1.0],
    });
    let whole = of(None);
    assert_eq!(whole["sky"], sky);
    assert_eq!(whole["lights"][0]["diameter_degrees"], json!(0.53));
    let of_sky = of(Some(LightPart::Sky));
    assert_eq!(of_sky["sky"], sky);
    assert_eq!(
        [&of_sky["lights"], &of_sky["ambient"]],
        [&json!([]), &json!([0.0, 0.0, 0.0])]
    );
    for part in [LightPart::Light(0), LightPart::Ambient] {
        assert_eq!(of(Some(part)).get("sky"), None, "{part:?}");
    }
}

#[test]
fn rectangular_pixels_have_two_focal_lengths() {
    let text = SCENE.replace(
        "Retina(width: 32, distance: 25, shift: (1, -2))",
        "Matrix(fx: 500, fy: 400, cx: 300, cy: 200)",
    );
    let scene = Scene::parse(&text, Path::new("a.ron")).unwrap();
    let view = scene.view(7).unwrap();
    let (_, value) = written(&Sidecar::of(&scene, Path::new("a.ron"), 7, &view));
    let camera = &value["camera"];
    // With the zoom of 2.
    let matrix = json!([[1000.0, 0.0, 300.0], [0.0, 800.0, 200.0], [0.0, 0.0, 1.0]]);
    assert_eq!(camera["K"], matrix);
    assert_eq!(camera["pixel_size"], json!(1.0));
    assert_eq!(camera["pixel_aspect"], json!(0.8));
}

#[test]
fn what_rendering_knows_is_added() {
    let scene = scene();
    let view = scene.view(7).unwrap();
    let all = Region::all(Size::of(&view));
    let digest = blake3::hash(b"ball");
    let summary = Summary {
        pixels: 307_200,
        largest_error: 0.1 + 0.2,
        bounds: 307_200,
        over_tolerance: 3,
    };
    let with = |region: &Region, method, summary: &Summary| {
        let sidecar = Sidecar::of(&scene, Path::new("wall.ron"), 7, &view);
        written(&sidecar.with_results(region, method, summary, &digest))
    };
    let (text, value) = with(&all, Method::Tolerance(1e-3), &summary);
    let mut expected = known();
    for (key, fact) in [
        ("tolerance", json!(1e-3)),
        ("error", json!(0.1 + 0.2)),
        ("evidence", json!("bound")),
        ("bounded_pixels", json!(307_200)),
        ("over", json!(3)),
        ("digest", json!(digest.to_hex().as_str())),
    ] {
        expected[key] = fact;
    }
    assert_eq!(value, expected);
    // All of 17 digits where it takes them.
    assert!(text.contains("\"error\": 0.30000000000000004,"), "{text}");

    let window = Window {
        col: 16,
        row: 8,
        width: 30,
        height: 20,
    };
    let part = Region::new(window, all.whole).unwrap();
    let unknown = Summary {
        largest_error: f64::INFINITY,
        bounds: 0,
        ..summary
    };
    let samples = Method::Samples(1.try_into().unwrap());
    let (_, value) = with(&part, samples, &unknown);
    assert_eq!(
        value["region"],
        json!({"col": 16, "row": 8, "width": 30, "height": 20})
    );
    assert_eq!(value["image"], expected["image"]);
    assert_eq!(value["camera"], expected["camera"]);
    assert_eq!(value["samples"], json!(1));
    assert_eq!(value.get("tolerance"), None);
    assert_eq!(
        (&value["error"], &value["evidence"]),
        (&Value::Null, &Value::Null)
    );

    let some = Summary {
        bounds: 307_199,
        ..summary
    };
    let (_, value) = with(&all, Method::Tolerance(1e-3), &some);
    assert_eq!(value["evidence"], json!("estimate"));
}

#[test]
fn a_sidecar_is_known_again_unless_it_is_cut() {
    let scene = scene();
    let view = scene.view(1).unwrap();
    let path = temporary("known.json");
    let digest = blake3::hash(b"ball");
    let window = Window {
        col: 600,
        row: 0,
        width: 40,
        height: 480,
    };
    let whole = Size::of(&view);
    for region in [Region::all(whole), Region::new(window, whole).unwrap()] {
        let summary = Summary {
            pixels: 1,
            largest_error: 1e-4,
            bounds: 0,
            over_tolerance: 0,
        };
        let sidecar = Sidecar::of(&scene, Path::new("wall.ron"), 1, &view);
        let sidecar = sidecar.with_results(&region, Method::Tolerance(1e-3), &summary, &digest);
        let text = sidecar.text().unwrap();
        fs::write(&path, &text).unwrap();
        assert_eq!(contents(&path), Some((digest, region)));
        let end = text.rfind('}').unwrap();
        for cut in (0..=end).step_by(37).chain([end]) {
            fs::write(&path, &text[..cut]).unwrap();
            assert_eq!(contents(&path), None, "cut at {cut}");
        }
    }
    let unrendered = Sidecar::of(&scene, Path::new("wall.ron"), 1, &view);
    fs::write(&path, unrendered.text().unwrap()).unwrap();
    assert_eq!(contents(&path), None);
    fs::remove_file(&path).unwrap();
    assert_eq!(contents(&path), None);
}

#[test]
fn a_sidecar_has_the_name_of_its_picture() {
    let name = |path: &str| beside(Path::new(path)).to_string_lossy().into_owned();
    assert_eq!(name("out/a.0001.png"), "out/a.0001.json");
    assert_eq!(name("ball.exr"), "ball.json");
}

/// The camera looks along +x from (1, 2, 3): its right is the world's back.
#[test]
fn a_lamp_has_its_direction_in_both_axes() {
    let lights =
        "lights: [Point(position: (2, 2, 3), direction: (3, 0, -4), mu: 1.5, reference: 1)]";
    let text = SCENE.replace(
        "lights: [Directional(toward: (0, 0, -3), intensity: (1, 0.1, 0))]",
        lights,
    );
    let scene = Scene::parse(&text, Path::new("a.ron")).unwrap();
    let view = scene.view(7).unwrap();
    let (_, value) = written(&Sidecar::of(&scene, Path::new("wall.ron"), 7, &view));
    let lamp = &value["lights"][0];
    let close = |name: &str, expected: [f64; 3]| {
        for (index, expected) in expected.into_iter().enumerate() {
            let found = lamp[name][index].as_f64().unwrap();
            assert!((found - expected).abs() < 1e-15, "{name}: {found}");
        }
    };
    close("direction", [0.6, 0.0, 0.8]);
    close("direction_camera", [0.8, 0.0, 0.6]);
    close("position_camera", [0.0, 0.0, 1.0]);
    assert_eq!(lamp["mu"], 1.5);
    // One that shines in all directions has none.
    let plain = text.replace(", direction: (3, 0, -4), mu: 1.5", "");
    let scene = Scene::parse(&plain, Path::new("a.ron")).unwrap();
    let (_, value) = written(&Sidecar::of(&scene, Path::new("wall.ron"), 7, &view));
    for name in ["direction", "direction_camera", "mu"] {
        assert_eq!(value["lights"][0].get(name), None, "{name}");
    }
}
