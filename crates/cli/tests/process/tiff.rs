//! TIFF, as another decoder reads it: its numbers are those of the NPY.

use std::fs;
use std::io::Cursor;

use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;

use crate::folder::{Folder, code, text};

const SCENE: &str = "(
    image: (width: 40, height: 37),
    lens: Fov(50),
    camera: Free(position: (0, 0, -5)),
    background: (0, 0.1, 0.2),
    lights: [Directional(toward: (-1, 1, -1), intensity: (1.5, 0.8, 0.5))],
    spheres: [(center: (0, 0, 0), radius: 1)],
)
";

/// A folder with a scene in color and a gray one.
fn folder() -> Folder {
    let folder = Folder::new();
    fs::write(folder.path("scene.ron"), SCENE).unwrap();
    let grey = SCENE
        .replace("(0, 0.1, 0.2)", "0.1")
        .replace("(1.5, 0.8, 0.5)", "1.5");
    fs::write(folder.path("grey.ron"), grey).unwrap();
    folder
}

fn run(folder: &Folder, arguments: &str) -> String {
    let output = folder.run(arguments);
    assert_eq!(code(&output), 0, "{arguments}: {}", text(&output.stderr));
    text(&output.stdout)
}

/// The numbers of a file, and the number of channels.
fn numbers(bytes: &[u8]) -> (DecodingResult, usize) {
    let mut decoder = Decoder::new(Cursor::new(bytes)).unwrap();
    let samples: Option<u16> = decoder.find_tag_unsigned(Tag::SamplesPerPixel).unwrap();
    (decoder.read_image().unwrap(), samples.unwrap().into())
}

/// The doubles of an NPY.
fn npy(bytes: &[u8]) -> Vec<f64> {
    let start = bytes.iter().position(|&byte| byte == b'\n').unwrap() + 1;
    let (doubles, _) = bytes[start..].as_chunks();
    doubles
        .iter()
        .map(|&double| f64::from_le_bytes(double))
        .collect()
}

#[test]
fn the_numbers_are_those_of_the_npy() {
    /// The largest code.
    const MOST: f64 = 65535.0;
    let folder = folder();
    for (scene, options, channels) in [
        ("scene", "", 3),
        ("scene", "--alpha", 4),
        ("grey", "", 1),
        ("grey", "--alpha", 2),
        ("grey", "--rgb", 3),
    ] {
        let plain = options.replace("--rgb", "");
        run(&folder, &format!("render {scene}.ron -o a.npy {plain}"));
        let expected = npy(&folder.read("a.npy"));
        let stride = if options == "--alpha" { 4 } else { 3 };
        // A gray picture stores one of three equal numbers.
        let expected = expected.chunks_exact(stride).flat_map(|pixel| {
            let colors = if channels < 3 { 1 } else { 3 };
            pixel[..colors].iter().chain(&pixel[3..]).copied()
        });
        let expected: Vec<f64> = expected.collect();

        run(
            &folder,
            &format!("render {scene}.ron -o a.tif --float {options}"),
        );
        let (DecodingResult::F32(floats), samples) = numbers(&folder.read("a.tif")) else {
            panic!("these are no floats");
        };
        assert_eq!(samples, channels);
        let rounded = expected.iter().map(|&value| value as f32);
        assert!(rounded.eq(floats), "{scene} {options}");

        run(&folder, &format!("render {scene}.ron -o a.tiff {options}"));
        let (DecodingResult::U16(codes), samples) = numbers(&folder.read("a.tiff")) else {
            panic!("these are no codes");
        };
        assert_eq!(samples, channels);
        assert_eq!(codes.len(), expected.len());
        for (code, value) in codes.into_iter().zip(&expected) {
            let error = (f64::from(code) - MOST * value.min(1.0)).abs();
            assert!(error <= 0.5 + 1e-9, "{value}: {code}");
        }
    }
}

