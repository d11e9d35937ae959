//! Data sets for photometric stereo.

use std::fs;

use crate::folder::{Folder, code, text};
use crate::lights::{folder, run};

#[test]
fn a_data_set_has_the_files_that_its_readers_expect() {
    let folder = folder();
    let dataset = "dataset all.ron -o set --layout diligent";
    let lines = run(&folder, dataset);
    assert!(
        lines.contains("\n3 pictures: ") && !lines.contains("clipped"),
        "{lines}"
    );
    let expected = "001.png 002.png 003.png Normal_gt.mat Normal_gt.png filenames.txt \
                    light_directions.txt light_intensities.txt mask.png names.txt normal.png normal.txt";
    assert_eq!(folder.names("set").join(" "), expected);
    let read = |name: &str| fs::read_to_string(folder.path("set").join(name)).unwrap();
    assert_eq!(read("filenames.txt"), "001.png\n002.png\n003.png\n");
    assert_eq!(read("names.txt"), read("filenames.txt"));
    // The depth in bits is the 25th byte of a PNG.
    for (name, bits) in [("Normal_gt.png", 16), ("normal.png", 8)] {
        assert_eq!(
            fs::read(folder.path("set").join(name)).unwrap()[24],
            bits,
            "{name}"
        );
    }
    // White is 0.5 at most: all light is doubled, and so is what is left of the tolerance.
    assert_eq!(
        read("light_intensities.txt"),
        "1 1 1\n1 0.5 0.25\n0.5 0.5 0.5\n"
    );
    let directions = read("light_directions.txt");
    let first = 1.0 / 3.0_f64.sqrt();
    assert!(
        directions.starts_with(&format!("{} ", -first)),
        "{directions}"
    );
    assert_eq!(directions.matches('\n').count(), 3);
    let normals = read("normal.txt");
    assert_eq!(normals.lines().count(), 50 * 37);
    assert!(normals.starts_with("0 0 0\n") && normals.ends_with("\n0 0 0"));

    // Each picture is that of the scene with its light, brighter by one stop.
    run(
        &folder,
        "render light-2.ron -o b.png --tolerance 5e-5 --linear --rgb --exposure 1",
    );
    let [found, alone] = ["set/002.png", "b.png"].map(|name| fs::read(folder.path(name)).unwrap());
    assert!(found == alone);

    // What is there is left alone, and what is not is made again.
    fs::remove_file(folder.path("set/002.png")).unwrap();
    let lines = run(&folder, &format!("{dataset} --skip-existing"));
    assert_eq!(lines.matches("skipped").count(), 2, "{lines}");
    assert_eq!(folder.names("set").join(" "), expected);

    let output = folder.run("dataset ambient.ron -o other --layout diligent");
    assert_eq!(code(&output), 2);
    assert!(text(&output.stderr).contains("ambient.ron: the scene has no lights"));
    assert!(!folder.path("other").exists());
}

/// A ball at a distance of 4 from a camera that looks along +x, under these lights.
fn beside(lights: &str) -> String {
    format!(
        "(image: (width: 50, height: 37), lens: Fov(40), camera: Free(position: (-6, 0, 0), pan: 90),
         lights: [{lights}], spheres: [(center: (-1, 0, 0), radius: 1)])"
    )
}

