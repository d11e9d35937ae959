use std::fs::{self, File};
use std::io::BufReader;

use marbles_scene::Scene;

use super::picture::render;
use super::screen::Area;
use crate::base::size::Size;
use crate::tests::{SCENE, run_here, temporary};

#[test]
fn pictures_fill_the_area_one_way() {
    let fit = |(width, height), area: (u32, u32), enlarges| {
        let size = Size { width, height };
        let (width, height) = area;
        let area = Area {
            width,
            height,
            enlarges,
        };
        let size = area.fit(size);
        (size.width, size.height)
    };
    assert_eq!(fit((600, 600), (80, 44), true), (44, 44));
    assert_eq!(fit((640, 400), (80, 60), true), (80, 50));
    assert_eq!(fit((8, 4), (80, 60), true), (80, 40));
    assert_eq!(fit((8, 4), (80, 60), false), (8, 4));
    assert_eq!(fit((640, 400), (80, 60), false), (80, 50));
    assert_eq!(fit((65_536, 1), (80, 60), true), (80, 1));
    assert_eq!(fit((1, 65_536), (1, 2), true), (1, 2));
}

#[test]
fn without_a_terminal_the_picture_is_a_text() {
    let path = temporary("preview.ron");
    fs::write(&path, SCENE).unwrap();
    let scene = path.to_str().unwrap();
    let (code, out, err) = run_here(&["preview", scene]);
    assert_eq!((code, &*err), (0, ""));
    let lines: Vec<&str> = out.lines().collect();
    assert_eq!(lines.len(), 24);
    for line in lines {
        assert_eq!(line.matches('▀').count(), 48);
        assert!(line.ends_with("\x1b[0m"));
    }
    let (code, out, err) = run_here(&["preview", scene, "--watch"]);
    assert_eq!((code, &*out), (2, ""));
    assert!(err.contains("--watch needs a terminal"), "{err}");
    let (code, out, err) = run_here(&["preview", scene, "--frame", "2"]);
    assert_eq!((code, &*out), (2, ""));
    assert!(err.contains("expected 1, the only frame of the scene, found 2"));
    fs::remove_file(path).unwrap();
}

#[test]
fn the_frame_that_is_asked_for_is_shown() {
    let path = temporary("preview-frames.ron");
    let away = "camera: Free(),
    animation: Keyframes(frames: (1, 2), keys: [(frame: 1, pan: 0), (frame: 2, pan: 180)])";
    fs::write(&path, SCENE.replace("camera: Free()", away)).unwrap();
    let scene = path.to_str().unwrap();
    let shown = |more: &[&str]| {
        let (code, out, err) = run_here(&[&["preview", scene], more].concat());
        assert_eq!((code, &*err), (0, ""));
        out
    };
    let [first, second] = ["1", "2"].map(|frame| shown(&["--frame", frame]));
    assert_eq!(shown(&[]), first);
    assert_ne!(first, second);
    fs::remove_file(path).unwrap();
}

#[test]
fn pixels_are_those_of_a_file() {
    let folder = temporary("preview");
    fs::create_dir_all(&folder).unwrap();
    let [scene, file] = ["ball.ron", "ball.png"].map(|name| folder.join(name));
    fs::write(&scene, SCENE).unwrap();
    let [path, png] = [&scene, &file].map(|path| path.to_str().unwrap());
    let options = ["--size", "20x20", "--tolerance", "1e-2", "--rgb"];
    let (code, _, err) = run_here(&[&["render", path, "-o", png], &options[..]].concat());
    assert_eq!((code, &*err), (0, ""));
    let decoder = png::Decoder::new(BufReader::new(File::open(&file).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut codes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut codes).unwrap();

    let scene = Scene::load(&scene).unwrap();
    let area = Area {
        width: 30,
        height: 20,
        enlarges: true,
    };
    let view = scene.view(1).unwrap();
    let view = area.fit(Size::of(&view)).resize(view);
    let picture = render((&scene, scene.world()), &view, 1e-2, None).unwrap();
    assert_eq!((picture.size.width, picture.size.height), (20, 20));
    assert_eq!(picture.codes.as_flattened(), codes);
    assert!(codes.iter().any(|&code| code > 100) && codes.contains(&0));
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn pictures_are_shown_as_scenes_are() {
    let scene = temporary("preview_of_picture.ron");
    fs::write(&scene, SCENE).unwrap();
    let scene = scene.to_str().unwrap();
    let (code, of_scene, _) = run_here(&["preview", scene, "--tolerance", "1e-4"]);
    assert_eq!(code, 0);
    // One pixel of the picture for each pixel of the text, or two by two, whose mean is the same.
    let lines = of_scene.lines().count() as u32;
    let kinds = [
        ("png", 1, 0),
        ("webp", 1, 0),
        ("tif", 2, 3),
        ("npy", 2, 3),
        ("npz", 2, 3),
    ];
    for (ending, factor, most) in kinds {
        let picture = temporary(&format!("preview_of_picture.{ending}"));
        let picture = picture.to_str().unwrap();
        let size = format!("{0}x{0}", 2 * factor * lines);
        let (code, _, err) = run_here(&[
            "render",
            scene,
            "-o",
            picture,
            "--size",
            &size,
            "--tolerance",
            "1e-4",
        ]);
        assert_eq!((code, &*err), (0, ""));
        let (code, out, err) = run_here(&["preview", picture]);
        assert_eq!((code, &*err), (0, ""), "{ending}");
        assert_eq!(codes(&out).len(), codes(&of_scene).len());
        let pairs = codes(&out).into_iter().zip(codes(&of_scene));
        for (found, expected) in pairs {
            assert!(
                found.abs_diff(expected) <= most,
                "{ending}: {found} {expected}"
            );
        }
        for option in ["--watch", "--frame=3", "--set=zoom=2"] {
            let (code, _, err) = run_here(&["preview", picture, option]);
            assert_eq!(code, 2);
            assert!(
                err.contains(" is for scenes, but this is a picture\n"),
                "{err}"
            );
        }
        fs::remove_file(picture).unwrap();
    }
    fs::remove_file(scene).unwrap();
}

/// An NPY of particles would be a picture of three columns.
#[test]
fn a_table_in_an_array_is_no_picture() {
    let dictionary = "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 3), }\n";
    let length = (dictionary.len() as u16).to_le_bytes();
    let numbers = (0..12).flat_map(|number| f64::from(number * number % 7).to_le_bytes());
    let numbers: Vec<u8> = numbers.collect();
    let bytes = [
        b"\x93NUMPY\x01\x00",
        &length[..],
        dictionary.as_bytes(),
        &numbers,
    ];
    let table = temporary("preview_of_table.npy");
    fs::write(&table, bytes.concat()).unwrap();
    // Pictures have nothing to set.
    let (code, out, err) = run_here(&[
        "preview",
        table.to_str().unwrap(),
        "--once",
        "--set=ambient=0.5",
    ]);
    assert_eq!(code, 0, "{err}");
    assert!(out.lines().count() > 1, "{out}");
    fs::remove_file(table).unwrap();
}

/// The numbers in a text. Only the numbers of colors may differ.
fn codes(text: &str) -> Vec<u32> {
    let numbers = text.split(|letter: char| !letter.is_ascii_digit());
    numbers.filter_map(|number| number.parse().ok()).collect()
}
