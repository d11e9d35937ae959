use std::io::Cursor;

use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, ImageAttributes,
    IntegerBounds, Layer, LayerAttributes, LineOrder, SmallVec, Vec2, WritableImage,
};

use super::*;
use crate::formats::encoding::ExrOptions;
use crate::formats::load;
use crate::formats::picture::tests::Whole;
use crate::formats::tests::{Scene, exr_bytes, render, size};

/// A part of a file, with all its channels.
type Part = Layer<AnyChannels<FlatSamples>>;
type Parts = Image<exr::image::Layers<AnyChannels<FlatSamples>>>;

fn part(
    size: (usize, usize),
    attributes: LayerAttributes,
    channels: &[(&str, FlatSamples)],
) -> Part {
    let channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = channels
        .iter()
        .map(|(name, samples)| AnyChannel::new(*name, samples.clone()))
        .collect();
    Layer::new(
        size,
        attributes,
        Encoding::FAST_LOSSLESS,
        AnyChannels::sort(channels),
    )
}

/// The bytes of a file; the size of its picture is that of its first part.
fn file(parts: impl IntoIterator<Item = Part>) -> Vec<u8> {
    let parts: exr::image::Layers<_> = parts.into_iter().collect();
    let display = IntegerBounds::from_dimensions(parts[0].size);
    bytes(&Image::from_layers(ImageAttributes::new(display), parts))
}

fn bytes(file: &Parts) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    file.write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

fn decode(bytes: &[u8]) -> Result<Picture, String> {
    begin(&Source::Memory(bytes.into()))
}

/// The description and the pixels of a picture with one line.
fn line(width: usize, channels: &[(&str, FlatSamples)]) -> (String, Whole) {
    let part = part((width, 1), LayerAttributes::default(), channels);
    described(&file([part]))
}

fn described(bytes: &[u8]) -> (String, Whole) {
    let picture = decode(bytes).unwrap();
    (picture.description.clone(), picture.whole().unwrap())
}

fn one(value: f32) -> FlatSamples {
    FlatSamples::F32(vec![value])
}

#[test]
fn rounding_is_half_a_step() {
    let halves = [1.0, 1.999, 0.0, 1e-6, 65504.0].map(f16::from_f32);
    let (_, picture) = line(5, &[("Y", FlatSamples::F16(halves.to_vec()))]);
    let steps = [0, 1, 2, 3, 4].map(|col: usize| picture.rounding[0][col][0]);
    let power = |exponent| libm::ldexp(1.0, exponent);
    assert_eq!(
        steps,
        [power(-11), power(-11), power(-25), power(-25), 16.0]
    );
    let full = [0, 1, 2, 3, 4].map(|col: usize| picture.is_full[0][col][0]);
    assert_eq!(full, [false, false, false, false, true]);
    let float = line(1, &[("Y", one(1.0))]).1.rounding[0][0];
    assert_eq!(float, [power(-24), power(-24), power(-24), 0.0]);
}

#[test]
fn channels_of_all_types_are_read() {
    let (description, picture) = line(
        2,
        &[
            ("R", FlatSamples::F16(vec![f16::from_f32(0.5), f16::NAN])),
            ("G", FlatSamples::F32(vec![-2.0, f32::INFINITY])),
            ("B", FlatSamples::U32(vec![7, u32::MAX])),
            ("A", FlatSamples::F32(vec![0.25, 1.0])),
            ("Z", FlatSamples::F32(vec![9.0, 9.0])),
        ],
    );
    assert_eq!(description, "EXR, float + half + uint, RGBA");
    assert_eq!(picture.rgba[0][0], [0.5, -2.0, 7.0, 0.25]);
    let [red, green, blue, alpha] = picture.rgba[0][1];
    assert!(red.is_nan());
    assert_eq!((green, blue, alpha), (f64::INFINITY, u32::MAX.into(), 1.0));
}

