use png::Encoder;

use super::*;
use crate::formats::encoding::PngOptions;
use crate::formats::srgb;
use crate::formats::tests::{Scene, png_bytes, render, size};

fn decoded(color_type: ColorType, depth: BitDepth, width: u32, samples: &[u8]) -> Picture {
    decode(&encoded(color_type, depth, width, samples, |_| {})).unwrap()
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
    let picture = decoded(ColorType::Rgb, BitDepth::Eight, 2, &[0, 10, 255, 1, 2, 3]);
    assert_eq!(picture.description, "PNG, 8 bit sRGB, RGB");
    assert_eq!(picture.samples.rgba(0, 0), [0.0, light(10.0), 1.0, 1.0]);
    assert_eq!(
        picture.samples.rgba(1, 0),
        [light(1.0), light(2.0), light(3.0), 1.0]
    );

    let picture = decoded(ColorType::Grayscale, BitDepth::Sixteen, 1, &[0x12, 0x34]);
    assert_eq!(picture.description, "PNG, 16 bit sRGB, grey");
    let grey = srgb::decode(f64::from(0x1234) / 65535.0);
    assert_eq!(picture.samples.rgba(0, 0), [grey, grey, grey, 1.0]);
}

#[test]
fn light_is_premultiplied_by_alpha() {
    let picture = decoded(ColorType::Rgba, BitDepth::Eight, 1, &[255, 0, 188, 51]);
    let blue = 0.2 * srgb::decode(188.0 / 255.0);
    assert!(close(picture.samples.rgba(0, 0), [0.2, 0.0, blue, 0.2]));
    let picture = decoded(ColorType::GrayscaleAlpha, BitDepth::Eight, 1, &[255, 0]);
    assert_eq!(picture.samples.rgba(0, 0), [0.0; 4]);
}

#[test]
fn short_codes_and_palettes_are_expanded() {
    let picture = decoded(ColorType::Grayscale, BitDepth::Two, 4, &[0b0001_1011]);
    assert_eq!(picture.description, "PNG, 2 bit sRGB, grey");
    let greys = [0, 1, 2, 3].map(|col| picture.samples.rgba(col, 0)[0]);
    let expected = [0.0, 85.0, 170.0, 255.0].map(|code| srgb::decode(code / 255.0));
    assert_eq!(greys, expected);
    // Half the way from 0 to 1 of 3.
    assert_eq!(
        picture.samples.rounding(0, 0)[0],
        srgb::decode(42.5 / 255.0)
    );

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
    let picture = decode(&indexed).unwrap();
    assert_eq!(picture.description, "PNG, 8 bit sRGB, RGBA");
    assert_eq!(picture.samples.rgba(0, 0), [0.0; 4]);
    assert_eq!(picture.samples.rgba(1, 0), [1.0, 0.0, 0.0, 1.0]);
}

#[test]
fn the_curve_is_what_the_file_says() {
    let of = |gamma: u32| {
        let gamma = png::ScaledFloat::from_scaled(gamma);
        let tagged = |png: &mut Encoder<&mut Vec<u8>>| png.set_source_gamma(gamma);
        let bytes = encoded(ColorType::Grayscale, BitDepth::Eight, 1, &[51], tagged);
        decode(&bytes).unwrap().samples.rgba(0, 0)[0]
    };
    assert!((of(100_000) - 0.2).abs() < 1e-15);
    assert!((of(50_000) - 0.04).abs() < 1e-15);
    assert_eq!(of(45_455), srgb::decode(0.2));
    assert_eq!(of(0), srgb::decode(0.2));
}

#[test]
fn rounding_is_half_a_step() {
    let picture = decoded(ColorType::Rgba, BitDepth::Eight, 1, &[188, 0, 255, 255]);
    let [red, green, _, alpha] = picture.samples.rounding(0, 0);
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
        assert!(decode(&bytes[..length]).is_err(), "{length}");
    }
}

/// Half a step of the format, and what doubles lose in between.
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
            for (col, row) in size(&image).places() {
                let [red, green, blue, coverage] = image.rgba(col, row);
                let expected = [gain * red, gain * green, gain * blue, coverage];
                let found = picture.samples.rgba(col, row);
                let rounding = picture.samples.rounding(col, row);
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
