//! The codes of PNG pictures: linear codes, exposures, and pixels that are too bright.

use std::fs;
use std::io::Cursor;

use crate::folder::{BALL, Folder, code, text};

/// A ball in two lights, whose brightest pixels are above 1.
fn bright() -> Folder {
    let folder = Folder::new();
    let scene = BALL.replace("(-1, 1, -1))]", "(-1, 1, -1), intensity: 2)]");
    folder.write_scene(&scene);
    folder
}

/// The output of `render`.
fn printed(folder: &Folder, arguments: &str) -> String {
    let is_sequence = arguments.contains("--frames");
    let scene = if is_sequence { "roll" } else { "ball" };
    let output = folder.run(&format!("render {scene}.ron --size 40x30 {arguments}"));
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    text(&output.stdout)
}

/// The number of clipped pixels in a line of results.
fn clipped(line: &str) -> Option<u64> {
    let (start, _) = line.split_once(" clipped, ")?;
    start.rsplit_once(' ').unwrap().1.parse().ok()
}

/// The codes of a PNG, as stored in the file.
fn codes(bytes: &[u8]) -> Vec<u8> {
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    let mut codes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut codes).unwrap();
    codes
}

#[test]
fn clipped_pixels_are_counted_for_every_png() {
    let folder = bright();
    let line = printed(&folder, "-o a.png");
    let count = clipped(&line).unwrap();
    let white = codes(&folder.read("a.png"));
    let white = white.iter().filter(|&&code| code == 255).count() as u64;
    // White alone is not clipped.
    assert!(count > 100 && count <= white && white < 2 * count, "{line}");
    for (options, is_clipped) in [
        ("-o b.png --bits 16", true),
        ("-o b.png --linear", true),
        ("-o b.png --rgb --alpha", true),
        ("-o b.png --exposure -1", false),
        ("-o b.png --exposure -0.5", true),
        ("-o b.exr", false),
        ("-o b.npy", false),
    ] {
        let line = printed(&folder, options);
        assert_eq!(clipped(&line).is_some(), is_clipped, "{options}: {line}");
        assert_eq!(line.contains("clipped"), is_clipped, "{options}: {line}");
    }

    let lines = printed(&folder, "-o #.png --frames 1-3");
    let counts: Vec<u64> = lines.lines().filter_map(clipped).collect();
    assert_eq!(counts, [count, count, count, 3 * count], "{lines}");
    let line = printed(&folder, "-o a.apng --frames 1-3");
    assert_eq!(clipped(&line), Some(3 * count), "{line}");
    let lines = printed(&folder, "-o #.png --frames 1-3 --exposure -1");
    assert!(!lines.contains("clipped"), "{lines}");
}

#[test]
fn clipped_pixels_are_an_error_where_warnings_are() {
    let folder = bright();
    for (options, expected) in [("", 1), ("--exposure -1", 0)] {
        let output = folder.run(&format!(
            "render ball.ron --size 40x30 -o a.png --strict {options}"
        ));
        let errors = text(&output.stderr);
        assert_eq!(code(&output), expected, "{errors}");
        assert_eq!(
            errors.contains("clipped pixels are an error"),
            expected == 1
        );
        assert!(folder.path("a.png").exists());
    }
}

#[test]
fn an_exposure_multiplies_light() {
    let folder = bright();
    let half = BALL.replace("(-1, 1, -1))]", "(-1, 1, -1), intensity: 0.5)]");
    fs::write(folder.path("half.ron"), half).unwrap();
    for bits in ["", "--bits 16", "--linear"] {
        printed(
            &folder,
            &format!("-o bright.png --samples 3 {bits} --exposure -2"),
        );
        let output = folder.run(&format!(
            "render half.ron --size 40x30 -o half.png --samples 3 {bits}"
        ));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        let [bright, half] = ["bright.png", "half.png"].map(|name| codes(&folder.read(name)));
        assert!(bright == half, "{bits}");
    }
    // Another exposure is another file.
    let again = "-o a.png --skip-existing --exposure";
    printed(&folder, &format!("{again} 1"));
    assert!(printed(&folder, &format!("{again} 1.0")).contains(": skipped"));
    assert!(!printed(&folder, &format!("{again} 1.5")).contains(": skipped"));
}

#[test]
fn what_a_format_cannot_have_is_refused() {
    let folder = bright();
    for (options, reason) in [
        (
            "-o a.exr --linear",
            "--linear is for PNG files, but the output is EXR",
        ),
        (
            "-o a.npy --exposure 1",
            "--exposure is for PNG, TIFF, GIF and WebP files, but the output is NPY",
        ),
        (
            "-o a.exr --exposure 0",
            "--exposure is for PNG, TIFF, GIF and WebP files, but the output is EXR",
        ),
        (
            "-o a.npy --float",
            "--float is for EXR and TIFF files, but the output is NPY",
        ),
        (
            "-o a.npy --bits 16",
            "--bits is for PNG files, but the output is NPY",
        ),
        (
            "-o a.png --linear --bits 8",
            "--linear writes 16 bits, but --bits asks for 8",
        ),
    ] {
        let output = folder.run(&format!("render ball.ron {options}"));
        assert_eq!(code(&output), 2, "{options}");
        assert_eq!(text(&output.stderr), format!("marbles: {reason}\n"));
    }
    let output = folder.run("render ball.ron --exposure 101");
    let errors = text(&output.stderr);
    assert!(
        errors.contains("expected a number from -100 to 100"),
        "{errors}"
    );
}
