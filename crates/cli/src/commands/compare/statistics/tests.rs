use std::path::PathBuf;

use png::{BitDepth, ColorType, Encoder, SrgbRenderingIntent};

use super::*;
use crate::base::size::Size;
use crate::formats::exr::write::write_floats;
use crate::formats::load;
use crate::formats::picture::Picture;
use crate::tests::temporary;

/// A picture of floats, one line high.
fn line(values: &[f32]) -> Picture {
    let width = values.len() as u32;
    let path = temporary(&format!("{values:p}.exr"));
    let size = Size { width, height: 1 };
    write_floats(size, &["Y"], &path, |row| {
        row.extend(values.iter().map(|&value| f64::from(value)));
        Ok(())
    })
    .unwrap();
    let bytes = std::fs::read(&path).unwrap();
    std::fs::remove_file(path).unwrap();
    load::decode(&bytes).unwrap()
}

fn png(color_type: ColorType, samples: &[u8]) -> Picture {
    let mut bytes = Vec::new();
    let width = (samples.len() / color_type.samples()) as u32;
    let mut encoder = Encoder::new(&mut bytes, width, 1);
    encoder.set_color(color_type);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(samples).unwrap();
    writer.finish().unwrap();
    load::decode(&bytes).unwrap()
}

fn statistics(a: Picture, b: Picture, tolerance: f64) -> Statistics {
    let paths = ["a", "b"].map(PathBuf::from);
    let mut pair = Pair { a, b, paths };
    let mut counter = Counter::new(&pair, Some(tolerance), 2);
    pair.advance().unwrap();
    counter.add_row(&pair);
    counter.finish()
}

#[test]
fn known_differences_are_told() {
    let b = line(&[0.0, 0.5, 1.0, 4.0]);
    let a = line(&[0.25, 0.5, 0.5, 2.0]);
    let statistics = statistics(a, b, 0.5);
    assert_eq!(statistics.rms, ((0.0625 + 0.25 + 4.0) / 4.0_f64).sqrt());
    assert_eq!(statistics.percentile, 2.0);
    // Exactly the tolerance is not over it.
    assert_eq!(statistics.over_tolerance, 1);
    assert_eq!((statistics.beyond_rounding, statistics.clipped), (3, 0));
    assert_eq!(statistics.not_finite, 0);
    let worst = |col, size, values| Difference {
        col,
        row: 0,
        channel: 0,
        size,
        values,
        rounding: values.map(|value| value * libm::ldexp(1.0, -24)),
    };
    let expected = [worst(3, 2.0, [2.0, 4.0]), worst(2, 0.5, [0.5, 1.0])];
    assert_eq!(statistics.worst, expected);
}

#[test]
fn equal_pictures_do_not_differ() {
    let statistics = statistics(line(&[0.0, -1.0, 3.0]), line(&[-0.0, -1.0, 3.0]), 0.0);
    assert_eq!((statistics.rms, statistics.percentile), (0.0, 0.0));
    assert_eq!(statistics.over_tolerance, 0);
    assert!(statistics.worst.is_empty());
}

/// The largest of some differences, given one by one.
fn largest(differences: &[f64], most: usize) -> Largest<u64> {
    let mut largest = Largest::new(most);
    for (&difference, index) in differences.iter().zip(0..) {
        largest.add(difference, index, || index);
    }
    largest
}

#[test]
fn the_percentile_is_by_nearest_rank() {
    for (count, expected) in [
        (1_u32, 1.0),
        (999, 999.0),
        (1000, 999.0),
        (1001, 1000.0),
        (2000, 1998.0),
    ] {
        let down: Vec<f64> = (1..=count).rev().map(f64::from).collect();
        let up: Vec<f64> = (1..=count).map(f64::from).collect();
        let most = above_percentile(u64::from(count));
        assert_eq!(largest(&down, most).least_of_most(), expected, "{count}");
        assert_eq!(largest(&up, most).least_of_most(), expected, "{count}");
    }
    // Pixels that do not differ are not taken.
    assert_eq!(largest(&[3.0], 2).least_of_most(), 0.0);
}

#[test]
fn the_worst_come_in_the_order_of_size_and_place() {
    let differences = [1.0, 0.0, 3.0, f64::INFINITY, 3.0, 0.5];
    let indices = |most| largest(&differences, most).into_values();
    assert_eq!(indices(3), [3, 2, 4]);
    assert_eq!(indices(2), [3, 2]);
    assert_eq!(indices(9), [3, 2, 4, 0, 5, 1]);
}

#[test]
fn what_is_not_finite_differs_even_from_itself() {
    let values = [0.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1.0];
    let statistics = statistics(line(&values), line(&values), 1e300);
    assert_eq!(statistics.not_finite, 3);
    assert_eq!(statistics.first_not_finite, Some((1, 0)));
    assert_eq!(statistics.over_tolerance, 3);
    assert_eq!(statistics.rms, f64::INFINITY);
    assert_eq!(statistics.worst[0].size, f64::INFINITY);
}

#[test]
fn grey_stands_for_three_equal_colors() {
    let grey = png(ColorType::Grayscale, &[0, 255]);
    let color = png(ColorType::Rgb, &[0, 0, 0, 255, 255, 0]);
    let statistics = statistics(grey, color, 0.5);
    assert_eq!(statistics.worst[0].size, 1.0);
    assert_eq!(statistics.rms, (1.0 / 6.0_f64).sqrt());
    assert_eq!(statistics.worst[0].channel, 2);
}

#[test]
fn missing_alpha_counts_as_full() {
    let opaque = png(ColorType::Grayscale, &[255, 255]);
    let covered = png(ColorType::GrayscaleAlpha, &[255, 255, 255, 51]);
    let statistics = statistics(covered, opaque, 0.5);
    assert_eq!(statistics.worst[0].size, 1.0 - 51.0 / 255.0);
    // Premultiplied light and alpha differ alike; the first of them is named.
    assert_eq!(statistics.worst[0].channel, 0);
}

#[test]
fn rounding_and_clipping_are_told_from_error() {
    // 188 and 189 lie on the two sides of 0.5; white is all there is above 1.
    let codes = png(ColorType::Grayscale, &[188, 189, 188, 255]);
    let light = line(&[0.5, 0.5, 0.6, 1.5]);
    let statistics = statistics(codes, light, 1.0);
    assert_eq!((statistics.beyond_rounding, statistics.clipped), (3, 1));
}
