use std::io::Cursor;
use std::path::Path;

use image::codecs::gif::GifEncoder;
use image::codecs::webp::WebPEncoder;
use image::{
    Delay, ExtendedColorType, Frame, ImageBuffer, ImageEncoder, Rgba, RgbaImage,
    codecs::{
        bmp::BmpEncoder, hdr::HdrEncoder, jpeg::JpegEncoder, pnm::PnmEncoder, qoi::QoiEncoder,
        tga::TgaEncoder,
    },
};

use super::*;
use crate::formats::load;
use crate::formats::picture::tests::exif_of_orientation;
use marbles_core::srgb;

const SIZE: (u32, u32) = (5, 3);
const ALL: [Other; 8] = [
    Other::Jpeg,
    Other::Gif,
    Other::Webp,
    Other::Radiance,
    Other::Pnm,
    Other::Tga,
    Other::Bmp,
    Other::Qoi,
];

/// The codes of a small picture.
fn codes() -> Vec<u8> {
    let pixels = SIZE.0 * SIZE.1;
    let color = |pixel: u32| [16 * pixel as u8, 255 - 9 * pixel as u8, 40];
    (0..pixels).flat_map(color).collect()
}

/// The picture as other programs write it.
fn written(format: Other) -> Vec<u8> {
    let mut bytes = Vec::new();
    let ((width, height), codes) = (SIZE, codes());
    let rgb = ExtendedColorType::Rgb8;
    match format {
        Other::Jpeg => {
            JpegEncoder::new_with_quality(&mut bytes, 100).write_image(&codes, width, height, rgb)
        }
        Other::Gif => {
            let rgba: Vec<u8> = codes
                .chunks(3)
                .flat_map(|pixel| [pixel, &[255]].concat())
                .collect();
            GifEncoder::new(&mut bytes).encode(&rgba, width, height, ExtendedColorType::Rgba8)
        }
        Other::Webp => {
            WebPEncoder::new_lossless(&mut bytes).write_image(&codes, width, height, rgb)
        }
        Other::Radiance => {
            let light = codes
                .chunks_exact(3)
                .map(|pixel| image::Rgb([0, 1, 2].map(|channel| f32::from(pixel[channel]) / 64.0)));
            let light: Vec<image::Rgb<f32>> = light.collect();
            HdrEncoder::new(&mut bytes).encode(&light, width as usize, height as usize)
        }
        Other::Pnm => PnmEncoder::new(&mut bytes).write_image(&codes, width, height, rgb),
        Other::Tga => TgaEncoder::new(&mut bytes).write_image(&codes, width, height, rgb),
        Other::Bmp => BmpEncoder::new(&mut bytes).write_image(&codes, width, height, rgb),
        Other::Qoi => QoiEncoder::new(&mut bytes).write_image(&codes, width, height, rgb),
    }
    .unwrap();
    bytes
}

fn name(format: Other) -> &'static str {
    match format {
        Other::Tga => "picture.TGA",
        _ => "picture",
    }
}

fn decode(format: Other, bytes: &[u8]) -> Result<Picture, String> {
    load::decode_named(bytes, name(format))
}

#[test]
fn pictures_of_other_programs_are_read() {
    for format in ALL {
        let picture = decode(format, &written(format)).unwrap();
        assert_eq!(picture.format, format.name());
        assert_eq!((picture.size.width, picture.size.height), SIZE);
        assert_eq!(picture.warnings, [""; 0]);
        let picture = picture.whole().unwrap();
        let found = picture.rgba.concat();
        let rounding = picture.rounding.concat();
        for ((found, rounding), codes) in found.iter().zip(rounding).zip(codes().chunks(3)) {
            for channel in 0..3 {
                let code = f64::from(codes[channel]);
                let (expected, allowed) = match format {
                    Other::Radiance => (code / 64.0, rounding[channel]),
                    // Its codes are not those of the picture; see below.
                    Other::Jpeg => (srgb::decode(code / 255.0), 0.1),
                    _ => (srgb::decode(code / 255.0), 0.0),
                };
                let error = (found[channel] - expected).abs();
                assert!(error <= allowed, "{format:?}: {found:?}, {codes:?}");
            }
            assert_eq!(found[3], 1.0);
        }
    }
}

