//! The time of testing one ray against one sphere.

use std::hint::black_box;
use std::time::Instant;

use glam::DVec3;
use marbles_core::{Ray, Sphere};

use crate::table::median;
use marbles_tests::hits::forms::{FORMS, marbles, original, perpendicular, stable};
use marbles_tests::hits::frames::Frame;

/// The number of measurements of every form, which take turns.
const ROUNDS: usize = 25;

/// The median time of a test of one ray against one sphere for each of [`FORMS`], in nanoseconds.
pub(crate) fn nanoseconds_a_test(frame: &Frame) -> [f64; FORMS.len()] {
    let mut times = FORMS.map(|_| Vec::new());
    for _ in 0..ROUNDS {
        // By name, so that each form is compiled into the loop of its own.
        times[0].push(one_round(frame, original));
        times[1].push(one_round(frame, stable));
        times[2].push(one_round(frame, perpendicular));
        times[3].push(one_round(frame, marbles));
    }
    times.map(|mut times| median(&mut times))
}

/// Finds the nearest sphere for each ray of the frame by testing all spheres.
fn one_round(frame: &Frame, form: impl Fn(&Sphere, &Ray) -> Option<(f64, DVec3)>) -> f64 {
    let start = Instant::now();
    let mut sum = 0.0;
    for ray in black_box(&frame.rays) {
        let mut nearest = (f64::MAX, DVec3::ZERO);
        for sphere in &frame.spheres {
            if let Some(hit) = form(sphere, ray)
                && hit.0 < nearest.0
            {
                nearest = hit;
            }
        }
        sum += nearest.1.element_sum() + nearest.0.min(1.0);
    }
    black_box(sum);
    let tests = frame.rays.len() * frame.spheres.len();
    start.elapsed().as_secs_f64() * 1e9 / tests as f64
}
