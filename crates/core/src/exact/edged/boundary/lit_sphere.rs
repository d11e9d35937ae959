//! Spheres whose light is summed up along chords, and held against closed forms: for tests.

use fearless_simd::{Level, dispatch};
use glam::{DMat3, DVec2, DVec3};

use super::chord::{Chord, Reference};
use super::power_rules::PowerRules;
use super::primitive::{Lines, Sender};
use crate::edges::cell::{Ball, Cell};
use crate::edges::silhouette::silhouette;
use crate::edges::tests::{ray, value};
use crate::exact::classify::active::{Active, Terminators};
use crate::exact::scene::{InCamera, Light};
use crate::exact::surface::Finish;
use crate::light::near_light::NearLight;
use crate::model::camera::{Camera, Lens};
use crate::model::color::Color;
use crate::model::material::Material;
use crate::model::roughness::PixelKey;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::lanes::f64x8;
use crate::numeric::pair::both;
use crate::picture::image::Channels;
use crate::search::visibility::Visibility;

const VIEW: View = View {
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

/// A sphere of which eight lines of a cell see chords.
pub(super) struct LitSphere {
    pub(super) cell: Cell,
    pub(super) ball: Ball,
    /// That of its diffuse light.
    pub(super) exponent: f64,
    /// The direction toward the light, and its place.
    pub(super) toward: DVec3,
    pub(super) near: Option<NearLight>,
    /// Whether light is summed up to the right ends of chords, and not to the left ones.
    pub(super) is_to_right: bool,
}

/// The light along chords.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Checked {
    pub(super) chords: usize,
    /// The chords of which one end is lit.
    pub(super) partly: usize,
    /// The largest doubt.
    pub(super) doubt: f64,
}

impl LitSphere {
    /// The point of the sphere on the ray through a place of the cell.
    pub(super) fn point(&self, x: f64, y: f64) -> DVec3 {
        let (ball, ray) = (&self.ball, ray(&self.cell, x, y));
        let (along, ray_sq) = (ray.dot(ball.center), ray.length_squared());
        let across = ray.cross(ball.center).length_squared();
        let root = (ray_sq * ball.radius * ball.radius - across)
            .max(0.0)
            .sqrt();
        ray * (ball.outside / (along + root))
    }

    /// Holds the light along chords against what it is at their points; the light ends at its cutoff where `is_cut_off`.
    pub(super) fn check(&self, is_cut_off: bool, light: impl Fn(DVec3) -> f64) -> Checked {
        let Self {
            cell,
            ball,
            exponent,
            ..
        } = *self;
        let discriminant = silhouette(&cell, &ball);
        let mut lines = Vec::new();
        for lane in 0..8 {
            let y = 0.11 * f64::from(lane) - 0.4;
            let [one, other] = discriminant.crossings(y);
            let (left, right) = (one.min(other).max(-0.5), one.max(other).min(0.5));
            let is_seen = value(&discriminant, 0.5 * (left + right), y).0 > 0.0;
            if left < right && is_seen && ball.outside > 0.0 {
                lines.push((if self.is_to_right { right } else { left }, y));
            }
        }
        let mut checked = Checked::default();
        let Some(last) = lines.last().copied() else {
            return checked;
        };
        let count = lines.len();
        lines.resize(8, last);
        let mut world = World::new();
        let material = world.add_material(Material {
            exponent,
            ..Material::MATTE_WHITE
        });
        world.add_sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap(), material);
        let visibility = Visibility::new(&world);
        let mut scene = InCamera::new(&world, &visibility, &VIEW, Channels::Grey, 0);
        let (right, up) = self.toward.any_orthonormal_pair();
        scene.lights.push(Light {
            index: 0,
            intensity: Color::ONE,
            toward: self.toward,
            right,
            up,
            near: self.near,
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
            cutoffs: u64::from(is_cut_off),
            rules: &rules,
            tolerance: 1e-6,
        };
        let [sums, doubts, starts] = dispatch!(Level::new(), simd => {
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
            let sum = match is_cut_off {
                true => sender.cut_off(simd, &chord, &lines, &mut None),
                false => sender.fractional(simd, &chord, &lines, &mut None),
            };
            [sum.light[0], sum.doubt, reference.at(lines.y)].map(<[f64; 8]>::from)
        });
        for (lane, (end, y)) in lines.into_iter().enumerate().take(count) {
            let start = starts[lane];
            let light = |x: f64| light(self.point(x, y));
            let exact = brute(light, start, end);
            let (off, doubt) = ((sums[lane] - exact).abs(), doubts[lane]);
            assert!(
                off <= doubt + 1e-8,
                "{exponent} {off:e} {doubt:e} {cell:?} {ball:?} {} {:?}",
                self.toward,
                self.near
            );
            checked.doubt = checked.doubt.max(doubt);
            checked.chords += 1;
            checked.partly += usize::from((light(start) > 0.0) != (light(end) > 0.0));
        }
        checked
    }
}

impl Checked {
    pub(super) fn add(&mut self, other: Self) {
        self.chords += other.chords;
        self.partly += other.partly;
        self.doubt = self.doubt.max(other.doubt);
    }
}

/// The light along a line from its start to its end: midpoints that are dense towards both ends, and towards
/// the places where light begins.
fn brute(light: impl Fn(f64) -> f64, start: f64, end: f64) -> f64 {
    const LOOKS: u32 = 4000;
    const STEPS: u32 = 4000;
    let at = |share: f64| start + (end - start) * share;
    let mut stops = vec![start];
    for look in 0..LOOKS {
        let [one, other] = both([look, look + 1], |look| {
            at(f64::from(look) / f64::from(LOOKS))
        });
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
