//! Compares integrals over visible directions with integrals along meridians.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::{Hidden, share_of, sky_share};
use crate::soft::cap::{Cap, Meeting};

/// Numbers from 0 to 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 * 2_f64.powi(-53)
    }

    fn direction(&mut self) -> DVec3 {
        let (z, turn) = (2.0 * self.next() - 1.0, TAU * self.next());
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * libm::cos(turn), across * libm::sin(turn), z)
    }
}

/// The integral of the directions within `reach` of an axis that no cap hides, meridian by meridian.
fn along_meridians(caps: &[Cap], axis: DVec3, reach: f64) -> DVec3 {
    let x = axis.any_orthonormal_vector();
    let y = axis.cross(x);
    let meridian = |turn: f64| {
        let aside = x * libm::cos(turn) + y * libm::sin(turn);
        let mut hidden: Vec<[f64; 2]> = Vec::new();
        for cap in caps {
            let (a, b) = (cap.axis.dot(axis), cap.axis.dot(aside));
            let length = a.hypot(b);
            // The cosine of the angle to the meridian's plane, less that of the cap, both from 1.
            let aslant = cap.axis.dot(axis.cross(aside));
            let above = cap.versine - aslant * aslant / (1.0 + length);
            if above <= 0.0 {
                continue;
            }
            let middle = libm::atan2(b, a);
            let half = 2.0 * libm::asin((above / (2.0 * length)).sqrt());
            for turns in [-TAU, 0.0, TAU] {
                hidden.push([middle - half + turns, middle + half + turns]);
            }
        }
        hidden.sort_by(|one, other| one[0].total_cmp(&other[0]));
        let of = |from: f64, to: f64| {
            let [from, to] = [from, to].map(|angle| angle.clamp(0.0, reach));
            let along = |angle: f64| 0.5 * libm::sin(angle) * libm::sin(angle);
            let across = |angle: f64| 0.5 * (angle - libm::sin(angle) * libm::cos(angle));
            axis * (along(to) - along(from)) + aside * (across(to) - across(from))
        };
        let mut sum = DVec3::ZERO;
        let mut end = 0.0_f64;
        for [from, to] in hidden {
            if from > end {
                sum += of(end, from);
            }
            end = end.max(to);
        }
        if end < reach {
            sum += of(end, reach);
        }
        sum
    };
    let azimuth = |at: DVec3| libm::atan2(at.dot(y), at.dot(x)).rem_euclid(TAU);
    let disc = Cap {
        versine: 1.0 - libm::cos(reach),
        ..Cap::within(axis, reach)
    };
    let mut breaks = vec![0.0, TAU];
    for (index, cap) in caps.iter().enumerate() {
        let aside = cap.axis.cross(axis).length();
        if cap.sine < aside {
            let half = libm::asin(cap.sine / aside);
            let middle = azimuth(cap.axis);
            breaks.extend([middle - half, middle + half].map(|turn| turn.rem_euclid(TAU)));
        }
        for other in caps[..index].iter().chain([&disc]) {
            breaks.extend(crossings(cap, other).into_iter().flatten().map(azimuth));
        }
    }
    breaks.sort_by(f64::total_cmp);
    let between = breaks.windows(2).map(|ends| {
        let length = ends[1] - ends[0];
        // Square roots at the ends become smooth.
        let smooth = |s: f64| {
            meridian(ends[0] + length * s * s * (3.0 - 2.0 * s)) * (6.0 * s * (1.0 - s) * length)
        };
        adaptive(
            &smooth,
            0.0,
            1.0,
            2e-14 * disc.sine.max(disc.versine).powi(2),
            16,
        )
    });
    between.sum()
}

/// The directions on the circles around two caps: only ends of intervals of quadrature.
fn crossings(one: &Cap, other: &Cap) -> Option<[DVec3; 2]> {
    let frame = one.frame();
    match one.meeting(other, false) {
        Meeting::Crossing(crossing) => {
            let toward = crossing.toward(&frame);
            let (x, y) = (toward * crossing.t, toward.perp() * crossing.root);
            let ends = [x - y, x + y];
            Some(ends.map(|at| one.point(&frame, at.normalize(), DVec3::ZERO)))
        }
        Meeting::Apart | Meeting::Inside => None,
    }
}

