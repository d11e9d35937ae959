use std::io::Cursor;
use std::num::NonZeroU32;

use exr::prelude::{
    AnyChannels, AttributeValue, FlatSamples, Image as ExrImage, Layer, ReadChannels, ReadLayers,
    Text, f16,
};
use glam::{DVec2, DVec3, DVec4};
use marbles_core::{Angle, Camera, Lens, Method, View};

use super::*;
use crate::formats::encoding::Encoding;
use crate::formats::exr::attributes::sort_attributes;
use crate::formats::exr::header::REC_709;
use crate::formats::facts::{Facts, SOFTWARE};
use crate::formats::tests::{DIGEST, Scene, encode, render, size, view};

const HALF: ExrOptions = ExrOptions {
    float: false,
    error: false,
};
const FLOAT: ExrOptions = ExrOptions {
    float: true,
    error: false,
};

fn facts() -> Facts {
    let [pan, tilt, roll] = [30.0, -10.0, 5.0].map(Angle::from_degrees);
    Facts {
        view: View {
            camera: Camera::free(DVec3::new(1.0, 2.0, 3.0), pan, tilt, roll),
            lens: Lens {
                width: 6.0,
                distance: 4.0,
                shift: DVec2::new(0.5, -1.0),
                pixel_aspect: 1.25,
            },
            zoom: 2.0,
            ..view()
        },
        frame: -7,
        frames_per_second: Some(23.976),
        method: Method::Samples(NonZeroU32::MIN),
        digest: DIGEST,
    }
}

/// The bytes of a file, and how many numbers were too large.
fn file(image: &Image, options: ExrOptions, facts: &Facts) -> (Vec<u8>, u64) {
    encode(image, Encoding::Exr(options), facts)
}

type Layers = ExrImage<Layer<AnyChannels<FlatSamples>>>;

fn read(bytes: &[u8]) -> Layers {
    exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .unwrap()
}

#[test]
fn pictures_come_back() {
    for scene in [Scene::Grey, Scene::Color] {
        for alpha in [false, true] {
            let image = render(scene, alpha);
            for options in [HALF, FLOAT] {
                let (bytes, clipped) = file(&image, options, &facts());
                assert_eq!(clipped, 0);
                let file = read(&bytes);
                compare(&image, &file.layer_data.channel_data, options.float);
            }
        }
    }
}

fn compare(image: &Image, channels: &AnyChannels<FlatSamples>, is_float: bool) {
    let names: Vec<String> = channels.list.iter().map(|c| c.name.to_string()).collect();
    let expected = if image.has_alpha() {
        "A,B,G,R"
    } else {
        "B,G,R"
    };
    assert_eq!(names.join(","), expected);
    for channel in &channels.list {
        let index = "RGBA".find(&channel.name.to_string()).unwrap();
        let expected = size(image)
            .places()
            .map(|(col, row)| image.rgba(col, row)[index]);
        match &channel.sample_data {
            FlatSamples::F16(samples) if !is_float => {
                assert!(samples.iter().copied().eq(expected.map(half::nearest)));
            }
            FlatSamples::F32(samples) if is_float => {
                assert!(samples.iter().copied().eq(expected.map(float)));
            }
            other => panic!("unexpected samples {other:?}"),
        }
    }
}

#[test]
fn errors_are_floats_that_stay_bounds() {
    let image = render(Scene::Color, true);
    for light in [HALF, FLOAT] {
        let options = ExrOptions {
            error: true,
            ..light
        };
        let file = read(&file(&image, options, &facts()).0);
        let channels = file.layer_data.channel_data.list;
        let names: Vec<String> = channels.iter().map(|c| c.name.to_string()).collect();
        assert_eq!(names, ["A", "B", "G", "R", "error.V"]);
        let FlatSamples::F32(stored) = &channels[4].sample_data else {
            panic!("expected floats");
        };
        let mut some = false;
        for (&stored, (col, row)) in stored.iter().zip(size(&image).places()) {
            let (stored, error) = (f64::from(stored), image.error(col, row));
            assert!(stored >= error && stored <= error * (1.0 + f64::from(f32::EPSILON)));
            some |= error > 0.0;
        }
        assert!(some);
    }
    assert_eq!(float_above(f64::INFINITY), f32::INFINITY);
    assert_eq!(float_above(0.1), 0.1);
    assert_eq!(float_above(0.7), 0.7_f32.next_up());
}

