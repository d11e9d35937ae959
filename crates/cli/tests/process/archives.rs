//! Pictures as NPZ, with all arrays under their names.

use std::fs;

use crate::folder::{Folder, code, text};

const BALLS: &str = "(
    image: (width: 41, height: 31),
    lens: Retina(width: 41, distance: 50),
    camera: Free(),
    lights: [Directional(toward: (-1, 1, -1))],
    spheres: [(center: (0, 0, 10), radius: 2), (center: (3, 0, 10), radius: 1)],
)
";
const PIXELS: usize = 41 * 31;
const OPTIONS: &str = "--error-channel --channels depth,normal,id,mask,mean_normal,coverage_id";

/// The bytes of an array of an archive, behind the header of its NPY file, and the form that this header states.
fn array(archive: &[u8], name: &str) -> (Vec<u8>, String) {
    let name = [name.as_bytes(), b".npy"].concat();
    let find = |part: &[u8], from: usize| {
        let found = archive[from..].windows(part.len());
        from + found.into_iter().position(|bytes| bytes == part).unwrap()
    };
    // Before the name is a header of 30 bytes.
    let mut place = find(&name, 0);
    while !archive[place - 30..].starts_with(b"PK\x03\x04") {
        place = find(&name, place + 1);
    }
    let sizes = place + name.len() + 4;
    let bytes = u64::from_le_bytes(archive[sizes..sizes + 8].try_into().unwrap()) as usize;
    let file = &archive[sizes + 16..][..bytes];
    let header = usize::from(u16::from_le_bytes([file[8], file[9]]));
    let form = String::from_utf8_lossy(&file[10..10 + header]).into_owned();
    (file[10 + header..].to_vec(), form)
}

/// The numbers with these offsets in each pixel.
fn picked(bytes: &[u8], pixel: usize, numbers: std::ops::Range<usize>) -> Vec<u8> {
    let pixels = bytes.chunks_exact(8 * pixel);
    let own = pixels.flat_map(|pixel| &pixel[8 * numbers.start..8 * numbers.end]);
    own.copied().collect()
}

#[test]
fn arrays_of_an_archive_are_those_of_the_files() {
    let folder = Folder::new();
    fs::write(folder.path("balls.ron"), BALLS).unwrap();
    for output in ["a.npz", "a.npy"] {
        let result = folder.run(&format!("render balls.ron -o {output} {OPTIONS}"));
        assert_eq!(code(&result), 0, "{}", text(&result.stderr));
    }
    let archive = folder.read("a.npz");
    let of_file = |name: &str, number: usize| {
        let bytes = folder.read(name);
        bytes[bytes.len() - PIXELS * number..].to_vec()
    };
    let channels = of_file("a_channels.npy", 11 * 8);
    for (name, shape, expected) in [
        ("light", "(31, 41, 3)", of_file("a.npy", 24)),
        ("error", "(31, 41)", of_file("a_error.npy", 8)),
        ("id", "(31, 41)", of_file("a_id.npy", 4)),
        ("coverage_id", "(31, 41)", of_file("a_coverage_id.npy", 4)),
        ("depth", "(31, 41)", picked(&channels, 11, 0..1)),
        ("normal", "(31, 41, 3)", picked(&channels, 11, 1..4)),
        ("mask", "(31, 41)", picked(&channels, 11, 4..5)),
        ("mean_normal", "(31, 41, 3)", picked(&channels, 11, 5..8)),
        ("mean_normal_error", "(31, 41)", picked(&channels, 11, 8..9)),
        ("coverage_share", "(31, 41)", picked(&channels, 11, 9..10)),
        ("coverage_error", "(31, 41)", picked(&channels, 11, 10..11)),
    ] {
        let (bytes, form) = array(&archive, name);
        assert!(form.contains(&format!("'shape': {shape},")), "{form}");
        assert!(bytes == expected, "{name}");
    }
    let same = folder.run("compare a.npz a.npy");
    assert!(text(&same.stdout).contains("the same"), "{same:?}");
    assert!(!folder.path("a_error.npz").exists());
}

#[test]
fn complete_archives_are_kept_and_damaged_ones_replaced() {
    let folder = Folder::new();
    fs::write(folder.path("balls.ron"), BALLS).unwrap();
    let arguments = format!("render balls.ron -o a.npz {OPTIONS} --skip-existing");
    let run = || text(&folder.run(&arguments).stdout).to_owned();
    assert!(run().contains("error <="));
    let whole = folder.read("a.npz");
    assert!(run().contains("skipped"));
    let mut damaged = whole.clone();
    damaged[9000] ^= 8;
    fs::write(folder.path("a.npz"), damaged).unwrap();
    assert!(run().contains("error <="));
    assert!(folder.read("a.npz") == whole);
    // Parts of pictures are merged from other formats.
    let merged = folder.run("merge b.npz a.npz a.npz");
    assert_eq!(code(&merged), 2);
    let why = "expected a file name that ends in .png, .exr, .npy or .tif";
    assert!(text(&merged.stderr).contains(why), "{merged:?}");
}