#[test]
fn codes_end_at_white() {
    let folder = folder();
    let clipped = |arguments: &str| {
        let line = run(&folder, &format!("render scene.ron {arguments}"));
        line.contains(" clipped, ")
    };
    assert!(clipped("-o a.tif"));
    assert!(!clipped("-o a.tif --exposure -1"));
    assert!(!clipped("-o a.tif --float"));
    let (DecodingResult::U16(codes), _) = numbers(&folder.read("a.tif")) else {
        let (DecodingResult::F32(floats), _) = numbers(&folder.read("a.tif")) else {
            panic!("neither codes nor floats");
        };
        assert!(floats.iter().any(|&value| value > 1.2));
        return;
    };
    panic!("{codes:?}");
}

#[test]
fn options_of_other_formats_are_refused() {
    let folder = folder();
    for (options, message) in [
        (
            "--bits 16",
            "--bits is for PNG files, but the output is TIFF",
        ),
        (
            "--linear",
            "--linear is for PNG files, but the output is TIFF",
        ),
        (
            "--error-channel",
            "--error-channel is for EXR, NPY and NPZ files, but the output is TIFF",
        ),
        (
            "--float --exposure 1",
            "--exposure is for codes, but --float writes the light itself",
        ),
    ] {
        let output = folder.run(&format!("render scene.ron -o a.tif {options}"));
        assert_eq!(code(&output), 2, "{options}");
        assert_eq!(text(&output.stderr), format!("marbles: {message}\n"));
    }
}

#[test]
fn files_that_are_there_are_skipped_and_damaged_ones_are_not() {
    let folder = folder();
    let render = "render scene.ron -o a.tif --skip-existing --sidecar";
    run(&folder, render);
    let bytes = folder.read("a.tif");
    assert!(run(&folder, render).starts_with("a.tif: skipped, "));
    let mut damaged = bytes.clone();
    damaged[200] ^= 0x40;
    let mut longer = bytes.clone();
    longer.push(0);
    for other in [
        damaged,
        longer,
        bytes[..bytes.len() - 1].to_vec(),
        Vec::new(),
    ] {
        fs::write(folder.path("a.tif"), other).unwrap();
        assert!(run(&folder, render).contains("error <= "));
        assert!(folder.read("a.tif") == bytes);
    }
    // Another scene, other settings.
    for options in ["--float", "--exposure 1", "--tolerance 1e-4"] {
        assert!(run(&folder, &format!("{render} {options}")).contains("error <= "));
    }
}

#[test]
fn parts_become_the_file_of_the_whole() {
    let folder = folder();
    for options in ["", "--float --alpha"] {
        run(&folder, &format!("render scene.ron -o whole.tif {options}"));
        run(
            &folder,
            &format!("render scene.ron -o upper.tif --region 0,0,40,11 {options}"),
        );
        run(
            &folder,
            &format!("render scene.ron -o left.tif --region 0,11,13,26 {options}"),
        );
        run(
            &folder,
            &format!("render scene.ron -o right.tif --region 13,11,27,26 {options}"),
        );
        run(&folder, "merge merged.tif upper.tif left.tif right.tif");
        assert!(
            folder.read("merged.tif") == folder.read("whole.tif"),
            "{options}"
        );
    }
    let output = folder.run("merge merged.tif upper.tif left.tif");
    assert_eq!(code(&output), 2);
}

#[test]
fn compare_reads_it() {
    let folder = folder();
    run(&folder, "render scene.ron -o a.npy");
    run(&folder, "render scene.ron -o a.tif");
    run(&folder, "render scene.ron -o float.tif --float");
    let printed = run(&folder, "compare a.npy float.tif --tolerance 1e-7");
    assert!(
        printed.contains("40 x 37, TIFF, 32 bit float, RGB"),
        "{printed}"
    );
    assert!(
        printed.contains("0 of 1480 pixels, fraction 0.0e+00, differ by more"),
        "{printed}"
    );
    let printed = run(&folder, "compare a.npy a.tif");
    assert!(
        printed.contains("40 x 37, TIFF, 16 bit linear, RGB"),
        "{printed}"
    );
    // Only light above white differs by more than half a code.
    let row = |name: &str| {
        let line = printed.lines().find(|line| line.starts_with(name)).unwrap();
        line.split_whitespace().nth(1).unwrap().to_owned()
    };
    assert_eq!(row("beyond"), row("clipped"));
}
