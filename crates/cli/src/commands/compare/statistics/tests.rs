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
    line_of(&["Y"], values)
}

/// One of floats of these channels, pixel by pixel.
fn line_of(channels: &[&str], values: &[f32]) -> Picture {
    let width = (values.len() / channels.len()) as u32;
    let path = temporary(&format!("{values:p}.exr"));
    let size = Size { width, height: 1 };
    write_floats(size, channels, &path, |row| {
        row.extend(values.iter().map(|&value| f64::from(value)));
        Ok(0..width)
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

/// The first row of two pictures.
fn first_row(a: Picture, b: Picture) -> Pair {
    let paths = ["a", "b"].map(PathBuf::from);
    let mut pair = Pair { a, b, paths };
    pair.advance().unwrap();
    pair
}

fn statistics(a: Picture, b: Picture, tolerance: f64) -> Statistics {
    let pair = first_row(a, b);
    let mut counter = Counter::new(&pair, Some(tolerance), 2);
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
fn pixels_of_a_run_are_alike_and_others_do_not_differ() {
    let rows: [&[u8]; 5] = [
        &[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
        &[0, 0, 9, 9, 9, 0, 0, 0, 9, 9, 0, 0],
        &[7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7],
        &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12],
        &[0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 2],
    ];
    let floats = |row: &[u8]| {
        let light = row.iter().map(|&code| match code {
            7 => f32::NAN,
            code => f32::from(code),
        });
        light.collect::<Vec<f32>>()
    };
    type Read = fn(&[u8]) -> Picture;
    let kinds: [Read; 4] = [
        |row| png(ColorType::Grayscale, row),
        |row| png(ColorType::GrayscaleAlpha, row),
        |row| png(ColorType::Rgb, row),
        |row| png(ColorType::Rgba, row),
    ];
    let mut pairs = Vec::new();
    for a in rows {
        for b in rows {
            pairs.extend(kinds.map(|read| first_row(read(a), read(b))));
            pairs.push(first_row(line(&floats(a)), line(&floats(b))));
            pairs.push(first_row(line(&floats(a)), kinds[0](b)));
            let [one, other] = [a, b].map(|row| line_of(&["R", "G", "B"], &floats(row)));
            pairs.push(first_row(one, other));
            let covered = line_of(&["A", "Y"], &floats(a));
            pairs.push(first_row(covered, kinds[1](b)));
        }
    }
    for pair in pairs {
        let mut next = pair.columns().start;
        for run in pair.runs(pair.columns()) {
            assert_eq!(run.start, next);
            next = run.end;
            for col in run.clone() {
                for row in [&pair.a.row, &pair.b.row] {
                    let bits = |col| row.rgba(col).map(f64::to_bits);
                    assert_eq!(bits(col), bits(run.start));
                }
            }
        }
        assert_eq!(next, pair.columns().end);
        for col in 0..pair.size().width {
            assert!(pair.columns().contains(&col) || pair.differences(col) == [0.0; 4]);
        }
    }
}

#[test]
fn large_areas_are_looked_at_once() {
    let runs = |a: Picture, b: Picture| {
        let pair = first_row(a, b);
        let runs = pair.runs(pair.columns());
        runs.map(|run| (run.start, run.end)).collect::<Vec<_>>()
    };
    let [black, white] = [[0; 999], [255; 999]];
    let mut dot = black;
    dot[500] = 1;
    let grey = |row: &[u8]| png(ColorType::Grayscale, row);
    let color = |row: &[u8]| png(ColorType::Rgb, row);
    assert_eq!(runs(grey(&white), grey(&white)), []);
    assert_eq!(runs(grey(&black), grey(&white)), [(0, 999)]);
    assert_eq!(runs(grey(&black), grey(&dot)), [(500, 501)]);
    assert_eq!(
        runs(grey(&dot), grey(&white)),
        [(0, 500), (500, 501), (501, 999)]
    );
    assert_eq!(runs(color(&black), color(&white)), [(0, 333)]);
    let [black, ones] = [[0.0; 999], [1.0; 999]];
    let not_finite = [f32::NAN; 999];
    assert_eq!(runs(line(&black), line(&ones)), [(0, 999)]);
    assert_eq!(runs(line(&not_finite), line(&not_finite)), [(0, 999)]);
}

#[test]
fn every_pixel_of_a_run_counts() {
    let [black, white] = [[0; 40], [255; 40]].map(|row| png(ColorType::Grayscale, &row));
    let counted = statistics(black, white, 0.5);
    assert_eq!((counted.rms, counted.over_tolerance), (1.0, 40));
    assert_eq!((counted.beyond_rounding, counted.clipped), (40, 0));
    let columns = counted.worst.iter().map(|worst| worst.col);
    assert_eq!(columns.collect::<Vec<_>>(), [0, 1]);
    let [black, light] = [[0, 255], [0, 0]].map(|[first, second]| {
        let mut row = [first; 40];
        row[30..].fill(second);
        png(ColorType::Grayscale, &row)
    });
    let bright = [2.0; 40];
    assert_eq!(statistics(line(&bright), black, 0.5).clipped, 10);
    assert_eq!(statistics(line(&bright), light, 0.5).clipped, 0);
    let not_finite = [f32::NAN; 40];
    assert_eq!(
        statistics(line(&not_finite), line(&bright), 0.5).not_finite,
        40
    );
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
