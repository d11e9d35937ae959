//! Light and lengths have no unit: random scenes of many kinds, with all light and the tolerance, or all lengths,
//! multiplied by a power of two.

use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::Path;

use marbles_core::{Image, Method, Renderer, Settings};
use marbles_scene::Scene;
use marbles_tests::numbers::Numbers;

use crate::studio::pixels;

const SCENES: u64 = 24;

/// The units of a scene: the factors on its light and on its lengths.
#[derive(Clone, Copy)]
struct Units {
    light: f64,
    length: f64,
}

const OWN: Units = Units {
    light: 1.0,
    length: 1.0,
};

/// The text of a scene in some units.
struct Writer {
    random: Numbers,
    /// Random numbers for choices, which do not affect the other numbers.
    aside: Numbers,
    units: Units,
    /// Columns and rows.
    size: [u32; 2],
}

impl Writer {
    fn length(&self, length: f64) -> String {
        format!("{:e}", length * self.units.length)
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
            format!("{:e}", brightness * share * self.units.light)
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
            let color = match self.light(0.5) {
                _ if self.aside.below(2) == 0 => "0".to_owned(),
                color => color,
            };
            let width = match self.aside.below(3) {
                0 => format!("Units({})", self.length(0.3)),
                _ => "1.5".to_owned(),
            };
            let _ = write!(text, ", outline: (width: {width}, color: {color})");
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
            camera = match self.aside.below(4) {
                0 => {
                    let target = self.point([0.3, -0.2, 31.0]);
                    format!("LookAt(position: {place}, target: {target}, roll: 7)")
                }
                1 => format!(
                    "Orbit(target: {}, radius: {}, azimuth: -4, elevation: 3)",
                    self.point([0.3, -0.2, 31.0]),
                    self.length(30.7)
                ),
                _ => format!("Free(position: {place}, pan: 3.1, tilt: -2, roll: 13)"),
            };
        }
        let lights = [(); 2].map(|()| self.source()).join(", ");
        let materials: String = (0..3)
            .map(|name| format!("\"{name}\": {}, ", self.material()))
            .collect();
        let shadows = self.is(0.7);
        let [ambient, background] = [0.0625, 0.375].map(|light| self.light(light));
        let spheres = self.spheres();
        let [width, height] = self.size;
        let text = format!(
            "(image: (width: {width}, height: {height}), lens: {lens}, camera: {camera}, shadows: {shadows},
            ambient: {ambient}, background: {background}, lights: [{lights}],
            materials: {{ {materials} }}, spheres: [{spheres}]{motion})"
        );
        Scene::parse(&text, Path::new("laws.ron")).unwrap_or_else(|error| panic!("{error} {text}"))
    }
}

fn image(seed: u64, units: Units, size: [u32; 2], method: Method) -> Image {
    let writer = Writer {
        random: Numbers(seed),
        aside: Numbers(!seed),
        units,
        size,
    };
    let scene = writer.scene();
    let alpha = seed.is_multiple_of(3);
    let view = scene.view(1).unwrap();
    let go_on = |_| ControlFlow::Continue(());
    let settings = Settings { method, alpha };
    Renderer::new(scene.world())
        .render_with_progress(scene.exposure(&view), &settings, &go_on)
        .unwrap()
}

#[test]
fn light_of_random_scenes_has_no_unit() {
    const SIZE: [u32; 2] = [18, 14];
    let samples = Method::Samples(2.try_into().unwrap());
    for seed in 0..SCENES {
        for tolerance in [Some(1e-2), Some(1e-4), None] {
            let method = |light: f64| match tolerance {
                Some(tolerance) => Method::Tolerance(tolerance * light),
                None => samples,
            };
            let expected = image(seed, OWN, SIZE, method(1.0));
            for exponent in [-40, 1, 34] {
                let light = libm::scalbn(1.0, exponent);
                let units = Units { light, ..OWN };
                let found = image(seed, units, SIZE, method(light));
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

/// A picture, which must be the same in other units of length.
fn check_lengths(seed: u64, method: Method) -> Image {
    const SIZE: [u32; 2] = [10, 8];
    let expected = image(seed, OWN, SIZE, method);
    // Fine bumps, and averages over time, cost as much as all others.
    let exponents: &[i32] = match expected.work().samples {
        1_000_000.. => &[-40],
        _ => &[-40, -17, 3, 40],
    };
    for &exponent in exponents {
        let length = libm::scalbn(1.0, exponent);
        let found = image(seed, Units { length, ..OWN }, SIZE, method);
        let place = format!("scene {seed} at {method:?}, 2^{exponent}");
        assert_eq!(found.work(), expected.work(), "{place}");
        for (col, row) in pixels(&found) {
            let place = format!("{place} ({col}, {row})");
            assert_eq!(found.rgba(col, row), expected.rgba(col, row), "{place}");
            let [claimed, expected] = [&found, &expected].map(|it| it.error(col, row));
            assert_eq!(claimed, expected, "{place}");
        }
    }
    expected
}

#[test]
fn lengths_of_random_scenes_have_no_unit() {
    /// Expensive scenes are not rendered at smaller tolerances.
    const MOST_SAMPLES: u64 = 100_000;
    for seed in 0..SCENES {
        check_lengths(seed, Method::Samples(2.try_into().unwrap()));
        for tolerance in [1e-2, 1e-3, 1e-5] {
            let image = check_lengths(seed, Method::Tolerance(tolerance));
            if image.work().samples > MOST_SAMPLES {
                break;
            }
        }
    }
}
