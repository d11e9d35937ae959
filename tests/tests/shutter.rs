//! Pictures of cameras that move while the shutter is open, compared with many single moments.
//!
//! The moments come from the same scene with more frames, not from the shutter's own code.

use std::num::NonZeroU32;
use std::ops::ControlFlow;
use std::path::Path;

use marbles_core::{Exposure, Image, Method, Renderer, Settings, Status};
use marbles_scene::Scene;

use crate::studio::pixels;

/// The number of moments that are averaged.
const MOMENTS: i32 = 192;
/// The tolerance of each.
const FINE: f64 = 2e-5;
/// More than the error of averaging single moments.
const BETWEEN: f64 = 5e-5;
/// The time for which the shutter is open, in frames.
const SHUTTER: f64 = 0.5;
/// The number of frames that replace one frame.
const FRAMES: i32 = 4 * MOMENTS;

fn scene(text: &str) -> Scene {
    Scene::parse(text, Path::new("shutter.ron")).unwrap()
}

fn render<'a>(scene: &Scene, exposure: impl Into<Exposure<'a>>, method: Method) -> Image {
    let settings = Settings {
        method,
        alpha: true,
    };
    Renderer::new(scene.world())
        .render_with_progress(exposure, &settings, &|_| ControlFlow::Continue(()))
        .unwrap()
}

fn open(scene: &Scene, frame: i32, method: Method) -> Image {
    let view = scene.view(frame).unwrap();
    render(scene, scene.exposure(&view), method)
}

/// A function that makes a scene, from the number of frames that replace one frame, and the shutter.
type Animated = fn(i32, &str) -> String;

