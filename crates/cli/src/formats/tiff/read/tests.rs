use std::io::Cursor;

use tiff::encoder::compression::{CompressionAlgorithm, Lzw};
use tiff::encoder::{Compression, DeflateLevel, Predictor, Rational, TiffEncoder, colortype};
use tiff::tags::{CompressionMethod, ExtraSamples};

use super::*;
use crate::formats::picture::tests::Whole;
use crate::formats::tests::{Scene, render, size, tiff_bytes};
use marbles_core::srgb;

fn decode(bytes: &[u8]) -> Result<Picture, String> {
    begin(&Source::Memory(bytes.into()))
}

fn whole(bytes: &[u8]) -> Result<Whole, String> {
    decode(bytes)?.whole()
}

/// The light of all pixels of a row.
fn row(bytes: &[u8]) -> Vec<[f64; 4]> {
    whole(bytes).unwrap().rgba.remove(0)
}

/// A file of another program with one row.
fn written<C: colortype::ColorType>(
    width: u32,
    samples: &[C::Inner],
    compression: Compression,
    predictor: Predictor,
) -> Vec<u8>
where
    [C::Inner]: tiff::encoder::TiffValue,
{
    let mut file = Cursor::new(Vec::new());
    let encoder = TiffEncoder::new(&mut file).unwrap();
    let mut encoder = encoder
        .with_compression(compression)
        .with_predictor(predictor);
    encoder.write_image::<C>(width, 1, samples).unwrap();
    file.into_inner()
}

#[test]
fn what_render_writes_comes_back() {
    for scene in [Scene::Grey, Scene::Color] {
        for (alpha, float) in [(false, false), (true, false), (false, true), (true, true)] {
            let image = render(scene, alpha);
            let bytes = tiff_bytes(&image, float);
            let picture = decode(&bytes).unwrap();
            let kind = if float {
                "32 bit float"
            } else {
                "16 bit linear"
            };
            assert!(picture.description.starts_with(&format!("TIFF, {kind}, ")));
            assert_eq!(picture.warnings, [""; 0]);
            assert_eq!(picture.alpha, alpha);
            let picture = picture.whole().unwrap();
            for (col, row) in size(&image).places() {
                let place = (row as usize, col as usize);
                let (found, rounding) = (
                    picture.rgba[place.0][place.1],
                    picture.rounding[place.0][place.1],
                );
                for (channel, expected) in image.rgba(col, row).into_iter().enumerate() {
                    let expected = if float { expected } else { expected.min(1.0) };
                    let error = (expected - found[channel]).abs();
                    assert!(
                        error <= rounding[channel] + 1e-15,
                        "{channel}, {col}, {row}"
                    );
                    let half_a_step = if float { 6e-8 } else { 0.5 / 65535.0 };
                    assert!(rounding[channel] < 1.000001 * half_a_step * expected.max(1.0));
                }
            }
        }
    }
}

#[test]
fn numbers_of_others_become_light() {
    let deflate = Compression::Deflate(DeflateLevel::Fast);
    let light = |code: f64, most: f64| srgb::decode(code / most);
    let bytes =
        written::<colortype::RGB8>(2, &[0, 51, 255, 9, 8, 7], deflate, Predictor::Horizontal);
    assert_eq!(
        row(&bytes),
        [
            [0.0, light(51.0, 255.0), 1.0, 1.0],
            [light(9.0, 255.0), light(8.0, 255.0), light(7.0, 255.0), 1.0]
        ]
    );
    // The file declares four channels as colors: the last is alpha.
    let bytes = written::<colortype::RGBA8>(
        1,
        &[255, 0, 255, 51],
        Compression::Packbits,
        Predictor::None,
    );
    assert_eq!(row(&bytes), [[0.2, 0.0, 0.2, 0.2]]);
    let codes = [0, 1000, 65535];
    let bytes = written::<colortype::Gray16>(3, &codes, Compression::Lzw, Predictor::Horizontal);
    let greys = codes.map(|code| light(code.into(), 65535.0));
    assert_eq!(row(&bytes), greys.map(|grey| [grey, grey, grey, 1.0]));
    let warnings = decode(&bytes).unwrap().warnings;
    assert_eq!(warnings, [SRGB_ASSUMED]);
    let values = [0.25, -1.0, 7e9, f32::NAN, 0.0, f32::MAX];
    let bytes =
        written::<colortype::RGB32Float>(2, &values, Compression::Uncompressed, Predictor::None);
    let found = row(&bytes);
    assert_eq!(found[0], [0.25, -1.0, 7e9, 1.0]);
    assert!(found[1][0].is_nan());
    let picture = whole(&bytes).unwrap();
    assert_eq!(picture.is_full[0][1], [false, false, true, true]);
    assert_eq!(picture.rounding[0][0][2], 256.0);
    let bytes =
        written::<colortype::Gray64Float>(1, &[0.1], Compression::Uncompressed, Predictor::None);
    assert_eq!(row(&bytes), [[0.1, 0.1, 0.1, 1.0]]);
}

