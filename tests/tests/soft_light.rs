//! Suns with a disc and skies, against closed forms and against pictures under many lights without a disc.

use std::f64::consts::TAU;
use std::num::NonZeroU32;
use std::path::Path;

use glam::{DVec2, DVec3};
use marbles_core::{
    Angle, Camera, DirectionalLight, Exposure, Highlight, Image, Lens, Light, LightPart, Material,
    Method, Motion, Pose, Renderer, Settings, Sky, Sphere, View, World,
};
use marbles_scene::Scene;

fn world(spheres: &[([f64; 3], f64)]) -> World {
    let mut world = World::new();
    let grey = world.add_material(Material {
        albedo: DVec3::splat(0.5),
        ..Material::default()
    });
    for &(center, radius) in spheres {
        world.add_sphere(Sphere::new(center.into(), radius).unwrap(), grey);
    }
    world
}

fn sun(toward: DVec3, degrees: f64) -> Light {
    let light = DirectionalLight::new(toward, DVec3::ONE).unwrap();
    light.with_diameter(degrees.to_radians()).unwrap().into()
}

fn view(width: u32, height: u32) -> View {
    let camera = Camera::look_at(DVec3::new(0.5, 2.0, -6.0), DVec3::ZERO, Angle::ZERO).unwrap();
    let lens = Lens::from_field_of_view(Angle::from_degrees(35.0)).unwrap();
    View::new(camera, lens, width, height)
}

fn to_tolerance(tolerance: f64) -> Settings {
    Settings {
        method: Method::Tolerance(tolerance),
        ..Settings::default()
    }
}

/// The largest difference between two pictures, beyond what both claim.
fn beyond(one: &Image, other: &Image) -> f64 {
    let pixels = (0..one.height()).flat_map(|row| (0..one.width()).map(move |col| (col, row)));
    let off = |(col, row)| {
        let apart = (one.rgba(col, row)[0] - other.rgba(col, row)[0]).abs();
        apart - one.error(col, row) - other.error(col, row)
    };
    pixels.map(off).fold(f64::NEG_INFINITY, f64::max)
}

const PILE: [([f64; 3], f64); 4] = [
    ([0.0, 0.0, 0.0], 1.0),
    ([1.3, -0.5, -0.4], 0.5),
    ([-1.2, -0.7, -0.8], 0.3),
    ([0.0, -1001.0, 0.0], 1000.0),
];

#[test]
fn a_ball_alone_under_a_sky_has_its_albedo_everywhere() {
    let mut world = world(&PILE[..1]);
    world.sky = Some(Sky::uniform(DVec3::splat(0.5)));
    let settings = Settings {
        alpha: true,
        ..to_tolerance(1e-4)
    };
    let image = Renderer::new(&world).render(&view(30, 20), &settings);
    assert_eq!(image.summary().over_tolerance, 0);
    for row in 0..20 {
        for col in 0..30 {
            let [light, _, _, alpha] = image.rgba(col, row);
            let error = image.error(col, row);
            assert!(
                (light - 0.25 * alpha).abs() <= 1.25 * error + 1e-12,
                "{col} {row}: {light} {alpha}"
            );
        }
    }
}

#[test]
fn a_ball_over_a_floor_hides_its_projection() {
    // Parallel rays from below the ball: the pixel shows the floor right under it.
    let height = 2.0;
    let mut world = world(&[([0.0, -1e6, 0.0], 1e6), ([0.0, height, 0.0], 1.0)]);
    world.sky = Some(Sky::uniform(DVec3::ONE));
    let camera = Camera::look_at(DVec3::new(0.0, 0.5, 0.0), DVec3::ZERO, Angle::ZERO).unwrap();
    let view = View::new(camera, Lens::parallel(1e-4, DVec2::ZERO), 3, 3);
    let image = Renderer::new(&world).render(&view, &to_tolerance(1e-6));
    let share = 1.0 - 1.0 / (height * height);
    let found = image.rgba(1, 1)[0];
    assert!(
        (found - 0.5 * share).abs() <= image.error(1, 1) + 1e-8,
        "{found}"
    );
}

