//! Tests of `point_occluders.rs`.

use super::*;
use crate::search::tests::Random;

/// Whether a ball reaches some of the balls between the apex and the last one, by many of them.
fn reaches(beam: &Beam, (middle, around): (DVec3, f64), center: DVec3, radius: f64) -> bool {
    (0..=400).any(|step| {
        let share = f64::from(step) / 400.0;
        let point = beam.apex.lerp(middle, share);
        point.distance(center) < radius + around * share
    })
}

#[test]
fn a_beam_leaves_out_nothing_that_reaches_into_it() {
    let mut random = Random(8);
    let (mut reached, mut left_out) = (0, 0);
    for _ in 0..20_000 {
        let (apex, middle) = (random.point() * 2.0, random.point() * 2.0);
        let around = random.number() * random.number();
        let beam = Beam::new(apex, middle, around);
        let beside = apex.lerp(middle, random.number()) + random.point();
        let (center, radius) = (beside, 0.5 * random.number());
        let claimed = beam.is_reached_by(center, radius);
        let found = reaches(&beam, (middle, around), center, radius);
        assert!(claimed || !found, "{beam:?} {center} {radius}");
        reached += u32::from(found);
        left_out += u32::from(!claimed);
    }
    assert!(reached > 500 && left_out > 5000, "{reached} {left_out}");
}

/// Whether the surface of a sphere is met on the way between two points: by the distances of points on it.
fn is_between(sphere: &Sphere, from: DVec3, to: DVec3) -> bool {
    let inside = |point: DVec3| point.distance(sphere.center()) < sphere.radius();
    let way = to - from;
    let share = (sphere.center() - from).dot(way) / way.length_squared();
    let nearest = from + way * share.clamp(0.0, 1.0);
    inside(from) != inside(to) || inside(nearest) && !(inside(from) && inside(to))
}

fn sphere(random: &mut Random) -> Sphere {
    let radius = 0.05 + 0.5 * random.number() * random.number();
    Sphere::new(random.point() * 2.0, radius).unwrap()
}

#[test]
fn a_light_is_hidden_where_surfaces_lie_between() {
    let mut random = Random(9);
    let (mut dark, mut asked) = (0, 0);
    for _ in 0..300 {
        let spheres: Vec<Sphere> = (0..30).map(|_| sphere(&mut random)).collect();
        let hierarchy = Arc::new(Hierarchy::new(&spheres));
        let position = random.point() * 2.0;
        let occluders = PointOccluders::new(&spheres, hierarchy, position, 0.0);
        for (index, own) in spheres.iter().enumerate() {
            let point = own.center() + random.point().normalize() * own.radius();
            let has_light = own.center().distance(position) < own.radius();
            let mut others = spheres.iter().enumerate();
            let expected = has_light
                || others
                    .any(|(other, sphere)| other != index && is_between(sphere, point, position));
            let found = occluders.is_blocked(point, 1e-15, index);
            assert_eq!(found, expected, "{point} {position} {own:?}");
            dark += u32::from(found);
            asked += 1;
        }
    }
    assert!(
        dark > asked / 10 && dark < asked * 9 / 10,
        "{dark} of {asked}"
    );
}

#[test]
fn spheres_that_hide_a_light_are_asked_before_points() {
    let mut random = Random(11);
    let (mut hiding, mut left_out) = (0, 0);
    for case in 0..400 {
        // Scattered, and nearly coincident ones.
        let nearly = |random: &mut Random| Sphere::new(random.point() * 0.02, 1.0).unwrap();
        let one = |_| match case % 2 {
            0 => sphere(&mut random),
            _ => nearly(&mut random),
        };
        let spheres: Vec<Sphere> = (0..40).map(one).collect();
        let hierarchy = Arc::new(Hierarchy::new(&spheres));
        let radii = spheres.iter().map(Sphere::radius);
        let smallest = radii.fold(f64::INFINITY, f64::min);
        let position = random.point() * 6.0;
        let occluders = PointOccluders::new(&spheres, hierarchy, position, smallest);
        let (middle, around) = (random.point() * 2.0, 0.02);
        let beam = Beam::new(position, middle, around);
        let before = Before {
            around,
            eye: DVec3::splat(1e3),
        };
        let [mut all, mut asked] = [vec![false; spheres.len()], vec![false; spheres.len()]];
        occluders.any_in(&beam, |index| {
            all[index] = true;
            false
        });
        occluders.any_before(&beam, &before, |index| {
            asked[index] = true;
            false
        });
        left_out += (0..spheres.len())
            .filter(|&index| all[index] && !asked[index])
            .count();
        for side in [DVec3::ZERO, DVec3::X, DVec3::NEG_Y, DVec3::Z] {
            let point = middle + side * around;
            for (index, sphere) in spheres.iter().enumerate() {
                let is_outside = point.distance(sphere.center()) > sphere.radius();
                let is_around = position.distance(sphere.center()) <= sphere.radius();
                if is_outside && !is_around && is_between(sphere, point, position) {
                    hiding += 1;
                    assert!(asked[index], "{sphere:?} {point} {position}");
                }
            }
        }
    }
    assert!(hiding > 100 && left_out > 100, "{hiding} {left_out}");
}
