//! Exact hits that were computed independently, in `tests/truth/hits`.

use std::path::{Path, PathBuf};

use glam::DVec3;
use marbles_core::{Ray, Sphere};

use marbles_tests::hits::judge::judge;

/// A case of the files: a ray, a sphere, and the exact hit, if there is one.
struct Case {
    name: String,
    ray: Ray,
    sphere: Sphere,
    /// The distance as an unevaluated sum of two doubles, and the normal.
    hit: Option<(f64, f64, DVec3)>,
}

/// A double in hexadecimal notation, such as `-0x1.8p+3`.
fn from_hexadecimal(text: &str) -> f64 {
    let (sign, digits) = match text.strip_prefix('-') {
        Some(digits) => (-1.0, digits),
        None => (1.0, text),
    };
    let (mantissa, exponent) = digits.strip_prefix("0x").unwrap().split_once('p').unwrap();
    let (whole, fraction) = mantissa.split_once('.').unwrap();
    let integer = u64::from_str_radix(&format!("{whole}{fraction}"), 16).unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    sign * libm::scalbn(integer as f64, exponent - 4 * fraction.len() as i32)
}

fn cases(file: &Path) -> Vec<Case> {
    let text = std::fs::read_to_string(file).unwrap();
    let mut lines = text.lines();
    assert!(
        lines
            .next()
            .unwrap()
            .starts_with("family,id,group,ox,oy,oz,dx,dy,dz,cx,cy,cz,r,hit")
    );
    lines
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            let number = |index: usize| from_hexadecimal(fields[index]);
            let vector =
                |index: usize| DVec3::new(number(index), number(index + 1), number(index + 2));
            Case {
                name: format!("{} {}", fields[0], fields[1]),
                ray: Ray {
                    origin: vector(3),
                    direction: vector(6),
                },
                sphere: Sphere::new(vector(9), number(12)).unwrap(),
                hit: (fields[13] == "1").then(|| (number(15), number(16), vector(17))),
            }
        })
        .collect()
}

/// The distance between a double and the next one away from zero.
fn unit_in_the_last_place(value: f64) -> f64 {
    let magnitude = value.abs();
    f64::from_bits(magnitude.to_bits() + 1) - magnitude
}

#[test]
fn published_cases_are_right_to_the_last_place() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("truth/hits");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    let mut count = 0;
    for case in files.iter().flat_map(|file| cases(file)) {
        count += 1;
        let (found, floor) = case.sphere.hit_and_floor(&case.ray);
        let name = format!("{} ({floor:?})", case.name);
        assert_eq!(
            found.is_some(),
            case.hit.is_some(),
            "{name}: the wrong decision"
        );
        let exact = judge(&case.sphere, &case.ray);
        assert_eq!(
            exact.is_some(),
            case.hit.is_some(),
            "{name}: the judge decides otherwise"
        );
        let (Some(found), Some((t, t_rest, normal)), Some(exact)) = (found, case.hit, exact) else {
            continue;
        };
        assert!(
            exact.ulps(t) <= 0.5 && exact.angle(normal) <= 1.0,
            "{name}: the judge knows another distance or normal"
        );
        let t_error = ((found.t - t) - t_rest).abs() / unit_in_the_last_place(t);
        // Both normals are unit to some 1e-16: the difference is the angle.
        let normal_error = (found.normal.cross(normal)).length() * 2.0_f64.powi(53);
        assert!(
            t_error <= 1.0,
            "{name}: t is off by {t_error} units in the last place"
        );
        // The published normal is rounded too: half a unit in each component.
        assert!(
            normal_error <= 3.0,
            "{name}: the normal is off by {normal_error} · 2^-53"
        );
    }
    assert_eq!(count, 19 * 60);
}
