//! Pictures that are larger than the memory.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::process::Command;

use crate::folder::{BALL, Folder, assert_complete, code, text};

/// `marbles` with a limited address space.
fn in_memory(folder: &Folder, kilobytes: u32, arguments: &str) -> Command {
    let marbles = folder.marbles(arguments);
    let mut command = Command::new("sh");
    command
        .args(["-c", &format!("ulimit -v {kilobytes}; exec \"$@\""), "sh"])
        .arg(marbles.get_program())
        .args(marbles.get_args())
        .current_dir(&folder.0);
    command
}

/// A folder with a picture in color, so that all of its channels are needed.
fn colored() -> Folder {
    let folder = Folder::new();
    let colored = BALL.replace("lights:", "background: (0, 0, 1), lights:");
    folder.write_scene(&colored);
    folder
}

#[test]
fn pictures_larger_than_the_memory_are_rendered() {
    // Of address space, which the binary and the stacks of threads take, too.
    const KILOBYTES: u32 = 300_000;
    let folder = colored();
    // 11.5 million pixels of four channels in double precision are 367 MB.
    for output in ["a.png --bits 16", "a.exr --float", "a.npy"] {
        let arguments =
            format!("render ball.ron -o {output} --alpha --samples 1 --threads 2 --size 16384x700");
        let mut marbles = in_memory(&folder, KILOBYTES, &arguments);
        // Otherwise glibc sets 64 MiB aside for each thread, more or less of them from run to run.
        let output = marbles.env("MALLOC_ARENA_MAX", "1").output().unwrap();
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        assert!(text(&output.stdout).contains(": error "));
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
                "render roll.ron {options} --samples 1 --threads 2 --size 65536x30 --frames 1-2"
            );
            let output = in_memory(&folder, kilobytes, &arguments).output().unwrap();
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

#[test]
fn tables_larger_than_the_memory_are_errors() {
    const ROWS: u32 = 1_500_000;
    let folder = Folder::new();
    let mut table = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({ROWS}, 4), }}");
    table.extend(format!("{header:<117}\n").bytes());
    for row in 0..ROWS {
        let place = |step: u32| (row * step % 1009) as f32;
        for number in [place(7), place(131), place(517), 0.5] {
            table.extend(number.to_le_bytes());
        }
    }
    fs::write(folder.path("table.npy"), table).unwrap();
    let scene = "(image: (width: 9, height: 9), lens: Fov(40), camera: Frame(),
        lights: [Directional(toward: (1, 2, -1))], clouds: [(file: \"table.npy\")])";
    fs::write(folder.path("table.ron"), scene).unwrap();
    let mut codes = Vec::new();
    // From what the program itself takes to more than enough.
    for step in 0..8 {
        let kilobytes = 100_000 + 25_000 * step * step;
        let arguments = "render table.ron -o out/table.npy --samples 1 --threads 2";
        let output = in_memory(&folder, kilobytes, arguments).output().unwrap();
        let errors = text(&output.stderr);
        let code = output.status.code();
        assert!(
            matches!(code, Some(0..=2)),
            "{kilobytes} kB: {code:?}, {errors}"
        );
        assert_eq!(
            errors.contains("memory"),
            code != Some(0),
            "{kilobytes} kB: {errors}"
        );
        if folder.path("out").exists() {
            let names: &[&str] = if code == Some(0) { &["table.npy"] } else { &[] };
            assert_eq!(folder.names("out"), names, "{kilobytes} kB");
            fs::remove_dir_all(folder.path("out")).unwrap();
        }
        codes.push(code);
    }
    for expected in 0..=1 {
        assert!(codes.contains(&Some(expected)), "{codes:?}");
    }
}

/// Allocations that are too small to be checked before, including those of decompression libraries and of the standard
/// library.
#[test]
fn memory_that_ends_in_small_pieces_is_an_error() {
    let folder = Folder::new();
    let mut table = String::from("x,y,z\n");
    for row in 0..400_000_u32 {
        let mixed = row.wrapping_mul(2_654_435_761);
        let place = |shift: u32| (mixed >> shift) % 1009;
        let _ = writeln!(table, "{},{},{}", place(0), place(7), place(14));
    }
    fs::write(folder.path("table.csv"), table).unwrap();
    let packed = Command::new("gzip").arg(folder.path("table.csv")).status();
    let name = if packed.is_ok_and(|packed| packed.success()) {
        "table.csv.gz"
    } else {
        "table.csv"
    };
    let scene = format!(
        "(image: (width: 9, height: 9), lens: Fov(40), camera: Frame(), clouds: [(file: {name:?}, radius: 1)])"
    );
    fs::write(folder.path("table.ron"), scene).unwrap();
    let mut said = String::new();
    // The program itself must fit, but not the table.
    for kilobytes in (30_000..84_000).step_by(1800) {
        let arguments = "render table.ron -o a.png --samples 1 --threads 2";
        let output = in_memory(&folder, kilobytes, arguments).output().unwrap();
        let errors = text(&output.stderr);
        let code = output.status.code();
        assert!(
            matches!(code, Some(1 | 2)),
            "{kilobytes} kB: {code:?}, {errors}"
        );
        assert!(errors.contains(" memory"), "{kilobytes} kB: {errors}");
        said += &errors;
    }
    assert!(said.contains("out of memory"), "{said}");
}

/// A gray picture with one repeated line.
fn write_grey(folder: &Folder, name: &str, side: u32, profile: Option<Vec<u8>>) {
    let mut info = png::Info::with_size(side, side);
    info.color_type = png::ColorType::Grayscale;
    info.bit_depth = png::BitDepth::Sixteen;
    info.icc_profile = profile.map(Into::into);
    let file = File::create(folder.path(name)).unwrap();
    let encoder = png::Encoder::with_info(file, info).unwrap();
    let mut writer = encoder.write_header().unwrap();
    let mut stream = writer.stream_writer_with_size(2 * side as usize).unwrap();
    let row = vec![0; 2 * side as usize];
    for _ in 0..side {
        std::io::Write::write_all(&mut stream, &row).unwrap();
    }
    stream.finish().unwrap();
}

#[test]
fn pictures_larger_than_the_memory_are_compared() {
    let folder = colored();
    write_grey(&folder, "a.png", 4700, None);
    for output in ["a.npy --alpha", "a.exr --float"] {
        let arguments = format!("render ball.ron -o {output} --samples 1 --size 4096x850 -q");
        assert_eq!(code(&folder.run(&arguments)), 0);
    }
    // The codes of the first are 44 MB, the numbers of the others 111 and 42 MB.
    for arguments in ["a.png a.png", "a.exr a.npy --diff d.exr"] {
        let mut marbles = in_memory(&folder, 40_000, &format!("compare {arguments}"));
        let output = marbles.output().unwrap();
        assert_eq!(code(&output), 0, "{arguments}: {}", text(&output.stderr));
    }
    assert_eq!(code(&folder.run("compare d.exr d.exr")), 0);
}

/// A compressed color profile may expand a thousandfold. Its contents do not matter here.
#[test]
fn profiles_take_no_memory() {
    let folder = Folder::new();
    write_grey(&folder, "a.png", 9, None);
    write_grey(&folder, "profile.png", 9, Some(vec![0; 400_000_000]));
    let mut marbles = in_memory(&folder, 300_000, "compare a.png profile.png");
    let output = marbles.output().unwrap();
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
}
