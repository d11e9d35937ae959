//! Measures soft light over a thousand balls: beside hard light, and beside rays to as small an error.

mod rays;

use glam::DVec3;
use marbles_benches::{
    Case, by_samples, cloud, load, main as run, mean, medians, square_view, table, to_tolerance,
};
use marbles_core::{Color, DirectionalLight, Image, Light, Renderer, Sky, View, World};

use rays::{Place, places};

const BALLS: u32 = 1000;

/// The side of the pictures, and of the few pixels whose light is also found by rays.
const SIDE: u32 = 600;
const FEW: u32 = 24;

/// The error at which rays are compared.
const ERROR: f64 = 1e-3;

/// The cloud under one light.
fn under(light: Option<Light>, sky: Option<Sky>) -> World {
    let mut world = cloud(BALLS);
    world.lights = light.into_iter().collect();
    world.sky = sky;
    world
}

/// A sun with a diameter in degrees.
fn sun(diameter: f64) -> Light {
    let light = DirectionalLight::new(DVec3::new(-1.0, 1.0, -1.0), Color::ONE);
    let light = light.and_then(|light| light.with_diameter(diameter.to_radians()));
    light.expect("the light is valid").into()
}

fn main() {
    run(|| {
        let view = square_view(&load("tests/truth/pixels/cloud1k"), SIDE);
        beside_hard_light(&view);
        let few = View {
            width: FEW,
            height: FEW,
            ..view
        };
        beside_rays(&few);
    });
}

/// The time of pictures to a tolerance.
fn beside_hard_light(view: &View) {
    let sky = Some(Sky::uniform(Color::ONE));
    let lights = [
        ("hard light, 1e-3", under(Some(sun(0.0)), None), 1e-3),
        ("sun of 0.53°, 1e-3", under(Some(sun(0.53)), None), 1e-3),
        ("sun of 5°, 1e-3", under(Some(sun(5.0)), None), 1e-3),
        ("sky, 1e-2", under(None, sky), 1e-2),
    ];
    let renderers = lights.each_ref().map(|(_, world, _)| Renderer::new(world));
    let cases: Vec<Case<'_, Image>> = lights
        .iter()
        .zip(&renderers)
        .map(|((name, _, tolerance), renderer)| Case {
            name: (*name).into(),
            millions: f64::from(SIDE * SIDE) * 1e-6,
            run: Box::new(move |spent| to_tolerance(renderer, view, *tolerance, spent)),
        })
        .collect();
    let images = table("a thousand balls", "pixels", 6, &cases);
    let means: Vec<f64> = images.iter().map(mean).collect();
    // A disc is as bright as its middle, but for penumbrae across horizons.
    assert!((means[0] - means[1]).abs() < 1e-3, "{means:?}");
    assert!((means[0] - means[2]).abs() < 1e-2, "{means:?}");
}

/// The light of the sky in the middles of pixels, by marbles and by rays.
#[expect(
    clippy::print_stdout,
    reason = "the ratio is what the benchmark is for"
)]
fn beside_rays(view: &View) {
    let world = under(None, Some(Sky::uniform(Color::ONE)));
    let renderer = Renderer::new(&world);
    let places = places(&world, view);
    let cases: [Case<'_, Vec<f64>>; 4] = [0, 16, 32, 64].map(|side| Case {
        name: match side {
            0 => "exact".into(),
            side => format!("{side} x {side} rays"),
        },
        millions: places.len() as f64 * 1e-6,
        run: Box::new({
            let (renderer, places) = (&renderer, &places);
            move |_| match side {
                0 => light_of(&by_samples(renderer, view, 1, None), places),
                side => places.iter().map(|place| place.light(side)).collect(),
            }
        }),
    });
    let (rounds, timed) = medians(1, 10, &cases);
    let truth = &timed[0].result;
    let errors: Vec<f64> = timed
        .iter()
        .map(|timed| {
            let squares = timed.result.iter().zip(truth);
            let sum: f64 = squares.map(|(one, other)| (one - other).powi(2)).sum();
            (sum / truth.len() as f64).sqrt()
        })
        .collect();
    // More rays come closer.
    assert!(
        errors[1] > errors[2] && errors[2] > errors[3] && errors[3] < 5e-3,
        "{errors:?}"
    );
    println!("\nthe light of a sky at points, medians of {rounds}");
    for ((case, timed), error) in cases.iter().zip(&timed).zip(&errors) {
        let time = 1e6 * timed.median / places.len() as f64;
        println!(
            "{:>24} {time:>12.1} µs/point   error {error:.1e}",
            case.name
        );
    }
    // Time as a power of the error, from the last two numbers of rays.
    let [coarse, fine] = [&timed[2], &timed[3]].map(|timed| timed.median.ln());
    let power = (fine - coarse) / (errors[3].ln() - errors[2].ln());
    let rays = (fine + power * (ERROR.ln() - errors[3].ln())).exp();
    println!(
        "To an error of {ERROR:.0e}, rays take {:.1} times as long as exact light.",
        rays / timed[0].median
    );
}

/// The light of an image in the pixels of some places.
fn light_of(image: &Image, places: &[Place]) -> Vec<f64> {
    let light = places
        .iter()
        .map(|place| image.rgba(place.col, place.row)[0]);
    light.collect()
}
