//! Pictures that are larger than the memory.

use std::fs;
use std::process::{Command, Output};

use crate::folder::{BALL, Folder, assert_complete, code, text};

/// Runs `marbles` with no more addresses than so many.
fn run_in_memory(folder: &Folder, kilobytes: u32, arguments: &str) -> Output {
    let marbles = folder.marbles(arguments);
    let output = Command::new("sh")
        .args(["-c", &format!("ulimit -v {kilobytes}; exec \"$@\""), "sh"])
        .arg(marbles.get_program())
        .args(marbles.get_args())
        .current_dir(&folder.0)
        .output();
    output.unwrap()
}

/// A folder in which the picture of the ball has color, so that none of its channels can be left out.
fn colored() -> Folder {
    let folder = Folder::new();
    let colored = BALL.replace("lights:", "background: (0, 0, 1), lights:");
    fs::write(folder.path("ball.ron"), colored).unwrap();
    folder
}

#[test]
fn pictures_larger_than_the_memory_are_rendered() {
    // Of address space, which the binary, threads and what the allocator sets aside for each take, too.
    const KILOBYTES: u32 = 500_000;
    let folder = colored();
    // 16.8 million pixels of four channels in double precision are 537 MB.
    for output in ["a.png --bits 16", "a.exr --float"] {
        let arguments = format!(
            "render ball.ron -o {output} --alpha --samples 1 --threads 2 --size 16384x1024"
        );
        let output = run_in_memory(&folder, KILOBYTES, &arguments);
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        assert!(text(&output.stdout).contains(": 16777216 pixels, "));
    }
    assert_complete(&folder.path("a.png"));
}

#[test]
fn too_little_memory_is_an_error() {
    let folder = colored();
    let mut codes = Vec::new();
    for kilobytes in [300_000, 400_000, 500_000, 900_000] {
        for options in ["-o #.exr --float --alpha", "-o #.png --bits 16"] {
            // The widest there are.
            let arguments = format!(
                "render ball.ron {options} --samples 1 --threads 2 --size 65536x30 --frames 1-2"
            );
            let output = run_in_memory(&folder, kilobytes, &arguments);
            let errors = text(&output.stderr);
            let code = output.status.code();
            assert!(matches!(code, Some(0 | 1)), "{arguments}: {errors}");
            let refused = errors.contains(" memory");
            assert_eq!(refused, code == Some(1), "{arguments}: {errors}");
            codes.push(code);
        }
    }
    assert!(codes.contains(&Some(0)) && codes.contains(&Some(1)));
}
