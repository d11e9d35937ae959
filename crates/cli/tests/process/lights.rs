//! Pictures of single lights.

use std::fs;

use exr::prelude::FlatSamples;

use crate::channels::{Channels, read};
use crate::folder::{Folder, code, text};

/// The scene of `balls`, without the part before its spheres.
pub(crate) fn balls(light: &str) -> String {
    format!(
        "(image: (width: 50, height: 37), lens: Fov(40), camera: Free(position: (0, 0, -6)), {light}
         materials: {{ \"red\": (albedo: (0.75, 0.25, 0.125), highlight: (strength: 0.25, shininess: 9)) }},
         spheres: [(center: (0, 0, 0), radius: 1, material: \"red\"),
                   (center: (1.25, 0.75, -0.5), radius: 0.5)])"
    )
}

const LIGHTS: [&str; 3] = [
    "Directional(toward: (-1, 1, -1), intensity: 0.5)",
    "Directional(toward: (1, 0.5, -1), intensity: (0.5, 0.25, 0.125))",
    "Directional(toward: (0.5, 2, -1), intensity: 0.25)",
];
const SURROUNDINGS: &str = "ambient: 0.0625, background: (0.125, 0.25, 0.5),";

/// A folder with the scene under all light, and one scene for each part of the light.
pub(crate) fn folder() -> Folder {
    let folder = Folder::new();
    let write = |name: &str, light: &str| {
        fs::write(folder.path(&format!("{name}.ron")), balls(light)).unwrap();
    };
    write(
        "all",
        &format!("{SURROUNDINGS} lights: [{}],", LIGHTS.join(", ")),
    );
    write("ambient", SURROUNDINGS);
    for (number, light) in (1..).zip(LIGHTS) {
        write(&format!("light-{number}"), &format!("lights: [{light}],"));
    }
    folder
}

pub(crate) fn run(folder: &Folder, arguments: &str) -> String {
    let output = folder.run(arguments);
    assert_eq!(code(&output), 0, "{arguments}: {}", text(&output.stderr));
    text(&output.stdout)
}

const KEYS: [&str; 4] = ["light-1", "light-2", "light-3", "ambient"];

/// Who sorts the names of files or layers has them in the order of the lights, however many there are.
#[test]
fn names_of_many_lights_sort_as_the_lights_do() {
    const LAMPS: usize = 11;
    let folder = Folder::new();
    // Each is weaker than the one before.
    let lamp = |number: usize| {
        format!(
            "Directional(toward: (0, 0, -1), intensity: {})",
            1.0 / number as f64
        )
    };
    let lamps: Vec<String> = (1..=LAMPS).map(lamp).collect();
    fs::write(
        folder.path("many.ron"),
        balls(&format!("lights: [{}],", lamps.join(", "))),
    )
    .unwrap();
    run(
        &folder,
        "render many.ron -o out/a.npy --per-light --size 5x5 --samples 1",
    );
    let mut names = folder.names("out");
    names.sort();
    let names: Vec<&String> = names.iter().filter(|name| name.contains("light")).collect();
    let brightest = |name: &&String| {
        let bytes = folder.read(&format!("out/{name}"));
        let numbers = bytes[bytes.len() - 5 * 5 * 3 * 8..]
            .as_chunks::<8>()
            .0
            .iter();
        numbers
            .map(|number| f64::from_le_bytes(*number))
            .fold(0.0, f64::max)
    };
    let all: Vec<f64> = names.iter().map(brightest).collect();
    assert_eq!(all.len(), LAMPS, "{names:?}");
    assert!(
        all.windows(2).all(|pair| pair[0] > pair[1]),
        "{names:?}: {all:?}"
    );
    run(
        &folder,
        "render many.ron -o all.exr --per-light=layers --size 5x5 --samples 1",
    );
    let header = String::from_utf8_lossy(&folder.read("all.exr")).into_owned();
    let place = |number: usize| header.find(&format!("light-{number:02}.R"));
    let places: Vec<usize> = (1..=LAMPS).filter_map(place).collect();
    assert!(places.len() == LAMPS && places.is_sorted(), "{places:?}");
}

#[test]
fn each_file_is_that_of_the_scene_with_this_light() {
    let folder = folder();
    for (ending, options) in [
        ("png", ""),
        ("png", "--samples 3 --alpha --bits 16"),
        ("exr", "--error-channel --region 3,5,30,20"),
        ("npy", "--error-channel --tolerance 1e-5"),
    ] {
        let all = format!("render all.ron --per-light -o a.{ending} {options}");
        let lines = run(&folder, &all);
        assert_eq!(lines.lines().count(), 5, "{lines}");
        assert!(lines.contains("\n4 pictures: "), "{lines}");
        for key in KEYS {
            run(
                &folder,
                &format!("render {key}.ron -o b.{key}.{ending} {options}"),
            );
            let [found, expected] = ["a", "b"].map(|name| {
                let bytes = fs::read(folder.path(&format!("{name}.{key}.{ending}")));
                bytes.unwrap()
            });
            assert!(found == expected, "{key}.{ending} {options}");
        }
    }
    assert!(!folder.path("a.png").exists());
}

/// Suns and the sky have files of their own, too, and so does each layer.
#[test]
fn each_file_is_that_of_the_scene_with_this_soft_light() {
    let sun = "Directional(toward: (-1, 1, -1), intensity: 0.5, diameter: 8)";
    let sky = "sky: (above: (0.125, 0.25, 0.5), below: 0.0625),";
    let folder = Folder::new();
    let write = |name: &str, light: &str| {
        fs::write(folder.path(&format!("{name}.ron")), balls(light)).unwrap();
    };
    write(
        "all",
        &format!("{SURROUNDINGS} {sky} lights: [{sun}, {}],", LIGHTS[1]),
    );
    write("ambient", SURROUNDINGS);
    write("sky", sky);
    write("light-1", &format!("lights: [{sun}],"));
    write("light-2", &format!("lights: [{}],", LIGHTS[1]));
    for options in ["--tolerance 0.03125", "--samples 2 --alpha"] {
        let options = format!("{options} --size 25x18");
        run(
            &folder,
            &format!("render all.ron --per-light -o a.npy {options}"),
        );
        for key in ["light-1", "light-2", "sky", "ambient"] {
            run(
                &folder,
                &format!("render {key}.ron -o b.{key}.npy {options}"),
            );
            let [found, expected] =
                ["a", "b"].map(|name| folder.read(&format!("{name}.{key}.npy")));
            assert!(found == expected, "{key} {options}");
        }
    }
    let layers = "render all.ron --per-light=layers -o all.exr --samples 1 --size 25x18";
    run(&folder, layers);
    let names: Vec<String> = read(&folder, "all.exr").into_keys().collect();
    let expected = "B G R ambient.B ambient.G ambient.R light-1.B light-1.G light-1.R light-2.B light-2.G light-2.R \
                    sky.B sky.G sky.R";
    assert_eq!(names.join(" "), expected);
    let named = folder
        .run("render all.ron --per-light=layers -o b.exr --samples 1 --set lights[0].name=\"sky\"");
    assert_eq!(code(&named), 2);
    let message = "two lights would share the layer `sky`";
    assert!(
        text(&named.stderr).contains(message),
        "{}",
        text(&named.stderr)
    );
}

/// The same with an open shutter, a parallel lens, a light between the balls and a light at the camera.
#[test]
fn each_file_is_that_of_the_scene_with_this_light_in_motion() {
    const LIGHTS: [&str; 2] = [
        "Point(position: (1, 1.5, -2), intensity: 0.5, reference: 1.5)",
        "Directional(toward: (0.25, 0, -1), intensity: 0.5)",
    ];
    let folder = Folder::new();
    let write = |name: &str, light: &str| {
        let scene = balls(light).replace("Fov(40)", "Parallel(width: 5)").replace(
            "spheres:",
            "animation: Keyframes(frames: (1, 2), shutter: 0.5, keys: [
                (frame: 1, position: (0, 0, -6), ease: Linear), (frame: 2, position: (0.75, 0, -6))]),
             spheres:",
        );
        fs::write(folder.path(&format!("{name}.ron")), scene).unwrap();
    };
    write(
        "all",
        &format!("{SURROUNDINGS} lights: [{}],", LIGHTS.join(", ")),
    );
    write("ambient", SURROUNDINGS);
    for (number, light) in (1..).zip(LIGHTS) {
        write(&format!("light-{number}"), &format!("lights: [{light}],"));
    }
    let options = "--frames 1 --error-channel --tolerance 1e-2";
    run(
        &folder,
        &format!("render all.ron --per-light -o a.####.npy {options}"),
    );
    for key in ["light-1", "light-2", "ambient"] {
        run(
            &folder,
            &format!("render {key}.ron -o b.####.{key}.npy {options}"),
        );
        let [found, expected] = ["a", "b"]
            .map(|name| fs::read(folder.path(&format!("{name}.0001.{key}.npy"))).unwrap());
        assert!(found == expected, "{key}");
    }
}