#[test]
fn layers_are_found() {
    let (description, picture) = line(
        1,
        &[
            ("depth.Z", one(9.0)),
            ("light.R", one(1.0)),
            ("light.G", one(2.0)),
            ("light.B", one(3.0)),
            ("mask.Y", one(4.0)),
        ],
    );
    assert_eq!(description, "EXR, float, RGB of layer light");
    assert_eq!(picture.rgba[0][0], [1.0, 2.0, 3.0, 1.0]);

    let parts = [("depth", "Z", 9.0), ("grey", "Y", 2.0)].map(|(name, channel, value)| {
        let attributes = LayerAttributes::named(name);
        part((1, 1), attributes, &[(channel, one(value))])
    });
    let (description, picture) = described(&file(parts));
    assert_eq!(description, "EXR, float, Y of layer grey");
    assert_eq!(picture.rgba[0][0], [2.0, 2.0, 2.0, 1.0]);
}

/// marbles once stored errors as `error`, and those of a light as `KEY.error`.
#[test]
fn errors_are_found_under_their_old_names_too() {
    for (layer, error) in [
        ("", "error.V"),
        ("", "error"),
        ("key.", "key_error.V"),
        ("key.", "key.error"),
    ] {
        let [red, green, blue] = ["R", "G", "B"].map(|name| format!("{layer}{name}"));
        let mut description = "EXR, float, RGB and error".to_owned();
        if let Some(layer) = layer.strip_suffix('.') {
            description.push_str(&format!(" of layer {layer}"));
        }
        let channels = [(&*red, 1.0), (&green, 2.0), (&blue, 3.0), (error, 4.0)];
        let channels = channels.map(|(name, value)| (name, one(value)));
        let (found, picture) = line(1, &channels);
        assert_eq!(found, description);
        assert_eq!(picture.rgba[0][0], [1.0, 2.0, 3.0, 1.0]);
    }
}

#[test]
fn outside_the_data_window_there_is_nothing() {
    let numbers = FlatSamples::F32(vec![1.0, 2.0, 3.0, 4.0]);
    let attributes = LayerAttributes {
        layer_position: Vec2(11, 4),
        ..LayerAttributes::default()
    };
    let display = IntegerBounds::new((10, 5), (4, 2));
    let parts = [part((2, 2), attributes, &[("Y", numbers)])];
    let image = Image::from_layers(
        ImageAttributes::new(display),
        parts.into_iter().collect::<exr::image::Layers<_>>(),
    );
    let picture = decode(&bytes(&image)).unwrap();
    assert_eq!((picture.size.width, picture.size.height), (4, 2));
    let expected = "EXR, float, Y, data window 2 x 2 at column 1, row -1";
    assert_eq!(picture.description, expected);
    let picture = picture.whole().unwrap();
    let row = |row: usize| [0, 1, 2, 3].map(|col: usize| picture.rgba[row][col][0]);
    assert_eq!((row(0), row(1)), ([0.0, 3.0, 4.0, 0.0], [0.0; 4]));
}

/// Every way to store a picture is read as the same picture.
#[test]
fn the_order_of_blocks_does_not_matter() {
    let size = Vec2(37, 41);
    let numbers = |step: u16| {
        let numbers = (0..37 * 41).map(|number: u16| f32::from(number) * f32::from(step));
        FlatSamples::F32(numbers.collect())
    };
    let tiles = |levels: &[usize]| Blocks::Tiles(Vec2(levels[0], levels[1]));
    for compression in [
        Compression::Uncompressed,
        Compression::ZIP16,
        Compression::PIZ,
    ] {
        for (blocks, line_order) in [
            (Blocks::ScanLines, LineOrder::Increasing),
            (Blocks::ScanLines, LineOrder::Decreasing),
            (tiles(&[8, 16]), LineOrder::Increasing),
            (tiles(&[16, 8]), LineOrder::Decreasing),
            (tiles(&[64, 64]), LineOrder::Unspecified),
        ] {
            let encoding = Encoding {
                compression,
                blocks,
                line_order,
            };
            let channels = [("B", 3), ("G", 2), ("R", 1)];
            let channels = channels.map(|(name, step)| AnyChannel::new(name, numbers(step)));
            let channels = AnyChannels::sort(channels.into_iter().collect());
            let part = Layer::new(size, LayerAttributes::default(), encoding, channels);
            let (_, picture) = described(&file([part]));
            for row in 0..41 {
                for col in 0..37 {
                    let number = (row * 37 + col) as f64;
                    let expected = [number, 2.0 * number, 3.0 * number, 1.0];
                    assert_eq!(picture.rgba[row][col], expected, "{encoding:?} {col} {row}");
                }
            }
        }
    }
}

