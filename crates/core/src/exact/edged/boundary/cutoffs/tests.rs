//! Tests of `cutoffs.rs`.

use fearless_simd::{Level, dispatch};
use glam::{DMat3, DVec3};

use super::super::fractional::tests::{VIEW, brute};
use super::*;
use crate::edges::cell::{Ball, Cell};
use crate::edges::silhouette::silhouette;
use crate::edges::tests::{ball_in_front, cell_at, direction, first_hit, magnitude, ray, value};
use crate::exact::classify::active::{Active, Terminators};
use crate::exact::edged::boundary::chord::Reference;
use crate::exact::edged::boundary::power_rules::PowerRules;
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::light::lobe::Lobe;
use crate::light::near_light::NearLight;
use crate::model::color::Color;
use crate::model::emission::Emission;
use crate::model::light::{LightFalloff, PointLight};
use crate::model::material::Material;
use crate::model::roughness::PixelKey;
use crate::model::sphere::Sphere;
use crate::model::world::World;
use crate::picture::image::Channels;
use crate::search::tests::Random;
use crate::search::visibility::Visibility;

/// A lamp: its position, the direction that it faces, and the power.
#[derive(Clone, Copy, Debug)]
struct Lamp {
    position: DVec3,
    facing: DVec3,
    mu: f64,
}

/// The light at a place of a line by closed form; whole exponents go on where the surface turns away.
fn light(cell: &Cell, ball: &Ball, lamp: &Lamp, exponent: f64, x: f64, y: f64) -> f64 {
    let ray = ray(cell, x, y);
    let (along, ray_sq) = (ray.dot(ball.center), ray.length_squared());
    let across = ray.cross(ball.center).length_squared();
    let root = (ray_sq * ball.radius * ball.radius - across)
        .max(0.0)
        .sqrt();
    let point = ray * (ball.outside / (along + root));
    let normal = (point - ball.center) / ball.radius;
    let way = lamp.position - point;
    let toward = way.normalize();
    let cosine = normal.dot(toward);
    let diffuse = if exponent == 1.0 {
        cosine
    } else {
        libm::pow(cosine.max(0.0), exponent)
    };
    let ahead = -toward.dot(lamp.facing);
    diffuse * libm::pow(ahead.max(0.0), lamp.mu) * (ball.radius * ball.radius)
        / way.length_squared()
}

#[test]
fn light_of_lamps_is_summed_up_along_chords() {
    let mut random = Random(7);
    let (mut partly, mut chords) = (0, 0);
    let mut closest = 0.0_f64;
    for case in 0..120 {
        let mu = [0.01, 0.1, 0.3, 0.5, 0.9, 1.3, 2.6, 5.5][case % 8];
        let exponent = [1.0, 1.0, 0.6][case % 3];
        let ball = ball_in_front(&mut random);
        let widths = magnitude(&mut random, 1e-2, 1.0);
        let mut cell = cell_at(&mut random, &ball, widths);
        cell.middle += direction(&mut random).with_z(0.0) * (0.9 * ball.radius / ball.center.z);
        let Some(point) = first_hit(ray(&cell, 0.0, 0.0), &ball) else {
            continue;
        };
        // Its plane passes near the middle of the cell.
        let normal = (point - ball.center) / ball.radius;
        let way = (normal * 1.5 + direction(&mut random)).normalize() * (3.0 * ball.radius);
        let facing = direction(&mut random).cross(way).normalize();
        let aside = 0.5 * random.number() * cell.size[0] * point.z;
        let lamp = Lamp {
            position: point + way + facing * aside,
            facing,
            mu,
        };
        let discriminant = silhouette(&cell, &ball);
        let mut world = World::new();
        let material = world.add_material(Material {
            exponent,
            ..Material::MATTE_WHITE
        });
        world.add_sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap(), material);
        let visibility = Visibility::new(&world);
        let mut scene = InCamera::new(&world, &visibility, &VIEW, Channels::Grey, 0);
        let falloff = LightFalloff::InverseSquare;
        let point_light = PointLight::new(lamp.position, Color::ONE, falloff, ball.radius);
        let lobe = Lobe::new(&Emission::new(facing, mu).unwrap(), &DMat3::IDENTITY);
        scene.lights.push(Light {
            index: 0,
            intensity: Color::ONE,
            toward: DVec3::Z,
            right: DVec3::X,
            up: DVec3::Y,
            near: Some(NearLight::new(
                &point_light.unwrap(),
                lamp.position,
                Some(lobe),
            )),
            is_shut_off: false,
        });
        let pixel = PixelKey {
            col: 0,
            row: 0,
            frame: 1,
        };
        let finish = Finish::new(&scene, 0, pixel);
        let active = Active {
            sphere: 0,
            ball,
            discriminant,
            along: cell.dot(ball.center),
            terminators: Terminators::Plain,
            is_dark: false,
        };
        let reference = Reference::new(&discriminant, &active.along);
        let rules = PowerRules::of(exponent, &mut Vec::new());
        let sender = Sender {
            scene: &scene,
            cell: &cell,
            active: &active,
            finish: &finish,
            reference: &reference,
            terminators: u64::from(exponent != 1.0),
            cutoffs: 1,
            rules: &rules,
            tolerance: 1e-6,
        };
        let mut lines = Vec::new();
        for lane in 0..8 {
            let y = 0.11 * f64::from(lane) - 0.4;
            let [one, other] = discriminant.crossings(y);
            let (left, right) = (one.min(other).max(-0.5), one.max(other).min(0.5));
            let is_seen = value(&discriminant, 0.5 * (left + right), y).0 > 0.0;
            if left < right && is_seen && ball.outside > 0.0 {
                lines.push((if case % 2 == 0 { left } else { right }, y));
            }
        }
        let Some(last) = lines.last().copied() else {
            continue;
        };
        let count = lines.len();
        lines.resize(8, last);
        let found = dispatch!(Level::new(), simd => {
            let lanes = |part: fn(&(f64, f64)) -> f64| {
                let mut lanes = [0.0; 8];
                for (lane, line) in lanes.iter_mut().zip(&lines) {
                    *lane = part(line);
                }
                f64x8::from_array(simd, lanes)
            };
            let lines = Lines {
                x: lanes(|line| line.0),
                y: lanes(|line| line.1),
                lights: 1,
                diffuse: 1,
            };
            let chord = Chord::new(simd, &discriminant, &reference, lines.x, lines.y);
            let sum = sender.cut_off(simd, &chord, &lines, &mut None);
            [sum.light[0], sum.doubt, reference.at(lines.y)].map(<[f64; 8]>::from)
        });
        for (lane, (end, y)) in lines.into_iter().enumerate().take(count) {
            let start = found[2][lane];
            let light = |x: f64| light(&cell, &ball, &lamp, exponent, x, y);
            let exact = brute(light, start, end);
            let (off, doubt) = ((found[0][lane] - exact).abs(), found[1][lane]);
            assert!(
                off <= doubt + 1e-8,
                "{mu} {exponent} {off:e} {doubt:e} {cell:?} {ball:?} {lamp:?}"
            );
            closest = closest.max(doubt);
            chords += 1;
            partly += usize::from((light(start) > 0.0) != (light(end) > 0.0));
        }
    }
    assert!(chords > 200 && partly > 30, "{chords} {partly}");
    assert!(closest < 1e-5, "{closest}");
}
