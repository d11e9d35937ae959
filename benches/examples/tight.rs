//! throw-away
use glam::{DVec2, DVec3};
use marbles_core::*;
use std::num::NonZeroU32;
use std::ops::ControlFlow;
use std::time::Instant;

fn cpu() -> f64 {
    let s = std::fs::read_to_string("/proc/self/schedstat").unwrap();
    let _ = s;
    let s = std::fs::read_to_string("/proc/self/stat").unwrap();
    let f: Vec<&str> = s.rsplit(')').next().unwrap().split_whitespace().collect();
    (f[11].parse::<f64>().unwrap() + f[12].parse::<f64>().unwrap()) / 100.0
}

fn cloud(count: u32, radius: f64) -> World {
    let mut state = u64::from(count);
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    let mut spheres = Vec::new();
    for _ in 0..count {
        let point = DVec3::new(random(), random(), random()) - 0.5;
        let r = if radius > 0.0 {
            radius
        } else {
            3.0 + 9.0 * random()
        };
        spheres.push(Sphere::new(200.0 * point + 400.0 * DVec3::Z, r).unwrap());
    }
    world.add_spheres(spheres, white, None);
    world.lights.extend(DirectionalLight::new(
        DVec3::new(-1.0, 1.0, -1.0),
        Color::ONE,
    ));
    world
}

// tight COUNT RADIUS SHADOWS SIDE PIXELS THREADS REPEAT METHOD... (s8 or 1e-3), last "ref:FILE" writes, "vs:FILE" compares
fn main() {
    let a: Vec<String> = std::env::args().skip(1).collect();
    let count: u32 = a[0].parse().unwrap();
    let radius: f64 = a[1].parse().unwrap();
    let shadows = a[2] == "1";
    let side: u32 = a[3].parse().unwrap();
    let pixels_wide: f64 = a[4].parse().unwrap();
    let threads: usize = a[5].parse().unwrap();
    let repeat: usize = a[6].parse().unwrap();
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| {
        let mut world = cloud(count, radius);
        world.shadows = shadows;
        let t = Instant::now();
        let renderer = Renderer::new(&world);
        let prep = t.elapsed().as_secs_f64();
        let view = View {
            camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
            lens: Lens { width: pixels_wide, distance: 700.0, shift: DVec2::new(0.0, 0.0) },
            zoom: 1.0, width: side, height: side, frame: 1,
        };
        let mut reference: Option<Vec<f64>> = None;
        for m in &a[7..] {
            if let Some(f) = m.strip_prefix("vs:") {
                let b = std::fs::read(f).unwrap();
                reference = Some(b.chunks_exact(8).map(|c| f64::from_le_bytes(c.try_into().unwrap())).collect());
                continue;
            }
            if m.starts_with("ref:") { continue; }
            let (method, tol) = match m.strip_prefix('s') {
                Some(n) => (Method::Samples(NonZeroU32::new(n.parse().unwrap()).unwrap()), f64::INFINITY),
                None => { let t: f64 = m.parse().unwrap(); (Method::Tolerance(t), t) }
            };
            let settings = Settings { method, alpha: false };
            let before = cpu();
            let mut times = Vec::new();
            let mut image = None;
            for _ in 0..repeat {
                let t = Instant::now();
                image = Some(renderer.render_over(image.take(), &view, &settings, &|_| ControlFlow::Continue(())).unwrap());
                times.push(t.elapsed().as_secs_f64());
            }
            print!("cpu {:.2} us/px ", (cpu() - before) / repeat as f64 * 1e6 / (side as f64 * side as f64));
            times.sort_by(f64::total_cmp);
            let image = image.unwrap();
            let s = image.summary();
            print!("{m:>6} prep {prep:.3} time {:.3} s = {:.2} us/px | work/px {:?} unmet {}", times[times.len()/2], times[times.len()/2]*1e6/(side as f64*side as f64),
              image.work(), s.over_tolerance);
            if let Ok(px) = std::env::var("PX") {
                let v: Vec<u32> = px.split(',').map(|x| x.parse().unwrap()).collect();
                print!(" PX {:.9} err {:.2e}", image.rgba(v[0], v[1])[0], image.error(v[0], v[1]));
                if let Some(r) = &reference { print!(" ref {:.9}", r[(v[1]*side+v[0]) as usize]); }
            }
            if let Some(r) = &reference {
                let (mut sq, mut over, mut over5, mut worst, mut beyond) = (0.0, 0, 0, 0.0_f64, 0);
                let mut claim = 0.0; let mut wp=(0,0);
                let mut est=0; let (mut mo, mut mw, mut mwp) = (0, 0.0_f64, (0,0)); let mut msq=0.0; let mut hist=[0;10]; let mut mratio=(0.0_f64,(0,0));
                for row in 0..side { for col in 0..side {
                    let e = (image.rgba(col,row)[0] - r[(row*side+col) as usize]).abs();
                    sq += e*e; let c = image.error(col,row); claim += c*c;
                    if e > tol { over += 1; } if e > 5.0*tol { over5 += 1; }
                    if e > c { beyond += 1; }
                    if e > worst { worst = e; wp=(col,row); }
                    if image.status(col,row) != Status::Met { est += 1; } else { msq+=e*e; if e > tol { mo += 1; } if e > mw { mw = e; mwp=(col,row); } if e > 1e-6 && e/c > mratio.0 { mratio=(e/c,(col,row)); } }
 hist[((-(c.max(1e-12)).log10()) as usize).min(9)] += 1;
                }}
                let n = (side*side) as f64;
                print!(" | rmse {:.2e} claimed {:.2e} worst {worst:.2e} at {wp:?} over {over} over5 {over5} beyond {beyond} notmet {est}", (sq/n).sqrt(), (claim/n).sqrt());
                print!("\n        MET: rmse {:.2e} over {mo} worst {mw:.2e} at {mwp:?} claims {hist:?} worst ratio {mratio:?}", (msq/n).sqrt());
            }
            println!();
            for m in &a[7..] { if let Some(f) = m.strip_prefix("ref:") {
                let mut out = Vec::new();
                for row in 0..side { for col in 0..side { out.extend(image.rgba(col,row)[0].to_le_bytes()); }}
                std::fs::write(f, out).unwrap();
            }}
        }
    });
}
