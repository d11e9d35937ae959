//! Scenes whose lengths or light are far from 1: huge floors, viewpoints near surfaces, distant cameras, spheres that
//! nearly coincide, and any brightness.

use glam::DVec3;

use super::draft::{Draft, SIDE, sphere};
use super::outlines::outlined;
use super::point_lights::{lights_between_spheres, near_lights};
use super::pose::Pose;
use super::scenes::{
    DISTANCE, add_balls, exponents, floors, grazing_shadows, highlights, ordinary, place, seams,
    shutters, surface_bumps, touching, wide_lenses,
};
use marbles_tests::numbers::Numbers;

/// A number whose decimal logarithm is between two numbers.
pub(super) fn power_of_ten(numbers: &mut Numbers, low: f64, high: f64) -> f64 {
    libm::pow(10.0, numbers.between(low, high))
}

/// The direction through a point of the picture, with a lens of this distance in pixels.
fn through(numbers: &mut Numbers, distance: f64) -> DVec3 {
    let half = 0.45 * f64::from(SIDE);
    let [u, v] = [(); 2].map(|()| numbers.between(-half, half));
    DVec3::new(u / distance, v / distance, 1.0)
}

fn surface(numbers: &mut Numbers) -> String {
    let exponent = numbers.either(&["1", "1", "2", "0.5"]);
    let highlight = numbers.either(&["", ", highlight: (strength: 0.4, shininess: 20)"]);
    format!("albedo: (0.9, 0.6, 0.3), exponent: {exponent}{highlight}")
}

/// Balls on, above and cut by a floor with a radius from 1e3 to 1e12, under suns that may be low, lamps, and parallel
/// lenses.
pub(super) fn huge_floors(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 0);
    draft.material = surface(numbers);
    let radius = power_of_ten(numbers, 3.0, 12.0);
    let is_parallel = numbers.below(3) == 0;
    let (below, tilt) = match is_parallel {
        true => (numbers.between(80.0, 150.0), numbers.between(-70.0, -20.0)),
        false => (numbers.between(5.0, 30.0), numbers.between(-25.0, 2.0)),
    };
    let turned = [
        numbers.between(-180.0, 180.0),
        tilt,
        numbers.between(-20.0, 20.0),
    ];
    let straight = [0.0, if is_parallel { tilt } else { 0.0 }, 0.0];
    let angles = if numbers.below(2) == 0 {
        turned
    } else {
        straight
    };
    let pose = Pose::new(DVec3::ZERO, angles);
    draft.head[2] = pose.camera();
    let width = f64::from(SIDE) * numbers.between(1.0, 3.0);
    if is_parallel {
        draft.head[1] = format!("lens: Parallel(width: {width})");
    }
    draft.sphere([0.0, -radius - below, 0.0], radius);
    // Where a ray through the picture meets the floor, or somewhere on the ray.
    let spot = |numbers: &mut Numbers| {
        let DVec3 { x, y, .. } = through(numbers, DISTANCE);
        let (start, way) = match is_parallel {
            true => (
                DVec3::new(x, y, 0.0) * (width / f64::from(SIDE) * DISTANCE),
                DVec3::Z,
            ),
            false => (DVec3::ZERO, DVec3::new(x, y, 1.0)),
        };
        let (start, way) = (pose.direction(start), pose.direction(way));
        let t = (-below - start.y) / way.y;
        let far = numbers.between(60.0, 200.0);
        start + way * if t > 20.0 && t < 400.0 { t } else { far }
    };
    for _ in 0..numbers.below(4) + 2 {
        let DVec3 { x, z, .. } = spot(numbers);
        let size = numbers.between(2.0, 12.0);
        let height = size * numbers.either(&[1.0, 1.0, numbers.clone().between(-0.9, 0.9), 1.5]);
        draft.sphere(
            [x, height - below - 0.5 * (x * x + z * z) / radius, z],
            size,
        );
    }
    for _ in 0..numbers.below(2) + 1 {
        let turn = numbers.between(0.0, std::f64::consts::TAU);
        let (sin, cos) = (libm::sin(turn), libm::cos(turn));
        match numbers.below(3) {
            0 => draft.light([cos, numbers.between(0.3, 2.0), sin], 0.6),
            1 => draft.light([cos, power_of_ten(numbers, -4.0, -1.0), sin], 0.6),
            _ => {
                let DVec3 { x, z, .. } = spot(numbers);
                let height = numbers.between(5.0, 60.0);
                let reference = numbers.either(&[None, Some(height)]);
                draft.point_light([x, height - below, z], 0.5, reference);
            }
        }
    }
    draft
}