#[test]
fn a_data_set_of_near_lights_tells_them_in_the_axes_of_its_readers() {
    let folder = folder();
    let lights = [
        "Point(position: (-4, 1, 2), intensity: 0.5, reference: 2, direction: (3, 0, -4), mu: 0.25)",
        "Point(position: (-6, -1, 0), intensity: (0.5, 0.25, 0), reference: 4)",
    ];
    fs::write(folder.path("near.ron"), beside(&lights.join(", "))).unwrap();
    fs::write(folder.path("second.ron"), beside(lights[1])).unwrap();
    let dataset = "dataset near.ron -o set --layout luces";
    let lines = run(&folder, dataset);
    assert!(
        lines.contains("\n2 pictures: ") && !lines.contains("clipped"),
        "{lines}"
    );
    let expected = "01.png 02.png K.txt filenames.txt led_params.txt light_directions.txt \
                    light_intensities.txt light_positions.txt mask.png normals.png zgt.npz";
    assert_eq!(folder.names("set").join(" "), expected);
    let read = |name: &str| fs::read_to_string(folder.path("set").join(name)).unwrap();
    assert_eq!(read("filenames.txt"), "01.png\n02.png\n");

    let numbers = |text: &str| -> Vec<f64> {
        let words = text.split([' ', '\n']).filter(|word| !word.is_empty());
        words.map(|word| word.parse().unwrap()).collect()
    };
    let parameters = read("led_params.txt");
    let (_, parameters) = parameters.split_once('\n').unwrap();
    let parameters: Vec<Vec<f64>> = parameters.lines().map(numbers).collect();
    let [setup, first, second] = &parameters[..] else {
        panic!("{parameters:?}");
    };
    let (focal_length, mean_distance) = (setup[3], setup[6]);
    let half_width = 20.0_f64.to_radians().tan();
    assert!((focal_length * half_width - 25.0).abs() < 1e-12);
    assert_eq!(setup[..3], [2.0, 37.0, 50.0]);
    assert_eq!(setup[4..6], [24.5, 18.0]);
    assert!((4.0..5.0).contains(&mean_distance), "{mean_distance}");
    assert_eq!(
        numbers(&read("K.txt")),
        [
            focal_length,
            0.0,
            24.5,
            0.0,
            focal_length,
            18.0,
            0.0,
            0.0,
            1.0
        ]
    );
    // The camera's right is the world's back.
    let close = |found: &[f64], expected: &[f64]| {
        let mut pairs = found.iter().zip(expected);
        let all = pairs.all(|(found, expected)| (found - expected).abs() < 1e-12);
        assert!(all && found.len() == expected.len(), "{found:?}");
    };
    close(&first[..3], &[-2.0, -1.0, 2.0]);
    close(&second[..3], &[0.0, 1.0, 0.0]);
    // The direction that each faces.
    close(&first[3..6], &[0.8, 0.0, 0.6]);
    close(&second[3..6], &[0.0, 0.0, 1.0]);
    close(
        &numbers(&read("light_positions.txt")),
        &[-2.0, 1.0, -2.0, 0.0, -1.0, 0.0],
    );
    let length = mean_distance.hypot(1.0);
    close(
        &numbers(&read("light_directions.txt"))[3..],
        &[0.0, -1.0 / length, mean_distance / length],
    );
    // The first light is no more than 2.75 from the ball, and makes 0.265 of it at most; the second one 0.49.
    let gain = 2.0;
    let brightness = |intensity: f64, reference: f64| {
        gain * intensity * (reference / mean_distance) * (reference / mean_distance)
    };
    let white = brightness(0.5, 2.0);
    close(&first[6..], &[white, white, white, 0.25, 0.0]);
    close(
        &second[6..],
        &[brightness(0.5, 4.0), brightness(0.25, 4.0), 0.0, 0.0, 0.0],
    );
    assert_eq!(numbers(&read("light_intensities.txt"))[3..], second[6..9]);

    // Each picture is that of the scene with its light, brighter by one stop.
    run(
        &folder,
        "render second.ron -o b.png --tolerance 5e-5 --linear --rgb --exposure 1",
    );
    let [found, alone] = ["set/02.png", "b.png"].map(|name| fs::read(folder.path(name)).unwrap());
    assert!(found == alone);
    let lines = run(&folder, &format!("{dataset} --skip-existing"));
    assert_eq!(lines.matches("skipped").count(), 2, "{lines}");
}