#[test]
fn alpha_depth_and_curve_are_those_of_the_file() {
    let first = |bytes: &[u8], name: &str| {
        let picture = load::decode_named(bytes, name).unwrap();
        let description = picture.description.clone();
        (description, picture.whole().unwrap().rgba[0][0])
    };
    let mut qoi = Vec::new();
    let encoder = QoiEncoder::new(&mut qoi);
    encoder
        .write_image(&[255, 51, 0, 51], 1, 1, ExtendedColorType::Rgba8)
        .unwrap();
    let (description, rgba) = first(&qoi, "a.qoi");
    assert_eq!(description, "QOI, 8 bit sRGB, RGBA");
    assert_eq!(rgba, [0.2, 0.2 * srgb::decode(0.2), 0.0, 0.2]);
    qoi[13] = 1;
    let (description, rgba) = first(&qoi, "a.qoi");
    assert_eq!(description, "QOI, 8 bit linear, RGBA");
    assert_eq!(rgba, [0.2, 0.2 * 0.2, 0.0, 0.2]);

    let (description, rgba) = first(b"P5 1 1 65535\n\x12\x34", "a.pgm");
    assert_eq!(description, "PNM, 16 bit sRGB, gray");
    assert_eq!(rgba[0], srgb::decode(f64::from(0x1234) / 65535.0));
    let (description, rgba) = first(b"P1 2 1\n0 1\n", "a.pbm");
    assert_eq!(description, "PNM, 8 bit sRGB, gray");
    assert_eq!(rgba[0], 1.0);
    let pam =
        b"P7\nWIDTH 1\nHEIGHT 1\nDEPTH 2\nMAXVAL 255\nTUPLTYPE GRAYSCALE_ALPHA\nENDHDR\n\xff\x33";
    let (description, rgba) = first(pam, "a.pam");
    assert_eq!(description, "PNM, 8 bit sRGB, gray + alpha");
    assert_eq!(rgba, [0.2, 0.2, 0.2, 0.2]);
    // Its numbers range from 0 to 100.
    let (_, rgba) = first(b"P2 1 1 100\n50\n", "a.pgm");
    assert!((rgba[0] - srgb::decode(0.5)).abs() < 0.01, "{rgba:?}");

    let (_, rgba) = first(
        b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x40\x00\x83",
        "a.hdr",
    );
    assert_eq!(rgba, [4.0, 2.0, 0.0, 1.0]);
}

#[test]
fn of_animations_the_first_frame_is_read() {
    let frame = |code: u8| {
        let picture: RgbaImage = ImageBuffer::from_pixel(2, 1, Rgba([code, 0, 0, 255]));
        Frame::from_parts(picture, 0, 0, Delay::from_numer_denom_ms(100, 1))
    };
    let mut bytes = Vec::new();
    let mut encoder = GifEncoder::new(&mut bytes);
    encoder.encode_frames([frame(255), frame(0)]).unwrap();
    drop(encoder);
    let picture = load::decode_named(&bytes, "a.gif").unwrap();
    assert_eq!(picture.warnings, [ONE_FRAME]);
    assert_eq!(picture.whole().unwrap().rgba[0][0], [1.0, 0.0, 0.0, 1.0]);
}

