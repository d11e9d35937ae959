//! Every sphere is found where it is, on sets of every kind.

use glam::DVec3;

use super::*;
use crate::search::tests::Random;

/// All spheres that a box along the axes reaches, by the hierarchy; fails where one comes twice.
fn found(hierarchy: &Hierarchy, low: DVec3, high: DVec3) -> Vec<u32> {
    let mut found = Vec::new();
    let may = |boxes: &Boxes| {
        let mut may = 0;
        for place in 0..WIDTH {
            let is_beyond = (0..3).any(|axis| {
                f64::from(boxes.low[axis][place]) > high[axis]
                    || f64::from(boxes.high[axis][place]) < low[axis]
            });
            may |= u8::from(!is_beyond) << place;
        }
        BoxTest {
            may,
            keys: [0.0; WIDTH],
        }
    };
    hierarchy.any(may, |group| {
        let indices = hierarchy.indices(group).iter().copied();
        found.extend(indices.filter(|&index| is_sphere(index)));
        false
    });
    let count = found.len();
    found.sort_unstable();
    found.dedup();
    assert_eq!(found.len(), count, "some sphere came twice");
    found
}

fn sets() -> Vec<Vec<(DVec3, f64)>> {
    let mut random = Random(11);
    let mut sets = vec![vec![], vec![(DVec3::ONE, 2.0)]];
    for count in [7, 8, 9, 63, 64, 65, 511, 513, 5000] {
        sets.push((0..count).map(|_| (random.point(), 0.1)).collect());
    }
    sets.push(vec![(DVec3::ONE, 0.5); 1000]);
    // Equal spheres among others that lie as near as single precision can tell.
    let near = |index: i32| {
        let moved = if index % 3 == 0 { 1e-12 } else { 0.0 };
        (
            DVec3::new(1.0, 2.0 + moved, 3.0),
            if index % 7 == 0 { 0.4 } else { 0.5 },
        )
    };
    sets.push((0..1000).map(near).collect());
    sets.push((0..1000).map(|x| (DVec3::X * f64::from(x), 0.6)).collect());
    sets.push((1..1000).map(|x| (DVec3::ZERO, f64::from(x))).collect());
    let decades = (0..1000).map(|_| {
        let radius = libm::exp10(12.0 * random.number() - 6.0);
        (random.point() * 1e3, radius)
    });
    sets.push(decades.collect());
    let mut grains: Vec<_> = (0..3000).map(|_| (random.point(), 0.01)).collect();
    grains.push((DVec3::NEG_Y * 1e6, 1e6));
    grains.push((DVec3::splat(1e200), 1.0));
    grains.push((DVec3::ZERO, 1e300));
    sets.push(grains);
    sets
}

#[test]
fn every_sphere_is_found() {
    let mut random = Random(3);
    for set in sets() {
        let spheres = set
            .iter()
            .map(|&(center, radius)| Sphere::new(center, radius).unwrap());
        let spheres: Vec<Sphere> = spheres.collect();
        let hierarchy = Hierarchy::new(&spheres);
        // Of equal spheres the first is enough.
        let is_first = |index: usize| !set[..index].contains(&set[index]);
        let firsts: Vec<bool> = (0..set.len()).map(is_first).collect();
        for _ in 0..50 {
            let size = libm::exp10(8.0 * random.number() - 5.0);
            let middle = random.point() * libm::exp10(4.0 * random.number() - 1.0);
            let (low, high) = (middle - size, middle + size);
            let found = found(&hierarchy, low, high);
            for (index, (center, radius)) in set.iter().enumerate() {
                let reaches = (center - radius).cmple(high) & (center + radius).cmpge(low);
                let is_needed = reaches.all() && firsts[index];
                let index = index as u32;
                assert!(!is_needed || found.binary_search(&index).is_ok());
            }
        }
        let everywhere = DVec3::splat(f64::INFINITY);
        let all = found(&hierarchy, -everywhere, everywhere).len();
        let distinct = firsts.iter().filter(|first| **first).count();
        assert_eq!(all, distinct);
    }
}

#[test]
fn groups_are_around_their_spheres_and_barely() {
    for set in sets() {
        // What single precision cannot hold is in no group.
        let is_held = |&(center, radius): &(DVec3, f64)| center.abs().max_element() + radius < 1e38;
        let held = set.iter().copied().filter(is_held);
        let spheres: Vec<Sphere> = held
            .map(|(center, radius)| Sphere::new(center, radius).unwrap())
            .collect();
        let hierarchy = Hierarchy::new(&spheres);
        for number in 0..hierarchy.groups.len() as u32 {
            let group = hierarchy.group(number, &spheres);
            for (place, &index) in hierarchy.indices(number).iter().enumerate() {
                if !is_sphere(index) {
                    continue;
                }
                let sphere = &spheres[index as usize];
                let center = DVec3::from_array(group.center.map(|axis| axis[place]));
                let moved = (center - sphere.center()).length();
                let (radius, excess) = (group.radius[place], group.excess(place));
                assert!(moved + sphere.radius() <= radius);
                assert!(moved + radius - excess <= sphere.radius());
                let size = center.abs().element_sum() + radius;
                assert!(excess < 1e-6 * size, "{excess:e} of {size:e}");
            }
        }
    }
}

/// Counted work: what a small box finds does not grow with all that is elsewhere.
#[test]
fn few_others_are_found() {
    let mut random = Random(5);
    let mut spheres: Vec<Sphere> = (0..20_000)
        .map(|_| Sphere::new(random.point() * 100.0, 0.5).unwrap())
        .collect();
    spheres.push(Sphere::new(DVec3::NEG_Y * 1e6, 1e6).unwrap());
    spheres.push(Sphere::new(DVec3::splat(1e7), 0.5).unwrap());
    let hierarchy = Hierarchy::new(&spheres);
    let mut count = 0;
    for _ in 0..1000 {
        let point = random.point() * 100.0;
        count += found(&hierarchy, point, point).len();
    }
    assert!(
        count < 40 * 1000,
        "{} of a point",
        f64::from(count as u32) / 1e3
    );
}
