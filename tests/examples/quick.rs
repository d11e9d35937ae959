#[path = "../src/hits/forms.rs"]
mod forms;
use glam::DVec3;
use marbles_core::*;
use std::time::Instant;
fn time(
    form: impl Fn(&Sphere, &Ray) -> Option<(f64, DVec3)>,
    spheres: &[Sphere],
    rays: &[Ray],
) -> (f64, f64, usize) {
    let s = Instant::now();
    let mut acc = 0.0;
    let mut n = 0;
    for ray in rays {
        for sp in spheres {
            if let Some((t, nn)) = form(sp, ray) {
                acc += t + nn.x + nn.y + nn.z;
                n += 1;
            }
        }
    }
    std::hint::black_box(acc);
    (
        s.elapsed().as_secs_f64() * 1e9 / (rays.len() * spheres.len()) as f64,
        acc,
        n,
    )
}
fn main() {
    let mk = |w: u32, dist: f64| {
        let mut v = vec![];
        for row in 0..w {
            for col in 0..w {
                v.push(Ray {
                    origin: DVec3::ZERO,
                    direction: DVec3::new(
                        col as f64 + 0.5 - w as f64 / 2.0,
                        w as f64 / 2.0 - row as f64 - 0.5,
                        dist,
                    ),
                });
            }
        }
        v
    };
    let seed1 = vec![Sphere::new(DVec3::new(0.0, 0.0, 400.0), 300.0).unwrap()];
    let mut x = 12345u64;
    let mut rnd = || {
        x = x
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (x >> 11) as f64 / (1u64 << 53) as f64
    };
    let cloud: Vec<Sphere> = (0..200)
        .map(|_| {
            Sphere::new(
                DVec3::new(
                    rnd() * 200.0 - 100.0,
                    rnd() * 200.0 - 100.0,
                    300.0 + 200.0 * rnd(),
                ),
                3.0 + 9.0 * rnd(),
            )
            .unwrap()
        })
        .collect();
    for (name, spheres, rays) in [
        ("seed1", &seed1, mk(600, 100.0)),
        ("seed1 tele (mostly hits)", &seed1, mk(600, 400.0)),
        ("cloud", &cloud, mk(100, 117.0)),
    ] {
        let mut times = vec![vec![]; 4];
        for _ in 0..21 {
            times[0].push(time(forms::original, spheres, &rays).0);
            times[1].push(time(forms::stable, spheres, &rays).0);
            times[2].push(time(forms::perpendicular, spheres, &rays).0);
            times[3].push(time(|s, r| s.hit(r).map(|h| (h.t, h.normal)), spheres, &rays).0);
        }
        let med: Vec<f64> = times
            .iter_mut()
            .map(|t| {
                t.sort_by(f64::total_cmp);
                t[10]
            })
            .collect();
        println!(
            "{name}: {med:.2?} ratio {:.3} hits {:.3}",
            med[3] / med[2],
            time(forms::perpendicular, spheres, &rays).2 as f64
                / (rays.len() * spheres.len()) as f64
        );
    }
}
