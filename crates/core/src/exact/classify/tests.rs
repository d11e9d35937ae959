//! Spheres left out of a cell, checked against many of its points.

use fearless_simd::Level;
use glam::{DVec2, DVec3};

use super::active::{Active, Terminators};
use super::hidden::HiddenSpheres;
use super::occluder_cache::{OccluderCache, Shade};
use super::patch::Patch;
use crate::edges::cell::{Ball, Cell};
use crate::edges::shadow::Caster;
use crate::edges::silhouette::silhouette;
use crate::edges::tests::{
    ball_in_front, cell_at, coordinate, direction, first_hit, magnitude, ray,
};
use crate::exact::scene::{InCamera, Light};
use crate::model::camera::{Camera, Lens};
use crate::model::color::Color;
use crate::model::light::Light as WorldLight;
use crate::model::material::Material;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::angle::Angle;
use crate::picture::image::Channels;
use crate::search::tests::Random;
use crate::search::visibility::Visibility;

fn patch_of(cell: &Cell, ball: &Ball) -> Patch {
    Patch::new(cell, ball, &silhouette(cell, ball), &cell.dot(ball.center))
}

fn distance_from_way(patch: &Patch, point: DVec3) -> f64 {
    let [start, end] = patch.ends;
    let way = end - start;
    let share = (point - start).dot(way) / way.length_squared();
    let share = if share.is_nan() { 0.0 } else { share };
    (start + way * share.clamp(0.0, 1.0)).distance(point)
}

/// Whether a ball keeps light from a point.
fn is_between(caster: &Caster, point: DVec3, toward: DVec3) -> bool {
    let to_center = caster.center - point;
    let ahead = to_center.dot(toward);
    let inside = to_center.length() < caster.radius;
    inside || ahead > 0.0 && (to_center - toward * ahead).length() < caster.radius
}

#[test]
fn all_that_a_cell_sees_of_a_sphere_lies_in_its_patch() {
    let mut random = Random(1);
    let (mut seen, mut narrow) = (0, 0);
    for _ in 0..2000 {
        let ball = ball_in_front(&mut random);
        let widths = magnitude(&mut random, 1e-4, 4.0);
        let mut cell = cell_at(&mut random, &ball, widths);
        // At the contour, too.
        let aside = direction(&mut random).with_z(0.0) * 1.2 * random.number();
        cell.middle += aside * (ball.radius / ball.center.z);
        let patch = patch_of(&cell, &ball);
        for _ in 0..30 {
            let mut at = || (coordinate(&mut random) * 1.1).clamp(-0.5, 0.5);
            let Some(point) = first_hit(ray(&cell, at(), at()), &ball) else {
                continue;
            };
            let off = distance_from_way(&patch, point);
            let rounding = 1e-9 * ball.center.length() * f64::EPSILON.sqrt();
            assert!(
                off <= patch.around + rounding,
                "{off} {patch:?} {cell:?} {ball:?}"
            );
            seen += 1;
        }
        // Nor is the patch idle: for a small cell it is no more than a part of the ball.
        narrow += u32::from(patch.ends[0].distance(patch.ends[1]) < 0.5 * ball.radius);
    }
    assert!(seen > 10_000 && narrow > 500, "{seen} {narrow}");
}

/// A light from some direction.
fn light_from(toward: DVec3) -> Light {
    let (right, up) = toward.any_orthonormal_pair();
    Light {
        index: 0,
        intensity: Color::ONE,
        toward,
        right,
        up,
        near: None,
        is_shut_off: false,
    }
}

