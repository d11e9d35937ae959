//! Smooth balls and floors with highlights in the large pixels of wide lenses, where the direction of view changes as
//! much as normals do, or more. Pixels are compared with the model's formula, integrated by a product rule.

use glam::{DVec2, DVec3};
use marbles_core::{Color, Highlight, Image, Light, Material, Sphere, View, World};
use marbles_tests::numbers::Numbers;

use crate::studio::{exact_picture, looking_forward, pixels};

const SIDE: u32 = 24;
const AMBIENT: f64 = 0.1;
const TOLERANCES: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-5];

/// Nodes and weights of Gauss's rule with five points on [−½, ½].
const GAUSS: [(f64, f64); 5] = [
    (-0.453_089_922_969_332, 0.118_463_442_528_094_54),
    (-0.269_234_655_052_841_55, 0.239_314_335_249_683_23),
    (0.0, 0.284_444_444_444_444_44),
    (0.269_234_655_052_841_55, 0.239_314_335_249_683_23),
    (0.453_089_922_969_332, 0.118_463_442_528_094_54),
];

/// A ball in front of a viewpoint at the origin that looks along z, and the sun.
#[derive(Debug)]
struct Place {
    center: DVec3,
    radius: f64,
    toward: DVec3,
    exponent: f64,
    strength: f64,
    shininess: f64,
    /// Half of the width of the picture at distance 1.
    half_width: f64,
}

/// The object that a ray hits.
#[derive(Clone, Copy)]
enum Met {
    /// The lit part of the ball, with this light.
    Lit(f64),
    Dark,
    Nothing,
}

impl Place {
    fn new(random: &mut Numbers) -> Self {
        let degrees: f64 = random.either(&[60.0, 120.0, 160.0, 170.0, 175.0, 178.0]);
        let log = |random: &mut Numbers, low, high| libm::pow(10.0, random.between(low, high));
        let ahead = |random: &mut Numbers, share| {
            let [x, y, z] = random.direction();
            DVec3::new(x, y, z.abs() * share).normalize()
        };
        // Balls, and floors of any size.
        let (away, radius) = if random.uniform() < 0.5 {
            let away = random.between(1.2, 3.5);
            (away, away * random.between(0.6, 0.97))
        } else {
            let radius = log(random, 0.0, 4.0);
            (radius + log(random, -2.0, 2.0), radius)
        };
        let direction = ahead(random, 0.7);
        let [x, y, z] = random.direction();
        Self {
            center: direction * away,
            radius,
            toward: DVec3::new(x, y, z.min(0.3)).normalize(),
            exponent: random.either(&[1.0, 1.0, 2.0, 3.0, 0.7]),
            strength: random.either(&[0.3, 1.0, 2.0]),
            shininess: random.either(&[1.0, 2.0, 5.0, 8.0, 20.0, 60.0, 300.0, 2000.0]),
            half_width: libm::tan(degrees.to_radians() * 0.5),
        }
    }

    fn view(&self) -> View {
        looking_forward(SIDE, SIDE, f64::from(SIDE) * 0.5 / self.half_width)
    }

    fn image(&self, tolerance: f64) -> Image {
        let mut world = World::new();
        let material = world.add_material(Material {
            exponent: self.exponent,
            highlight: Some(Highlight {
                strength: self.strength,
                shininess: self.shininess,
            }),
            ..Material::MATTE_WHITE
        });
        world.add_sphere(Sphere::new(self.center, self.radius).unwrap(), material);
        world.ambient = Color::splat(AMBIENT);
        world.shadows = false;
        world
            .lights
            .extend(Light::directional(self.toward, Color::ONE));
        exact_picture(&world, &self.view(), tolerance, false)
    }

    /// The formula of the model.
    fn light(&self, at: DVec2) -> Met {
        let ray = at.extend(1.0);
        let along = ray.dot(self.center);
        let outside = (self.center.length() - self.radius) * (self.center.length() + self.radius);
        let discriminant = along * along - ray.length_squared() * outside;
        if discriminant < 0.0 || along <= 0.0 {
            return Met::Nothing;
        }
        let t = outside / (along + discriminant.sqrt());
        let normal = (ray * t - self.center) / self.radius;
        let cosine = normal.dot(self.toward);
        if cosine <= 0.0 {
            return Met::Dark;
        }
        let half = (self.toward - ray.normalize()).normalize();
        let highlight = libm::pow(normal.dot(half).max(0.0), self.shininess);
        Met::Lit(AMBIENT + libm::pow(cosine, self.exponent) + self.strength * highlight)
    }

    /// The average over a square by `parts` × `parts` times 25 points, if all of it is lit.
    fn average(&self, middle: DVec2, side: f64, parts: u32) -> Option<f64> {
        let step = 1.0 / f64::from(parts);
        let place = |part: u32, node: f64| (f64::from(part) + 0.5 + node) * step - 0.5;
        let mut sum = 0.0;
        for (row, col) in (0..parts).flat_map(|row| (0..parts).map(move |col| (row, col))) {
            for (v, of_row) in GAUSS {
                for (u, of_col) in GAUSS {
                    let at = DVec2::new(place(col, u), place(row, v));
                    let Met::Lit(light) = self.light(middle + at * side) else {
                        return None;
                    };
                    sum += light * of_row * of_col;
                }
            }
        }
        Some(sum * step * step)
    }

    /// The average over a square, and its error, if all of it is lit and far enough from the end of the light.
    fn truth(&self, middle: DVec2, side: f64) -> Option<(f64, f64)> {
        const FARTHER: f64 = 1.1;
        self.average(middle, side * FARTHER, 4)?;
        let [coarse, fine] = [8, 16].map(|parts| self.average(middle, side, parts));
        let (coarse, fine) = (coarse?, fine?);
        // Near its silhouette double precision loses digits, too.
        Some((fine, (fine - coarse).abs() + 1e-10))
    }
}

#[test]
fn smooth_pixels_are_within_their_claims_though_the_view_turns() {
    const PLACES: usize = 40;
    let mut random = Numbers(48);
    let (mut asked, mut tight) = (0, [0; TOLERANCES.len()]);
    for _ in 0..PLACES {
        let place = Place::new(&mut random);
        let view = place.view();
        let side = view.pixel_size().x / view.magnification();
        let images = TOLERANCES.map(|tolerance| place.image(tolerance));
        for (col, row) in pixels(&images[0]) {
            let middle = view.cell_center(u64::from(col), u64::from(row), 1) / view.magnification();
            let Some((truth, doubt)) = place.truth(middle, side) else {
                continue;
            };
            asked += 1;
            for ((image, tolerance), tight) in images.iter().zip(TOLERANCES).zip(&mut tight) {
                let off = (image.rgba(col, row)[0] - truth).abs();
                let claimed = image.error(col, row);
                assert!(
                    off <= claimed + doubt,
                    "({col}, {row}) at {tolerance:e}: {off:e} {claimed:e} {doubt:e}: {place:?}"
                );
                *tight += usize::from(off > 0.1 * claimed);
            }
        }
    }
    assert!(asked > 3000, "{asked}");
    // Not by claiming much more than is wrong.
    assert!(tight.iter().all(|&tight| tight > 50), "{tight:?}");
}