#[test]
fn the_umbra_of_an_eclipse_is_a_section_of_its_cone() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/eclipse.ron");
    let scene = Scene::load(&file).unwrap();
    let world = scene.world();
    let [earth, moon] = [0, 1].map(|index| world.spheres()[index]);
    // Rays along the axis of the shadow, from between both; a pixel is half a kilometer wide.
    const PIXELS: u32 = 200;
    let position = moon.center().with_z(-8000.0);
    let camera = Camera::free(position, Angle::ZERO, Angle::ZERO, Angle::ZERO);
    let view = View::new(camera, Lens::parallel(100.0, DVec2::ZERO), PIXELS, 1);
    let image = Renderer::new(world).render(&view, &to_tolerance(1e-6));
    let dark = world.albedo(0).x * world.ambient.x;
    let is_dark = |col: &u32| image.rgba(*col, 0)[0] <= dark * (1.0 + 1e-6);
    let found = 0.5 * (0..PIXELS).filter(is_dark).count() as f64;
    // The cone narrows from the moon's radius on, and meets the ground north of the earth's middle.
    let half = 0.5 * world.lights[0].sun().unwrap().diameter();
    let sine_north = moon.center().y / earth.radius();
    let up = (1.0 - sine_north * sine_north).sqrt();
    let away = -moon.center().z - earth.radius() * up;
    let umbra = 2.0 * (moon.radius() / libm::cos(half) - away * libm::tan(half));
    assert!((found - umbra).abs() <= 1.0, "{found} {umbra}");
    // On the ground it is longer, from north to south.
    assert!((umbra / up - 58.0).abs() < 0.5, "{umbra} {up}");
}

#[test]
fn no_soft_light_reaches_what_is_inside_of_a_sphere() {
    // Parallel rays begin inside of the large ball, unless they pass to the right of it.
    let camera = Camera::look_at(DVec3::new(0.0, 0.0, -6.0), DVec3::ZERO, Angle::ZERO).unwrap();
    let view = View::new(camera, Lens::parallel(8.0, DVec2::ZERO), 8, 4);
    let large = ([-10.0, 0.0, 0.0], 60.0);
    let balls = [([-1.5, 0.0, 0.0], 1.2), ([1.5, 0.0, 0.0], 1.2)];
    let settings = [
        to_tolerance(1e-3),
        Settings {
            method: Method::Samples(NonZeroU32::new(2).unwrap()),
            ..Settings::default()
        },
    ];
    for around in [large, ([-60.5, 0.0, -6.0], 60.0)] {
        let mut world = world(&[balls[0], balls[1], around]);
        world.sky = Some(Sky::uniform(DVec3::ONE));
        world.lights = vec![sun(DVec3::new(0.3, 0.2, -1.0), 3.0)];
        for settings in &settings {
            let image = Renderer::new(&world).render(&view, settings);
            let light = |col: u32| image.rgba(col, 2)[0] - image.error(col, 2);
            let is_lit = [2, 5].map(|col| light(col) > 0.1);
            assert_eq!(is_lit, [false, around != large], "{settings:?}");
            assert_eq!(image.rgba(2, 2)[0], 0.0, "{settings:?}");
        }
    }
}

#[test]
fn half_a_sky_is_what_the_normal_turns_to_it() {
    let mut world = world(&PILE[..1]);
    world.sky = Some(Sky::in_halves(DVec3::ONE, DVec3::ZERO, DVec3::Y).unwrap());
    let view = view(60, 40);
    let image = Renderer::new(&world).render(&view, &to_tolerance(1e-4));
    // A hemisphere at the angle θ from the normal has the share (1 + cos θ)/2.
    for (col, row) in [(30, 20), (25, 15), (33, 24)] {
        let ray = view.ray(view.cell_center(col, row, 1));
        let hit = world.spheres()[0].hit(&ray).unwrap();
        let expected = 0.5 * 0.5 * (1.0 + hit.normal.y);
        let found = image.rgba(col as u32, row as u32)[0];
        // The middle of a pixel is off its mean by the square of its size.
        assert!(
            (found - expected).abs() < 2e-4,
            "{col} {row}: {found} {expected}"
        );
    }
}