/// A viewpoint at a distance of 1e-1 to 1e-9 radii from a surface, and equally near balls.
pub(super) fn near_eyes(numbers: &mut Numbers) -> Draft {
    let mut draft = Draft::new(numbers, DISTANCE, 0);
    draft.material = surface(numbers);
    let radius = power_of_ten(numbers, 0.0, 4.0);
    let height = radius * power_of_ten(numbers, -9.0, -1.0);
    let pose = Pose::random(numbers, radius);
    draft.head[1] = format!("lens: Retina(width: {SIDE}, distance: {DISTANCE})");
    draft.head[2] = pose.camera();
    let down = DVec3::new(numbers.between(-0.5, 0.5), -1.0, numbers.between(-0.2, 0.6)).normalize();
    draft.sphere(pose.place(down * (radius + height)), radius);
    for _ in 0..numbers.below(5) + 2 {
        let way = through(numbers, DISTANCE);
        let t = height / way.dot(down);
        let size = numbers.between(1.0, 9.0) / DISTANCE;
        let center = if t > 0.0 && t < 60.0 * height && numbers.below(4) > 0 {
            let raised = numbers.either(&[1.0, numbers.clone().between(-0.9, 1.0)]);
            way * t - down * (size * t * raised)
        } else {
            way * (height * numbers.between(3.0, 30.0))
        };
        draft.sphere(pose.place(center), size * center.z);
    }
    for _ in 0..numbers.below(2) + 1 {
        let across = DVec3::from_array(numbers.direction());
        let up = numbers.between(-0.3, 1.5);
        if numbers.below(3) > 0 {
            draft.light(pose.direction(across - down * up).to_array(), 0.6);
        } else {
            // In the axes of the camera, beside the way to what is seen.
            let along = DVec3::Z * numbers.between(0.0, 20.0);
            let across = across - down * across.dot(down);
            let position =
                across * 8.0 + (along - down * along.dot(down)) - down * (2.0 * up.abs());
            let reference = numbers.either(&[None, Some(15.0 * height)]);
            draft.point_light(pose.place(position * height), 0.5, reference);
        }
    }
    draft
}

