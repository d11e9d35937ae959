//! Light has no unit: random scenes of many kinds, with all light and the tolerance a power of two times as bright.

use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::Path;

use marbles_core::{Image, Method, Renderer, Settings};
use marbles_scene::Scene;
use marbles_tests::numbers::Numbers;

use crate::studio::pixels;

const SCENES: u64 = 24;

/// Text of a scene, all light of which is so many times as bright.
struct Writer {
    random: Numbers,
    factor: f64,
}

impl Writer {
    fn length(&self, length: f64) -> String {
        format!("{length:e}")
    }

    fn point(&self, [x, y, z]: [f64; 3]) -> String {
        format!(
            "({}, {}, {})",
            self.length(x),
            self.length(y),
            self.length(z)
        )
    }

    fn between(&mut self, lows: [f64; 3], highs: [f64; 3]) -> [f64; 3] {
        let mut axis = 0..3;
        [(); 3].map(|()| {
            let axis = axis.next().unwrap_or_default();
            self.random.between(lows[axis], highs[axis])
        })
    }

    fn light(&mut self, brightness: f64) -> String {
        let channels = [(); 3].map(|()| {
            let share = self.random.either(&[1.0, 0.75, 0.5, 0.3]);
            format!("{:e}", brightness * share * self.factor)
        });
        format!("({})", channels.join(", "))
    }

    fn is(&mut self, probability: f64) -> bool {
        self.random.uniform() < probability
    }

    fn lens(&mut self) -> String {
        match self.random.below(4) {
            0 => format!(
                "Retina(width: {}, distance: {})",
                self.length(20.0),
                self.length(40.0)
            ),
            1 => format!(
                "Retina(width: {}, distance: {}, shift: ({}, {}))",
                self.length(20.0),
                self.length(30.0),
                self.length(1.7),
                self.length(-2.3)
            ),
            2 => format!("Fov({})", self.random.either(&[30.0, 60.0, 120.0, 160.0])),
            _ => format!("Parallel(width: {})", self.length(24.0)),
        }
    }

    fn source(&mut self) -> String {
        let intensity = self.light(0.8);
        if self.is(0.5) {
            let [x, y, z] = self.between([-1.0, 0.1, -1.0], [1.0, 1.0, 0.3]);
            return format!("Directional(toward: ({x}, {y}, {z}), intensity: {intensity})");
        }
        let place = self.between([-12.0, -2.0, 10.0], [12.0, 12.0, 30.0]);
        let falloff = match self.is(0.6) {
            true => format!("reference: {}", self.length(17.3)),
            false => "falloff: None".to_owned(),
        };
        let place = self.point(place);
        format!("Point(position: {place}, intensity: {intensity}, {falloff})")
    }

    fn material(&mut self) -> String {
        let exponent = self.random.either(&[1.0, 1.0, 2.0, 0.7, 3.5]);
        let mut text = format!("(albedo: (1, 0.5, 0.83), exponent: {exponent}");
        if self.is(0.5) {
            let shininess = self.random.either(&[2.0, 8.0, 30.0, 300.0]);
            let _ = write!(text, ", highlight: (strength: 0.6, shininess: {shininess})");
        }
        if self.is(0.3) {
            let size = self.random.either(&[0.3, 2.0, 5.1]);
            let size = self.length(size);
            let _ = write!(
                text,
                ", rough: (amplitude: 0.4, grain: Surface({size}), seed: 3)"
            );
        } else if self.is(0.15) {
            text.push_str(", rough: (amplitude: 0.3, grain: Pixel, seed: 2)");
        }
        if self.is(0.25) {
            let color = self.light(0.5);
            let _ = write!(text, ", outline: (width: 1.5, color: {color})");
        }
        text.push(')');
        text
    }

    fn sphere(&mut self, center: [f64; 3], radius: f64, text: &mut String) {
        let material = self.random.below(3);
        let (center, radius) = (self.point(center), self.length(radius));
        let _ = write!(
            text,
            "(center: {center}, radius: {radius}, material: \"{material}\"), "
        );
    }