#[test]
fn no_warning_hides_another() {
    let exif = exif_of_orientation(6);
    let (codes, profile) = ([1, 2, 3], vec![0; 200]);
    let mut jpeg = Vec::new();
    let mut encoder = JpegEncoder::new(&mut jpeg);
    encoder.set_icc_profile(profile.clone()).unwrap();
    encoder.set_exif_metadata(exif.clone()).unwrap();
    encoder
        .write_image(&codes, 1, 1, ExtendedColorType::Rgb8)
        .unwrap();
    let mut webp = Vec::new();
    let mut encoder = WebPEncoder::new_lossless(&mut webp);
    encoder.set_icc_profile(profile).unwrap();
    encoder.set_exif_metadata(exif).unwrap();
    encoder
        .write_image(&codes, 1, 1, ExtendedColorType::Rgb8)
        .unwrap();
    for (format, bytes) in [(Other::Jpeg, jpeg), (Other::Webp, webp)] {
        let warnings = decode(format, &bytes).unwrap().warnings;
        assert_eq!(warnings, [Curve::IGNORED_PROFILE, NOT_TURNED], "{format:?}");
    }
}

#[test]
fn of_several_pnm_pictures_the_first_is_read() {
    for (file, is_one) in [
        (&b"P5 1 1 255\n\xff"[..], true),
        (b"P5 1 1 255\n\xff\nP is a letter", true),
        (b"P5 1 1 255\n\xffP5 1 1 255\n\0", false),
        (
            b"P6 1 1 65535\n\xff\xff\xff\xff\xff\xffP5 1 1 255\n\0",
            false,
        ),
        (b"P2 1 1 255\n255\n\nP2 1 1 255\n0\n", false),
    ] {
        let picture = decode(Other::Pnm, file).unwrap();
        let expected: &[&str] = if is_one { &[] } else { &[ONE_PICTURE] };
        assert_eq!(picture.warnings, expected, "{}", file.escape_ascii());
        assert_eq!(picture.whole().unwrap().rgba[0][0], [1.0; 4]);
    }
}

/// The part of a file that a decoder needs. Only an end mark and metadata may follow the pixels.
#[test]
fn truncated_files_are_refused() {
    for format in ALL {
        let bytes = written(format);
        let enough = match format {
            Other::Jpeg => bytes.len(),
            Other::Gif => bytes.len() - 24,
            Other::Qoi => bytes.len() - 8,
            Other::Tga => bytes.len() - 26,
            _ => bytes.len() - 2,
        };
        for length in 0..enough {
            let read = decode(format, &bytes[..length]).and_then(Picture::whole);
            assert!(read.is_err(), "{format:?}: {length} of {}", bytes.len());
        }
    }
}

/// A JPEG as above, whose coded pixels contain restarts and stuffed bytes, and whose metadata contains a preview.
#[test]
fn jpegs_end_with_their_own_end() {
    let bytes = written(Other::Jpeg);
    let (start, rest) = bytes.split_at(2);
    let preview = [&b"\xff\xe1\0\x0a"[..], b"\xff\xd8\xff\xd9\xff\xff\xd9\0"].concat();
    let mut whole = [start, &preview, rest].concat();
    assert!(decode(Other::Jpeg, &whole).is_ok());
    assert_eq!(
        decode(Other::Jpeg, &whole[..whole.len() - 2])
            .err()
            .unwrap(),
        "not a usable JPEG: it ends early: expected the marker of its end (FF D9), found none"
    );
    whole.extend(b"the serial number of a camera");
    assert!(decode(Other::Jpeg, &whole).is_ok());
    let coded = b"\xff\xd8\xff\xda\0\x02\x12\xff\0\xff\xd3\x34\xff\xff\xd9";
    for length in 0..coded.len() {
        assert!(jpeg::check(&mut Cursor::new(&coded[..length])).is_err());
    }
    assert_eq!(jpeg::check(&mut Cursor::new(coded)), Ok(()));
}

#[test]
fn a_webp_has_the_length_that_it_states() {
    let mut bytes = written(Other::Webp);
    bytes.extend(b"more");
    assert!(decode(Other::Webp, &bytes).is_ok());
    let length = bytes.len() as u32;
    bytes[4..8].copy_from_slice(&length.to_le_bytes());
    assert_eq!(
        decode(Other::Webp, &bytes).err().unwrap(),
        format!(
            "not a usable WebP: it ends early: expected {} bytes, found {length}",
            length + 8
        )
    );
}