#[test]
fn what_a_data_set_of_near_lights_cannot_tell_is_refused() {
    let folder = Folder::new();
    let near = "Point(position: (-4, 1, 2))";
    let scene = beside(near);
    for (scene, why) in [
        (
            beside(&format!("{near}, Directional(toward: (0, 1, 0))")),
            "light 2 of the scene is directional",
        ),
        (
            beside("Point(position: (-4, 1, 2), falloff: None)"),
            "light 1 of the scene does not fall off",
        ),
        (
            scene.replace("Fov(40)", "Parallel(width: 4)"),
            "the lens of the scene has none",
        ),
        (
            scene.replace("Fov(40)", "Matrix(fx: 30, fy: 40, cx: 9, cy: 9)"),
            "but the lens of the scene has two: fx 30 and fy 40",
        ),
        (
            scene.replace("pan: 90", "pan: -90"),
            "no pixel sees a sphere",
        ),
        (beside(""), "the scene has no lights"),
    ] {
        fs::write(folder.path("near.ron"), scene).unwrap();
        let output = folder.run("dataset near.ron -o other --layout luces");
        assert_eq!(code(&output), 2);
        let message = text(&output.stderr);
        assert!(
            message.contains("near.ron: ") && message.contains(why),
            "{message}"
        );
        assert!(!folder.path("other").exists());
    }
    fs::write(folder.path("near.ron"), beside(near)).unwrap();
    let output = folder.run("dataset near.ron -o other --layout diligent");
    assert!(text(&output.stderr).contains("but the scene has a point light"));
}

/// The numbers of a PNG with 16-bit codes.
fn codes(folder: &Folder, name: &str) -> Vec<u16> {
    let file = std::io::BufReader::new(fs::File::open(folder.path(name)).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    let (pairs, _) = bytes.as_chunks::<2>();
    pairs.iter().map(|pair| u16::from_be_bytes(*pair)).collect()
}

/// The tolerance of a data set is relative to its full scale, whatever the lights.
#[test]
fn the_tolerance_of_a_data_set_is_a_share_of_its_full_scale() {
    let folder = Folder::new();
    // A reference of a thousandth makes the light of lamps some meters away a millionth.
    let lights = |reference: f64| {
        let [left, right] = [(-4, 0.5), (-6, 0.25)].map(|(x, intensity)| {
            format!("Point(position: ({x}, 1, 2), intensity: {intensity}, reference: {reference})")
        });
        format!("{left}, {right}")
    };
    for (name, reference) in [("bright", 4.0), ("dim", 4.0 / 1024.0)] {
        fs::write(
            folder.path(&format!("{name}.ron")),
            beside(&lights(reference)),
        )
        .unwrap();
        let line = run(
            &folder,
            &format!("dataset {name}.ron -o {name} --layout luces --strict"),
        );
        let error = line.split_once("2 pictures: error <= ").unwrap().1;
        let error: f64 = error.split_once(' ').unwrap().0.parse().unwrap();
        assert!((1e-6..=1e-4).contains(&error), "{line}");
    }
    for picture in ["01.png", "02.png"] {
        // All but the digest is the same: light has no unit.
        let [bright, dim] =
            ["bright", "dim"].map(|name| codes(&folder, &format!("{name}/{picture}")));
        assert!(bright == dim, "{picture}");
        let largest = bright.iter().max();
        assert!(largest > Some(&4000), "{picture}: {largest:?}");
    }
    // Without a reference the lamps are what one expects them to be: white on the ball.
    fs::write(
        folder.path("some.ron"),
        beside("Point(position: (-4, 1, 2))"),
    )
    .unwrap();
    run(&folder, "dataset some.ron -o some --layout luces --strict");
    let intensity = fs::read_to_string(folder.path("some/light_intensities.txt")).unwrap();
    let intensity: f64 = intensity.split_once(' ').unwrap().0.parse().unwrap();
    assert!((0.1..2.0).contains(&intensity), "{intensity}");
}

#[test]
fn light_near_the_tolerance_is_told() {
    let folder = Folder::new();
    let lamp = beside("Point(position: (-4, 1, 2), reference: 0.01)");
    fs::write(folder.path("dim.ron"), lamp).unwrap();
    for command in [
        "check dim.ron",
        "check dim.ron --json",
        "render dim.ron",
        "render dim.ron --per-light",
    ] {
        let output = folder.run(command);
        assert_eq!(code(&output), 0);
        let message = text(&output.stderr);
        assert!(message.contains("brighter than"), "{command}: {message}");
        assert_eq!(
            code(&folder.run(&format!("{command} --strict"))),
            2,
            "{command}"
        );
    }
    for command in [
        "render dim.ron --tolerance 1e-8",
        "render dim.ron --samples 2",
    ] {
        let output = folder.run(&format!("{command} --strict"));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    }
}

#[test]
fn a_list_of_lights_has_the_directions_of_the_pictures() {
    let folder = folder();
    let lights = "Directional(toward: (-1, 0, 0)), Directional(toward: (0, 2, 0)), Directional(toward: (-4, 0, -3))";
    fs::write(folder.path("dome.ron"), beside(lights)).unwrap();
    run(&folder, "dataset dome.ron -o set --layout lp --size 20x15");
    let expected = "001.png 002.png 003.png Normal_gt.png filenames.txt lights.lp mask.png";
    assert_eq!(folder.names("set").join(" "), expected);
    let list = fs::read_to_string(folder.path("set/lights.lp")).unwrap();
    let lines: Vec<&str> = list.lines().collect();
    assert_eq!((lines.len(), lines[0]), (4, "3"));
    // The camera looks along +x, and its right is -z.
    let expected = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.6, 0.0, 0.8]];
    for (index, (line, expected)) in lines[1..].iter().zip(expected).enumerate() {
        let words: Vec<&str> = line.split(' ').collect();
        assert_eq!(words[0], format!("{:03}.png", index + 1));
        for (word, expected) in words[1..].iter().zip(expected) {
            let number: f64 = word.parse().unwrap();
            assert!((number - expected).abs() < 1e-15, "{line}");
        }
    }

    // The list has no brightness.
    let output = folder.run("dataset all.ron -o other --layout lp");
    let message = text(&output.stderr);
    assert_eq!(code(&output), 2, "{message}");
    let expected = "the layout lp needs lights of the same intensity, but light 2 of the scene has another one";
    assert!(message.contains(expected), "{message}");
}

