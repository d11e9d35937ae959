use png::Encoder;

use super::*;
use crate::base::size::Size;
use crate::formats::encoding::PngOptions;
use crate::formats::picture::tests::{Whole, exif_of_orientation};
use crate::formats::tests::{Scene, png_bytes, render, size};
use marbles_core::srgb;

fn decode(bytes: &[u8]) -> Result<Picture, String> {
    begin(&Source::Memory(bytes.into()))
}

fn whole(bytes: &[u8]) -> Result<Whole, String> {
    decode(bytes)?.whole()
}

/// The description and the pixels of a PNG with one line.
fn decoded(color_type: ColorType, depth: BitDepth, width: u32, samples: &[u8]) -> (String, Whole) {
    described(&encoded(color_type, depth, width, samples, |_| {}))
}

fn described(bytes: &[u8]) -> (String, Whole) {
    let picture = decode(bytes).unwrap();
    (picture.description.clone(), picture.whole().unwrap())
}

/// A PNG of one line.
fn encoded(
    color_type: ColorType,
    depth: BitDepth,
    width: u32,
    samples: &[u8],
    more: impl Fn(&mut Encoder<&mut Vec<u8>>),
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, 1);
    encoder.set_color(color_type);
    encoder.set_depth(depth);
    more(&mut encoder);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(samples).unwrap();
    writer.finish().unwrap();
    bytes
}

fn close(one: [f64; 4], other: [f64; 4]) -> bool {
    (0..4).all(|channel| (one[channel] - other[channel]).abs() < 1e-12)
}

#[test]
fn codes_become_light() {
    let light = |code: f64| srgb::decode(code / 255.0);
    let (description, picture) =
        decoded(ColorType::Rgb, BitDepth::Eight, 2, &[0, 10, 255, 1, 2, 3]);
    assert_eq!(description, "PNG, 8 bit sRGB, RGB");
    assert_eq!(picture.rgba[0][0], [0.0, light(10.0), 1.0, 1.0]);
    assert_eq!(
        picture.rgba[0][1],
        [light(1.0), light(2.0), light(3.0), 1.0]
    );

    let (description, picture) = decoded(ColorType::Grayscale, BitDepth::Sixteen, 1, &[0x12, 0x34]);
    assert_eq!(description, "PNG, 16 bit sRGB, gray");
    let grey = srgb::decode(f64::from(0x1234) / 65535.0);
    assert_eq!(picture.rgba[0][0], [grey, grey, grey, 1.0]);
}

#[test]
fn light_is_premultiplied_by_alpha() {
    let (_, picture) = decoded(ColorType::Rgba, BitDepth::Eight, 1, &[255, 0, 188, 51]);
    let blue = 0.2 * srgb::decode(188.0 / 255.0);
    assert!(close(picture.rgba[0][0], [0.2, 0.0, blue, 0.2]));
    let (_, picture) = decoded(ColorType::GrayscaleAlpha, BitDepth::Eight, 1, &[255, 0]);
    assert_eq!(picture.rgba[0][0], [0.0; 4]);
}

#[test]
fn short_codes_and_palettes_are_expanded() {
    let (description, picture) = decoded(ColorType::Grayscale, BitDepth::Two, 4, &[0b0001_1011]);
    assert_eq!(description, "PNG, 2 bit sRGB, gray");
    let greys = [0, 1, 2, 3].map(|col: usize| picture.rgba[0][col][0]);
    let expected = [0.0, 85.0, 170.0, 255.0].map(|code| srgb::decode(code / 255.0));
    assert_eq!(greys, expected);
    // Half the way from 0 to 1 of 3.
    assert_eq!(picture.rounding[0][0][0], srgb::decode(42.5 / 255.0));

    let indexed = encoded(
        ColorType::Indexed,
        BitDepth::One,
        2,
        &[0b0100_0000],
        |png| {
            png.set_palette(vec![0, 0, 0, 255, 0, 0]);
            png.set_trns(vec![0, 255]);
        },
    );
    let (description, picture) = described(&indexed);
    assert_eq!(description, "PNG, 8 bit sRGB, RGBA");
    assert_eq!(picture.rgba[0][0], [0.0; 4]);
    assert_eq!(picture.rgba[0][1], [1.0, 0.0, 0.0, 1.0]);
}

