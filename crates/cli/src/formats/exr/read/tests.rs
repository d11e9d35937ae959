use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, ImageAttributes, IntegerBounds, Layer, LayerAttributes,
    SmallVec, Vec2, WritableImage,
};

use super::*;
use crate::formats::encoding::ExrOptions;
use crate::formats::exr::channels::Part;
use crate::formats::load;
use crate::formats::tests::{Scene, exr_bytes, render, size};

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

/// A picture of one line.
fn line(width: usize, channels: &[(&str, FlatSamples)]) -> Picture {
    let part = part((width, 1), LayerAttributes::default(), channels);
    decode(&file([part])).unwrap()
}

fn one(value: f32) -> FlatSamples {
    FlatSamples::F32(vec![value])
}

#[test]
fn rounding_is_half_a_step() {
    let halves = [1.0, 1.999, 0.0, 1e-6, 65504.0].map(f16::from_f32);
    let picture = line(5, &[("Y", FlatSamples::F16(halves.to_vec()))]);
    let steps = [0, 1, 2, 3, 4].map(|col| picture.samples.rounding(col, 0)[0]);
    let power = |exponent| libm::ldexp(1.0, exponent);
    assert_eq!(
        steps,
        [power(-11), power(-11), power(-25), power(-25), 16.0]
    );
    let full = [0, 1, 2, 3, 4].map(|col| picture.samples.is_full(col, 0)[0]);
    assert_eq!(full, [false, false, false, false, true]);
    let float = line(1, &[("Y", one(1.0))]).samples.rounding(0, 0);
    assert_eq!(float, [power(-24), power(-24), power(-24), 0.0]);
}

#[test]
fn channels_of_all_types_are_read() {
    let picture = line(
        2,
        &[
            ("R", FlatSamples::F16(vec![f16::from_f32(0.5), f16::NAN])),
            ("G", FlatSamples::F32(vec![-2.0, f32::INFINITY])),
            ("B", FlatSamples::U32(vec![7, u32::MAX])),
            ("A", FlatSamples::F32(vec![0.25, 1.0])),
            ("Z", FlatSamples::F32(vec![9.0, 9.0])),
        ],
    );
    assert_eq!(picture.description, "EXR, float + half + uint, RGBA");
    assert_eq!(picture.samples.rgba(0, 0), [0.5, -2.0, 7.0, 0.25]);
    let [red, green, blue, alpha] = picture.samples.rgba(1, 0);
    assert!(red.is_nan());
    assert_eq!((green, blue, alpha), (f64::INFINITY, u32::MAX.into(), 1.0));
}

#[test]
fn layers_are_found() {
    let picture = line(
        1,
        &[
            ("depth.Z", one(9.0)),
            ("light.R", one(1.0)),
            ("light.G", one(2.0)),
            ("light.B", one(3.0)),
            ("mask.Y", one(4.0)),
        ],
    );
    assert_eq!(picture.description, "EXR, float, RGB of layer light");
    assert_eq!(picture.samples.rgba(0, 0), [1.0, 2.0, 3.0, 1.0]);

    let parts = [("depth", "Z", 9.0), ("grey", "Y", 2.0)].map(|(name, channel, value)| {
        let attributes = LayerAttributes::named(name);
        part((1, 1), attributes, &[(channel, one(value))])
    });
    let picture = decode(&file(parts)).unwrap();
    assert_eq!(picture.description, "EXR, float, Y of layer grey");
    assert_eq!(picture.samples.rgba(0, 0), [2.0, 2.0, 2.0, 1.0]);
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
    let row = |row| [0, 1, 2, 3].map(|col| picture.samples.rgba(col, row)[0]);
    assert_eq!((row(0), row(1)), ([0.0, 3.0, 4.0, 0.0], [0.0; 4]));
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
        let refusal = load::decode(&file).unwrap_err();
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
        assert!(decode(&file[..length]).is_err(), "{length}");
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
            for (col, row) in size(&image).places() {
                let (expected, found) = (image.rgba(col, row), picture.samples.rgba(col, row));
                let rounding = picture.samples.rounding(col, row);
                for channel in 0..4 {
                    let error = (expected[channel] - found[channel]).abs();
                    assert!(error <= rounding[channel], "{error:e} in {col}, {row}");
                }
            }
        }
    }
}