/// A file in tiles of 16 × 16 pixels, with 8-bit gray and alpha. The last tiles extend beyond the picture.
fn tiled(width: u32, height: u32, alpha: u16, value: impl Fn(u32, u32) -> [u8; 2]) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut file).unwrap();
    let mut directory = encoder.image_directory().unwrap();
    let (mut places, mut lengths) = (Vec::new(), Vec::new());
    for first_row in (0..height).step_by(16) {
        for first_col in (0..width).step_by(16) {
            let rows = first_row..first_row + 16;
            let pixels =
                rows.flat_map(|row| (first_col..first_col + 16).map(move |col| (col, row)));
            let bytes: Vec<u8> = pixels.flat_map(|(col, row)| value(col, row)).collect();
            let mut tile = Vec::new();
            Lzw.write_to(&mut tile, &bytes).unwrap();
            places.push(directory.write_data(&tile[..]).unwrap() as u32);
            lengths.push(tile.len() as u32);
        }
    }
    let mut tag = |tag: Tag, numbers: &[u16]| directory.write_tag(tag, numbers).unwrap();
    tag(Tag::BitsPerSample, &[8, 8]);
    tag(Tag::Compression, &[CompressionMethod::LZW.to_u16()]);
    tag(Tag::PhotometricInterpretation, &[1]);
    tag(Tag::SamplesPerPixel, &[2]);
    tag(Tag::ExtraSamples, &[alpha]);
    tag(Tag::TileWidth, &[16]);
    tag(Tag::TileLength, &[16]);
    directory.write_tag(Tag::ImageWidth, width).unwrap();
    directory.write_tag(Tag::ImageLength, height).unwrap();
    directory.write_tag(Tag::TileOffsets, &places[..]).unwrap();
    directory
        .write_tag(Tag::TileByteCounts, &lengths[..])
        .unwrap();
    directory
        .write_tag(Tag::XResolution, Rational { n: 1, d: 1 })
        .unwrap();
    directory.finish().unwrap();
    file.into_inner()
}

#[test]
fn tiles_are_put_together() {
    let value = |col: u32, row: u32| [(3 * col + 5 * row) as u8, 255 - row as u8];
    for (alpha, is_straight) in [(2, true), (0, false)] {
        let bytes = tiled(37, 18, alpha, value);
        let picture = decode(&bytes).unwrap();
        assert_eq!((picture.size.width, picture.size.height), (37, 18));
        // A channel without a meaning is ignored.
        assert_eq!(picture.alpha, is_straight);
        let picture = picture.whole().unwrap();
        for row in 0..18 {
            for col in 0..37 {
                let [grey, alpha] = value(col, row).map(f64::from);
                let alpha = if is_straight { alpha / 255.0 } else { 1.0 };
                let light = srgb::decode(grey / 255.0) * alpha;
                let found = picture.rgba[row as usize][col as usize];
                assert_eq!(found, [light, light, light, alpha], "{col}, {row}");
            }
        }
    }
}