/// Files of a few bytes that claim the largest number of pixels of their format.
#[test]
fn huge_pictures_are_refused_before_there_is_room_for_them() {
    let mut bmp = written(Other::Bmp);
    bmp[18..22].copy_from_slice(&65_535_u32.to_le_bytes());
    bmp[22..26].copy_from_slice(&65_535_u32.to_le_bytes());
    let mut tga = written(Other::Tga);
    tga[12..16].fill(0xff);
    let mut qoi = written(Other::Qoi);
    // Its decoder accepts up to 400 million pixels.
    qoi[4..12].copy_from_slice(&[0, 0, 0x4e, 0x1f, 0, 0, 0x4e, 0x1f]);
    let mut gif = written(Other::Gif);
    gif[6..10].fill(0xff);
    let mut jpeg = written(Other::Jpeg);
    let frame = jpeg
        .windows(2)
        .position(|marker| marker == [0xff, 0xc0])
        .unwrap();
    jpeg[frame + 5..frame + 9].copy_from_slice(&[0xff, 0xdc, 0xff, 0xdc]);
    let mut webp = written(Other::Webp);
    // 14 bits of the width less 1, and of the height.
    webp[21..24].fill(0xff);
    webp[24] |= 0x0f;
    let pnm = b"P6 65535 65535 255\n".to_vec();
    let hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 65000 +X 65000\n".to_vec();
    let vast = b"P6 4294967295 4294967295 255\n".to_vec();
    for (format, bytes) in [
        (Other::Bmp, bmp),
        (Other::Tga, tga),
        (Other::Qoi, qoi),
        (Other::Gif, gif),
        (Other::Jpeg, jpeg),
        (Other::Webp, webp),
        (Other::Pnm, pnm),
        (Other::Radiance, hdr),
        (Other::Pnm, vast),
    ] {
        let refusal = decode(format, &bytes).err().unwrap();
        let start = format!("not a usable {}: ", format.name());
        assert!(refusal.starts_with(&start), "{refusal}");
        let is_about_size = ["expected ", "too large"]
            .iter()
            .any(|words| refusal.contains(words));
        assert!(is_about_size, "{refusal}");
    }
}

#[test]
fn lossy_data_of_another_size_is_refused_before_it_is_decoded() {
    // A picture of 1 × 1, whose data says 16383 × 16383.
    let mut bytes = b"RIFF\0\0\0\0WEBPVP8X\x0a\0\0\0\0\0\0\0\0\0\0\0\0\0VP8 ".to_vec();
    let data = b"\x10\0\0\x9d\x01\x2a\xff\x3f\xff\x3f\0\0\0\0";
    bytes.extend((data.len() as u32).to_le_bytes());
    bytes.extend(data);
    let length = bytes.len() as u32 - 8;
    bytes[4..8].copy_from_slice(&length.to_le_bytes());
    assert_eq!(
        decode(Other::Webp, &bytes).err().unwrap(),
        "not a usable WebP: its data has 16383 x 16383 pixels, but the picture has 1 x 1"
    );
}

#[test]
fn what_is_no_picture_is_refused_in_words() {
    for (bytes, name) in [
        (&b"BMW is a company"[..], "a.bmp"),
        (b"P5 is a post code\n", "a.pgm"),
        (b"GIF89a", "a.gif"),
        (b"RIFF\x10\0\0\0WEBPVP8 \x04\0\0\0\0\0\0\0", "a.webp"),
        (b"\xff\xd8\xff\xe0", "a.jpg"),
        (b"qoif", "a.qoi"),
        (b"#?RADIANCE\n", "a.hdr"),
        (b"a text", "a.tga"),
    ] {
        let refusal = load::decode_named(bytes, name).err().unwrap();
        assert!(refusal.starts_with("not a usable "), "{refusal}");
    }
    // The name does not change the format of a picture.
    let qoi = written(Other::Qoi);
    assert_eq!(load::decode_named(&qoi, "a.tga").unwrap().format, "QOI");
    assert!(Path::new("a.tga").extension().is_some());
}