#[test]
fn the_curve_is_what_the_file_says() {
    let of = |gamma: u32| {
        let gamma = png::ScaledFloat::from_scaled(gamma);
        let tagged = |png: &mut Encoder<&mut Vec<u8>>| png.set_source_gamma(gamma);
        let bytes = encoded(ColorType::Grayscale, BitDepth::Eight, 1, &[51], tagged);
        whole(&bytes).unwrap().rgba[0][0][0]
    };
    assert!((of(100_000) - 0.2).abs() < 1e-15);
    assert!((of(50_000) - 0.04).abs() < 1e-15);
    assert_eq!(of(45_455), srgb::decode(0.2));
    assert_eq!(of(0), srgb::decode(0.2));
}

#[test]
fn animations_and_requests_to_turn_are_warnings() {
    let warnings = |frames: u32, orientation: Option<u8>| {
        let mut info = png::Info::with_size(1, 1);
        info.exif_metadata = orientation.map(|it| exif_of_orientation(it).into());
        let mut file = Vec::new();
        let mut encoder = Encoder::with_info(&mut file, info).unwrap();
        if frames > 0 {
            encoder.set_animated(frames, 0).unwrap();
        }
        let mut writer = encoder.write_header().unwrap();
        for _ in 0..frames.max(1) {
            writer.write_image_data(&[7]).unwrap();
        }
        writer.finish().unwrap();
        decode(&file).unwrap().warnings
    };
    for (frames, orientation) in [(0, None), (1, None), (0, Some(1))] {
        assert_eq!(warnings(frames, orientation), [""; 0]);
    }
    assert_eq!(warnings(2, None), [ONE_FRAME]);
    assert_eq!(warnings(0, Some(3)), [NOT_TURNED]);
    assert_eq!(warnings(2, Some(8)), [ONE_FRAME, NOT_TURNED]);
}

/// An interlaced PNG whose zlib stream, without compression, holds these bytes.
fn stored(width: u32, height: u32, bytes: &[u8]) -> Vec<u8> {
    // Of 8 bit and gray.
    let mut info = png::Info::with_size(width, height);
    info.interlaced = true;
    let mut file = Vec::new();
    let encoder = Encoder::with_info(&mut file, info).unwrap();
    let mut writer = encoder.write_header().unwrap();
    let length = bytes.len() as u16;
    let mut stream = vec![0x78, 0x01, 1];
    stream.extend(length.to_le_bytes());
    stream.extend((!length).to_le_bytes());
    stream.extend(bytes);
    let (mut a, mut b) = (1_u32, 0_u32);
    for &byte in bytes {
        a = (a + u32::from(byte)) % 65521;
        b = (b + a) % 65521;
    }
    stream.extend(((b << 16) | a).to_be_bytes());
    writer.write_chunk(png::chunk::IDAT, &stream).unwrap();
    writer.finish().unwrap();
    file
}

