use std::num::NonZeroU32;

use glam::{DVec2, DVec3, Vec3};

use super::*;
use crate::model::camera::{Camera, Lens};
use crate::model::material::Material;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::angle::Angle;
use crate::picture::image::Image;
use crate::picture::pixel::Method;
use crate::render::renderer::Renderer;
use crate::render::settings::Settings;
use crate::search::hierarchy::Hierarchy;

/// Numbers from −1 to 1.
fn numbers() -> impl FnMut() -> f64 {
    let mut state = 7_u64;
    move || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 11) as f64 * 2_f64.powi(-52) - 1.0
    }
}

/// Small spheres in a cube around a point, some of which cut each other, and a floor below.
fn crowd(count: usize, middle: DVec3) -> Vec<Sphere> {
    let mut next = numbers();
    let mut spheres: Vec<Sphere> = (0..count)
        .map(|_| {
            let center = middle + DVec3::new(next(), next(), next()) * 10.0;
            Sphere::new(center, 0.3 + 0.2 * next()).unwrap()
        })
        .collect();
    let floor = middle - DVec3::Y * (1e5 + 10.5);
    spheres.push(Sphere::new(floor, 1e5).unwrap());
    spheres
}

#[test]
fn rays_along_an_axis_find_what_is_far() {
    // So many spheres around the first one that those far above are not among its surroundings.
    let mut spheres = crowd(6000, DVec3::ZERO);
    spheres.insert(0, Sphere::new(DVec3::Y * 11.0, 0.1).unwrap());
    spheres.push(Sphere::new(DVec3::new(0.0, 1e4, 0.0), 1.0).unwrap());
    let occluders = Occluders {
        spheres: &spheres,
        hierarchy: &Hierarchy::new(&spheres),
    };
    let around = Surroundings::new(0, &occluders);
    for direction in [Vec3::Y, Vec3::new(-0.0, 1.0, -0.0), Vec3::Z] {
        let normal = direction;
        let ray = FromSurface { normal, direction };
        let stops = around.stops(Level::new(), &ray, 0, &occluders);
        assert_eq!(stops, direction.y == 1.0, "{direction}");
    }
}

#[test]
fn surroundings_stop_the_rays_that_meet_any_sphere() {
    let spheres = crowd(4000, DVec3::new(300.0, -20.0, 4.0));
    let occluders = Occluders {
        spheres: &spheres,
        hierarchy: &Hierarchy::new(&spheres),
    };
    let level = Level::new();
    let mut next = numbers();
    let mut stopped = [0; 2];
    for own in 0..40 {
        let around = Surroundings::new(own, &occluders);
        let sphere = &spheres[own];
        for _ in 0..250 {
            let mut unit = || DVec3::new(next(), next(), next()).normalize().as_vec3();
            let (normal, mut direction) = (unit(), unit());
            if direction.dot(normal) < 0.0 {
                direction = -direction;
            }
            let ray = FromSurface { normal, direction };
            let origin = sphere.center() + normal.as_dvec3() * sphere.radius();
            // By how much of its radius a ray passes inside of a sphere, at most.
            let mut deepest = f64::NEG_INFINITY;
            let mut is_inside = false;
            for (index, other) in spheres.iter().enumerate() {
                if index == own || !occluders.may_hide(index, own) {
                    continue;
                }
                let to_center = other.center() - origin;
                let direction = direction.as_dvec3().normalize();
                is_inside |= to_center.length() < other.radius();
                if to_center.dot(direction) > 0.0 {
                    let aside = to_center.cross(direction).length();
                    deepest = deepest.max(1.0 - aside / other.radius());
                }
            }
            // What is inside of a sphere is not seen, and single precision does not tell how a ray passes a surface.
            if is_inside || deepest.abs() < 1e-4 {
                continue;
            }
            let stops = around.stops(level, &ray, own, &occluders);
            assert_eq!(stops, deepest > 0.0, "{own} {normal} {direction}");
            stopped[usize::from(stops)] += 1;
        }
    }
    // Both happen often.
    assert!(stopped.iter().all(|&count| count > 1000), "{stopped:?}");
}

fn picture(world: &World, method: Method) -> Image {
    let lens = Lens {
        width: 1.0,
        distance: 1.0,
        shift: DVec2::ZERO,
        pixel_aspect: 1.0,
    };
    let camera = Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO);
    let settings = Settings {
        method,
        alpha: false,
    };
    Renderer::new(world).render(&View::new(camera, lens, 14, 14), &settings)
}

/// Pixels of a crowd under a sky in halves against exact light at regular places.
#[test]
fn rays_have_the_mean_of_exact_light() {
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    for sphere in crowd(1500, DVec3::Z * 40.0) {
        world.add_sphere(sphere, white);
    }
    let [above, below] = [DVec3::new(1.0, 0.75, 0.5), DVec3::new(0.25, 0.5, 0.75)];
    world.sky = Some(Sky::in_halves(above, below, DVec3::new(0.3, 1.0, -0.4)).unwrap());
    const SIDE: u32 = 5;
    let exact = picture(&world, Method::Samples(NonZeroU32::new(SIDE).unwrap()));
    let by_rays = picture(&world, Method::Tolerance(0.05));
    let (mut sum, mut squares, mut lit) = (DVec3::ZERO, 0.0, 0);
    for row in 0..14 {
        for col in 0..14 {
            let light = |image: &Image| {
                let [red, green, blue, _] = image.rgba(col, row);
                DVec3::new(red, green, blue)
            };
            let (exact, found) = (light(&exact), light(&by_rays));
            let error = found - exact;
            sum += error;
            squares += error.abs().max_element().powi(2);
            lit += u32::from(exact != DVec3::ZERO);
            assert!(by_rays.error(col, row) <= 0.05);
        }
    }
    let count = f64::from(lit);
    let [mean, deviation] = [(sum / count).abs().max_element(), (squares / count).sqrt()];
    // 25 places are off by some 0.02, and rays by a tenth of their claims.
    assert!(lit > 100 && deviation < 0.03, "{lit} {deviation}");
    assert!(mean < 3e-3, "{mean}");
    // Patches would compute light at fewer places.
    assert!(
        by_rays.work().samples > 14 * 14 * 64,
        "{:?}",
        by_rays.work()
    );
}