/// The mean of pictures under lights without a disc, whose directions fill that of a sun.
fn mean_under_many_lights(
    world: &World,
    view: &View,
    toward: DVec3,
    degrees: f64,
    count: u32,
) -> Vec<f64> {
    let axis = toward.normalize();
    let (x, y) = axis.any_orthonormal_pair();
    let versine = 1.0 - (0.5 * degrees).to_radians().cos();
    let golden = 0.5 * (5_f64.sqrt() - 1.0);
    let mut sums = vec![0.0; (view.width * view.height) as usize];
    for index in 0..count {
        let cosine = 1.0 - versine * (f64::from(index) + 0.5) / f64::from(count);
        let sine = (1.0 - cosine * cosine).sqrt();
        let turn = TAU * (f64::from(index) * golden).fract();
        let direction = axis * cosine + (x * turn.cos() + y * turn.sin()) * sine;
        let mut hard = world.clone();
        hard.lights = vec![Light::directional(direction, DVec3::ONE).unwrap()];
        let image = Renderer::new(&hard).render(view, &to_tolerance(1e-4));
        for (place, sum) in sums.iter_mut().enumerate() {
            let place = place as u32;
            *sum += image.rgba(place % view.width, place / view.width)[0] / f64::from(count);
        }
    }
    sums
}

#[test]
fn a_sun_is_the_mean_of_the_lights_of_its_disc() {
    let view = view(18, 12);
    for (degrees, count, slack) in [(1.0, 300, 2e-3), (12.0, 600, 2e-3), (90.0, 600, 4e-3)] {
        let toward = DVec3::new(-1.0, 1.5, -1.0);
        let mut world = world(&PILE);
        let expected = mean_under_many_lights(&world, &view, toward, degrees, count);
        world.lights = vec![sun(toward, degrees)];
        let image = Renderer::new(&world).render(&view, &to_tolerance(1e-3));
        // Pixels may be reported as over the tolerance, but none is off by more than it claims.
        let mut largest: f64 = 0.0;
        for (place, expected) in expected.iter().enumerate() {
            let place = place as u32;
            let found = image.rgba(place % view.width, place / view.width)[0];
            let claimed = image.error(place % view.width, place / view.width);
            largest = largest.max((found - expected).abs() - claimed);
        }
        assert!(largest < slack, "{degrees}: {largest:e}");
    }
}

#[test]
fn averages_agree_with_samples() {
    let mut world = world(&PILE);
    world.lights = vec![sun(DVec3::new(-1.0, 1.5, -1.0), 8.0)];
    world.sky = Some(Sky::in_halves(DVec3::splat(0.4), DVec3::splat(0.1), DVec3::Y).unwrap());
    let renderer = Renderer::new(&world);
    let samples = Settings {
        method: Method::Samples(NonZeroU32::new(24).unwrap()),
        ..Settings::default()
    };
    let (width, height) = (24, 16);
    let sampled = renderer.render(&view(width, height), &samples);
    let exact = renderer.render(&view(width, height), &to_tolerance(1e-4));
    let (mut square, mut largest) = (0.0, 0.0_f64);
    for row in 0..height {
        for col in 0..width {
            let apart = (sampled.rgba(col, row)[0] - exact.rgba(col, row)[0]).abs();
            square += apart * apart;
            largest = largest.max(apart);
        }
    }
    let rms = (square / f64::from(width * height)).sqrt();
    assert!(rms < 1e-3 && largest < 1e-2, "{rms:e} {largest:e}");
}

#[test]
fn outlines_and_several_lights_share_a_tolerance() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/figure.ron");
    let text = r#"(
        image: (width: 60, height: 50),
        lens: Fov(30),
        camera: Frame(azimuth: 25, elevation: 20),
        background: 1,
        sky: 0.7,
        lights: [Directional(toward: (-0.6, 1, -1.4), attached: Camera, intensity: 0.35, diameter: 10)],
        materials: { "m": (outline: (width: Units(0.0362), color: 0.02)) },
        clouds: [(file: "cluster.csv", material: "m", radius: 0.856, value: "shell", color: Category)],
    )"#;
    let scene = Scene::parse(text, &file).unwrap();
    let view = scene.view(1).unwrap();
    let exposure = scene.exposure(&view);
    let image = Renderer::new(scene.world()).render(exposure, &to_tolerance(1e-2));
    for row in 0..50 {
        for col in 0..60 {
            let error = image.error(col, row);
            assert!(error <= 1e-2, "{col}, {row}: {error:e}");
        }
    }
}

