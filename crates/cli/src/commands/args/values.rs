//! Values on the command line.

use std::num::NonZeroU32;

/// The most samples on a side of a pixel. More would take too long.
const MOST_SAMPLES: i64 = 1000;
/// The most threads. More would only slow each other down.
const MOST_THREADS: i64 = 1024;
/// The most pixels in a list. A picture of the differences shows more than a longer list.
const MOST_WORST: i64 = 100_000;
/// The most runs. More would not improve the median.
const MOST_RUNS: i64 = 1000;
/// The most frames per task. More would not save any work.
const LARGEST_CHUNK: i64 = 1_000_000;

/// A tolerance that a picture can meet.
pub(super) fn tolerance_above_zero(text: &str) -> Result<f64, String> {
    number(text, "a number greater than 0", |tolerance| tolerance > 0.0)
}

pub(super) fn samples(text: &str) -> Result<NonZeroU32, String> {
    positive_number(text, MOST_SAMPLES)
}

pub(super) fn threads(text: &str) -> Result<usize, String> {
    whole_number(text, 1, MOST_THREADS).map(|threads| threads as usize)
}

pub(super) fn bits(text: &str) -> Result<u8, String> {
    match text {
        "8" => Ok(8),
        "16" => Ok(16),
        _ => Err("expected 8 or 16".to_owned()),
    }
}

/// A number of stops. Each stop doubles the light.
pub(super) fn exposure(text: &str) -> Result<f64, String> {
    /// Beyond this, a picture is black or white.
    const MOST: f64 = 100.0;
    let expected = format!("a number from -{MOST} to {MOST}");
    number(text, &expected, |stops| stops.abs() <= MOST)
}

pub(super) fn tolerance(text: &str) -> Result<f64, String> {
    number(text, "a number from 0", |tolerance| tolerance >= 0.0)
}

pub(super) fn above_zero(text: &str) -> Result<f64, String> {
    number(text, "a number above 0", |number| number > 0.0)
}

pub(super) fn seconds(text: &str) -> Result<f64, String> {
    /// About eleven days.
    const MOST: f64 = 1e6;
    let expected = format!("a number of seconds from 0 to {MOST}");
    number(text, &expected, |seconds| (0.0..=MOST).contains(&seconds))
}

pub(super) fn runs(text: &str) -> Result<usize, String> {
    whole_number(text, 1, MOST_RUNS).map(|runs| runs as usize)
}

pub(super) fn chunk(text: &str) -> Result<NonZeroU32, String> {
    positive_number(text, LARGEST_CHUNK)
}

pub(super) fn worst(text: &str) -> Result<usize, String> {
    whole_number(text, 0, MOST_WORST).map(|worst| worst as usize)
}

fn positive_number(text: &str, most: i64) -> Result<NonZeroU32, String> {
    let number = whole_number(text, 1, most)?;
    Ok(NonZeroU32::new(number as u32).unwrap_or(NonZeroU32::MIN))
}

fn whole_number(text: &str, least: i64, most: i64) -> Result<i64, String> {
    text.parse()
        .ok()
        .filter(|number| (least..=most).contains(number))
        .ok_or_else(|| format!("expected a whole number from {least} to {most}"))
}

fn number(text: &str, expected: &str, is_right: impl Fn(f64) -> bool) -> Result<f64, String> {
    let number = text.parse().ok();
    let number = number.filter(|&number: &f64| number.is_finite() && is_right(number));
    number.ok_or_else(|| format!("expected {expected}"))
}
