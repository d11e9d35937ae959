//! Soft light at points, compared with integrals over meridians: see `tests/src/reference/soft`.
//!
//! `MARBLES_POINTS=10000 cargo test --release --package marbles-tests soft_light_points -- --nocapture` compares that many
//! points of each family, and prints the largest differences.

use std::f64::consts::TAU;
use std::io::Write;
use std::num::NonZeroU32;
use std::time::Instant;

use glam::{DVec2, DVec3};
use marbles_core::{
    Angle, Camera, DirectionalLight, Grain, Highlight, Lens, Material, Method, Renderer, Roughness,
    Settings, Sky, Sphere, View, World,
};
use marbles_tests::numbers::Numbers;
use marbles_tests::reference::Reference;
use rayon::prelude::*;

/// A family of scenes, and the largest difference that is allowed in addition to the effect of rounding.
struct Family {
    name: &'static str,
    scene: fn(&mut Numbers) -> (World, View),
    aim: f64,
}

const FAMILIES: [Family; 13] = [
    family(
        "suns of 0.01 degrees",
        |it| under_sun(it, 0.01, random),
        1e-10,
    ),
    family(
        "suns of 0.1 degrees",
        |it| under_sun(it, 0.1, random),
        1e-12,
    ),
    family(
        "suns of 0.53 degrees",
        |it| under_sun(it, 0.53, random),
        1e-12,
    ),
    family("suns of 5 degrees", |it| under_sun(it, 5.0, random), 1e-12),
    family(
        "suns of 60 degrees",
        |it| under_sun(it, 60.0, random),
        1e-12,
    ),
    family(
        "suns of 170 degrees",
        |it| under_sun(it, 170.0, random),
        5e-12,
    ),
    family("skies", |it| under_sky(it, random), 1e-12),
    family(
        "contacts under suns",
        |it| under_any_sun(it, contacts),
        1e-12,
    ),
    family("contacts under skies", |it| under_sky(it, contacts), 1e-12),
    family("horizons", horizons, 1e-12),
    family(
        "huge floors under suns",
        |it| under_any_sun(it, floors),
        1e-12,
    ),
    family("huge floors under skies", |it| under_sky(it, floors), 1e-12),
    family(
        "crowds",
        |it| match it.below(3) {
            0 => under_sky(it, crowds),
            _ => under_any_sun(it, crowds),
        },
        1e-12,
    ),
];

const fn family(name: &'static str, scene: fn(&mut Numbers) -> (World, View), aim: f64) -> Family {
    Family { name, scene, aim }
}

const WIDTH: u32 = 12;
const HEIGHT: u32 = 8;

type Shape = fn(&mut Numbers, &mut World) -> View;

/// A sun whose disc a sphere hides in part from a point of the picture, and the part of the picture around this point.
fn under_sun(numbers: &mut Numbers, degrees: f64, shape: Shape) -> (World, View) {
    let mut world = World::new();
    let view = shape(numbers, &mut world);
    for _ in 0..100 {
        let (col, row) = (
            numbers.below(WIDTH as usize) as u64,
            numbers.below(HEIGHT as usize) as u64,
        );
        let ray = view.ray(view.cell_center(col, row, 1));
        let spheres = world.spheres();
        let hits = spheres.iter().filter_map(|sphere| sphere.hit(&ray));
        let Some(hit) = hits.min_by(|a, b| a.t.total_cmp(&b.t)) else {
            continue;
        };
        let point = ray.at(hit.t);
        let caster = spheres[numbers.below(spheres.len())];
        let to_center = caster.center() - point;
        let distance = to_center.length();
        if distance <= caster.radius() * (1.0 + 1e-9) {
            continue;
        }
        let half = 0.5 * degrees.to_radians();
        let angle = libm::asin(caster.radius() / distance) + numbers.between(-1.0, 1.0) * half;
        let aside = to_center.cross(numbers.direction().into()).normalize();
        let toward = to_center / distance * libm::cos(angle) + aside * libm::sin(angle);
        if toward.dot(hit.normal) > -libm::sin(half) {
            add_sun(&mut world, toward, degrees);
            let depth = hit.t * ray.direction.length();
            let reach = distance.min(1.0) * libm::tan(half.min(0.5)) * numbers.between(1.0, 8.0);
            let across = match view.lens.is_parallel() {
                true => view.lens.width,
                false => view.lens.width / view.lens.distance * depth,
            };
            let lens = Lens {
                width: view.lens.width * (reach / across).min(1.0),
                shift: view.cell_center(col, row, 1),
                ..view.lens
            };
            return (world, View { lens, ..view });
        }
    }
    add_sun(&mut world, numbers.direction().into(), degrees);
    (world, view)
}

fn under_any_sun(numbers: &mut Numbers, shape: Shape) -> (World, View) {
    let degrees = numbers.either(&[0.01, 0.1, 0.53, 2.0, 5.0, 20.0, 60.0, 120.0, 170.0]);
    under_sun(numbers, degrees, shape)
}

