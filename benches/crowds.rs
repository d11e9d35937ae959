//! Measures crowds: a million spheres of about two pixels, with and without shadows, by tolerances and by samples, and a
//! still, for which the world is prepared anew.

use std::num::NonZeroU32;

use marbles_benches::{
    Case, largest_difference, load, main as run, mean, million, render, square_view, table,
};
use marbles_core::{Method, Renderer, View, World};

const SIDE: u32 = 600;
/// The finest last.
const TOLERANCES: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-4];
/// Samples on a side of a pixel.
const SAMPLES: [u32; 2] = [1, 4];
const OF_STILL: f64 = 1e-2;

fn main() {
    run(|| {
        let view = square_view(&load("tests/truth/pixels/cloud1k"), SIDE);
        let mut world = million();
        let dark = measure("a million with shadows", &world, &view);
        world.shadows = false;
        let bright = measure("a million without shadows", &world, &view);
        assert!(0.01 < dark && dark < bright && bright < 0.9);
        // The degenerate case: no crowd at all.
        assert_eq!(measure("nothing", &World::new(), &view), 0.0);
    });
}

/// Measures a world; returns the mean of its finest picture.
fn measure(name: &str, world: &World, view: &View) -> f64 {
    let renderer = &Renderer::new(world);
    let by_samples = SAMPLES.map(|side| {
        let samples = NonZeroU32::new(side).expect("at least one sample");
        (format!("{side} x {side} samples"), Method::Samples(samples))
    });
    let by_tolerance = TOLERANCES.map(|tolerance| {
        let name = format!("to {tolerance:e}");
        (name, Method::Tolerance(tolerance))
    });
    let millions = f64::from(SIDE * SIDE) * 1e-6;
    let methods = by_samples.into_iter().chain(by_tolerance);
    let mut cases: Vec<Case<'_, _>> = methods
        .map(|(name, method)| Case {
            name,
            millions,
            run: Box::new(move |spent| render(renderer, view, method, spent)),
        })
        .collect();
    cases.push(Case {
        name: format!("a still to {OF_STILL:e}"),
        millions,
        run: Box::new(|spent| {
            let method = Method::Tolerance(OF_STILL);
            render(&Renderer::new(world), view, method, spent)
        }),
    });
    let images = table(name, "pixels", 1, &cases);
    let (still, images) = images.split_last().expect("a still");
    let finest = images.last().expect("tolerances");
    for (image, tolerance) in images[SAMPLES.len()..].iter().zip(TOLERANCES) {
        assert_eq!(image.summary().over_tolerance, 0, "{name} at {tolerance:e}");
        assert!(largest_difference(image, finest) <= tolerance + TOLERANCES[3]);
    }
    assert!(largest_difference(still, finest) <= OF_STILL + TOLERANCES[3]);
    for image in images {
        assert!((mean(image) - mean(finest)).abs() < 1e-3);
    }
    mean(finest)
}