#[test]
fn shadows_on_a_patch_are_never_claimed_too_large() {
    let mut random = Random(2);
    let (mut counts, mut together) = ([0; 3], 0);
    for _ in 0..6000 {
        let start = random.point() * 3.0;
        let patch = Patch {
            ends: [
                start,
                start + random.point() * magnitude(&mut random, 1e-3, 1.0),
            ],
            around: magnitude(&mut random, 1e-4, 0.3),
            is_parallel: false,
        };
        let light = light_from(direction(&mut random));
        let toward = light.toward;
        let casters: Vec<Caster> = (0..7)
            .map(|_| {
                let lift = toward * (6.0 * random.number() - 1.0);
                let center = start + random.point() * 0.7 + lift;
                light.caster(center, magnitude(&mut random, 0.02, 0.8))
            })
            .collect();
        let (mut cache, range) = OccluderCache::of(&casters, &light);
        let shade = cache.shade(&patch, &light, range);
        let kind = match shade {
            Shade::Nothing => 0,
            Shade::Edges(_) => 1,
            Shade::Everything => 2,
            Shade::Crowd => 3,
        };
        counts[kind] += 1;
        let (mut dark, mut alone) = (true, false);
        for _ in 0..100 {
            let [start, end] = patch.ends;
            let way = start + (end - start) * (1.2 * coordinate(&mut random) + 0.5).clamp(0.0, 1.0);
            // Most of them near its border, where there is most to be missed.
            let away = patch.around * (1.0 - random.number() * random.number());
            let point = way + direction(&mut random) * away;
            // A point inside of a caster is behind its surface, whatever is ahead.
            let is_open = |caster: &&Caster| point.distance(caster.center) > caster.radius;
            let hides = |caster: &Caster| is_between(caster, point, toward);
            if !casters.iter().all(|caster| is_open(&caster)) {
                continue;
            }
            let is_dark = casters.iter().any(hides);
            match shade {
                Shade::Everything => assert!(is_dark, "{patch:?} {casters:?}"),
                Shade::Crowd => unreachable!("few edges"),
                Shade::Nothing => assert!(!is_dark, "{patch:?} {casters:?}"),
                Shade::Edges(found) => {
                    let mut spheres = found.iter().map(|&index| &casters[index as usize]);
                    let known = spheres.any(hides);
                    assert_eq!(is_dark, known, "{patch:?} {casters:?} {found:?}");
                }
            }
            dark &= is_dark;
            alone |= casters.iter().filter(|caster| hides(caster)).count() == 1;
        }
        together += u32::from(shade == Shade::Everything && dark && alone);
    }
    assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
    assert!(together > 10, "{together}");
}

fn cloud(random: &mut Random, count: usize) -> World {
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    for _ in 0..count {
        let center = random.point() + DVec3::Z * 3.0;
        let radius = magnitude(random, 0.01, 0.3);
        world.add_sphere(Sphere::new(center, radius).unwrap(), white);
    }
    let floor = Sphere::new(DVec3::new(0.0, -1001.0, 3.0), 1000.0).unwrap();
    world.add_sphere(floor, white);
    for toward in [direction(random), DVec3::Y, direction(random)] {
        world
            .lights
            .extend(WorldLight::directional(toward, Color::ONE));
    }
    world
}

/// Whoever keeps light from a point that a tile sees is among its occluders, and nobody whose shadow
/// is known to pass by.
#[test]
fn occluders_are_all_spheres_that_matter() {
    let mut random = Random(3);
    let (mut dark, mut listed, mut asked) = (0, 0, 0);
    for step in 0..12 {
        let world = cloud(&mut random, [5, 60, 300][step % 3]);
        let visibility = Visibility::new(&world);
        let degrees = |range: f64| Angle::from_degrees(range);
        let view = View {
            camera: Camera::free(
                random.point() * 0.3,
                degrees(10.0),
                degrees(-8.0),
                degrees(30.0),
            ),
            lens: Lens {
                width: 2.0,
                distance: 2.0,
                shift: DVec2::ZERO,
                pixel_aspect: 1.0,
            },
            zoom: 1.0,
            width: 8,
            height: 8,
            frame: 1,
        };
        let scene = InCamera::new(&world, &visibility, &view, Channels::Grey, 0);
        for _ in 0..20 {
            let tile = Cell {
                middle: (random.point() * 0.4).with_z(1.0),
                size: [0; 2].map(|_| magnitude(&mut random, 1e-3, 0.3)),
                projection: crate::model::camera::Projection::Central,
            };
            let mut cache = OccluderCache::new(tile, tile.size[0] / 8.0);
            for sphere in 0..world.spheres().len() {
                let ball = scene.ball(sphere);
                let points: Vec<DVec3> = (0..20)
                    .filter_map(|_| {
                        let (x, y) = (coordinate(&mut random), coordinate(&mut random));
                        first_hit(ray(&tile, x, y), &ball)
                    })
                    .collect();
                if ball.outside <= 0.0 || points.is_empty() {
                    continue;
                }
                for light in 0..scene.lights.len() {
                    let toward = scene.lights[light].toward;
                    let range = cache.occluders(&scene, sphere, light);
                    assert_eq!(range, cache.occluders(&scene, sphere, light), "asked again");
                    let is_dark = range.is_none();
                    let found = cache.listed(range);
                    for other in (0..world.spheres().len()).filter(|&other| other != sphere) {
                        let (center, radius) = scene.center(other);
                        let caster = scene.lights[light].caster(center, radius);
                        let is_listed = found.contains(&other);
                        let hides = |&point: &DVec3| is_between(&caster, point, toward);
                        // A point inside of another sphere is not seen, unless the eye is in there.
                        let is_open = |point: &DVec3| point.distance(caster.center) > caster.radius;
                        let keeps = points.iter().any(|at| is_open(at) && hides(at));
                        assert!(
                            is_listed || is_dark || !keeps,
                            "{other} keeps light from {sphere}"
                        );
                        dark += u32::from(keeps);
                        listed += u32::from(is_listed);
                        asked += 1;
                    }
                    assert!(!found.contains(&sphere), "{sphere} shades itself");
                }
            }
        }
    }
    assert!(dark > 1000 && listed < asked / 4, "{dark} {listed} {asked}");
}