#[test]
fn interlaced_pictures_are_the_same() {
    /// Source: PNG, third edition, 8.2 "Interlace methods": the pass of each pixel of a block.
    const PASSES: [[u8; 8]; 8] = [
        [1, 6, 4, 6, 2, 6, 4, 6],
        [7, 7, 7, 7, 7, 7, 7, 7],
        [5, 6, 5, 6, 5, 6, 5, 6],
        [7, 7, 7, 7, 7, 7, 7, 7],
        [3, 6, 4, 6, 3, 6, 4, 6],
        [7, 7, 7, 7, 7, 7, 7, 7],
        [5, 6, 5, 6, 5, 6, 5, 6],
        [7, 7, 7, 7, 7, 7, 7, 7],
    ];
    for (width, height) in [(1, 1), (2, 3), (5, 1), (8, 8), (13, 21), (17, 9)] {
        let code = |col: u32, row: u32| (7 * col + 31 * row) as u8;
        let mut bytes = Vec::new();
        for pass in 1..=7 {
            for row in 0..height {
                let in_pass = |col: &u32| PASSES[row as usize % 8][*col as usize % 8] == pass;
                let codes: Vec<u8> = (0..width)
                    .filter(in_pass)
                    .map(|col| code(col, row))
                    .collect();
                if !codes.is_empty() {
                    bytes.push(0);
                    bytes.extend(codes);
                }
            }
        }
        let file = stored(width, height, &bytes);
        let picture = whole(&file).unwrap();
        for (col, row) in (Size { width, height }).places() {
            let expected = srgb::decode(f64::from(code(col, row)) / 255.0);
            let found = picture.rgba[row as usize][col as usize][0];
            assert_eq!(found, expected, "{width} x {height}, {col}, {row}");
        }
        for length in 0..file.len() - 16 {
            assert!(whole(&file[..length]).is_err(), "{length}");
        }
    }
}

#[test]
fn rounding_is_half_a_step() {
    let (_, picture) = decoded(ColorType::Rgba, BitDepth::Eight, 1, &[188, 0, 255, 255]);
    let [red, green, _, alpha] = picture.rounding[0][0];
    let light = |code: f64| srgb::decode(code / 255.0);
    assert!((red - (light(188.5) - light(188.0))).abs() < 1e-15);
    assert_eq!((green, alpha), (light(0.5), 0.5 / 255.0));
}

#[test]
fn truncated_files_are_refused() {
    let samples: Vec<u8> = (0..200).collect();
    let bytes = encoded(ColorType::Grayscale, BitDepth::Eight, 200, &samples, |_| {});
    // The pixels are whole before the empty chunk at the end, of 12 bytes, and the checksum of
    // their own.
    for length in 0..bytes.len() - 16 {
        assert!(whole(&bytes[..length]).is_err(), "{length}");
    }
}

/// Half a step of the format, and the rounding of doubles.
#[test]
fn what_render_writes_comes_back() {
    for scene in [Scene::Grey, Scene::Color] {
        for (alpha, deep, rgb, linear, gain) in [
            (false, false, false, false, 1.0),
            (false, true, true, false, 1.0),
            (true, false, true, false, 0.5),
            (true, true, false, false, 1.0),
            (false, false, false, true, 1.0),
            (true, true, true, true, 0.25),
            (false, false, false, false, 2.0),
        ] {
            let image = render(scene, alpha);
            let options = PngOptions {
                deep,
                rgb,
                linear,
                gain,
            };
            let bytes = png_bytes(&image, options);
            let picture = decode(&bytes).unwrap();
            assert_eq!(picture.alpha, alpha);
            let kind = match (deep || linear, linear) {
                (true, true) => "PNG, 16 bit linear, ",
                (true, false) => "PNG, 16 bit sRGB, ",
                (false, _) => "PNG, 8 bit sRGB, ",
            };
            assert!(picture.description.starts_with(kind));
            let picture = picture.whole().unwrap();
            for (col, row) in size(&image).places() {
                let place = (row as usize, col as usize);
                let [red, green, blue, coverage] = image.rgba(col, row);
                let expected = [gain * red, gain * green, gain * blue, coverage];
                let found = picture.rgba[place.0][place.1];
                let rounding = picture.rounding[place.0][place.1];
                for channel in 0..4 {
                    let full = found[3];
                    if found[channel] == full && expected[channel] > full {
                        continue; // above the white of a PNG
                    }
                    let error = (expected[channel] - found[channel]).abs();
                    assert!(
                        error <= rounding[channel] + 1e-15,
                        "channel {channel} of column {col}, row {row}: {error:e}"
                    );
                }
            }
        }
    }
}
