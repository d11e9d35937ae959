use std::io::Cursor;

use marbles_core::{Channels, Image};
use png::{BitDepth, Decoder};

use super::*;
use crate::formats::encoding::PngOptions;
use crate::formats::tests::{Scene, png_bytes, render, size};
use crate::tests::temporary;

const ALL: [PngOptions; 4] = [
    PngOptions {
        deep: false,
        rgb: false,
    },
    PngOptions {
        deep: true,
        rgb: false,
    },
    PngOptions {
        deep: false,
        rgb: true,
    },
    PngOptions {
        deep: true,
        rgb: true,
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
    let shape = Shape::of_codes(SIDES, ColorType::Rgb);
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
