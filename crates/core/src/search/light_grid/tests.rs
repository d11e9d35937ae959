//! What may darken a sphere is found, whatever the radii, against all spheres one by one.

use super::*;
use crate::search::tests::Random;

fn axes() -> [DVec3; 3] {
    let toward = DVec3::new(-1.0, 0.7, 0.4).normalize();
    let (right, up) = toward.any_orthonormal_pair();
    [right, up, toward]
}

/// Spheres with radii by `radius`, which gets a number from 0 to 1, in a block of these sides.
fn spheres(count: usize, sides: DVec3, radius: impl Fn(f64) -> f64) -> Vec<Sphere> {
    let mut random = Random(17);
    let mut sphere = || {
        let center = random.point() * sides + DVec3::new(3.0, -200.0, 50.0);
        Sphere::new(center, radius(random.number())).unwrap()
    };
    (0..count).map(|_| sphere()).collect()
}

/// Asks for every so many spheres; returns how many were found.
fn check(spheres: &[Sphere], grid: &LightGrid, step: usize) -> usize {
    let axes = axes();
    let mut memory = Found::default();
    let mut sum = 0;
    for (index, sphere) in spheres.iter().enumerate().step_by(step) {
        let asked = Asked {
            center: sphere.center(),
            radius: sphere.radius(),
            index: index as u32,
        };
        memory.list.clear();
        if !grid.find(spheres, &asked, &mut memory) {
            assert!(sphere.radius() > 3.0 * grid.side, "in many cells");
            continue;
        }
        sum += memory.list.len();
        let mut found: Vec<u32> = memory.list.iter().map(|higher| higher.index).collect();
        found.sort_unstable();
        let count = found.len();
        found.dedup();
        assert_eq!(found.len(), count, "none twice");
        for higher in &memory.list {
            let other = &spheres[higher.index as usize];
            let way = place(&axes, other.center() - sphere.center());
            let slack = 1e-5 * (sphere.radius() + other.radius()) + 1e-4 * grid.side;
            assert!((higher.way - way).abs().max_element() < slack);
            assert!((higher.radius - other.radius()).abs() < 1e-6 * other.radius());
        }
        for (number, other) in spheres.iter().enumerate() {
            let way = place(&axes, other.center() - sphere.center());
            let room = sphere.radius() + other.radius() - way.truncate().length();
            // What single precision does not decide may be either way.
            let doubt = 1e-4 * grid.side;
            if number != index && room.abs() > doubt && way.z.abs() > doubt {
                let expected = room > 0.0 && way.z > 0.0;
                let is_found = found.binary_search(&(number as u32)).is_ok();
                assert_eq!(is_found, expected, "{number} above {index}");
            }
        }
    }
    sum
}

#[test]
fn all_that_lie_higher_are_found() {
    let sides = DVec3::splat(4.0);
    let flat = DVec3::new(30.0, 30.0, 0.01);
    let worlds = [
        spheres(1000, sides, |_| 0.1),
        spheres(1000, sides, |random| 0.02 * libm::exp2(3.0 * random)),
        spheres(1000, flat, |random| 0.05 + 0.2 * random),
        // A few of a thousand are a hundred times as large.
        spheres(
            1000,
            sides * 4.0,
            |random| if random < 0.01 { 5.0 } else { 0.05 },
        ),
    ];
    for spheres in &worlds {
        let grid = LightGrid::new(spheres, axes()).expect("a crowd");
        let sum = check(spheres, &grid, 1);
        assert!(sum > 100, "{sum}");
    }
    let few_large = LightGrid::new(&worlds[3], axes()).expect("a crowd");
    assert!((5..=MOST_LARGE).contains(&few_large.large.len()));
    assert!(few_large.layers > 1 || few_large.columns > 5);
}

/// So many that threads share them; the indices of all are listed once.
#[test]
fn many_are_listed_by_several_threads() {
    let spheres = spheres(70_000, DVec3::splat(4.0), |random| 0.01 + 0.02 * random);
    let threads = rayon::ThreadPoolBuilder::new()
        .num_threads(3)
        .build()
        .unwrap();
    let grid = threads.install(|| LightGrid::new(&spheres, axes()).expect("a crowd"));
    let sum = check(&spheres, &grid, 700);
    assert!(sum > 100, "{sum}");
    let places = grid.indices.iter().enumerate();
    let heights = |place: usize| grid.blocks[place / LANES][2][place % LANES];
    let filled = places.filter(|(place, _)| heights(*place).is_finite());
    let mut indices: Vec<u32> = filled.map(|(_, index)| *index).collect();
    indices.extend(&grid.large);
    indices.sort_unstable();
    assert_eq!(indices, (0..70_000).collect::<Vec<u32>>());
}

/// Columns of spheres above each other, one at the place of another, and one that is alone.
#[test]
fn spheres_in_rows_are_found() {
    let mut spheres = Vec::new();
    let [right, _, toward] = axes();
    for column in 0..20 {
        for row in 0..30 {
            let center = right * f64::from(column) + toward * 1.5 * f64::from(row);
            spheres.push(Sphere::new(center, 0.4).unwrap());
        }
    }
    spheres.push(spheres[100]);
    spheres.push(Sphere::new(right * 100.0, 0.1).unwrap());
    let grid = LightGrid::new(&spheres, axes()).expect("a crowd");
    let sum = check(&spheres, &grid, 1);
    assert!((20 * 30 * 29 / 2..20 * 30 * 31 / 2).contains(&sum), "{sum}");
}

#[test]
fn crowds_that_do_not_fit_into_cells_have_none() {
    let sides = DVec3::splat(1.0);
    assert!(LightGrid::new(&spheres(100, sides, |_| 0.1), axes()).is_none());
    // Most of them share the cell of a few.
    let crowded = spheres(5000, sides, |random| if random < 0.1 { 1.0 } else { 1e-3 });
    assert!(LightGrid::new(&crowded, axes()).is_none());
}

/// Far away, and in deep worlds, centers are not known well enough beside small radii.
#[test]
fn nothing_is_found_where_roundings_are_as_large_as_spheres() {
    let find = |far: f64, sides: DVec3, radius: f64| {
        let moved = |sphere: Sphere| Sphere::new(sphere.center() + far, radius).unwrap();
        let spheres: Vec<Sphere> = spheres(1000, sides, |_| radius)
            .into_iter()
            .map(moved)
            .collect();
        let grid = LightGrid::new(&spheres, axes())?;
        let asked = Asked {
            center: spheres[500].center(),
            radius,
            index: 500,
        };
        Some(grid.find(&spheres, &asked, &mut Found::default()))
    };
    let sides = DVec3::splat(1.0);
    assert_eq!(find(0.0, sides, 0.05), Some(true));
    assert_eq!(find(1e6, sides, 0.05), Some(true));
    assert_eq!(find(1e9, sides, 0.05), Some(false));
    assert_eq!(find(0.0, sides * 1e3, 0.05), Some(false));
    assert_eq!(find(0.0, sides, 1e-6), Some(false));
}