/// A turn of 30 degrees per frame around balls with shadows and highlights.
fn turntable(frames: i32, shutter: &str) -> String {
    format!(
        "(image: (width: 40, height: 30), lens: Fov(40),
        camera: Orbit(target: (0, 0, 0), radius: 6, azimuth: 10, elevation: 25),
        ambient: 0.05, background: 0.1,
        lights: [Directional(toward: (-1, 1, -1), intensity: (0.9, 0.8, 0.7))],
        materials: {{ \"shiny\": (albedo: (0.8, 0.3, 0.2), highlight: (strength: 0.4, shininess: 30)) }},
        spheres: [
            (center: (0, 0, 0), radius: 0.8, material: \"shiny\"),
            (center: (1.4, 0.2, 0.3), radius: 0.4),
            (center: (-0.9, 0.6, -0.9), radius: 0.3, material: \"shiny\"),
            (center: (0.1, -0.5, -1.6), radius: 0.1),
            (center: (0, -1001, 0), radius: 1000),
        ],
        animation: Turntable(frames: {}{shutter}))",
        12 * frames
    )
}

/// A pan across balls smaller than a pixel, which reverses at frame 2.
fn pan(frames: i32, shutter: &str) -> String {
    let mut spheres = String::new();
    for index in 0..60 {
        let (x, y) = (f64::from(index % 12) - 5.5, f64::from(index / 12) - 2.0);
        let (x, y) = (x + 0.13 * y, 1.1 * y + 0.07 * x);
        let radius = 0.03 + 0.004 * f64::from(index % 7);
        spheres += &format!("(center: ({x}, {y}, 20), radius: {radius}),");
    }
    format!(
        "(image: (width: 40, height: 30), lens: Fov(40),
        camera: Free(roll: 20),
        lights: [Directional(toward: (-1, 1, -1))],
        spheres: [{spheres} (center: (2, 0, 12), radius: 1.5)],
        animation: Keyframes(frames: (1, 3){shutter}, keys: [
            (frame: {}, pan: -8, zoom: 1, ease: Linear),
            (frame: {}, pan: 4, tilt: 1, zoom: 1.2, ease: Linear),
            (frame: {}, pan: -6, tilt: 0),
        ]))",
        frames,
        2 * frames,
        3 * frames
    )
}

/// A movement past rough balls, with a jump at frame 2.
fn ride(frames: i32, shutter: &str) -> String {
    format!(
        "(image: (width: 40, height: 30), lens: Fov(50),
        camera: LookAt(position: (0, 1, -6), target: (0, 0, 0)),
        lights: [Directional(toward: (-1, 1, -1), intensity: 0.6), Directional(toward: (1, 2, 0), intensity: 0.4)],
        materials: {{ \"rough\": (rough: (amplitude: 0.3, grain: Surface(0.6), seed: 1)) }},
        spheres: [
            (center: (-1, 0, 0), radius: 0.9, material: \"rough\"),
            (center: (1, 0.3, 0.5), radius: 0.7, material: \"rough\"),
            (center: (0.3, -0.5, -1.5), radius: 0.3),
        ],
        animation: Keyframes(frames: (1, 3){shutter}, keys: [
            (frame: {}, position: (-1, 1, -6), ease: Hold),
            (frame: {}, position: (1, 1.5, -5), target: (0, 0, 0), ease: Linear),
            (frame: {}, position: (3, 1, -7), target: (1, 0, 0)),
        ]))",
        frames,
        2 * frames,
        3 * frames
    )
}

/// A parallel lens that moves past balls, one of which is cut by its plane, under a point light between them and a
/// directional light.
fn pass(frames: i32, shutter: &str) -> String {
    format!(
        "(image: (width: 40, height: 30), lens: Parallel(width: 5),
        camera: Free(position: (0, 0, -6)),
        background: 0.05, ambient: 0.05,
        lights: [
            Point(position: (0.4, 0.3, -1.2), intensity: 0.4, reference: 1),
            Directional(toward: (-1, 1, -1), intensity: 0.4),
        ],
        materials: {{ \"shiny\": (albedo: (0.8, 0.3, 0.2), highlight: (strength: 0.3, shininess: 20)) }},
        spheres: [
            (center: (-1, 0, 0), radius: 0.9, material: \"shiny\"),
            (center: (1, 0.3, 0.5), radius: 0.7),
            (center: (0.3, -0.7, -1.5), radius: 0.3, material: \"shiny\"),
            (center: (0.9, 0.9, -5.9), radius: 0.4),
        ],
        animation: Keyframes(frames: (1, 3){shutter}, keys: [
            (frame: {}, position: (-1, 0, -6), ease: Linear),
            (frame: {}, position: (0.5, 0.2, -6), roll: 5, ease: Linear),
            (frame: {}, position: (2, 0, -6)),
        ]))",
        frames,
        2 * frames,
        3 * frames
    )
}

/// The mean of many moments, of red, green, blue and alpha.
fn mean(animated: Animated, frame: i32) -> Vec<[f64; 4]> {
    let many = scene(&animated(FRAMES, ""));
    let is_turntable = many.description().animation == Some("Turntable");
    let first = if is_turntable { 1 } else { 0 };
    let mut sum = vec![[0.0; 4]; 40 * 30];
    for moment in 0..MOMENTS {
        // Odd numbers, the middle between them.
        let frame = first + (frame - first) * FRAMES + 2 * moment + 1 - MOMENTS;
        let image = render(&many, &many.view(frame).unwrap(), Method::Tolerance(FINE));
        for (sum, (col, row)) in sum.iter_mut().zip(pixels(&image)) {
            for (sum, channel) in sum.iter_mut().zip(image.rgba(col, row)) {
                *sum += channel / f64::from(MOMENTS);
            }
        }
    }
    assert_eq!(f64::from(2 * MOMENTS), SHUTTER * f64::from(FRAMES));
    sum
}

fn meets_its_tolerance(animated: Animated) {
    let expected = mean(animated, 2);
    let scene = scene(&animated(1, &format!(", shutter: {SHUTTER}")));
    let still = render(&scene, &scene.view(2).unwrap(), Method::Tolerance(1e-3));
    for tolerance in [1e-2, 1e-3] {
        let image = open(&scene, 2, Method::Tolerance(tolerance));
        let (mut blurred, mut met) = (0, 0);
        for ((col, row), expected) in pixels(&image).zip(&expected) {
            let found = image.rgba(col, row);
            let off = |values: [f64; 4]| {
                let channels = values.into_iter().zip(expected);
                channels.fold(0.0, |worst: f64, (one, other)| {
                    worst.max((one - other).abs())
                })
            };
            let error = image.error(col, row);
            assert!(
                off(found) <= error + BETWEEN + FINE,
                "({col}, {row}) at {tolerance}: off by {:e}, {error:e} claimed",
                off(found)
            );
            blurred += u32::from(off(still.rgba(col, row)) > 0.02);
            if image.status(col, row) == Status::Met {
                assert!(error <= tolerance);
                met += 1;
            }
        }
        assert!(blurred > 100, "{blurred} pixels are blurred");
        assert_eq!(met, 40 * 30, "at {tolerance}");
    }
}

#[test]
fn turntables_meet_their_tolerance() {
    meets_its_tolerance(turntable);
}

#[test]
fn small_balls_and_bends_meet_their_tolerance() {
    meets_its_tolerance(pan);
}

#[test]
fn jumps_and_bumps_meet_their_tolerance() {
    meets_its_tolerance(ride);
}

#[test]
fn parallel_lenses_and_point_lights_meet_their_tolerance() {
    meets_its_tolerance(pass);
}

#[test]
fn samples_come_near_the_average() {
    let expected = mean(turntable, 2);
    let scene = scene(&turntable(1, ", shutter: 0.5"));
    let image = open(&scene, 2, Method::Samples(NonZeroU32::new(8).unwrap()));
    let mut square = 0.0;
    for ((col, row), expected) in pixels(&image).zip(&expected) {
        let off = (image.rgba(col, row)[0] - expected[0]).abs();
        let error = image.error(col, row);
        assert!(
            off <= 2.0 * error + 1e-3,
            "({col}, {row}): {off:e}, {error:e} claimed"
        );
        square += off * off;
    }
    let mean = (square / 1200.0).sqrt();
    assert!(mean < 6e-3, "{mean:e}");
}

#[test]
fn the_frame_after_the_last_is_the_first_to_the_bit() {
    let scene = scene(&turntable(1, ", shutter: 0.9"));
    for method in [
        Method::Tolerance(1e-2),
        Method::Samples(NonZeroU32::new(3).unwrap()),
    ] {
        let first = open(&scene, 1, method);
        assert_eq!(first, open(&scene, 13, method));
        assert_eq!(first.work(), open(&scene, 1 - 24, method).work());
        assert_ne!(first, open(&scene, 2, method));
        assert_ne!(first, render(&scene, &scene.view(1).unwrap(), method));
    }
}

#[test]
fn what_stands_still_costs_nothing() {
    let text = |shutter| {
        format!(
            "(image: (width: 20, height: 20), lens: Fov(40),
            camera: Free(), lights: [Directional(toward: (-1, 1, -1))],
            spheres: [(center: (0, 0, 4), radius: 1)],
            animation: Keyframes(frames: (0, 9){shutter},
                keys: [(frame: 4, pan: 0), (frame: 5, pan: 3)]))"
        )
    };
    let (closed, moving) = (scene(&text("")), scene(&text(", shutter: 1")));
    for method in [
        Method::Tolerance(1e-3),
        Method::Samples(NonZeroU32::new(3).unwrap()),
    ] {
        for frame in [0, 2, 3, 6, 9] {
            let (one, other) = (open(&closed, frame, method), open(&moving, frame, method));
            assert_eq!(one, other);
            assert_eq!(one.work(), other.work());
        }
        for frame in [4, 5] {
            let (one, other) = (open(&closed, frame, method), open(&moving, frame, method));
            assert_ne!(one, other);
        }
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let scene = scene(&turntable(1, ", shutter: 0.5"));
    for method in [
        Method::Tolerance(1e-3),
        Method::Samples(NonZeroU32::new(2).unwrap()),
    ] {
        let [one, other] = [1, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap().install(|| open(&scene, 5, method))
        });
        assert_eq!(one, other);
        assert_eq!(one.work(), other.work());
    }
}

#[test]
fn motion_that_is_too_fast_is_not_claimed_to_be_known() {
    let text = "(image: (width: 12, height: 9), lens: Fov(10),
        camera: Free(), lights: [Directional(toward: (-1, 1, -1))],
        spheres: [(center: (0, 0, 40), radius: 0.5)],
        animation: Keyframes(frames: (1, 3), shutter: 1,
            keys: [(frame: 1, pan: -9000, ease: Linear), (frame: 3, pan: 9000)]))";
    let image = open(&scene(text), 2, Method::Tolerance(1e-2));
    assert!(image.summary().over_tolerance > 0);
}
