//! A pixel that a ball fills, and its average in 256-bit arithmetic.

use glam::{DVec2, DVec3};

use super::fixed::{Fixed, dot};
use crate::exact::only_pixel::only_pixel;
use crate::model::camera::{Camera, Lens};
use crate::model::color::Color;
use crate::model::light::Light;
use crate::model::material::{Highlight, Material};
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::angle::Angle;
use crate::picture::pixel::Pixel;
use crate::search::tests::Random;

/// Powers of cosines: whole exponents, and such with a half.
const EXPONENTS: [f64; 8] = [1.0, 1.0, 1.0, 2.0, 3.0, 0.5, 1.5, 7.0];

/// A ball before an eye at the origin, a pixel, and a light.
#[derive(Debug)]
pub(super) struct Place {
    center: DVec3,
    radius: f64,
    /// The middle of the pixel on the retina at distance 1, and its side.
    middle: DVec2,
    size: f64,
    toward: DVec3,
    exponent: f64,
    highlight: Option<(f64, u32)>,
    tolerance: f64,
    is_parallel: bool,
}

impl Place {
    /// One that is rendered to a tolerance between these powers of 10.
    pub(super) fn new(random: &mut Random, tolerances: [f64; 2]) -> Self {
        let mut log = |low: f64, high: f64| libm::pow(10.0, low + (high - low) * random.number());
        // How near to the contour, how large a pixel beside what is left, how far the eye from the surface.
        let graze = log(-5.0, 0.0);
        let size = log(-3.0, 0.3);
        let (radius, above) = (log(-3.0, 6.0), log(-4.5, 4.0));
        let tolerance = log(tolerances[0], tolerances[1]);
        let distance = radius * (1.0 + above);
        let widest = libm::asin(1.0 / (1.0 + above));
        let angle = widest * (1.0 - graze);
        // The ray, and the center at an angle to it.
        let ray = DVec3::new(
            2.0 * random.number() - 1.0,
            2.0 * random.number() - 1.0,
            1.0,
        );
        let (right, up) = ray.normalize().any_orthonormal_pair();
        let turn = std::f64::consts::TAU * random.number();
        let aside = right * libm::cos(turn) + up * libm::sin(turn);
        let center = ray.normalize() * libm::cos(angle) + aside * libm::sin(angle);
        let which = |count: usize, random: &mut Random| (random.number() * count as f64) as usize;
        let has_highlight = random.number() < 0.4;
        Self {
            center: center * distance,
            radius,
            middle: ray.truncate(),
            size: (size * (widest - angle)).min(0.5),
            toward: random.point() - ray * 0.3,
            exponent: EXPONENTS[which(EXPONENTS.len(), random)],
            highlight: has_highlight.then(|| (random.number(), 1 << which(9, random))),
            tolerance,
            is_parallel: false,
        }
    }

    /// One that parallel rays see.
    pub(super) fn of_parallel_rays(random: &mut Random, tolerances: [f64; 2]) -> Self {
        let place = Self::new(random, tolerances);
        let mut log = |low: f64, high: f64| libm::pow(10.0, low + (high - low) * random.number());
        let (graze, size) = (log(-5.0, 0.0), log(-3.0, 0.3));
        let (radius, far) = (log(-3.0, 3.0), log(-4.5, 4.0));
        let turn = std::f64::consts::TAU * random.number();
        let aside = DVec2::new(libm::cos(turn), libm::sin(turn)) * (radius * (1.0 - graze));
        let middle = place.middle * (radius * far);
        Self {
            center: (middle - aside).extend(radius * (1.0 + far)),
            radius,
            middle,
            size: size * graze * radius,
            is_parallel: true,
            ..place
        }
    }

    /// The pixel as it is rendered.
    pub(super) fn pixel(&self) -> Pixel {
        let mut world = World::new();
        let highlight = self.highlight.map(|(strength, shininess)| Highlight {
            strength,
            shininess: f64::from(shininess),
        });
        let material = world.add_material(Material {
            exponent: self.exponent,
            highlight,
            ..Material::MATTE_WHITE
        });
        world.add_sphere(Sphere::new(self.center, self.radius).unwrap(), material);
        let light = Light::directional(self.toward, Color::ONE).unwrap();
        world.lights.push(light);
        let view = View {
            camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
            lens: Lens {
                width: self.size,
                distance: if self.is_parallel { f64::INFINITY } else { 1.0 },
                shift: self.middle,
                pixel_aspect: 1.0,
            },
            zoom: 1.0,
            width: 1,
            height: 1,
            frame: 1,
        };
        only_pixel(&world, &view, self.tolerance)
    }