/// Gauss's rule with eight points, on halves until these agree.
fn adaptive(of: &dyn Fn(f64) -> DVec3, from: f64, to: f64, tolerance: f64, depth: u32) -> DVec3 {
    const RULE: [(f64, f64); 4] = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887_3),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    ];
    let rule = |from: f64, to: f64| -> DVec3 {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let pair = |&(at, weight): &(f64, f64)| {
            (of(middle - half * at) + of(middle + half * at)) * (weight * half)
        };
        RULE.iter().map(pair).sum()
    };
    let middle = 0.5 * (from + to);
    let (whole, halves) = (rule(from, to), [rule(from, middle), rule(middle, to)]);
    if depth == 0 || (whole - halves[0] - halves[1]).abs().max_element() <= tolerance {
        return halves[0] + halves[1];
    }
    adaptive(of, from, middle, 0.7 * tolerance, depth - 1)
        + adaptive(of, middle, to, 0.7 * tolerance, depth - 1)
}

fn hidden(caps: &[Cap]) -> Hidden {
    let mut hidden = Hidden::default();
    for cap in caps {
        hidden.add(*cap);
    }
    hidden
}

/// A sphere somewhere above the horizon or across it, seen from the origin.
fn sphere(random: &mut Random) -> Cap {
    let radius = 0.02 + random.next() * random.next();
    Cap::of_sphere(
        random.direction() * (radius * (1.0 + 4.0 * random.next())),
        radius,
    )
}

#[test]
fn nothing_hides_the_sky_above_a_plane() {
    let normal = DVec3::new(0.6, 0.0, 0.8);
    let seen = hidden(&[Cap::below(normal)]).seen(normal);
    assert!((sky_share(seen, normal) - 1.0).abs() < 1e-15);
}

#[test]
fn a_sphere_above_the_horizon_hides_its_projection() {
    let normal = DVec3::Y;
    for height in [1.5, 2.0, 10.0, 1e6] {
        let cap = Cap::of_sphere(DVec3::new(0.0, height, 0.0), 1.0);
        let seen = hidden(&[Cap::below(normal), cap]).seen(normal);
        let share = 1.0 - 1.0 / (height * height);
        assert!((sky_share(seen, normal) - share).abs() < 1e-15, "{height}");
    }
}

#[test]
fn the_sky_between_spheres_agrees_with_meridians() {
    let mut random = Random(1);
    let mut largest: f64 = 0.0;
    for scene in 0..400 {
        let normal = random.direction();
        let count = 1 + (random.next() * 12.0) as usize;
        let mut caps = vec![Cap::below(normal)];
        caps.extend((0..count).map(|_| sphere(&mut random)));
        if scene % 4 == 0 {
            // The shading normal of a bump has a horizon of its own.
            caps.push(Cap::below((normal + 0.3 * random.direction()).normalize()));
        }
        let seen = hidden(&caps).seen(normal);
        let truth = along_meridians(&caps, normal, PI);
        largest = largest.max((seen - truth).length());
    }
    assert!(largest < 1e-12, "{largest:e}");
}

#[test]
fn slopes_are_what_the_integral_changes_by() {
    const STEP: f64 = 1e-6;
    let mut random = Random(9);
    let (mut compared, mut steep) = (0, 0);
    for _ in 0..100 {
        let normal = random.direction();
        let mut caps = vec![Cap::below(normal)];
        caps.extend((0..8).map(|_| sphere(&mut random)));
        for (number, cap) in caps.iter_mut().enumerate() {
            cap.sphere = number as u32;
        }
        let toward = random.direction();
        let mut found = hidden(&caps);
        found.seen(toward);
        for slope in found.slopes() {
            let cap = slope.cap;
            let angle = libm::acos(cap.cosine);
            if cap.cosine < 0.1 || angle < 0.1 {
                continue;
            }
            let difference = |change: &dyn Fn(f64) -> Cap| {
                let mut changed = caps.clone();
                let mut seen = |step: f64| {
                    changed[cap.sphere as usize] = change(step);
                    hidden(&changed).seen(toward).dot(toward)
                };
                (seen(STEP) - seen(-STEP)) / (2.0 * STEP)
            };
            let by_cosine =
                difference(&|step| Cap::within(cap.axis, libm::acos(cap.cosine + step)));
            let way = cap.axis.any_orthonormal_vector() + 0.3 * cap.axis.cross(DVec3::X);
            let by_axis = difference(&|step| Cap {
                axis: (cap.axis + way * step).normalize(),
                ..cap
            });
            let slope_at = |step: f64| {
                let mut changed = caps.clone();
                let angle = libm::acos(cap.cosine + step);
                changed[cap.sphere as usize] = Cap {
                    sphere: cap.sphere,
                    ..Cap::within(cap.axis, angle)
                };
                let mut found = hidden(&changed);
                found.seen(toward);
                let mut slopes = found.slopes().iter();
                slopes
                    .find(|slope| slope.cap.sphere == cap.sphere)
                    .map_or(f64::NAN, |slope| slope.by_cosine)
            };
            let twice = (slope_at(STEP) - slope_at(-STEP)) / (2.0 * STEP);
            // Unless circles cross under a small angle.
            steep +=
                usize::from((twice - slope.twice_by_cosine).abs() > 1e-3 * (1.0 + twice.abs()));
            let errors = [
                by_cosine - slope.by_cosine,
                by_axis - slope.by_axis.dot(way),
            ];
            assert!(errors.iter().all(|error| error.abs() < 1e-5), "{errors:?}");
            compared += 1;
        }
    }
    assert!(
        compared > 200 && steep < compared / 50,
        "{compared} {steep}"
    );
}