/// If files have names of a data set, but no data set belongs to them, they are somebody else's.
#[test]
fn a_data_set_replaces_no_files_of_others() {
    let folder = folder();
    for (layout, scene, names) in [
        (
            "diligent",
            "all.ron",
            ["mask.png", "normal.txt", "filenames.txt", "002.png"],
        ),
        (
            "luces",
            "near.ron",
            ["mask.png", "K.txt", "zgt.npz", "01.png"],
        ),
    ] {
        let near = "Point(position: (-4, 1, 2))";
        fs::write(folder.path("near.ron"), beside(near)).unwrap();
        let dataset = format!("dataset {scene} --layout {layout} --size 12x9 -o");
        for name in names {
            let place = folder.path(&format!("{layout}-{name}"));
            fs::create_dir(&place).unwrap();
            fs::write(place.join(name), "mine").unwrap();
            for more in ["", " --skip-existing"] {
                let output = folder.run(&format!("{dataset} {layout}-{name}{more}"));
                let message = text(&output.stderr);
                assert_eq!(code(&output), 2, "{message}");
                let expected = format!(
                    "{name}: the data set would replace this file, which `marbles dataset` did not write"
                );
                assert!(message.contains(&expected), "{message}");
                assert_eq!(folder.names(&format!("{layout}-{name}")), [name]);
                assert_eq!(fs::read(place.join(name)).unwrap(), b"mine");
            }
        }
        // Other files are in nobody's way, and a data set may be made again: whole, or what was left of it.
        let place = folder.path(layout);
        fs::create_dir(&place).unwrap();
        fs::write(place.join("notes.txt"), "mine").unwrap();
        run(&folder, &format!("{dataset} {layout}"));
        fs::remove_file(place.join("filenames.txt")).unwrap();
        fs::remove_file(place.join(names[3])).unwrap();
        run(&folder, &format!("{dataset} {layout} --skip-existing"));
        run(&folder, &format!("{dataset} {layout}"));
        assert_eq!(fs::read(place.join("notes.txt")).unwrap(), b"mine");
    }
    let output = folder.run("dataset near.ron --layout luces --size 12x9 -o diligent");
    assert_eq!(code(&output), 2);
    let message = text(&output.stderr);
    assert!(
        message.contains("belongs to a data set of the layout diligent"),
        "{message}"
    );
}
