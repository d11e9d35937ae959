//! Scenes in which hits are difficult.

use glam::{DVec2, DVec3};
use marbles_core::{Angle, Camera, Color, Lens, Material, Sphere, View, World};
use marbles_tests::hits::families::Random;

/// Columns and rows of each picture. They are odd, so that some rays are in planes of the axes.
pub(super) const SIDE: u32 = 51;

/// A world of luminous spheres, each with its own color.
fn world(spheres: &[(DVec3, f64)]) -> World {
    let mut world = World::new();
    world.ambient = Color::ONE;
    for (index, &(center, radius)) in (1_u32..).zip(spheres) {
        let albedo = Color::new(f64::from(index), 0.5, 1.0 / f64::from(index));
        let material = world.add_material(Material {
            albedo,
            ..Material::MATTE_WHITE
        });
        world.add_sphere(Sphere::new(center, radius).unwrap(), material);
    }
    world
}

/// A view with a retina of this width at the distance 1.
pub(super) fn view(position: DVec3, [pan, tilt, roll]: [f64; 3], width: f64) -> View {
    let [pan, tilt, roll] = [pan, tilt, roll].map(Angle::from_degrees);
    View {
        camera: Camera::free(position, pan, tilt, roll),
        lens: Lens {
            width,
            distance: 0.7,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0 / 0.7,
        width: SIDE,
        height: SIDE,
        frame: 1,
    }
}

/// A floor with a radius of 1e9 and balls on it, seen straight and at an angle.
fn floors() -> Vec<(World, View)> {
    let mut spheres = vec![(DVec3::Y * -(1e9 + 1.0), 1e9)];
    spheres.extend([-3.0, 0.0, 2.5].map(|x| (DVec3::new(x, -0.5, 8.0 + x), 0.5)));
    vec![
        (world(&spheres), view(DVec3::ZERO, [0.0; 3], 1.4)),
        (
            world(&spheres),
            view(DVec3::new(40.0, 3.0, -7.0), [-60.0, -9.0, 4.0], 1.0),
        ),
    ]
}

/// Spheres with radii of about 1e-6, near the center of a turned view, one behind the other.
fn tiny() -> Vec<(World, View)> {
    let position = DVec3::new(3.0, -4.0, 5.0);
    let seen = view(position, [31.0, 12.0, -7.0], 1.2e-5);
    let mut random = Random::new(17);
    let spheres = (0..12).map(|_| {
        let center = position + seen.camera.forward() + random.in_cube(5e-6);
        (center, random.between(5e-7, 3e-6))
    });
    let spheres: Vec<(DVec3, f64)> = spheres.collect();
    vec![(world(&spheres), seen)]
}

/// Distant spheres that intersect, two of them identical, and a dome around everything.
fn crowd() -> Vec<(World, View)> {
    let position = DVec3::new(-20.0, 1.0, 3.0);
    let seen = view(position, [-140.0, 20.0, 0.0], 0.4);
    let mut random = Random::new(4);
    let mut spheres = Vec::new();
    for _ in 0..9 {
        let center = position + seen.camera.forward() * 10.0 + random.in_cube(1.2);
        spheres.push((center, random.between(0.3, 0.8)));
    }
    spheres.extend([spheres[3], (DVec3::ZERO, 60.0)]);
    let far = spheres.iter().map(|&(center, radius)| {
        let from = center - position;
        (position + from * 1e7, radius * 1e7)
    });
    let far: Vec<_> = far.take(9).collect();
    vec![(world(&spheres), seen), (world(&far), seen)]
}

/// Spheres that the central ray touches, and a sphere whose surface contains the viewpoint.
fn touching() -> Vec<(World, View)> {
    let ahead = view(DVec3::ZERO, [0.0; 3], 0.5);
    let tangent = [(DVec3::new(0.0, 1.0, 5.0), 1.0), (DVec3::Z * 9.0, 2.0)];
    let around = [(DVec3::Z * 2.0, 2.0), (DVec3::new(0.0, 0.2, 3.0), 0.2)];
    vec![(world(&tangent), ahead), (world(&around), ahead)]
}

/// Similar scenes through parallel lenses: a floor, tiny spheres, a crowd, and spheres cut by the plane.
fn parallel() -> Vec<(World, View)> {
    let through = |(world, view): (World, View), width: f64| {
        let lens = Lens::parallel(width, DVec2::new(0.1 * width, 0.0));
        (world, View { lens, ..view })
    };
    let [floor, aside] = floors().try_into().ok().unwrap();
    let [tiny] = tiny().try_into().ok().unwrap();
    let [crowd, far] = crowd().try_into().ok().unwrap();
    let cut = [
        (DVec3::new(0.1, 0.0, 0.3), 1.0),
        (DVec3::new(-0.3, 0.2, -0.4), 0.8),
    ];
    vec![
        through(floor, 8.0),
        through(aside, 30.0),
        through(tiny, 1.7e-5),
        through(crowd, 6.0),
        through(far, 6e7),
        through(
            (world(&cut), view(DVec3::ZERO, [10.0, 20.0, 30.0], 1.0)),
            4.0,
        ),
    ]
}

/// All scenes, with names.
pub(super) fn scenes() -> Vec<(&'static str, World, View)> {
    let named = [
        ("parallel", parallel()),
        ("floor", floors()),
        ("tiny", tiny()),
        ("crowd", crowd()),
        ("touching", touching()),
    ];
    let named = named.into_iter();
    named
        .flat_map(|(name, some)| {
            some.into_iter()
                .map(move |(world, view)| (name, world, view))
        })
        .collect()
}