#[test]
fn pictures_of_lights_are_resumed_one_by_one() {
    let folder = folder();
    let render = "render all.ron --per-light --sidecar -o a.####.png --frames 1 --skip-existing";
    run(&folder, render);
    let whole = fs::read(folder.path("a.0001.light-2.png")).unwrap();
    fs::remove_file(folder.path("a.0001.light-2.png")).unwrap();
    let lines = run(&folder, render);
    assert_eq!(lines.matches("skipped").count(), 3, "{lines}");
    assert_eq!(fs::read(folder.path("a.0001.light-2.png")).unwrap(), whole);
    assert!(
        run(
            &folder,
            &render.replace("all.ron", "all.ron --tolerance 1e-2")
        )
        .contains("4 pictures")
    );

    // Each sidecar tells its own light.
    let sidecar =
        |key: &str| fs::read_to_string(folder.path(&format!("a.0001.{key}.json"))).unwrap();
    let (second, ambient) = (sidecar("light-2"), sidecar("ambient"));
    assert!(
        second.contains("\"intensity\": [0.5, 0.25, 0.125]"),
        "{second}"
    );
    assert_eq!(second.matches("\"toward\"").count(), 1);
    assert!(second.contains("\"ambient\": [0.0, 0.0, 0.0]"), "{second}");
    assert!(
        ambient.contains("\"lights\": []") && ambient.contains("[0.125, 0.25, 0.5]"),
        "{ambient}"
    );
}

