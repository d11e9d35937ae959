//! Files that something has damaged after they were written, byte by byte, before they are kept or merged.
//!
//! Runs are in this process: there are thousands of them.

use std::ffi::OsString;
use std::fs;
use std::io::sink;

use crate::folder::Folder;

/// A ball so small that its files have some hundred bytes.
const SCENE: &str = "(
    image: (width: 6, height: 4), lens: Fov(40), camera: Free(), background: 0.25,
    lights: [Directional(toward: (-1, 1, -1))],
    spheres: [(center: (0, 0, 4), radius: 1)],
)";

/// The exit code of `marbles` with these words, in which `@` stands for the folder.
fn run(folder: &Folder, words: &str) -> u8 {
    let place = folder.path("").display().to_string();
    let words = words.split(' ').map(|word| word.replace('@', &place));
    let words = [OsString::from("marbles")]
        .into_iter()
        .chain(words.map(OsString::from));
    marbles_cli::run_with(words, sink(), sink())
}

/// The bytes that are changed without notice by `--skip-existing`, and those by `merge`, as parts of the file.
fn unnoticed(ending: &str) -> [Vec<f64>; 2] {
    let folder = Folder::new();
    fs::write(folder.path("small.ron"), SCENE).unwrap();
    let render = |name: &str, region: &str| {
        let options = format!("--skip-existing --quiet --threads 1 --region {region}");
        let code = run(
            &folder,
            &format!("render @small.ron -o @{name}.{ending} {options}"),
        );
        assert_eq!(code, 0);
    };
    let (upper, lower) = ("0,0,6,2", "0,2,6,2");
    render("upper", upper);
    render("lower", lower);
    let merge = format!("merge @whole.{ending} @upper.{ending} @lower.{ending} --quiet");
    assert_eq!(run(&folder, &merge), 0);
    let whole = folder.read(&format!("whole.{ending}"));
    let name = format!("lower.{ending}");
    let bytes = folder.read(&name);
    let (mut kept, mut merged) = (Vec::new(), Vec::new());
    for place in 0..bytes.len() {
        let part = place as f64 / bytes.len() as f64;
        let mut damaged = bytes.clone();
        damaged[place] ^= 0x04;
        fs::write(folder.path(&name), &damaged).unwrap();
        // What is refused is not written, and what was there stays.
        if run(&folder, &merge) == 0 && folder.read(&format!("whole.{ending}")) != whole {
            merged.push(part);
        }
        fs::write(folder.path(&format!("whole.{ending}")), &whole).unwrap();
        render("lower", lower);
        if folder.read(&name) != bytes {
            kept.push(part);
        }
    }
    [kept, merged]
}

/// A PNG has checksums over all of it.
#[test]
fn no_byte_of_a_png_is_damaged_unnoticed() {
    assert_eq!(unnoticed("png"), [const { Vec::new() }; 2]);
}

/// An EXR has checksums over compressed samples alone: what its header says beside the picture can change. An NPY has
/// none: any of its numbers can. `docs/sequences.md` says so.
#[test]
fn formats_without_checksums_are_known_by_their_form() {
    let [kept, merged] = unnoticed("npy");
    // The header is found to be wrong; of 288 bytes of numbers none is.
    assert!(kept.len() >= 288 && merged.len() >= 288);
    assert!(
        kept.iter()
            .chain(&merged)
            .filter(|&&part| part < 0.5)
            .count()
            < 288
    );
    let [kept, _] = unnoticed("exr");
    assert!(!kept.is_empty());
}