/// Parallel lenses at a distance of 1 to 1e12 from the scene, straight and turned.
pub(super) fn far_parallel_lenses(numbers: &mut Numbers) -> Draft {
    // As far as this all is before the plane in which rays begin; judges stand there.
    const NEAR: f64 = 1000.0;
    let mut draft = Draft::new(numbers, DISTANCE, 0);
    draft.material = surface(numbers);
    let width = f64::from(SIDE) * numbers.between(1.0, 3.0);
    draft.head[1] = format!("lens: Parallel(width: {width})");
    let distance = power_of_ten(numbers, 0.0, 12.0);
    let target = [(); 3].map(|()| numbers.between(-100.0, 100.0));
    let [azimuth, elevation, roll] = [180.0, 80.0, 30.0].map(|most| numbers.between(-most, most));
    let [x, y, z] = target;
    let kind = numbers.below(4);
    let (angles, distance) = match kind {
        0 => ([0.0; 3], distance),
        // Doubles tell no more of a turned camera that is free.
        3 => ([azimuth, -elevation, roll], distance.min(1e6)),
        _ => ([azimuth, -elevation, roll], distance),
    };
    let pose = Pose::new(target.into(), angles);
    let camera = |distance: f64| {
        let [px, py, pz] = pose.place(DVec3::NEG_Z * distance);
        match kind {
            0 => format!("camera: Free(position: ({x}, {y}, {pz}))"),
            1 => format!(
                "camera: Orbit(target: ({x}, {y}, {z}), radius: {distance}, azimuth: {azimuth}, \
                 elevation: {elevation}, roll: {roll})"
            ),
            2 => format!(
                "camera: LookAt(position: ({px}, {py}, {pz}), target: ({x}, {y}, {z}), roll: {roll})"
            ),
            _ => Pose::new([px, py, pz].into(), angles).camera(),
        }
    };
    draft.head[2] = camera(distance);
    if distance > NEAR && kind < 3 {
        draft.near_camera = Some(camera(NEAR));
    }
    let half = 0.4 * width;
    for _ in 0..numbers.below(5) + 2 {
        let center = [half, half, 60.0].map(|most| numbers.between(-most, most));
        draft.sphere(pose.place(center.into()), numbers.between(2.0, 14.0));
    }
    // The plane in which the rays of judges begin would cut a floor.
    if draft.near_camera.is_none() && numbers.below(2) == 0 {
        let radius = power_of_ten(numbers, 3.0, 8.0);
        draft.sphere([x, y - radius - 20.0, z], radius);
    }
    for _ in 0..numbers.below(2) + 1 {
        let direction = DVec3::from_array(numbers.direction());
        let toward = direction - DVec3::Z * 0.5;
        if numbers.below(3) > 0 {
            draft.light(pose.direction(toward).to_array(), 0.6);
        } else {
            let reference = numbers.either(&[None, Some(40.0)]);
            draft.point_light(pose.place(toward * 50.0), 0.5, reference);
        }
    }
    draft
}

/// Spheres that coincide up to 1e-3 to 1e-16 of their radius.
pub(super) fn nearly_coincident(numbers: &mut Numbers) -> Draft {
    // Spheres that are no farther apart change nothing that could be told.
    const ALIKE: f64 = 1e-12;
    let mut draft = Draft::new(numbers, DISTANCE, 0);
    draft.material = surface(numbers);
    for _ in 0..numbers.below(2) + 1 {
        let depth = numbers.between(80.0, 120.0);
        let ([x, y, z], radius) = (place(numbers, depth), numbers.between(5.0, 20.0));
        let apart = power_of_ten(numbers, -16.0, -3.0);
        let count = power_of_ten(numbers, 0.3, 1.2) as usize;
        draft.sphere([x, y, z], radius);
        for _ in 1..count {
            let [u, v, w, grown] = [(); 4].map(|()| radius * apart * numbers.between(-1.0, 1.0));
            let near = sphere([x + u, y + v, z + w], radius + grown);
            if apart < ALIKE {
                draft.doubles.push(near);
            } else {
                draft.spheres.push(near);
            }
        }
    }
    add_balls(numbers, &mut draft, 1, [3.0, 9.0]);
    for _ in 0..numbers.below(2) + 1 {
        let [u, v, w] = numbers.direction();
        if numbers.below(2) == 0 {
            draft.light([u, v, w - 0.5], 0.6);
        } else {
            let reference = numbers.either(&[None, Some(60.0)]);
            draft.point_light([60.0 * u, 60.0 * v, 60.0 + 50.0 * w], 0.5, reference);
        }
    }
    draft
}

/// Scenes of other families with light from 1e-6 to 1e6, with their backgrounds or with alpha.
pub(super) fn brightness(numbers: &mut Numbers) -> Draft {
    let family = numbers.either(&[
        ordinary,
        touching,
        grazing_shadows,
        exponents,
        highlights,
        wide_lenses,
        floors,
        seams,
        near_lights,
        lights_between_spheres,
        outlined,
    ]);
    let mut draft = match numbers.below(20) {
        0 => shutters(numbers),
        1 | 2 => surface_bumps(numbers, [-0.2, 1.5]),
        _ => family(numbers),
    };
    draft.light = power_of_ten(numbers, -6.0, 6.0);
    draft.alpha = numbers.below(2) == 0;
    draft
}