#[test]
fn the_header_tells_the_facts() {
    let image = render(Scene::Color, false);
    let from_facts = |facts: &Facts| read(&file(&image, HALF, facts).0);
    let file = from_facts(&facts());
    assert_eq!(file.attributes.chromaticities, Some(REC_709));
    let attributes = &file.layer_data.attributes;
    assert_eq!(attributes.frames_per_second, Some((24000, 1001)));
    assert_eq!(attributes.software_name, Some(Text::from(SOFTWARE)));
    let custom = |name: &str| attributes.other.get(&Text::from(name));
    assert_eq!(custom("samples"), Some(&AttributeValue::I32(1)));
    assert_eq!(custom("frame"), Some(&AttributeValue::I32(-7)));
    let colors = AttributeValue::Text("lin_rec709_scene".into());
    assert_eq!(custom("colorInteropID"), Some(&colors));
    let summary = image.summary();
    for (name, expected) in [
        ("error", summary.largest_error),
        ("bounded_pixels", summary.bounds as f64),
        ("over", summary.over_tolerance as f64),
    ] {
        assert_eq!(custom(name), Some(&AttributeValue::F64(expected)), "{name}");
    }
    assert_eq!(attributes.screen_window_center, Vec2(0.0625, -0.125));
    assert_eq!(attributes.screen_window_width, 0.75);
    assert_eq!(file.attributes.pixel_aspect, 1.25);
    let matrix = attributes.world_to_camera.unwrap().map(f64::from);
    let to_a_tolerance = Facts {
        method: Method::Tolerance(1e-3),
        ..facts()
    };
    let file = from_facts(&to_a_tolerance);
    let custom = &file.layer_data.attributes.other;
    let tolerance = custom.get(&Text::from("tolerance"));
    assert_eq!(tolerance, Some(&AttributeValue::F32(1e-3)));
    assert!(!custom.contains_key(&Text::from("samples")));

    let camera = facts().view.camera;
    let row_times_matrix = |p: DVec3| {
        let p = DVec4::from((p, 1.0)).to_array();
        [0, 1, 2].map(|col| {
            (0..4)
                .map(|row| p[row] * matrix[4 * row + col])
                .sum::<f64>()
        })
    };
    for in_camera in [
        DVec3::ZERO,
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        DVec3::new(-4.0, 5.0, 6.0),
    ] {
        let in_world = camera.position + camera.world_from_camera * in_camera;
        let mapped = DVec3::from(row_times_matrix(in_world));
        assert!(
            (mapped - in_camera).length() < 1e-5,
            "{mapped} for {in_camera}"
        );
    }
    assert_eq!(
        [3, 7, 11, 15].map(|index| matrix[index]),
        [0.0, 0.0, 0.0, 1.0]
    );
}

#[test]
fn attributes_are_sorted_and_bytes_repeat() {
    let image = render(Scene::Color, true);
    let (first, _) = file(&image, HALF, &facts());
    // Hash maps differ within a process as they do from run to run.
    for _ in 0..50 {
        assert!(file(&image, HALF, &facts()).0 == first);
    }
    let mut sorted = first.clone();
    sort_attributes(&mut sorted).unwrap();
    assert!(sorted == first);
}

#[test]
fn numbers_above_the_range_become_the_largest() {
    let image = render(Scene::Bright, false);
    let (bytes, clipped) = file(&image, HALF, &facts());
    let above = size(&image)
        .places()
        .filter(|&(col, row)| image.rgba(col, row)[0] > half::LARGEST);
    let above = above.count() as u64;
    assert!(above > 0);
    assert_eq!(clipped, 3 * above);
    for channel in read(&bytes).layer_data.channel_data.list {
        let FlatSamples::F16(samples) = channel.sample_data else {
            panic!("expected halves");
        };
        assert!(samples.contains(&f16::MAX));
        assert!(samples.iter().all(|sample| sample.is_finite()));
    }
    assert_eq!(file(&image, FLOAT, &facts()).1, 0);
}
