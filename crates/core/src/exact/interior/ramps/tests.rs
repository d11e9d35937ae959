use glam::{DVec2, DVec3};

use crate::exact::only_pixel::only_pixel;
use crate::model::camera::{Camera, Lens};
use crate::model::color::Color;
use crate::model::light::Light;
use crate::model::material::Material;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::angle::Angle;
use crate::picture::pixel::{Evidence, Pixel};
use crate::search::tests::{Random, aspect};

/// A white ball, a light along its surface in or beside the middle of the only pixel, and that pixel.
struct Place {
    world: World,
    view: View,
    sphere: Sphere,
    toward: DVec3,
}

impl Place {
    /// None where the middle does not see the ball.
    fn new(random: &mut Random, is_parallel: bool) -> Option<Self> {
        let mut log = |low: f64, high: f64| libm::pow(10.0, low + (high - low) * random.number());
        let (radius, far, size) = (log(-1.0, 2.0), log(0.1, 1.5), log(-3.0, -0.5));
        let middle = DVec2::new(random.number() - 0.5, random.number() - 0.5);
        let aside = random.point().truncate() * radius;
        let mut center = (aside + middle * radius * far).extend(radius * far);
        let mut of_pixel = size;
        let (origin, direction) = if is_parallel {
            center = aside.extend(radius * far);
            of_pixel *= radius;
            (DVec3::ZERO, DVec3::Z)
        } else {
            (DVec3::ZERO, middle.extend(1.0))
        };
        let shift = if is_parallel { DVec2::ZERO } else { middle };
        let sphere = Sphere::new(center, radius).unwrap();
        let normal = sphere.hit(&Ray { origin, direction })?.normal;
        let lift = (random.number() - 0.5) * size;
        let toward = (normal.cross(random.point()).normalize() + normal * lift).normalize();
        let mut world = World::new();
        let white = world.add_material(Material::MATTE_WHITE);
        world.add_sphere(sphere, white);
        let light = Light::directional(toward, Color::splat(0.75)).unwrap();
        world.lights.push(light);
        let view = View {
            camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
            lens: Lens {
                width: of_pixel,
                distance: if is_parallel { f64::INFINITY } else { 1.0 },
                shift,
                pixel_aspect: aspect(random),
            },
            zoom: 1.0,
            width: 1,
            height: 1,
            frame: 1,
        };
        Some(Self {
            world,
            view,
            sphere,
            toward,
        })
    }

    fn pixel(&self, tolerance: f64) -> Pixel {
        only_pixel(&self.world, &self.view, tolerance)
    }

    /// The average light over many points, and how far that may be off: of a kink in some of the cells around points.
    fn average(&self) -> [f64; 2] {
        const SIDE: u32 = 400;
        let lens = self.view.lens;
        let height = lens.width / lens.pixel_aspect;
        let place = |index: u32| (f64::from(index) + 0.5) / f64::from(SIDE) - 0.5;
        let (mut sum, mut least, mut most) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
        for row in 0..SIDE {
            for col in 0..SIDE {
                let at = lens.shift + DVec2::new(place(col) * lens.width, place(row) * height);
                let ray = match lens.distance.is_finite() {
                    true => Ray {
                        origin: DVec3::ZERO,
                        direction: at.extend(1.0),
                    },
                    false => Ray {
                        origin: at.extend(0.0),
                        direction: DVec3::Z,
                    },
                };
                let cosine = self.sphere.hit(&ray).unwrap().normal.dot(self.toward);
                (least, most) = (cosine.min(least), cosine.max(most));
                sum += cosine.max(0.0);
            }
        }
        let count = f64::from(SIDE) * f64::from(SIDE);
        [0.75 * sum / count, (most - least) / count]
    }
}

#[test]
fn ramps_are_within_their_bounds() {
    let mut random = Random(29);
    for is_parallel in [false, true] {
        let (mut proved, mut largest) = (0, 0.0_f64);
        while proved < 60 {
            let Some(place) = Place::new(&mut random, is_parallel) else {
                continue;
            };
            let pixel = place.pixel(0.05);
            if pixel.alpha < 1.0 || pixel.evidence == Evidence::Estimate {
                continue;
            }
            proved += 1;
            let [average, slack] = place.average();
            let off = (pixel.value.x - average).abs();
            assert!(off <= pixel.error + slack, "{off:e} {:e}", pixel.error);
            largest = largest.max((off - slack) / pixel.error);
        }
        // Not by claiming much more than is wrong.
        assert!(largest > 0.02, "{largest}");
    }
}
