//! Pictures of other programs, as read by `marbles compare`. Those in `tests/seeds/pictures` were written by OpenEXR,
//! NumPy, Pillow, tifffile and OpenCV, and by hand.

use std::ffi::OsString;
use std::io::sink;
use std::path::{Path, PathBuf};

/// The picture with the same colors as all EXR files and some others.
const COLORS: &str = "doubles.npy";

/// The picture whose codes the TIFF files and the files in formats that are only read contain, or whose light they contain
/// divided.
const CODES: &str = "plain.tif";

fn seed(name: &str) -> PathBuf {
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("seeds/pictures");
    seeds.join(name)
}

/// The exit code of a comparison.
fn compare(name: &str, other: &str, tolerance: &str) -> u8 {
    let words = ["marbles", "compare", "--quiet", "--tolerance", tolerance];
    let words = words.map(OsString::from).into_iter();
    let files = [name, other].map(|name| seed(name).into_os_string());
    marbles_cli::run_with(words.chain(files), sink(), sink())
}

#[test]
fn blocks_of_all_kinds_are_read() {
    // Half a unit in the last place of a half below 1; PXR24 keeps 24 bit, and B44 less than there are.
    for (name, tolerance, less) in [
        ("zip.exr", "2.5e-4", "1e-4"),
        ("rle.exr", "2.5e-4", "1e-4"),
        ("piz.exr", "2.5e-4", "1e-4"),
        ("tiles.exr", "2.5e-4", "1e-4"),
        ("parts.exr", "2.5e-4", "1e-4"),
        ("pxr24.exr", "1e-5", "1e-6"),
        ("b44.exr", "6e-2", "1e-2"),
        // Half a code of 16 bit, linear.
        ("rgb16.png", "1.6e-5", "1e-6"),
    ] {
        assert_eq!(compare(name, COLORS, tolerance), 0, "{name}");
        assert_eq!(compare(name, COLORS, less), 1, "{name}");
    }
}

/// The decoder of the library panics on these blocks.
#[test]
fn altered_blocks_are_refused() {
    assert_eq!(compare("b44_altered.exr", COLORS, "1"), 2);
}

#[test]
fn what_is_stored_in_two_ways_is_the_same() {
    for (one, other) in [
        ("interlaced.png", "rgb8.png"),
        ("animated.png", "grey.png"),
        ("floats.npy", "none_grey.exr"),
    ] {
        assert_eq!(compare(one, other, "0"), 0, "{one}");
        assert_eq!(compare(one, COLORS, "0"), 1, "{one}");
    }
}

#[test]
fn formats_without_loss_have_the_same_codes() {
    for (one, other) in [
        ("lzw.tif", CODES),
        ("deep_tiles.tif", CODES),
        ("loop.gif", CODES),
        ("palette.gif", CODES),
        ("lossless.webp", CODES),
        ("rgb.bmp", CODES),
        ("rgb.tga", CODES),
        ("rgb.ppm", CODES),
        // These have the same alpha.
        ("alpha.pam", "alpha.tif"),
        ("rle.tga", "alpha.tif"),
        ("bits.pbm", "bits.bmp"),
        // Numbers with 8 bits represent the light of these codes, divided by 64, exactly.
        ("rle.hdr", "float.tif"),
    ] {
        assert_eq!(compare(one, other, "0"), 0, "{one}");
    }
    assert_eq!(compare("alpha.tif", CODES, "0.4"), 1);
}

/// The expected values are the largest differences in linear light according to Pillow, to 1 %.
#[test]
fn formats_with_loss_are_as_near_as_another_decoder_says() {
    for (one, other, expected) in [
        ("cmyk.jpg", CODES, 0.04616),
        ("progressive.jpg", "grey.pgm", 0.04457),
        ("rgb.jpg", CODES, 0.4798),
        ("lossy.webp", CODES, 0.5150),
        ("loop.webp", CODES, 0.5247),
    ] {
        let [less, more] = [0.99, 1.01].map(|factor| (factor * expected).to_string());
        assert_eq!(compare(one, other, &more), 0, "{one}");
        assert_eq!(compare(one, other, &less), 1, "{one}");
    }
}
