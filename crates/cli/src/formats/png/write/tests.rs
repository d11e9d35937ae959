use std::io::Cursor;

use marbles_core::{Channels, Image};
use png::{BitDepth, Decoder};

use super::*;
use crate::formats::encoding::Encoding;
use crate::formats::encoding::PngOptions;
use crate::formats::tests::{PNG, Scene, encode, facts, png_bytes, render, size};
use crate::tests::temporary;

const ALL: [PngOptions; 4] = [
    PNG,
    PngOptions { deep: true, ..PNG },
    PngOptions { rgb: true, ..PNG },
    PngOptions {
        deep: true,
        rgb: true,
        ..PNG
    },
];

#[test]
fn pictures_come_back() {
    for scene in [Scene::Grey, Scene::Color] {
        for alpha in [false, true] {
            let image = render(scene, alpha);
            for options in ALL {
                check(&image, options);
            }
        }
    }
}

fn check(image: &Image, options: PngOptions) {
    let decoder = Decoder::new(Cursor::new(png_bytes(image, options)));
    let mut reader = decoder.read_info().unwrap();
    let info = reader.info();
    assert_eq!((info.width, info.height), (image.width(), image.height()));
    assert_eq!(info.srgb, Some(SrgbRenderingIntent::Perceptual));
    assert_eq!(info.uncompressed_latin1_text[0].keyword, "Software");
    let depth = if options.deep {
        BitDepth::Sixteen
    } else {
        BitDepth::Eight
    };
    assert_eq!(info.bit_depth, depth);
    let grey = image.channels() == Channels::Grey && !options.rgb;
    let color_type = match (grey, image.has_alpha()) {
        (true, false) => ColorType::Grayscale,
        (true, true) => ColorType::GrayscaleAlpha,
        (false, false) => ColorType::Rgb,
        (false, true) => ColorType::Rgba,
    };
    assert_eq!(info.color_type, color_type);

    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    let codes: Vec<f64> = if options.deep {
        let pairs = bytes.as_chunks::<2>().0.iter();
        pairs
            .map(|&pair| f64::from(u16::from_be_bytes(pair)) / 65535.0)
            .collect()
    } else {
        bytes.iter().map(|&byte| f64::from(byte) / 255.0).collect()
    };
    let half_code = 0.5 / if options.deep { 65535.0 } else { 255.0 };
    let stride = color_type.samples();
    let mut pixels = codes.chunks_exact(stride);
    for row in 0..image.height() {
        for col in 0..image.width() {
            let codes = pixels.next().unwrap();
            let [red, green, blue, alpha] = image.rgba(col, row);
            let colors = if grey {
                vec![red]
            } else {
                vec![red, green, blue]
            };
            for (&code, light) in codes.iter().zip(colors) {
                let light = if alpha > 0.0 {
                    (light / alpha).min(1.0)
                } else {
                    0.0
                };
                // The curve, once more.
                let expected = if light <= 0.003_130_8 {
                    12.92 * light
                } else {
                    1.055 * light.powf(1.0 / 2.4) - 0.055
                };
                assert!((code - expected).abs() <= half_code + 1e-12);
            }
            if image.has_alpha() {
                assert!((codes[stride - 1] - alpha).abs() <= half_code + 1e-12);
            }
        }
    }
    assert!(pixels.next().is_none());
}

/// The pixels with light above `most`, multiplied by `gain`, and not premultiplied.
fn brighter(image: &Image, gain: f64, most: f64) -> u64 {
    let is_brighter = |&(col, row): &(u32, u32)| {
        let [colors @ .., alpha] = image.rgba(col, row);
        alpha > 0.0 && colors.iter().any(|color| gain * color / alpha > most)
    };
    size(image).places().filter(is_brighter).count() as u64
}

#[test]
fn pixels_brighter_than_white_are_counted() {
    // Half a code of 8 bit above white, where the slope of the curve is 0.4396.
    const SRGB_8: f64 = 1.0 + 0.5 / 255.0 / 0.4396;
    const SLACK: f64 = 1e-4;
    for scene in [Scene::Grey, Scene::Color, Scene::Bright] {
        for alpha in [false, true] {
            let image = render(scene, alpha);
            for options in ALL {
                for (gain, linear) in [(1.0, false), (0.4, false), (1.5, false), (1.1, true)] {
                    let options = PngOptions {
                        gain,
                        linear,
                        ..options
                    };
                    let (_, clipped) = encode(&image, Encoding::Png(options), &facts());
                    let most = if options.deep || linear { 1.0 } else { SRGB_8 };
                    let least = brighter(&image, gain, most + SLACK);
                    let most = brighter(&image, gain, most - SLACK);
                    assert!((least..=most).contains(&clipped), "{scene:?} {options:?}");
                }
            }
        }
    }
    let bright = render(Scene::Bright, false);
    assert!(brighter(&bright, 1.0, 1.0) > 50);
    let grey = render(Scene::Grey, false);
    assert_eq!(encode(&grey, Encoding::Png(PNG), &facts()).1, 0);
}

#[test]
fn linear_files_say_that_they_are() {
    let options = PngOptions {
        linear: true,
        ..PNG
    };
    let bytes = png_bytes(&render(Scene::Color, false), options);
    let reader = Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    let info = reader.info();
    assert_eq!(info.bit_depth, BitDepth::Sixteen);
    assert_eq!(info.srgb, None);
    assert_eq!(info.gama_chunk.unwrap().into_scaled(), 100_000);
    // Rec. 709, in units of 1 / 100,000.
    let SourceChromaticities {
        white,
        red,
        green,
        blue,
    } = info.chrm_chunk.unwrap();
    let scaled = [white, red, green, blue].map(|(x, y)| (x.into_scaled(), y.into_scaled()));
    let expected = [
        (31_270, 32_900),
        (64_000, 33_000),
        (30_000, 60_000),
        (15_000, 6_000),
    ];
    assert_eq!(scaled, expected);
    assert!(Shape::of_file(info).is_linear);
}

#[test]
fn partly_covered_pixels_keep_their_light() {
    let image = render(Scene::Grey, true);
    let edge = size(&image).places().any(|(col, row)| {
        let [light, .., alpha] = image.rgba(col, row);
        alpha > 0.0 && alpha < 1.0 && light > 0.0
    });
    assert!(edge, "the scene should test something");
}

#[test]
fn noise_does_not_grow() {
    const SIDES: Size = Size {
        width: 700,
        height: 300,
    };
    let mut state = 1_u32;
    let mut noise = || {
        // Numerical Recipes' generator, whose high bits are good.
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    let samples: Vec<u8> = (0..SIDES.pixels() * 3).map(|_| noise()).collect();
    let shape = Shape::of_codes(SIDES, ColorType::Rgb, BitDepth::Eight);
    let path = temporary("noise.png");
    let codes = |stream: &mut dyn Write| Ok(stream.write_all(&samples)?);
    save(&path, |file| write(file, shape, &[], codes)).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    assert!(bytes.len() as u64 <= shape.file_bytes());
    let mut reader = Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    let mut decoded = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut decoded).unwrap();
    reader.finish().unwrap();
    assert!(decoded == samples);
    // In a hurry it would have grown.
    let mut hurried = Cursor::new(Vec::new());
    assert!(compress(&mut hurried, shape, &[], codes).unwrap());
}