/// A header of some hundred bytes does not make the process allocate gigabytes.
#[test]
fn blocks_have_a_limit() {
    let channel = FlatSamples::F32(vec![0.0; 64 * 64]);
    let attributes = LayerAttributes::default();
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::Tiles(Vec2(64, 64)),
        line_order: LineOrder::Increasing,
    };
    let channels = AnyChannels::sort([AnyChannel::new("Y", channel)].into_iter().collect());
    let mut bytes = file([Layer::new((64, 64), attributes, encoding, channels)]);
    let place = |bytes: &[u8], name: &[u8]| {
        let mut windows = bytes.windows(name.len());
        windows.position(|window| window == name).unwrap() + name.len()
    };
    let tiles = place(&bytes, b"tiledesc\0") + 4;
    bytes[tiles..tiles + 8].copy_from_slice(&[0, 0, 1, 0, 0, 0, 1, 0]);
    let window = place(&bytes, b"dataWindow\0box2i\0") + 4;
    bytes[window + 8..window + 16].copy_from_slice(&[255, 255, 0, 0, 255, 255, 0, 0]);
    let refused = decode(&bytes).err().unwrap();
    assert_eq!(refused, "its blocks need more than 268 MB at a time");
}

#[test]
fn refuses_files_without_light() {
    for (channels, reason) in [
        (
            &[("Z", one(1.0))][..],
            "expected channels R, G, B or Y, found Z",
        ),
        (
            &[("BY", one(1.0)), ("RY", one(1.0)), ("Y", one(1.0))],
            "its colors are luminance and chroma, expected R, G, B or Y",
        ),
    ] {
        let file = file([part((1, 1), LayerAttributes::default(), channels)]);
        let refusal = load::decode(&file).err().unwrap();
        assert_eq!(refusal, format!("not a usable EXR: {reason}"));
    }
}

#[test]
fn truncated_files_are_refused() {
    let numbers = FlatSamples::F32((0..4096_u16).map(f32::from).collect());
    let file = file([part(
        (64, 64),
        LayerAttributes::default(),
        &[("Y", numbers)],
    )]);
    for length in 0..file.len() {
        let read = decode(&file[..length]).and_then(Picture::whole);
        assert!(read.is_err(), "{length}");
    }
}

#[test]
fn what_render_writes_comes_back() {
    for scene in [Scene::Grey, Scene::Color] {
        for (alpha, float) in [(false, false), (false, true), (true, false)] {
            let image = render(scene, alpha);
            let bytes = exr_bytes(&image, ExrOptions { float, error: true });
            let picture = decode(&bytes).unwrap();
            assert_eq!(picture.alpha, alpha);
            let picture = picture.whole().unwrap();
            for (col, row) in size(&image).places() {
                let place = (row as usize, col as usize);
                let found = picture.rgba[place.0][place.1];
                let (expected, rounding) =
                    (image.rgba(col, row), picture.rounding[place.0][place.1]);
                for channel in 0..4 {
                    let error = (expected[channel] - found[channel]).abs();
                    assert!(error <= rounding[channel], "{error:e} in {col}, {row}");
                }
            }
        }
    }
}