#[test]
fn codes_that_were_multiplied_by_alpha_are_divided_by_it() {
    let bytes = tiled(1, 1, 1, |_, _| [51, 102]);
    let light = 0.4 * srgb::decode(0.5);
    let [grey, _, _, alpha] = row(&bytes)[0];
    assert!((grey - light).abs() < 1e-12 && (alpha - 0.4).abs() < 1e-12);
}

#[test]
fn more_pictures_and_requests_to_turn_are_warnings() {
    let warnings = |pictures: usize, orientation: u16| {
        let mut file = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut file).unwrap();
        for _ in 0..pictures {
            let mut image = encoder.new_image::<colortype::Gray8>(1, 1).unwrap();
            let directory = image.encoder();
            directory.write_tag(Tag::Orientation, orientation).unwrap();
            image.write_data(&[7]).unwrap();
        }
        decode(&file.into_inner()).unwrap().warnings
    };
    for orientation in [0, 1, 9] {
        assert_eq!(warnings(1, orientation), [""; 0]);
    }
    assert_eq!(warnings(2, 1), [ONE_PICTURE]);
    assert_eq!(warnings(1, 6), [NOT_TURNED]);
    assert_eq!(warnings(3, 2), [ONE_PICTURE, NOT_TURNED]);
}

/// A file with one row of three pixels that have more channels than RGB.
fn extended(extra: &[u16], compression: Compression, predictor: Predictor) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let encoder = TiffEncoder::new(&mut file).unwrap();
    let mut encoder = encoder
        .with_compression(compression)
        .with_predictor(predictor);
    let channels = 3 + extra.len();
    let mut image = encoder.new_image::<colortype::RGB8>(3, 1).unwrap();
    image.extra_samples(&extra_samples(extra)).unwrap();
    let samples: Vec<u8> = (0..3 * channels as u8).map(|it| 7 * it).collect();
    image.write_data(&samples).unwrap();
    file.into_inner()
}

/// The kinds of channels with these numbers.
fn extra_samples(numbers: &[u16]) -> Vec<ExtraSamples> {
    let kinds = numbers.iter().copied().map(ExtraSamples::from_u16);
    kinds.collect::<Option<_>>().unwrap()
}

#[test]
fn channels_without_a_meaning_are_left_out() {
    let plain = |extra: &[u16]| extended(extra, Compression::Uncompressed, Predictor::None);
    for (extra, has_alpha) in [
        (&[0][..], false),
        (&[0, 0], false),
        (&[2], true),
        (&[2, 0], true),
    ] {
        let channels = 3 + extra.len();
        for (col, found) in row(&plain(extra)).into_iter().enumerate() {
            let code = |channel: usize| (7 * (col * channels + channel)) as f64 / 255.0;
            let alpha = if has_alpha { code(3) } else { 1.0 };
            let [red, green, blue] = [0, 1, 2].map(|channel| srgb::decode(code(channel)) * alpha);
            assert_eq!(found, [red, green, blue, alpha], "{extra:?}, {col}");
        }
    }
    assert_eq!(
        decode(&plain(&[0, 2])).err().unwrap(),
        "its alpha follows another channel, expected alpha right after the colors"
    );
    let bytes = extended(&[0], Compression::Lzw, Predictor::Horizontal);
    assert_eq!(
        decode(&bytes).err().unwrap(),
        "it has the predictor 2 and 4 channels, but marbles knows the meaning of only 3"
    );
}

#[test]
fn what_programs_read_differently_is_refused() {
    for (compression, name) in [
        (Compression::Uncompressed, "None"),
        (Compression::Packbits, "PackBits"),
    ] {
        let bytes = written::<colortype::Gray8>(2, &[1, 2], compression, Predictor::Horizontal);
        assert_eq!(
            decode(&bytes).err().unwrap(),
            format!("it has the predictor 2 with the compression {name}, expected LZW or Deflate")
        );
    }
    let ordered = |order: u16| {
        let mut file = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut file).unwrap();
        let mut image = encoder.new_image::<colortype::Gray8>(1, 1).unwrap();
        image.encoder().write_tag(Tag::FillOrder, order).unwrap();
        image.write_data(&[1]).unwrap();
        file.into_inner()
    };
    assert!(decode(&ordered(1)).is_ok());
    assert_eq!(
        decode(&ordered(2)).err().unwrap(),
        "its bits are stored in the order 2 (FillOrder), expected 1"
    );
}