fn under_sky(numbers: &mut Numbers, shape: Shape) -> (World, View) {
    let mut world = World::new();
    let view = shape(numbers, &mut world);
    let up = numbers.direction().into();
    world.sky = Some(match numbers.below(2) {
        0 => Sky::uniform(DVec3::new(1.0, 0.5, 0.25)),
        _ => Sky::in_halves(DVec3::new(1.0, 0.5, 0.25), DVec3::splat(0.1), up).unwrap(),
    });
    (world, view)
}

fn add_sun(world: &mut World, toward: DVec3, degrees: f64) {
    let sun = DirectionalLight::new(toward, DVec3::new(1.0, 0.5, 0.25)).unwrap();
    let sun = sun.with_diameter(degrees.to_radians()).unwrap();
    world.lights.push(sun.into());
}

/// A material of one of some kinds.
fn material(numbers: &mut Numbers) -> Material {
    let highlight = Highlight {
        strength: 0.5,
        shininess: 20.0,
    };
    let bumps = Roughness {
        amplitude: 0.3,
        grain: Grain::Surface(0.2),
        seed: 7,
    };
    Material {
        exponent: numbers.either(&[1.0, 1.0, 1.0, 2.5]),
        highlight: (numbers.below(5) == 0).then_some(highlight),
        roughness: (numbers.below(8) == 0).then_some(bumps),
        ..Material::default()
    }
}

fn look(numbers: &mut Numbers, at: DVec3, from: DVec3, degrees: f64) -> View {
    let roll = Angle::from_radians(numbers.between(0.0, TAU));
    let camera = Camera::look_at(from, at, roll).unwrap();
    let lens = match numbers.below(4) {
        0 => Lens::parallel(from.distance(at) * degrees.to_radians(), DVec2::ZERO),
        _ => Lens::from_field_of_view(Angle::from_degrees(degrees)).unwrap(),
    };
    View::new(camera, lens, WIDTH, HEIGHT)
}

/// Balls anywhere, which may overlap.
fn random(numbers: &mut Numbers, world: &mut World) -> View {
    for _ in 0..numbers.below(6) + 2 {
        let material = world.add_material(material(numbers));
        let center = DVec3::from(numbers.direction()) * numbers.between(0.0, 1.8);
        let radius = libm::exp(numbers.between(-3.0, 0.0));
        world.add_sphere(Sphere::new(center, radius).unwrap(), material);
    }
    let from = DVec3::from(numbers.direction()) * numbers.between(3.0, 6.0);
    look(numbers, DVec3::ZERO, from, 40.0)
}

/// A chain of balls, each of which touches the one before, or nearly so; seen from close to a contact.
fn contacts(numbers: &mut Numbers, world: &mut World) -> View {
    let plain = world.add_material(Material::default());
    let (mut center, mut radius) = (DVec3::ZERO, 1.0);
    let (mut contact, mut side) = (DVec3::ZERO, DVec3::X);
    world.add_sphere(Sphere::new(center, radius).unwrap(), plain);
    for _ in 0..numbers.below(3) + 1 {
        let next = libm::exp(numbers.between(-2.0, 2.0));
        let way = DVec3::from(numbers.direction());
        let gap = numbers.either(&[0.0, 0.0, 1e-12, 1e-6, 1e-3, -1e-9, -1e-3]);
        contact = center + way * radius;
        side = way.any_orthonormal_vector();
        side = side * libm::cos(gap) + way.cross(side) * numbers.between(-1.0, 1.0);
        center += way * (radius + next + gap);
        radius = next;
        world.add_sphere(Sphere::new(center, radius).unwrap(), plain);
    }
    let near = libm::pow(10.0, numbers.between(-5.0, 0.5));
    let from = contact + side.normalize() * near + DVec3::from(numbers.direction()) * 0.1 * near;
    look(numbers, contact, from, 30.0)
}

/// Floors of many sizes, with balls that rest on them.
fn floors(numbers: &mut Numbers, world: &mut World) -> View {
    let plain = world.add_material(Material::default());
    let large = libm::pow(10.0, numbers.between(3.0, 6.0));
    let floor = Sphere::new(DVec3::new(0.0, -large, 0.0), large).unwrap();
    world.add_sphere(floor, plain);
    for _ in 0..numbers.below(4) + 1 {
        let radius = libm::exp(numbers.between(-3.0, 0.0));
        let [x, z]: [f64; 2] = [(); 2].map(|()| numbers.between(-1.0, 1.0));
        let ground = (large * large - x * x - z * z).sqrt() - large;
        let lifted = numbers.either(&[0.0, 0.0, 1e-3, 0.3]);
        let center = DVec3::new(x, ground + radius + lifted, z);
        world.add_sphere(Sphere::new(center, radius).unwrap(), plain);
    }
    let height = libm::exp(numbers.between(-3.0, 1.0));
    look(numbers, DVec3::ZERO, DVec3::new(0.3, height, -3.0), 40.0)
}