/// The numbers of a float channel.
fn floats<'a>(channels: &'a Channels, name: &str) -> &'a [f32] {
    match &channels[name] {
        FlatSamples::F32(floats) => floats,
        other => panic!("{name}: {other:?}"),
    }
}

/// Layers have the same names as files.
const LAYERS: [&str; 4] = KEYS;

#[test]
fn layers_hold_what_files_do() {
    let folder = folder();
    let options = "--float --error-channel --channels depth,id";
    run(&folder, &format!("render all.ron -o plain.exr {options}"));
    run(
        &folder,
        &format!("render all.ron -o a.exr --per-light {options}"),
    );
    let layered = format!("render all.ron -o layers.exr --per-light=layers {options}");
    let lines = run(&folder, &layered);
    // The pixels of the picture and of four layers.
    assert!(lines.starts_with("layers.exr: error <= "), "{lines}");
    assert_eq!(lines.lines().count(), 1, "{lines}");

    let layers = read(&folder, "layers.exr");
    let plain = read(&folder, "plain.exr");
    for (name, samples) in &plain {
        assert!(*samples == layers[name], "{name}");
    }
    let mut count = plain.len();
    for (layer, key) in LAYERS.into_iter().zip(KEYS) {
        let file = read(&folder, &format!("a.{key}.exr"));
        for name in ["R", "G", "B"] {
            assert!(
                file[name] == layers[&format!("{layer}.{name}")],
                "{layer}.{name}"
            );
        }
        assert!(file["error.V"] == layers[&format!("{layer}_error.V")]);
        count += 4;
    }
    assert_eq!(layers.len(), count);

    // The layers make the picture, as far as their errors allow, and the rounding of floats.
    let mut largest = 0.0_f64;
    for color in ["R", "G", "B"] {
        for pixel in 0..50 * 37 {
            let sum = |channel: &str| -> f64 {
                let numbers = LAYERS.map(|layer| format!("{layer}{channel}"));
                numbers
                    .map(|name| f64::from(floats(&layers, &name)[pixel]))
                    .iter()
                    .sum()
            };
            let picture = f64::from(floats(&layers, color)[pixel]);
            let error = sum("_error.V") + f64::from(floats(&layers, "error.V")[pixel]);
            let off = (sum(&format!(".{color}")) - picture).abs();
            assert!(off <= error + 1e-6, "{color} {pixel}: {off} {error}");
            largest = largest.max(picture);
        }
    }
    assert!(largest > 0.5);

    let compared = run(&folder, "compare layers.exr plain.exr");
    assert!(compared.contains("the pictures are the same"), "{compared}");
    let again = run(&folder, &format!("{layered} --skip-existing"));
    assert!(again.contains("layers.exr: skipped"), "{again}");
    // A file without layers is another one.
    let others = run(
        &folder,
        &format!("render all.ron -o layers.exr {options} --skip-existing"),
    );
    assert!(!others.contains("skipped"), "{others}");
    let again = run(&folder, &format!("{layered} --skip-existing"));
    assert!(!again.contains("skipped"), "{again}");
}

