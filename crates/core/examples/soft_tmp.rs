use marbles_core::glam::DVec3;
use marbles_core::*;
use std::num::NonZeroU32;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let kind = args[1].as_str();
    let n: u32 = args[2].parse().unwrap();
    let mut world = World::new();
    let white = world.add_material(Material {
        albedo: DVec3::splat(0.8),
        ..Material::default()
    });
    match args.get(4).map(String::as_str) {
        Some("cloud") => {
            let mut state = 7_u64;
            let mut next = || {
                state = state
                    .wrapping_mul(6364136223846793005)
                    .wrapping_add(1442695040888963407);
                (state >> 11) as f64 * 2_f64.powi(-52) - 1.0
            };
            for _ in 0..1000 {
                let c = DVec3::new(next(), next(), next());
                world.add_sphere(Sphere::new(c, 0.1).unwrap(), white);
            }
        }
        Some("horizon") => {
            let m = world.add_material(Material {
                albedo: DVec3::splat(0.8),
                highlight: Some(Highlight {
                    strength: 0.4,
                    shininess: 10.0,
                }),
                ..Material::default()
            });
            world.add_sphere(
                Sphere::new(
                    DVec3::new(0.0, -2228014.8958408292, 100.0),
                    2227998.4405758358,
                )
                .unwrap(),
                m,
            );
            world.add_sphere(
                Sphere::new(
                    DVec3::new(-12.281184278591372, -8.578163847611957, 91.12502012244563),
                    7.877101145832757,
                )
                .unwrap(),
                m,
            );
        }
        _ => {
            world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 0.0), 1.0).unwrap(), white);
            world.add_sphere(
                Sphere::new(DVec3::new(1.3, -0.5, -0.4), 0.5).unwrap(),
                white,
            );
            world.add_sphere(
                Sphere::new(DVec3::new(-1.2, -0.7, -0.8), 0.3).unwrap(),
                white,
            );
            world.add_sphere(
                Sphere::new(DVec3::new(0.0, -1001.0, 0.0), 1000.0).unwrap(),
                white,
            );
        }
    }
    let mut toward = DVec3::new(-1.0, 1.5, -1.0);
    let is_horizon = args.get(4).is_some_and(|a| a == "horizon");
    if is_horizon {
        toward = DVec3::new(0.3003549482638049, 0.02627532748465524, -0.9538275027768109);
    }
    if kind.starts_with("sun") {
        let d: f64 = kind[3..].parse().unwrap();
        world.lights.push(
            DirectionalLight::new(toward, DVec3::ONE)
                .unwrap()
                .with_diameter(d.to_radians())
                .unwrap()
                .into(),
        );
    } else {
        world.sky = Some(Sky::uniform(DVec3::ONE));
    }
    let camera = Camera::look_at(
        DVec3::new(0.5, 1.5, -6.0),
        DVec3::new(0.0, -0.2, 0.0),
        Angle::ZERO,
    )
    .unwrap();
    let lens = Lens::from_field_of_view(Angle::from_degrees(40.0)).unwrap();
    let mut view = View::new(camera, lens, n, n * 3 / 4);
    if is_horizon {
        view = View::new(
            Camera::look_at(DVec3::ZERO, DVec3::Z, Angle::ZERO).unwrap(),
            Lens::from_field_of_view(Angle::from_degrees(
                2.0 * (16.0_f64 / 66.15466191060432).atan().to_degrees(),
            ))
            .unwrap(),
            n,
            n * 3 / 4,
        );
    }
    let method = match args[3].parse::<u32>() {
        Ok(s) => Method::Samples(NonZeroU32::new(s).unwrap()),
        Err(_) => Method::Tolerance(args[3].parse().unwrap()),
    };
    let renderer = Renderer::new(&world);

    let start = std::time::Instant::now();
    let image = renderer.render(
        &view,
        &Settings {
            method,
            ..Settings::default()
        },
    );
    let seconds = start.elapsed().as_secs_f64();
    let summary = image.summary();
    eprintln!(
        "{kind} {}: {seconds:.3} s, largest error {:e}, over {}, points {}",
        args[3],
        summary.largest_error,
        summary.over_tolerance,
        image.work().samples
    );
    if let Some(reference) = args.get(5).and_then(|r| r.parse::<u32>().ok()) {
        let truth = renderer.render(
            &view,
            &Settings {
                method: Method::Samples(NonZeroU32::new(reference).unwrap()),
                ..Settings::default()
            },
        );
        let (mut worst, mut beyond, mut sq) = (0.0_f64, 0, 0.0);
        for row in 0..view.height {
            for col in 0..view.width {
                let d = (image.rgba(col, row)[0] - truth.rgba(col, row)[0]).abs();
                sq += d * d;
                worst = worst.max(d);
                if d > image.error(col, row) + truth.error(col, row) {
                    beyond += 1;
                    if beyond < 4 {
                        eprintln!(
                            "  {col} {row}: {} claims {:e}, reference {} claims {:e}",
                            image.rgba(col, row)[0],
                            image.error(col, row),
                            truth.rgba(col, row)[0],
                            truth.error(col, row)
                        );
                    }
                }
            }
        }
        eprintln!(
            "   against {reference} x {reference}: worst {worst:e}, rms {:e}, beyond both {beyond}",
            (sq / f64::from(view.width * view.height)).sqrt()
        );
    }
    let codes = image.to_srgb8();
    let mut out = format!("P6\n{} {}\n255\n", view.width, view.height).into_bytes();
    for px in codes.chunks(4) {
        out.extend(&px[..3]);
    }
    std::fs::write(format!("/tmp/w/soft_{kind}_{}.ppm", args[3]), out).unwrap();
}