/// Suns that are half below the horizon of what is seen.
fn horizons(numbers: &mut Numbers) -> (World, View) {
    let mut world = World::new();
    let degrees: f64 = numbers.either(&[0.01, 0.1, 0.53, 5.0, 60.0, 170.0]);
    let shape = numbers.either(&[random as Shape, floors]);
    shape(numbers, &mut world);
    let sphere = world.spheres()[0];
    let normal = match sphere.radius() > 100.0 {
        true => DVec3::Y,
        false => numbers.direction().into(),
    };
    let aside = DVec3::from(numbers.direction()).cross(normal).normalize();
    let above = numbers.between(-1.1, 1.1) * (0.5 * degrees).to_radians();
    add_sun(&mut world, aside + normal * libm::tan(above), degrees);
    let at = sphere.center() + normal * sphere.radius();
    let far = libm::exp(numbers.between(-4.0, 1.0));
    let from = at + (normal + 0.8 * aside.cross(normal)) * far;
    (world, look(numbers, at, from, 30.0))
}

/// Two hundred small balls.
fn crowds(numbers: &mut Numbers, world: &mut World) -> View {
    let plain = world.add_material(Material::default());
    for _ in 0..200 {
        let center = DVec3::from([(); 3].map(|()| numbers.between(-1.0, 1.0)));
        let radius = numbers.between(0.05, 0.15);
        world.add_sphere(Sphere::new(center, radius).unwrap(), plain);
    }
    let from = DVec3::from(numbers.direction()) * 4.0;
    look(numbers, DVec3::ZERO, from, 30.0)
}

/// The largest difference of a scene's points, that divided by what is allowed, and the number of points to which a part of
/// a light is hidden.
fn compare(family: &Family, seed: u64) -> (f64, f64, usize) {
    let (world, view) = (family.scene)(&mut Numbers(seed));
    let settings = Settings {
        method: Method::Samples(NonZeroU32::MIN),
        ..Settings::default()
    };
    let image = Renderer::new(&world).render(&view, &settings);
    let reference = Reference::new(&world, &view);
    let (mut worst, mut ratio, mut count) = (0.0_f64, 0.0_f64, 0);
    for (col, row) in (0..HEIGHT).flat_map(|row| (0..WIDTH).map(move |col| (col, row))) {
        let truth = reference.center(col, row);
        // Where rounding decides which sphere is seen, there is nothing to compare.
        if !truth.is_known {
            continue;
        }
        let found = DVec3::from_slice(&image.rgba(col, row));
        let off = (found - truth.value).abs().max_element();
        count += usize::from(truth.is_partial);
        worst = worst.max(off);
        let allowed = family.aim + truth.error;
        if off > ratio * allowed && off > allowed {
            let _ = writeln!(
                std::io::stderr(),
                "{} {seed}: {col} {row} is off by {off:e}, {allowed:e} are allowed: {found} {}",
                family.name,
                truth.value
            );
        }
        ratio = ratio.max(off / allowed);
    }
    (worst, ratio, count)
}

#[test]
fn points_agree_with_integrals_over_meridians() {
    const FEW: usize = 100;
    // Scenes that are compared at once, and the number of times after which there should be enough points.
    const AT_ONCE: u64 = 4;
    const MOST: u64 = 1_000;
    let asked = std::env::var("MARBLES_POINTS")
        .ok()
        .and_then(|it| it.parse().ok());
    let points: usize = asked.unwrap_or(FEW);
    let mut broken = Vec::new();
    for (number, family) in FAMILIES.iter().enumerate() {
        let start = Instant::now();
        let (mut worst, mut ratio, mut count) = (0.0_f64, 0.0_f64, 0);
        for round in 0..MOST {
            if count >= points {
                break;
            }
            let first = 1_000_003 * number as u64 + AT_ONCE * round;
            let seeds = (first..first + AT_ONCE).into_par_iter();
            let compared: Vec<_> = seeds.map(|seed| compare(family, seed)).collect();
            for (off, of_allowed, found) in compared {
                worst = worst.max(off);
                ratio = ratio.max(of_allowed);
                count += found;
            }
        }
        if asked.is_some() {
            let _ = writeln!(
                std::io::stderr(),
                "{}: {count} points, off by at most {worst:.1e}, {ratio:.3} of what is allowed, {:.1} s",
                family.name,
                start.elapsed().as_secs_f64()
            );
        }
        assert!(count >= points, "{}: {count} points", family.name);
        if ratio > 1.0 {
            broken.push(format!(
                "{}: {worst:e}, {ratio} of what is allowed",
                family.name
            ));
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}