    fn spheres(&mut self) -> String {
        let mut text = String::new();
        if self.is(0.5) {
            let radius = libm::pow(10.0, self.random.between(2.0, 8.0));
            let below = self.random.between(3.0, 8.0);
            self.sphere([0.0, -(radius + below), 30.0], radius, &mut text);
        }
        for _ in 0..self.random.either(&[1, 3, 8, 20]) {
            let radius = libm::pow(10.0, self.random.between(-1.5, 0.8));
            let center = self.between([-9.0, -7.0, 18.0], [9.0, 7.0, 45.0]);
            self.sphere(center, radius, &mut text);
        }
        if self.is(0.3) {
            // Spheres that cross, and are nearly the same.
            self.sphere([0.0, 0.0, 40.0], 8.0, &mut text);
            self.sphere([5.0, 6.0, 36.0], 3.0, &mut text);
            self.sphere([0.0, 0.0, 40.3], 8.0, &mut text);
        }
        text
    }

    fn scene(mut self) -> Scene {
        let lens = self.lens();
        let mut camera = "Free()".to_owned();
        let mut motion = String::new();
        if self.is(0.12) {
            let places = [[-0.4, 0.0, 0.0], [0.4, 0.1, 0.0]].map(|place| self.point(place));
            let [first, last] = places;
            motion = format!(
                ", animation: Keyframes(frames: (1, 3), shutter: 1, keys: [
                (frame: 1, position: {first}, ease: Linear), (frame: 3, position: {last})])"
            );
        } else if self.is(0.7) {
            let place = self.between([-1.0; 3], [1.0; 3]);
            let place = self.point(place);
            camera = format!("Free(position: {place}, pan: 3.1, tilt: -2, roll: 13)");
        }
        let lights = [(); 2].map(|()| self.source()).join(", ");
        let materials: String = (0..3)
            .map(|name| format!("\"{name}\": {}, ", self.material()))
            .collect();
        let shadows = self.is(0.7);
        let [ambient, background] = [0.0625, 0.375].map(|light| self.light(light));
        let spheres = self.spheres();
        let text = format!(
            "(image: (width: 18, height: 14), lens: {lens}, camera: {camera}, shadows: {shadows},
            ambient: {ambient}, background: {background}, lights: [{lights}],
            materials: {{ {materials} }}, spheres: [{spheres}]{motion})"
        );
        Scene::parse(&text, Path::new("laws.ron")).unwrap_or_else(|error| panic!("{error} {text}"))
    }
}

fn image(seed: u64, factor: f64, method: Method, alpha: bool) -> Image {
    let random = Numbers(seed);
    let scene = Writer { random, factor }.scene();
    let view = scene.view(1).unwrap();
    let go_on = |_| ControlFlow::Continue(());
    let settings = Settings { method, alpha };
    Renderer::new(scene.world())
        .render(scene.exposure(&view), &settings, &go_on)
        .unwrap()
}

#[test]
fn light_of_random_scenes_has_no_unit() {
    let samples = Method::Samples(2.try_into().unwrap());
    for seed in 0..SCENES {
        for tolerance in [Some(1e-2), Some(1e-4), None] {
            let method = |light: f64| match tolerance {
                Some(tolerance) => Method::Tolerance(tolerance * light),
                None => samples,
            };
            let alpha = seed % 3 == 0;
            let expected = image(seed, 1.0, method(1.0), alpha);
            for exponent in [-40, 1, 34] {
                let light = libm::scalbn(1.0, exponent);
                let found = image(seed, light, method(light), alpha);
                let place = format!("scene {seed} at {tolerance:?}, 2^{exponent}");
                assert_eq!(found.work(), expected.work(), "{place}");
                for (col, row) in pixels(&found) {
                    let [r, g, b, coverage] = expected.rgba(col, row);
                    let times = [r * light, g * light, b * light, coverage];
                    assert_eq!(found.rgba(col, row), times, "{place} ({col}, {row})");
                    if tolerance.is_some() {
                        let claimed = expected.error(col, row) * light;
                        assert_eq!(found.error(col, row), claimed, "{place} ({col}, {row})");
                    }
                }
            }
        }
    }
}
