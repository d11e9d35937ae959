//! Files that were damaged after they were written, byte by byte, before they are kept or merged.
//!
//! The commands run in this process, because there are thousands of them.

use std::ffi::OsString;
use std::fs;
use std::io::{Cursor, sink};

use exr::meta::MetaData;

use crate::folder::Folder;

/// A ball so small that its files have a few hundred bytes.
const SCENE: &str = "(
    image: (width: 6, height: 6), lens: Fov(40), camera: Free(), background: 0.25,
    lights: [Directional(toward: (-1, 1, -1))],
    spheres: [(center: (0, 0, 4), radius: 1)],
)";

/// The exit code of `marbles` with these words; `@` stands for the folder.
fn run(folder: &Folder, words: &str) -> u8 {
    let place = folder.path("").display().to_string();
    let words = words.split(' ').map(|word| word.replace('@', &place));
    let words = [OsString::from("marbles")]
        .into_iter()
        .chain(words.map(OsString::from));
    marbles_cli::run_with(words, sink(), sink())
}

/// The file of a part, and the positions of bytes, from `first`, whose change is not noticed: by `--skip-existing`, and
/// by `merge`.
fn unnoticed(ending: &str, size: u32, first: fn(&[u8]) -> usize) -> (Vec<u8>, [Vec<usize>; 2]) {
    let folder = Folder::new();
    fs::write(folder.path("small.ron"), SCENE).unwrap();
    let render = |name: &str, region: &str| {
        let options =
            format!("--skip-existing --quiet --threads 1 --size {size}x{size} --region {region}");
        let code = run(
            &folder,
            &format!("render @small.ron -o @{name}.{ending} {options}"),
        );
        assert_eq!(code, 0);
    };
    let half = size / 2;
    let (upper, lower) = (
        format!("0,0,{size},{half}"),
        format!("0,{half},{size},{half}"),
    );
    render("upper", &upper);
    render("lower", &lower);
    let merge = format!("merge @whole.{ending} @upper.{ending} @lower.{ending} --quiet");
    assert_eq!(run(&folder, &merge), 0);
    let whole = folder.read(&format!("whole.{ending}"));
    let name = format!("lower.{ending}");
    let bytes = folder.read(&name);
    let (mut kept, mut merged) = (Vec::new(), Vec::new());
    for place in first(&bytes)..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[place] ^= 0x04;
        fs::write(folder.path(&name), &damaged).unwrap();
        // What is refused is not written, and what was there stays.
        let ended = run(&folder, &merge);
        let found = folder.read(&format!("whole.{ending}")) == whole;
        assert!(found || ended == 0);
        if ended == 0 {
            merged.push(place);
        }
        fs::write(folder.path(&format!("whole.{ending}")), &whole).unwrap();
        render("lower", &lower);
        if folder.read(&name) != bytes {
            kept.push(place);
        }
    }
    (bytes, [kept, merged])
}

/// A PNG has checksums over all of it.
#[test]
fn no_byte_of_a_png_is_damaged_unnoticed() {
    let (_, places) = unnoticed("png", 6, |_| 0);
    assert_eq!(places.concat(), Vec::<usize>::new());
}

/// An NPY has no checksum for its numbers, as `docs/sequences.md` explains; everything before them must be unchanged.
#[test]
fn what_is_wrong_in_the_header_of_an_npy_is_noticed() {
    let (bytes, places) = unnoticed("npy", 4, |_| 0);
    let start = bytes.iter().position(|&byte| byte == b'\n').unwrap() + 1;
    for places in places {
        assert_eq!(places, Vec::from_iter(start..bytes.len()));
    }
}

/// An EXR has checksums for its compressed blocks, and the table of blocks must be correct.
#[test]
fn what_is_wrong_in_the_blocks_of_an_exr_is_noticed() {
    let (_, places) = unnoticed("exr", 24, |bytes| {
        let mut rest = Cursor::new(bytes);
        MetaData::read_from_buffered(&mut rest, false).unwrap();
        rest.position() as usize
    });
    // Deflate leaves bits without a meaning where it ends.
    let places = places.concat();
    assert!(places.len() <= 2, "{places:?}");
}