    /// Whether the ball faces the light in the middle of the pixel, in its corners and in the middles of its sides.
    pub(super) fn is_lit(&self) -> bool {
        let sphere = Sphere::new(self.center, self.radius).unwrap();
        let is_lit = |u: f64, v: f64| {
            let at = self.middle + DVec2::new(u, v) * self.size;
            let ray = if self.is_parallel {
                Ray {
                    origin: at.extend(0.0),
                    direction: DVec3::Z,
                }
            } else {
                Ray {
                    origin: DVec3::ZERO,
                    direction: at.extend(1.0),
                }
            };
            let hit = sphere.hit(&ray);
            hit.is_some_and(|hit| hit.normal.dot(self.toward) > 0.0)
        };
        let places = [-0.5, 0.0, 0.5];
        places.iter().all(|&v| places.iter().all(|&u| is_lit(u, v)))
    }

    /// The distance of a number from the average.
    pub(super) fn distance_from_average(&self, nodes: &[(Fixed, Fixed)], value: f64) -> f64 {
        let toward = self.toward.to_array().map(Fixed::new);
        let length = dot(&toward, &toward).sqrt();
        let toward = toward.map(|component| &component / &length);
        let (size, x, y) = (
            Fixed::new(self.size),
            Fixed::new(self.middle.x),
            Fixed::new(self.middle.y),
        );
        let mut sum = Fixed::new(0.0);
        for (v, of_row) in nodes {
            for (u, of_col) in nodes {
                let ray = [&x + &(&size * u), &y + &(&size * v), Fixed::new(1.0)];
                let light = self.light(&ray, &toward);
                sum = &sum + &(&light * &(of_row * of_col));
            }
        }
        (&sum - &Fixed::new(value)).to_f64().abs()
    }

    /// The light that a ray meets.
    fn light(&self, ray: &[Fixed; 3], toward: &[Fixed; 3]) -> Fixed {
        if self.is_parallel {
            return self.light_of(&self.parallel_normal(ray), &Fixed::axis(), toward);
        }
        let center = self.center.to_array().map(Fixed::new);
        let radius = Fixed::new(self.radius);
        let ray_sq = dot(ray, ray);
        let along = dot(ray, &center);
        let outside = &dot(&center, &center) - &(&radius * &radius);
        let root = (&(&along * &along) - &(&ray_sq * &outside)).sqrt();
        let t = &outside / &(&along + &root);
        let normal = |axis: usize| &(&(&t * &ray[axis]) - &center[axis]) / &radius;
        let normal = [normal(0), normal(1), normal(2)];
        self.light_of(&normal, ray, toward)
    }

    /// The normal that a parallel ray meets.
    fn parallel_normal(&self, ray: &[Fixed; 3]) -> [Fixed; 3] {
        let center = self.center.to_array().map(Fixed::new);
        let radius = Fixed::new(self.radius);
        let (a, b) = (&ray[0] - &center[0], &ray[1] - &center[1]);
        let square = &(&(&radius * &radius) - &(&a * &a)) - &(&b * &b);
        let depth = &Fixed::new(0.0) - &square.sqrt();
        [&a / &radius, &b / &radius, &depth / &radius]
    }

    /// The light of a point with this normal, seen along a direction.
    fn light_of(&self, normal: &[Fixed; 3], ray: &[Fixed; 3], toward: &[Fixed; 3]) -> Fixed {
        let cosine = dot(normal, toward);
        let mut light = cosine.powi(self.exponent as u32);
        if self.exponent.fract() != 0.0 {
            light = &light * &cosine.sqrt();
        }
        if let Some((strength, shininess)) = self.highlight {
            let length = dot(ray, ray).sqrt();
            let half = |axis: usize| &toward[axis] - &(&ray[axis] / &length);
            let half = [half(0), half(1), half(2)];
            let cosine = &dot(normal, &half) / &dot(&half, &half).sqrt();
            let highlight = &Fixed::new(strength) * &cosine.powi(shininess);
            light = &light + &highlight;
        }
        light
    }
}