#[test]
fn layers_come_with_sequences_parts_and_alpha() {
    let folder = folder();
    let moving = balls(&format!(
        "{SURROUNDINGS} lights: [{}],
         animation: Keyframes(frames: (1, 3), keys: [(frame: 1, pan: 0), (frame: 3, pan: 9)]),",
        LIGHTS.join(", ")
    ));
    fs::write(folder.path("moving.ron"), moving).unwrap();
    let lines = run(
        &folder,
        "render moving.ron -o m.#.exr --per-light=layers --alpha --threads 3",
    );
    assert_eq!(lines.lines().count(), 4, "{lines}");
    assert!(lines.contains("\n3 frames: error <= "), "{lines}");
    let second = "render moving.ron --frames 2 --per-light=layers --alpha";
    run(&folder, &format!("{second} -o alone.exr --threads 1"));
    let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
    assert!(bytes("alone.exr") == bytes("m.2.exr"));
    let names: Vec<String> = read(&folder, "alone.exr").into_keys().collect();
    let expected = "A B G R ambient.B ambient.G ambient.R light-1.B light-1.G light-1.R \
                    light-2.B light-2.G light-2.R light-3.B light-3.G light-3.R";
    assert_eq!(names.join(" "), expected);

    for (part, region) in [("upper", "0,0,50,21"), ("lower", "0,21,50,16")] {
        run(
            &folder,
            &format!("{second} -o {part}.exr --region {region}"),
        );
    }
    run(&folder, "merge merged.exr upper.exr lower.exr");
    assert!(read(&folder, "merged.exr") == read(&folder, "alone.exr"));
}

#[test]
fn layers_are_refused_where_there_can_be_none() {
    let folder = folder();
    let named = balls("lights: [Directional(name: \"depth\", toward: (0, 1, 0))],");
    fs::write(folder.path("named.ron"), named).unwrap();
    for (arguments, why) in [
        (
            "all.ron -o a.png",
            "--per-light=layers is for EXR files, but the output is PNG",
        ),
        (
            "all.ron -o a.npy",
            "--per-light=layers is for EXR files, but the output is NPY",
        ),
        (
            "named.ron -o a.exr --channels depth",
            "a layer of the light `depth` would have the name of the channels `depth`",
        ),
    ] {
        let output = folder.run(&format!("render {arguments} --per-light=layers"));
        assert_eq!(code(&output), 2);
        let message = text(&output.stderr);
        assert!(message.contains(why), "{message}");
    }
    assert_eq!(
        folder
            .names(".")
            .iter()
            .filter(|name| name.starts_with("a."))
            .count(),
        0
    );
    run(&folder, "render named.ron -o a.exr --per-light=layers");
}

#[test]
fn what_centers_see_comes_with_the_ambient_light() {
    let folder = folder();
    run(
        &folder,
        "render all.ron --per-light -o a.npy --channels depth,id",
    );
    run(&folder, "render ambient.ron -o b.npy --channels depth,id");
    for file in ["channels", "id"] {
        let [found, expected] = [format!("a.ambient_{file}"), format!("b_{file}")]
            .map(|name| fs::read(folder.path(&format!("{name}.npy"))).unwrap());
        assert!(found == expected, "{file}");
        assert!(!folder.path(&format!("a.light-1_{file}.npy")).exists());
    }
}

#[test]
fn all_lights_of_all_frames_are_not_one_file() {
    let folder = folder();
    let output = folder.run("render all.ron --per-light -o a.apng");
    assert_eq!(code(&output), 2);
    assert!(text(&output.stderr).contains("--per-light needs one file per frame"));
}