#[test]
fn coincident_spheres_cast_no_shadow_on_each_other() {
    let mut random = Random(4);
    let mut world = cloud(&mut random, 3);
    let white = world.add_material(Material::MATTE_WHITE);
    let twin = world.spheres()[0];
    let other = world.spheres().len();
    world.add_sphere(twin, white);
    let visibility = Visibility::new(&world);
    let view = View {
        camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
        lens: Lens {
            width: 2.0,
            distance: 1.0,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0,
        width: 8,
        height: 8,
        frame: 1,
    };
    let scene = InCamera::new(&world, &visibility, &view, Channels::Grey, 0);
    let tile = cell_at(&mut random, &scene.ball(0), 2.0);
    let mut cache = OccluderCache::new(tile, tile.size[0] / 8.0);
    for light in 0..scene.lights.len() {
        for (sphere, twin) in [(0, other), (other, 0)] {
            let range = cache.occluders(&scene, sphere, light);
            assert!(!cache.listed(range).contains(&twin));
        }
    }
}

#[test]
fn what_is_seen_in_a_cell_is_not_left_out_as_hidden() {
    let mut random = Random(5);
    let (mut left_out, mut seen) = (0, 0);
    for _ in 0..3000 {
        let front = ball_in_front(&mut random);
        let width = magnitude(&mut random, 0.2, 3.0);
        let cell = cell_at(&mut random, &front, width);
        let mut active: Vec<Active> = (0..12)
            .map(|sphere| {
                let aside = (random.point() * front.radius).with_z(0.0);
                let center = (front.center + aside) * (1.0 + 3.0 * random.number());
                let radius = front.radius * (0.5 + random.number());
                let ball = Ball {
                    center,
                    radius,
                    outside: center.length_squared() - radius * radius,
                    power: center.length_squared() - radius * radius,
                    projection: crate::model::camera::Projection::Central,
                };
                Active {
                    sphere,
                    ball,
                    discriminant: silhouette(&cell, &ball),
                    along: cell.dot(center),
                    terminators: Terminators::Plain,
                    is_dark: false,
                }
            })
            .collect();
        let all = active.clone();
        HiddenSpheres::default().remove(Level::new(), &mut active);
        left_out += all.len() - active.len();
        for _ in 0..100 {
            let ray = ray(&cell, coordinate(&mut random), coordinate(&mut random));
            let hits = all.iter().filter_map(|active| {
                let point = first_hit(ray, &active.ball)?;
                Some((point.length(), active.sphere))
            });
            let first = hits.min_by(|one, other| one.0.total_cmp(&other.0));
            let Some((_, first)) = first else { continue };
            seen += 1;
            assert!(
                active.iter().any(|active| active.sphere == first),
                "{first} of {all:?} in {cell:?}"
            );
        }
    }
    assert!(left_out > 5000 && seen > 50_000, "{left_out} {seen}");
}
