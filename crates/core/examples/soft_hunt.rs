use marbles_core::glam::DVec3;
use marbles_core::*;
struct R(u64);
impl R {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 * 2_f64.powi(-53)
    }
    fn s(&mut self) -> f64 {
        2.0 * self.next() - 1.0
    }
    fn v(&mut self) -> DVec3 {
        DVec3::new(self.s(), self.s(), self.s())
    }
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let (kind, scenes, seed): (&str, u64, u64) =
        (&args[1], args[2].parse().unwrap(), args[3].parse().unwrap());
    let only: Option<u64> = args.get(4).map(|a| a.parse().unwrap());
    let tolerances = [1e-2, 1e-3, 1e-4];
    let tol_only: Option<f64> = std::env::var("TOL").ok().map(|t| t.parse().unwrap());
    let mut count = [[0_u64; 5]; 3];
    let mut ratios: Vec<f64> = vec![];
    for number in 0..scenes {
        if only.is_some_and(|o| o != number) {
            continue;
        }
        let mut r = R(seed * 1000003 + number);
        for _ in 0..9 {
            r.next();
        }
        let mut world = World::new();
        let balls = 1 + (r.next() * 6.0) as usize;
        for _ in 0..balls {
            let material = world.add_material(Material {
                albedo: DVec3::splat(0.3 + 0.7 * r.next()),
                exponent: if r.next() < 0.8 {
                    1.0
                } else {
                    0.5 + 3.0 * r.next()
                },
                highlight: (r.next() < 0.2).then_some(Highlight {
                    strength: r.next(),
                    shininess: libm::exp(r.next() * 6.0),
                }),
                ..Material::default()
            });
            let radius = libm::exp(-3.0 * r.next());
            world.add_sphere(Sphere::new(r.v() * 1.3, radius).unwrap(), material);
        }
        if r.next() < 0.5 {
            let white = world.add_material(Material::default());
            let big = libm::exp(1.0 + 12.0 * r.next());
            let down = (DVec3::new(0.0, -1.0, 0.0) + 0.3 * r.v()).normalize();
            world.add_sphere(Sphere::new(down * (big + r.next()), big).unwrap(), white);
        }
        if kind == "contacts" {
            // Each ball touches the one before.
            let list: Vec<Sphere> = world.spheres().to_vec();
            let white = world.add_material(Material::default());
            let mut w = World::new();
            let m = w.add_material(Material::default());
            let _ = white;
            let mut last = list[0];
            w.add_sphere(last, m);
            for sphere in &list[1..] {
                let d = (sphere.center() - last.center()).normalize();
                let s = Sphere::new(
                    last.center() + d * (last.radius() + sphere.radius()),
                    sphere.radius(),
                )
                .unwrap();
                w.add_sphere(s, m);
                last = s;
            }
            world = w;
        }
        let what = r.next();
        if kind == "sky" || (kind != "sun" && what < 0.4) {
            world.sky = Some(if r.next() < 0.5 {
                Sky::uniform(DVec3::ONE)
            } else {
                Sky::in_halves(DVec3::ONE, DVec3::splat(0.2), r.v()).unwrap()
            });
        } else {
            let d = libm::exp(libm::log(0.2) + r.next() * libm::log(500.0));
            world.lights.push(
                DirectionalLight::new(r.v(), DVec3::ONE)
                    .unwrap()
                    .with_diameter(d.to_radians())
                    .unwrap()
                    .into(),
            );
        }
        let from = r.v().normalize() * (2.5 + 3.0 * r.next());
        let camera =
            Camera::look_at(from, 0.3 * r.v(), Angle::from_degrees(360.0 * r.next())).unwrap();
        let lens = if r.next() < 0.8 {
            Lens::from_field_of_view(Angle::from_degrees(15.0 + 60.0 * r.next())).unwrap()
        } else {
            Lens::parallel(2.0 + 3.0 * r.next(), marbles_core::glam::DVec2::ZERO)
        };
        let view = View::new(camera, lens, 20, 15);
        let renderer = Renderer::new(&world);
        if std::env::var("DUMP").is_ok() {
            let big = View::new(camera, lens, 800, 600);
            let image = renderer.render(
                &big,
                &Settings {
                    method: Method::Samples(std::num::NonZeroU32::MIN),
                    ..Settings::default()
                },
            );
            let mut out: Vec<u8> = vec![];
            for row in 0..600 {
                for col in 0..800 {
                    out.extend(image.rgba(col, row)[0].to_le_bytes());
                }
            }
            std::fs::write("/tmp/w/dump.f64", out).unwrap();
            eprintln!("{world:?}");
            return;
        }
        let render = |t: f64| {
            renderer.render(
                &view,
                &Settings {
                    method: Method::Tolerance(t),
                    ..Settings::default()
                },
            )
        };
        if tol_only.is_some() {
            eprintln!("TRUTH");
        }
        let truth = render(args.get(5).map_or(2e-5, |a| a.parse().unwrap()));
        for (place, &t) in tolerances.iter().enumerate() {
            if tol_only.is_some_and(|o| o != t) {
                continue;
            }
            if tol_only.is_some() {
                eprintln!("IMAGE");
            }
            let image = render(t);
            for row in 0..view.height {
                for col in 0..view.width {
                    let of = truth.error(col, row);
                    if of > 0.1 * t {
                        continue;
                    }
                    count[place][0] += 1;
                    let d = (0..3)
                        .map(|c| (image.rgba(col, row)[c] - truth.rgba(col, row)[c]).abs())
                        .fold(0.0, f64::max);
                    let e = image.error(col, row);
                    if e > t {
                        count[place][1] += 1;
                    }
                    if d > t + of && e <= t {
                        count[place][2] += 1;
                    }
                    if d > e + of {
                        count[place][3] += 1;
                        if count[place][3] < 4 || only.is_some() {
                            eprintln!(
                                "scene {number} t {t:e} pixel {col} {row}: off {d:e} claims {e:e} (truth claims {of:e}) value {}",
                                truth.rgba(col, row)[0]
                            );
                        }
                    }
                    if e > 0.1 * t {
                        ratios.push(d / e);
                    }
                }
            }
        }
    }
    for (t, c) in tolerances.iter().zip(count) {
        println!(
            "{kind} {t:e}: judged {} given up {} over unsaid {} beyond {}",
            c[0], c[1], c[2], c[3]
        );
    }
    ratios.sort_by(f64::total_cmp);
    if !ratios.is_empty() {
        println!(
            "median ratio {:.3} p99 {:.3} max {:.3}",
            ratios[ratios.len() / 2],
            ratios[ratios.len() * 99 / 100],
            ratios[ratios.len() - 1]
        );
    }
}
