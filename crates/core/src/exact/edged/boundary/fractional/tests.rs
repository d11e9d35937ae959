//! Tests of `fractional.rs`.

use fearless_simd::{Level, dispatch};
use glam::{DMat3, DVec2, DVec3};

use super::*;
use crate::edges::cell::{Ball, Cell};
use crate::edges::silhouette::silhouette;
use crate::edges::tests::{ball_in_front, cell_at, direction, first_hit, magnitude, ray, value};
use crate::exact::classify::active::{Active, Terminators};
use crate::exact::edged::boundary::chord::Reference;
use crate::exact::edged::boundary::power_rules::PowerRules;
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::model::camera::{Camera, Lens};
use crate::model::color::Color;
use crate::model::material::Material;
use crate::model::roughness::PixelKey;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::lanes::f64x8;
use crate::picture::image::Channels;
use crate::search::tests::Random;
use crate::search::visibility::Visibility;

pub(in super::super) const VIEW: View = View {
    camera: Camera {
        position: DVec3::ZERO,
        on_axis: DVec3::ZERO,
        world_from_camera: DMat3::IDENTITY,
    },
    lens: Lens {
        width: 1.0,
        distance: 1.0,
        shift: DVec2::ZERO,
        pixel_aspect: 1.0,
    },
    zoom: 1.0,
    width: 1,
    height: 1,
    frame: 1,
};

/// The light at a place of a line by closed form.
fn light(cell: &Cell, ball: &Ball, toward: DVec3, exponent: f64, x: f64, y: f64) -> f64 {
    let ray = ray(cell, x, y);
    let (along, ray_sq) = (ray.dot(ball.center), ray.length_squared());
    let across = ray.cross(ball.center).length_squared();
    let root = (ray_sq * ball.radius * ball.radius - across)
        .max(0.0)
        .sqrt();
    let t = ball.outside / (along + root);
    let normal = (ray * t - ball.center) / ball.radius;
    libm::pow(normal.dot(toward).max(0.0), exponent)
}

/// The light along a line from its start to its end: midpoints that are dense towards both ends, and towards
/// the places where light begins.
pub(in super::super) fn brute(light: impl Fn(f64) -> f64, start: f64, end: f64) -> f64 {
    const LOOKS: u32 = 4000;
    const STEPS: u32 = 4000;
    let at = |share: f64| start + (end - start) * share;
    let mut stops = vec![start];
    for look in 0..LOOKS {
        let [one, other] = [look, look + 1].map(|look| at(f64::from(look) / f64::from(LOOKS)));
        let (is_lit, is_lit_after) = (light(one) > 0.0, light(other) > 0.0);
        if is_lit == is_lit_after {
            continue;
        }
        let (mut one, mut other) = (one, other);
        for _ in 0..60 {
            let middle = 0.5 * (one + other);
            if (light(middle) > 0.0) == is_lit {
                one = middle;
            } else {
                other = middle;
            }
        }
        stops.push(0.5 * (one + other));
    }
    stops.push(end);
    let mut sum = 0.0;
    for pair in stops.windows(2) {
        for step in 0..STEPS {
            // s³ (10 − 15 s + 6 s²), whose slope is 30 s² (1 − s)².
            let s = (f64::from(step) + 0.5) / f64::from(STEPS);
            let share = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
            let slope = 30.0 * s * s * (1.0 - s) * (1.0 - s);
            let x = pair[0] + (pair[1] - pair[0]) * share;
            sum += light(x) * slope * (pair[1] - pair[0]) / f64::from(STEPS);
        }
    }
    sum
}

#[test]
fn powers_are_summed_up_along_chords() {
    let mut random = Random(5);
    let (mut partly, mut chords) = (0, 0);
    let mut closest = 0.0_f64;
    for case in 0..100 {
        let exponent = [0.02, 0.1, 0.5, 0.9, 1.3, 2.6, 5.5][case % 7];
        let ball = ball_in_front(&mut random);
        let widths = magnitude(&mut random, 1e-2, 2.0);
        let mut cell = cell_at(&mut random, &ball, widths);
        cell.middle += direction(&mut random).with_z(0.0) * (0.9 * ball.radius / ball.center.z);
        let discriminant = silhouette(&cell, &ball);
        // Its terminator passes near the middle of the cell.
        let mut toward = direction(&mut random);
        if let Some(point) = first_hit(ray(&cell, 0.0, 0.0), &ball) {
            let normal = (point - ball.center) / ball.radius;
            let aside = 0.5 * random.number() * cell.size[0] * point.z / ball.radius;
            toward = (toward - normal * (toward.dot(normal) + aside)).normalize();
        }
        let mut world = World::new();
        let material = world.add_material(Material {
            exponent,
            ..Material::MATTE_WHITE
        });
        world.add_sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap(), material);
        let visibility = Visibility::new(&world);
        let mut scene = InCamera::new(&world, &visibility, &VIEW, Channels::Grey, 0);
        let (right, up) = toward.any_orthonormal_pair();
        scene.lights.push(Light {
            index: 0,
            intensity: Color::ONE,
            toward,
            right,
            up,
            near: None,
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
            terminators: 1,
            cutoffs: 0,
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
            let sum = sender.fractional(simd, &chord, &lines, &mut None);
            [sum.light[0], sum.doubt, reference.at(lines.y)].map(<[f64; 8]>::from)
        });
        for (lane, (end, y)) in lines.into_iter().enumerate().take(count) {
            let start = found[2][lane];
            let light = |x: f64| light(&cell, &ball, toward, exponent, x, y);
            let exact = brute(light, start, end);
            let (off, doubt) = ((found[0][lane] - exact).abs(), found[1][lane]);
            assert!(
                off <= doubt + 1e-8,
                "{exponent} {off:e} {doubt:e} {cell:?} {ball:?} {toward}"
            );
            closest = closest.max(doubt);
            chords += 1;
            partly += usize::from((light(start) > 0.0) != (light(end) > 0.0));
        }
    }
    assert!(chords > 200 && partly > 30, "{chords} {partly}");
    assert!(closest < 1e-7, "{closest}");
}
