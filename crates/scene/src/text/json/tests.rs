//! Tests of `json.rs`.

use std::path::Path;

use super::to_ron;
use crate::Scene;

/// The text in RON without white space, of which only that in strings matters.
fn converted(json: &str) -> String {
    let ron = to_ron(json).unwrap_or_else(|fault| panic!("{json}: {fault:?}"));
    assert_eq!(ron.len(), json.len(), "{json}");
    let mut parts = ron.split('"');
    let outside = |part: &str| part.split_ascii_whitespace().collect::<String>();
    let mut text = outside(parts.next().unwrap());
    while let (Some(inside), Some(after)) = (parts.next(), parts.next()) {
        text += &format!("\"{inside}\"{}", outside(after));
    }
    text
}

#[test]
fn structures_variants_lists_and_tuples_are_told_apart() {
    for (json, ron) in [
        (r#"{"fps": 24}"#, "(fps:24)"),
        (r#"{"lens": {"Fov": 40}}"#, "(lens:Fov(40))"),
        (
            r#"{"camera": {"Free": {"position": [0, 1, -2]}}}"#,
            "(camera:Free(position:(0,1,-2)))",
        ),
        (r#"{"camera": {"Free": {}}}"#, "(camera:Free())"),
        (
            r#"{"sky": {"above": [0.5, 0.6, 1], "below": "tan", "up": [0, 0, 1]}}"#,
            r#"(sky:(above:(0.5,0.6,1),below:"tan",up:(0,0,1)))"#,
        ),
        (
            r#"{"lights": [{"Directional": {"toward": [1, 2, 3], "attached": "Camera"}}, {"Point": {}}]}"#,
            "(lights:[Directional(toward:(1,2,3),attached:Camera),Point()])",
        ),
        (
            r#"{"materials": {"Red": {"albedo": "red"}, "up": {"outline": {"width": {"Units": 0.1}}}}}"#,
            r#"(materials:{"Red":(albedo:"red"),"up":(outline:(width:Units(0.1)))})"#,
        ),
        (
            r#"{"keep": [["Type", {"Is": "C"}], ["x", {"Between": [0, 1e+3]}]]}"#,
            r#"(keep:[("Type",Is("C")),("x",Between(0,1e+3))])"#,
        ),
        (
            r#"{"up": "Z", "columns": {"z": "Z"}, "radii": "Covalent", "color": "Category"}"#,
            r#"(up:Z,columns:(z:"Z"),radii:Covalent,color:Category)"#,
        ),
        (
            r#"{"radii": {"Fe": 1.2}, "palette": {"Fe": "Value"}}"#,
            r#"(radii:{"Fe":1.2},palette:{"Fe":"Value"})"#,
        ),
        (
            r#"{"rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}"#,
            "(rotation:[(1,0,0),(0,1,0),(0,0,1)])",
        ),
        (
            r#"{"background": null, "shadows": false, "unit": null}"#,
            "(shadows:false,)",
        ),
        (
            r#"{"columns": {"radius": {"Power": {"factor": 2}}}}"#,
            "(columns:(radius:Power(factor:2)))",
        ),
        (
            r#"{"sky": {"Outer": {"Inner": 1}}}"#,
            "(sky:Outer(Inner(1)))",
        ),
        (r#"{"keys": []}"#, "(keys:[])"),
    ] {
        assert_eq!(converted(json), ron, "{json}");
    }
}

#[test]
fn escapes_of_strings_are_those_of_ron() {
    for (json, ron) in [
        (r#"{"file": "a\/b\\c\"d"}"#, r#"(file:"a/b\\c\"d")"#),
        (
            r#"{"file": "\u00e4\ud83d\ude00\u0022"}"#,
            "(file:\"ä😀\\\"\")",
        ),
        (r#"{"file": "a\tb\u005c"}"#, "(file:\"a\tb\\\\\")"),
    ] {
        let text = to_ron(json).unwrap();
        assert_eq!(text.len(), json.len());
        assert_eq!(text.replace(' ', "").trim(), ron, "{json}");
    }
    // Half of a pair is no character.
    let fault = to_ron(r#"{"file": "\ud83d"}"#).unwrap_err();
    assert!(
        fault.message.starts_with("expected JSON, found a fault: "),
        "{fault:?}"
    );
}

#[test]
fn a_scene_in_json_is_the_scene_in_ron() {
    let json = r##"{
        "image": {"width": 40, "height": 30},
        "lens": {"Retina": {"width": 1, "distance": 2, "shift": [0.1, -0.1]}},
        "camera": {"Orbit": {"target": [0, 0, 0], "radius": 8, "azimuth": 20}},
        "background": "#102030", "ambient": [0.1, 0.1, 0.2],
        "lights": [
            {"Directional": {"name": "sun", "toward": [1, 1, -1], "intensity": 0.8}},
            {"Point": {"position": [2, 3, -4], "falloff": "None", "intensity": 0.2}}
        ],
        "materials": {"m\u00e4": {"albedo": [0.9, 0.5, 0.1], "exponent": 0.5,
            "highlight": {"strength": 0.4, "shininess": 20},
            "rough": {"amplitude": 0.2, "grain": {"Surface": 0.3}, "seed": 4}}},
        "spheres": [{"center": [0, 0, 0], "radius": 1, "material": "m\u00e4"}, {"center": [2, 0, 0], "radius": 0.5}],
        "animation": {"Keyframes": {"fps": 10, "keys": [
            {"frame": 1, "azimuth": 20}, {"frame": 10, "azimuth": 80, "ease": "Linear"}]}}
    }"##;
    let ron = r##"(
        image: (width: 40, height: 30),
        lens: Retina(width: 1, distance: 2, shift: (0.1, -0.1)),
        camera: Orbit(target: (0, 0, 0), radius: 8, azimuth: 20),
        background: "#102030", ambient: (0.1, 0.1, 0.2),
        lights: [
            Directional(name: "sun", toward: (1, 1, -1), intensity: 0.8),
            Point(position: (2, 3, -4), falloff: None, intensity: 0.2),
        ],
        materials: { "mä": (albedo: (0.9, 0.5, 0.1), exponent: 0.5, highlight: (strength: 0.4, shininess: 20),
            rough: (amplitude: 0.2, grain: Surface(0.3), seed: 4)) },
        spheres: [(center: (0, 0, 0), radius: 1, material: "mä"), (center: (2, 0, 0), radius: 0.5)],
        animation: Keyframes(fps: 10, keys: [(frame: 1, azimuth: 20), (frame: 10, azimuth: 80, ease: Linear)]),
    )"##;
    let [json, ron] = [json, ron].map(|text| {
        let scene =
            Scene::parse(text, Path::new("scene")).unwrap_or_else(|error| panic!("{error}"));
        let view = scene.view(7).unwrap();
        format!("{:?} {view:?} {:?}", scene.world(), scene.frames())
    });
    assert_eq!(json, ron);
}

#[test]
fn faults_are_shown_where_they_are_in_the_text() {
    for (json, place, message) in [
        (
            "{\n  \"image\" 3}",
            "2:11",
            "expected JSON, found a fault: expected `:`",
        ),
        (
            "{\"image\": {\"width\": 4,}}",
            "1:23",
            "expected JSON, found a fault: key must be a string",
        ),
        (
            "{\"image\": {\"width\": -4, \"height\": 3}}",
            "1:21",
            "found -4",
        ),
        (
            "{\"lens\": {\"Fov\": 40, \"Retina\": {}}}",
            "1:22",
            "expected nothing beside \"Fov\"",
        ),
        (
            "{\"two words\": 3}",
            "1:2",
            "expected the name of a field, found \"two words\"",
        ),
        ("{\"lens\": {\"Fov\": 400}}", "1:18", "found 400"),
    ] {
        let error = Scene::parse(json, Path::new("scene.json")).unwrap_err();
        let text = error.to_string();
        assert!(
            text.contains(&format!("scene.json:{place}")),
            "{json}: {text}"
        );
        assert!(text.contains(message), "{json}: {text}");
        // The line as it is in the file.
        let line = json.lines().last().unwrap();
        assert!(text.contains(line), "{json}: {text}");
    }
}

/// Texts with bytes that are replaced at random.
#[test]
fn no_text_panics() {
    let whole = r#"{"keep": [["\u00e4", {"Is": [1, null]}]], "up": "Z", "radii": {"a\n": {"B": {"C": 2}}}}"#;
    let bytes = whole.as_bytes();
    let mut state = 1_u64;
    let mut taken = 0;
    for _ in 0..20_000 {
        let mut text = bytes.to_vec();
        for _ in 0..2 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let [at, from] = [33, 48].map(|bits| (state >> bits) as usize % text.len());
            text[at] = bytes[from % bytes.len()];
        }
        if let Ok(text) = String::from_utf8(text)
            && let Ok(ron) = to_ron(&text)
        {
            assert_eq!(ron.len(), text.len(), "{text}");
            taken += 1;
        }
    }
    assert!(taken > 300, "{taken}");
}
