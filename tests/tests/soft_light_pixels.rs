//! The averages of soft light over pixels: the tests' own integrator, and the renderer compared with it.

use glam::{DVec3, DVec4};
use marbles_core::{
    Angle, Camera, DirectionalLight, Lens, Material, Method, Renderer, Settings, Sky, Sphere, View,
    World,
};
use marbles_tests::reference::Reference;
use rayon::prelude::*;

const WIDTH: u32 = 12;
const HEIGHT: u32 = 8;

fn view() -> View {
    let camera = Camera::look_at(DVec3::new(0.5, 2.0, -6.0), DVec3::ZERO, Angle::ZERO).unwrap();
    let lens = Lens::from_field_of_view(Angle::from_degrees(35.0)).unwrap();
    View::new(camera, lens, WIDTH, HEIGHT)
}

/// Three balls on a floor.
fn pile() -> World {
    let mut world = World::new();
    let grey = world.add_material(Material {
        albedo: DVec3::splat(0.5),
        ..Material::default()
    });
    for (center, radius) in [
        ([0.0, 0.0, 0.0], 1.0),
        ([1.3, -0.5, -0.4], 0.5),
        ([-1.2, -0.7, -0.8], 0.3),
        ([0.0, -1001.0, 0.0], 1000.0),
    ] {
        world.add_sphere(Sphere::new(center.into(), radius).unwrap(), grey);
    }
    world
}

/// The pile under a sun of some degrees.
fn under_sun(degrees: f64) -> World {
    let mut world = pile();
    let sun = DirectionalLight::new(DVec3::new(-1.0, 1.5, -1.0), DVec3::ONE).unwrap();
    let sun = sun.with_diameter(degrees.to_radians()).unwrap();
    world.lights.push(sun.into());
    world
}

/// The pile under a sky.
fn under_sky() -> World {
    let mut world = pile();
    let up = DVec3::new(0.3, 1.0, 0.2);
    world.sky = Some(Sky::in_halves(DVec3::ONE, DVec3::splat(0.2), up).unwrap());
    world
}

#[test]
fn a_ball_alone_under_a_sky_is_as_bright_as_it_covers() {
    let mut world = World::new();
    let white = world.add_material(Material::default());
    world.add_sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap(), white);
    world.sky = Some(Sky::uniform(DVec3::splat(0.5)));
    let albedo = world.albedo(0).x;
    let reference = Reference::new(&world, &view());
    for (col, row) in [(6, 4), (6, 2), (4, 3)] {
        let truth = reference.pixel(col, row);
        let expected = 0.5 * albedo * truth.value.w;
        assert!(
            (truth.value.x - expected).abs() <= truth.error,
            "{col} {row}: {truth:?}"
        );
        assert!(truth.error < 1e-6, "{col} {row}: {truth:?}");
    }
}

#[test]
fn midpoints_approach_the_averages() {
    let view = view();
    let midpoints_approach = |world: &World, (col, row), count: u32| {
        let reference = Reference::new(world, &view);
        let truth = reference.pixel(col, row);
        let points = reference.midpoints(col, row, count);
        let off = (truth.value - points).abs().max_element();
        // An edge that is as bright as a light makes the mean of points as rough as this.
        let rough = 2.0 / f64::from(count).powf(1.5);
        assert!(off < rough, "{col} {row}: {off:e} of {rough:e}");
        assert!(truth.error < 1e-6, "{col} {row}: {truth:?}");
    };
    // A shadow's border, a contact, and a contour.
    let places = [(7, 5), (5, 6), (4, 2)];
    for world in [under_sun(0.5), under_sun(20.0)] {
        let places = places.par_iter();
        places.for_each(|place| midpoints_approach(&world, *place, 64));
    }
    midpoints_approach(&under_sky(), (5, 6), 16);
}

#[test]
fn pixels_are_off_by_no_more_than_they_claim() {
    let worlds = [under_sun(0.1), under_sun(5.0), under_sun(60.0)];
    let view = view();
    let settings = Settings {
        method: Method::Tolerance(1e-3),
        alpha: true,
    };
    let compared: Vec<f64> = worlds
        .par_iter()
        .flat_map_iter(|world| {
            let image = Renderer::new(world).render(&view, &settings);
            let reference = Reference::new(world, &view);
            [(7, 5), (8, 6), (3, 5), (6, 3)].map(|(col, row)| {
                let truth = reference.pixel(col, row);
                let found = DVec4::from_array(image.rgba(col, row));
                let off = (found - truth.value).abs().max_element();
                let claimed = image.error(col, row);
                assert!(
                    off <= claimed + truth.error,
                    "{col} {row}: off by {off:e}, claims {claimed:e}"
                );
                truth.value.x
            })
        })
        .collect();
    // Some are in the shadow, and some are not.
    assert!(compared.iter().any(|light| *light < 0.1));
    assert!(compared.iter().any(|light| *light > 0.3));
}