#[test]
fn truncated_files_are_refused() {
    for float in [false, true] {
        let bytes = tiff_bytes(&render(Scene::Color, true), float);
        for length in 0..bytes.len() {
            assert!(whole(&bytes[..length]).is_err(), "{length}");
        }
    }
}

/// A file with other numbers for a tag with one number.
fn altered(bytes: &[u8], tag: Tag, number: u32) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let directory = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize + 2;
    let mut entries = bytes[directory..].chunks_exact_mut(12);
    let entry = entries.find(|entry| entry[..2] == tag.to_u16().to_le_bytes());
    entry.unwrap()[8..12].copy_from_slice(&number.to_le_bytes());
    bytes
}

#[test]
fn numbers_that_cannot_be_are_refused() {
    let bytes = tiff_bytes(&render(Scene::Grey, false), false);
    let refusal = |tag, number| whole(&altered(&bytes, tag, number)).err().unwrap();
    let huge = refusal(Tag::ImageWidth, u32::MAX);
    assert!(
        huge.contains("expected each side from 1 to 65536"),
        "{huge}"
    );
    for (tag, number, expected) in [
        (Tag::ImageLength, 65_536, ""),
        (Tag::Compression, 7, "its compression is ModernJPEG"),
        (Tag::PhotometricInterpretation, 3, ""),
        (Tag::SampleFormat, 2, "its numbers are Int"),
        (Tag::BitsPerSample, 4, "its numbers have 4 bit"),
        (Tag::RowsPerStrip, 0, ""),
        (Tag::StripOffsets, u32::MAX, ""),
        (Tag::StripByteCounts, 1 << 20, ""),
    ] {
        let found = refusal(tag, number);
        assert!(found.starts_with(expected), "{tag:?}: {found}");
    }
}

/// Strips that share their bytes, and tables that would fill the memory.
#[test]
fn small_files_do_not_become_large() {
    let mut file = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut file).unwrap();
    let mut directory = encoder.image_directory().unwrap();
    let zeros = vec![0; 1 << 20];
    let mut strip = Vec::new();
    Lzw.write_to(&mut strip, &zeros).unwrap();
    let place = directory.write_data(&strip[..]).unwrap() as u32;
    const STRIPS: usize = 4096;
    directory.write_tag(Tag::ImageWidth, 65_536_u32).unwrap();
    directory.write_tag(Tag::ImageLength, 65_536_u32).unwrap();
    directory.write_tag(Tag::RowsPerStrip, 16_u32).unwrap();
    directory.write_tag(Tag::BitsPerSample, 8_u16).unwrap();
    directory
        .write_tag(Tag::Compression, CompressionMethod::LZW)
        .unwrap();
    directory
        .write_tag(Tag::PhotometricInterpretation, 1_u16)
        .unwrap();
    directory
        .write_tag(Tag::StripOffsets, &[place; STRIPS][..])
        .unwrap();
    directory
        .write_tag(Tag::StripByteCounts, &[strip.len() as u32; STRIPS][..])
        .unwrap();
    directory.finish().unwrap();
    let bytes = file.into_inner();
    assert_eq!(
        decode(&bytes).err().unwrap(),
        "its strips or tiles are longer than the file"
    );

    let mut bytes = tiff_bytes(&render(Scene::Grey, false), false);
    let directory = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize + 2;
    // The count of the first entry.
    bytes[directory + 4..directory + 8].copy_from_slice(&u32::MAX.to_le_bytes());
    assert_eq!(
        decode(&bytes).err().unwrap(),
        "it describes its picture with 4294967295 numbers, expected at most 262144"
    );
}