#[test]
fn the_lights_of_a_picture_add_up() {
    let mut world = world(&PILE);
    world.ambient = DVec3::splat(0.1);
    world.lights = vec![
        Light::directional(DVec3::new(1.0, 1.0, -1.0), DVec3::splat(0.4)).unwrap(),
        sun(DVec3::new(-1.0, 1.5, -1.0), 5.0),
    ];
    world.sky = Some(Sky::uniform(DVec3::splat(0.3)));
    let parts: Vec<LightPart> = world.light_parts().collect();
    assert_eq!(
        parts,
        [
            LightPart::Light(0),
            LightPart::Light(1),
            LightPart::Sky,
            LightPart::Ambient
        ]
    );
    let renderer = Renderer::new(&world);
    let (view, settings) = (view(18, 12), to_tolerance(1e-4));
    let whole = renderer.render(&view, &settings);
    let each: Vec<Image> = parts
        .iter()
        .map(|&part| renderer.under(part).render(&view, &settings))
        .collect();
    for (part, image) in parts.iter().zip(&each) {
        assert_eq!(
            Renderer::new(&world.under(*part)).render(&view, &settings),
            *image,
            "{part:?}"
        );
    }
    for row in 0..12 {
        for col in 0..18 {
            let sum: f64 = each.iter().map(|image| image.rgba(col, row)[0]).sum();
            let claims: f64 = each.iter().map(|image| image.error(col, row)).sum();
            let apart = (whole.rgba(col, row)[0] - sum).abs();
            assert!(
                apart <= whole.error(col, row) + claims,
                "{col} {row}: {apart:e}"
            );
        }
    }
}

#[test]
fn a_highlight_is_as_bright_as_what_is_seen_of_the_sun() {
    let mut world = World::new();
    let shiny = world.add_material(Material {
        highlight: Some(Highlight {
            strength: 0.5,
            shininess: 300.0,
        }),
        ..Material::default()
    });
    world.add_sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap(), shiny);
    let toward = DVec3::new(-0.3, 1.0, -1.5);
    world.lights = vec![Light::directional(toward, DVec3::ONE).unwrap()];
    let view = view(24, 16);
    let hard = Renderer::new(&world).render(&view, &to_tolerance(1e-4));
    // Without other spheres a small disc differs from a point by the square of its size.
    world.lights = vec![sun(toward, 0.2)];
    let soft = Renderer::new(&world).render(&view, &to_tolerance(1e-4));
    assert!(beyond(&hard, &soft) < 1e-5, "{:e}", beyond(&hard, &soft));
}

#[test]
fn light_and_lengths_have_no_unit() {
    let picture = |light: f64, length: f64| {
        let spheres = PILE.map(|(center, radius)| (center.map(|of| of * length), radius * length));
        let mut world = world(&spheres);
        let light_toward = DirectionalLight::new(DVec3::new(-1.0, 1.5, -1.0), DVec3::splat(light));
        world.lights = vec![light_toward.unwrap().with_diameter(0.1).unwrap().into()];
        world.sky = Some(Sky::uniform(DVec3::splat(0.25 * light)));
        let mut view = view(12, 8);
        view.camera = view.camera.moved(view.camera.position * (length - 1.0));
        Renderer::new(&world).render(&view, &to_tolerance(1e-3 * light))
    };
    let (one, bright, large) = (picture(1.0, 1.0), picture(1024.0, 1.0), picture(1.0, 64.0));
    for row in 0..8 {
        for col in 0..12 {
            assert_eq!(one.rgba(col, row)[0] * 1024.0, bright.rgba(col, row)[0]);
            assert_eq!(one.error(col, row) * 1024.0, bright.error(col, row));
            assert_eq!(one.rgba(col, row), large.rgba(col, row));
        }
    }
}

#[derive(Debug)]
struct Still;

impl Motion for Still {
    fn pose(&self, _: f64) -> Option<Pose> {
        None
    }

    fn is_smooth(&self) -> bool {
        true
    }
}

#[test]
fn an_open_shutter_sees_soft_light() {
    let mut world = world(&PILE);
    world.lights = vec![sun(DVec3::new(-1.0, 1.5, -1.0), 5.0)];
    let view = view(12, 8);
    let renderer = Renderer::new(&world);
    let settings = to_tolerance(1e-2);
    let still = renderer.render(&view, &settings);
    let open = renderer.render(Exposure::of_motion(view, Still), &settings);
    assert!(beyond(&still, &open) <= 0.0, "{:e}", beyond(&still, &open));
    assert!(still.rgba(6, 4)[0] > 0.1);
    let samples = Settings {
        method: Method::Samples(NonZeroU32::new(2).unwrap()),
        ..Settings::default()
    };
    let still = renderer.render(&view, &samples);
    let open = renderer.render(Exposure::of_motion(view, Still), &samples);
    assert!((still.rgba(6, 4)[0] - open.rgba(6, 4)[0]).abs() < 1e-12);
}
