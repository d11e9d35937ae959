//! Points side by side are in the shadow that single points are in.

use fearless_simd::{Level, dispatch};

use super::*;
use crate::model::color::Color;
use crate::model::light::Light;
use crate::model::material::Material;
use crate::model::world::World;
use crate::numeric::lanes::f64x8;
use crate::search::light_grid::Found;
use crate::search::tests::Random;

const SCALE: Scale = Scale {
    length: 1.0,
    tile_side: 0.1,
    projection: Projection::Central,
    are_samples_dense: true,
};

/// Points on the first of a world's spheres, the first light, and how far they are off; counts what is known above the
/// whole sphere.
fn agrees(world: &World, points: [DVec3; 8], error: f64, known: &mut usize) -> u64 {
    let visibility = Visibility::new(world);
    visibility.expect_rows(u64::MAX);
    let Light::Directional(light) = &world.lights[0] else {
        panic!("a directional light");
    };
    let is_dark = |&lane: &usize| {
        let to_light = Ray {
            origin: points[lane],
            direction: light.toward(),
        };
        visibility.is_blocked(0, &to_light, error, 0)
    };
    let expected = set_bits(0xff_u64)
        .filter(is_dark)
        .fold(0, |dark, lane| dark | 1 << lane);
    let (right, up) = visibility.light(0).axes();
    let found = dispatch!(Level::new(), simd => {
        let mut vectors = Vectors::splat(simd, DVec3::ZERO);
        for (lane, point) in points.into_iter().enumerate() {
            vectors.set_lane(lane, point);
        }
        let lit = LitPoints {
            points: vectors,
            errors: f64x8::splat(simd, error),
            right: vectors.dot_one(right),
            up: vectors.dot_one(up),
        };
        let mut above = Vec::new();
        if let Some(grid) = visibility.light(0).grid()
            && grid.discs_before(world.spheres(), 0, &mut Found::default(), &mut above)
        {
            *known += 1;
            let found = darkened(simd, &visibility, (&lit, light), &above, 0xff);
            assert_eq!(found, expected, "above the whole sphere");
        }
        let mut cells = ShadowCells::default();
        for (lane, &point) in points.iter().enumerate() {
            let center = world.spheres()[0].center();
            let (sphere, side) = (0, 1.0);
            let asked = SurfacePoint { point, error, sphere, center, side };
            let is_dark = cells.is_blocked(&visibility, 0, &asked);
            assert_eq!(is_dark, expected >> lane & 1 == 1, "alone");
        }
        let mut shadows = Shadows::new(&visibility, DVec3::ZERO, SCALE, &mut cells);
        let discs = match visibility.light(0).of_sphere(0) {
            Some(discs) => discs,
            None => shadows.discs_of_region(&lit, 0, 0, 0xff),
        };
        darkened(simd, &visibility, (&lit, light), discs, 0xff)
    });
    assert_eq!(found, expected);
    found
}

/// Occluders that barely reach the light of a point, or barely do not; few, and so many that regions
/// are looked up.
#[test]
fn occluders_that_nearly_touch_the_light() {
    let mut random = Random(21);
    let (mut dark, mut asked, mut known) = (0, 0, 0);
    for step in 0..600 {
        let mut world = World::new();
        let white = world.add_material(Material::MATTE_WHITE);
        let toward = random.point();
        world.lights.extend(Light::directional(toward, Color::ONE));
        let toward = world.lights[0].toward().unwrap();
        let (center, radius) = (random.point() * 3.0, 1.0 + random.number());
        world.add_sphere(Sphere::new(center, radius).unwrap(), white);
        if step % 2 == 0 {
            // It coincides, and darkens nothing that the sphere does not.
            world.add_sphere(Sphere::new(center, radius).unwrap(), white);
        }
        let points: [DVec3; 8] = std::array::from_fn(|lane| {
            // Two of them where the sphere turns away from the light.
            let aside = if lane < 6 { DVec3::ZERO } else { toward };
            let normal = random.point().normalize();
            let normal = (normal - aside * normal.dot(toward)).normalize();
            center + normal * (radius * normal.dot(toward).signum())
        });
        let occluders = if step % 3 == 0 { 200 } else { 8 };
        for number in 0..occluders {
            let point = points[number % 8];
            let aside = random.point().cross(toward).normalize();
            let size = libm::exp10(-2.0 + 2.0 * random.number());
            let place = point + toward * (size + 5.0 * random.number()) + aside * size;
            let across = (place - point).cross(toward).length();
            let radius = across * (1.0 + (random.number() * 5.0 - 2.5).round() * 1e-16);
            // Small ones leave some points in the light.
            let radius = if number < 8 { radius } else { 0.1 * radius };
            world.add_sphere(Sphere::new(place, radius).unwrap(), white);
        }
        // Cells need a crowd.
        for _ in 0..300 {
            let aside = random.point().cross(toward).normalize() * 20.0;
            world.add_sphere(Sphere::new(center + aside, 0.3).unwrap(), white);
        }
        let error = [0.0, 1e-15, 1e-12][step % 3];
        dark += agrees(&world, points, error, &mut known).count_ones();
        asked += 8;
    }
    assert!(
        dark > asked / 10 && dark < asked * 9 / 10,
        "{dark} of {asked}"
    );
    assert!(known > 50, "{known}");
}