#[test]
fn the_visible_part_of_a_disc_agrees_with_meridians() {
    let mut random = Random(2);
    for (diameter, most) in [
        (170.0, 1e-12),
        (30.0, 1e-12),
        (5.0, 1e-12),
        (0.53, 1e-12),
        (0.1, 1e-12),
        (0.01, 1e-10),
    ] {
        let angle = diameter / 360.0 * PI;
        let mut largest: f64 = 0.0;
        for _ in 0..60 {
            let disc = Cap::within(random.direction(), angle);
            let normal = (disc.axis + random.direction()).normalize();
            let mut caps = vec![Cap::below(normal)];
            // Spheres whose outlines are near the disc, some within it.
            for _ in 0..1 + (random.next() * 4.0) as usize {
                let radius = angle * libm::exp(4.0 * random.next() - 2.0);
                let aside = disc.axis.any_orthonormal_vector();
                let aside = aside * libm::cos(TAU * random.next())
                    + disc.axis.cross(aside) * libm::sin(TAU * random.next());
                let away = radius.min(1.0) + angle * (2.0 * random.next() - 1.0);
                caps.push(Cap::of_sphere(disc.axis + aside * away, radius.min(0.9)));
            }
            if random.next() < 0.3 {
                // A horizon that cuts the disc.
                let across = disc.axis.any_orthonormal_vector();
                let tilt = angle * (2.0 * random.next() - 1.0);
                caps.push(Cap::below(
                    (across + disc.axis * libm::tan(tilt)).normalize(),
                ));
            }
            let mut found = hidden(&caps);
            let share = share_of(found.seen_of(&disc), normal, &disc);
            let truth = along_meridians(&caps, disc.axis, angle);
            let truth = share_of(truth, normal, &disc);
            largest = largest.max((share - truth).abs());
        }
        assert!(largest < most, "{diameter}: {largest:e}");
    }
}

#[test]
fn a_sphere_that_is_there_twice_hides_as_much_as_one() {
    let mut random = Random(3);
    for _ in 0..200 {
        let normal = random.direction();
        let caps = [Cap::below(normal), sphere(&mut random), sphere(&mut random)];
        let once = hidden(&caps).seen(normal);
        let twice = hidden(&[caps[0], caps[1], caps[2], caps[1], caps[2]]).seen(normal);
        assert!((once - twice).length() < 1e-14);
        // Nearly the same, by some units in the last place.
        let beside = Cap {
            axis: caps[1].axis * (1.0 + 3.0 * f64::EPSILON),
            ..caps[1]
        };
        let beside = Cap {
            axis: beside.axis.normalize(),
            ..beside
        };
        let nearly = hidden(&[caps[0], caps[1], caps[2], beside]).seen(normal);
        assert!(
            (once - nearly).length() < 1e-12,
            "{:e}",
            (once - nearly).length()
        );
    }
}

#[test]
fn circles_through_one_point_hide_what_meridians_say() {
    let mut random = Random(4);
    let mut largest: f64 = 0.0;
    for scene in 0..600 {
        let normal = random.direction();
        // Of every other scene in the middle of the first circle's frame, where its arcs are cut.
        let axes = [(); 4].map(|()| (normal + random.direction()).normalize());
        let through = if scene % 2 == 0 {
            (normal + random.direction()).normalize()
        } else {
            let first = Cap::within(axes[0], 0.2 + random.next());
            first.point(&first.frame(), DVec2::X, DVec3::ZERO)
        };
        let mut caps = vec![Cap::below(normal)];
        let around = axes.iter().filter(|axis| axis.dot(through) > 0.1);
        caps.extend(around.map(|&axis| Cap::within(axis, libm::acos(axis.dot(through)))));
        let seen = hidden(&caps).seen(normal);
        let truth = along_meridians(&caps, normal, PI);
        largest = largest.max((seen - truth).length());
    }
    assert!(largest < 1e-12, "{largest:e}");
}
