//! Tests of `pipeline.rs`.

use super::*;
use crate::formats::encoding::{Encoding, ExrOptions, PngOptions};
use crate::formats::tests::PNG as PLAIN;

fn encoder(encoding: Encoding, width: u32, height: u32) -> Encoder {
    let form = Form {
        region: Region::all(Size { width, height }),
        channels: Channels::Rgb,
        alpha: true,
        centers: None,
    };
    Encoder::new(encoding, form, &[])
}

const PNG: Encoding = Encoding::Png(PngOptions {
    deep: true,
    rgb: true,
    ..PLAIN
});
const EXR: Encoding = Encoding::Exr(ExrOptions {
    float: true,
    error: true,
});

#[test]
fn the_height_of_a_picture_costs_no_strips() {
    for encoding in [PNG, EXR] {
        let [low, high] =
            [9, 1 << 20].map(|height| capacity(&encoder(encoding, 600, height)).unwrap());
        // The lower one has no whole strip of an EXR file.
        assert!(high > 2 && low >= high);
    }
}

#[test]
fn large_pictures_have_room_in_a_gigabyte() {
    for encoding in [PNG, EXR] {
        let encoder = encoder(encoding, 1 << 15, 1 << 15);
        let bytes = capacity(&encoder).unwrap() * encoder.strip_bytes();
        assert!(bytes < 1 << 29, "{bytes}");
    }
}

#[test]
fn the_widest_pictures_do_not_fit() {
    // Wider than scenes allow.
    let failure = capacity(&encoder(EXR, u32::MAX, 1 << 31)).unwrap_err();
    let Failure::Work(message) = failure else {
        panic!("{failure:?}");
    };
    assert!(message.ends_with("GB of memory, more than is available"));
}
