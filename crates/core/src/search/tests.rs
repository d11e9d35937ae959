//! Nothing is left out that matters: against asking every sphere, on sets of every kind.

mod tiles;

use std::num::NonZeroU32;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::grid::RayPoints;
use super::hierarchy::Hierarchy;
use super::view_index::ViewIndex;
use super::visibility::Visibility;
use crate::hit::nearest::nearest;
use crate::model::camera::{Camera, Lens};
use crate::model::color::Color;
use crate::model::light::Light;
use crate::model::material::Material;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::angle::Angle;
use crate::picture::tile::Tile;

/// Uniform numbers from 0 to 1.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn number(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A point of the cube from −1 to 1.
    pub(crate) fn point(&mut self) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number()) * 2.0 - 1.0
    }
}

const SIDE: u32 = Tile::SIDE;

fn world_of(balls: impl IntoIterator<Item = (DVec3, f64)>, random: &mut Random) -> World {
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    for (center, radius) in balls {
        world.add_sphere(Sphere::new(center, radius).unwrap(), white);
    }
    for toward in [random.point(), DVec3::Y, random.point()] {
        world.lights.extend(Light::directional(toward, Color::ONE));
    }
    world
}

/// The width of pixels over their height: 1 in every second view, and up to 5 in others, or one over that.
pub(crate) fn aspect(random: &mut Random) -> f64 {
    match random.number() < 0.5 {
        true => 1.0,
        false => libm::pow(5.0, 2.0 * random.number() - 1.0),
    }
}

/// A view of the surroundings of the origin, wide or narrow, rolled and shifted.
fn view(random: &mut Random) -> View {
    let mut degrees = |range: f64| Angle::from_degrees(range * (random.number() - 0.5));
    let (azimuth, elevation, roll) = (degrees(720.0), degrees(300.0), degrees(360.0));
    let camera = Camera::orbit(
        random.point(),
        6.0 * random.number(),
        azimuth,
        elevation,
        roll,
    );
    let shift = DVec2::new(random.number() - 0.5, random.number() - 0.5);
    let lens = Lens {
        width: 0.3 + 4.0 * random.number(),
        distance: 1.0,
        shift,
        pixel_aspect: aspect(random),
    };
    View {
        camera,
        lens,
        zoom: 1.0,
        width: 37,
        height: 27,
        frame: 1,
    }
}

/// Divisions of a pixel so fine that the cells along a tile's edge lie on it, nearly.
const FINE: u32 = 1 << 20;

/// For every pixel of a tile a cell in its middle; for those at the edge also cells at the edge.
fn cells_and_edges(tile: Tile) -> Vec<(u64, u64)> {
    let fine = u64::from(FINE);
    let steps = |first: u32, count: u32| {
        let first = u64::from(first) * fine;
        let last = first + u64::from(count) * fine - 1;
        let middles = (0..u64::from(count)).map(move |pixel| first + pixel * fine + fine / 2);
        [first]
            .into_iter()
            .chain(middles)
            .chain([last])
            .collect::<Vec<u64>>()
    };
    let rows = steps(tile.row, tile.height);
    let cols = steps(tile.col, tile.width);
    rows.iter()
        .flat_map(|&row| cols.iter().map(move |&col| (col, row)))
        .collect()
}

/// Asks at the midpoints of divisions of every pixel, as a crowd that is asked nowhere else.
fn midpoints_agree(few: &ViewIndex<'_>, view: &View, hierarchy: Option<&Hierarchy>) {
    for divisions in 1..=5 {
        let samples = NonZeroU32::new(divisions).unwrap();
        let points = RayPoints::Midpoints(samples);
        let crowd = ViewIndex::with_hierarchy(&few.visibility, view, points, hierarchy);
        for tile in tiles_of(view) {
            let cells = |first: u32, count: u32| {
                let cell = u64::from(first) * u64::from(divisions);
                cell..cell + u64::from(count) * u64::from(divisions)
            };
            for row in cells(tile.row, tile.height) {
                for col in cells(tile.col, tile.width) {
                    let ray = view.ray(view.cell_center(col, row, divisions));
                    let [one, other] = [few, &crowd].map(|index| index.nearest(tile, &ray));
                    assert_eq!(one, other, "{divisions} × {divisions}");
                }
            }
        }
    }
}

/// The tiles of a picture.
fn tiles_of(view: &View) -> impl Iterator<Item = Tile> {
    let View { width, height, .. } = *view;
    let corners = (0..height)
        .step_by(SIDE as usize)
        .flat_map(move |row| (0..width).step_by(SIDE as usize).map(move |col| (col, row)));
    corners.map(move |(col, row)| Tile {
        col,
        row,
        width: SIDE.min(width - col),
        height: SIDE.min(height - row),
    })
}

/// Asks for every pixel of some views, and from every point that they see for every light.
fn agrees_with_asking_all(world: &World, random: &mut Random) {
    let near = Visibility::new(world);
    let mut very_many = near.clone();
    let hierarchy = near.hierarchy.as_ref();
    very_many.hierarchy = hierarchy.map(|near| Arc::new(near.without_near()));
    let very_many = very_many.with_lights(world, world.lights.as_slice().into());
    for visibility in [near, very_many] {
        agrees_with_asking(world, &visibility, random);
    }
}

/// The same with one way to find them.
fn agrees_with_asking(world: &World, visibility: &Visibility<'_>, random: &mut Random) {
    let spheres = world.spheres();
    for _ in 0..3 {
        let view = view(random);
        let few = ViewIndex::new(visibility, &view, RayPoints::All);
        // Whatever their number, but for sizes whose squares are no numbers.
        let crowd = visibility.hierarchy.as_deref();
        let crowd = crowd.filter(|_| visibility.is_moderate());
        midpoints_agree(&few, &view, crowd);
        let crowd = ViewIndex::with_hierarchy(visibility, &view, RayPoints::All, crowd);
        for tile in tiles_of(&view) {
            for cell in cells_and_edges(tile) {
                let ray = view.ray(view.cell_center(cell.0, cell.1, FINE));
                let found = few.nearest(tile, &ray);
                let expected = nearest(spheres, &ray);
                assert_eq!(found, crowd.nearest(tile, &ray));
                // Distances agree to the last place; what is known from the viewpoint is rounded
                // another way.
                assert_eq!(
                    found.map(|(index, _)| index),
                    expected.map(|(index, _)| index)
                );
                let (Some((index, hit)), Some((_, other))) = (found, expected) else {
                    continue;
                };
                assert!((hit.t - other.t).abs() <= 2.0 * f64::EPSILON * other.t);
                for (number, light) in world.lights.iter().enumerate() {
                    let to_light = Ray {
                        origin: ray.at(hit.t),
                        direction: light.toward().unwrap(),
                    };
                    let error = ray.point_error(hit.t);
                    let expected = spheres.iter().enumerate().any(|(caster, sphere)| {
                        caster != index
                            && *sphere != spheres[index]
                            && sphere.is_met(&to_light, error)
                    });
                    assert_eq!(
                        visibility.is_blocked(number, &to_light, error, index),
                        expected
                    );
                }
            }
        }
    }
}

#[test]
fn random_clouds() {
    for seed in 0..6 {
        let mut random = Random(seed);
        let count = [1, 2, 10, 60, 200, 400][seed as usize];
        let balls: Vec<_> = (0..count)
            .map(|_| (random.point(), 0.02 + 0.2 * random.number()))
            .collect();
        agrees_with_asking_all(&world_of(balls, &mut random), &mut random);
    }
}

/// Counted work, and what is seen, where most is hidden.
#[test]
fn crowds_leave_out_what_is_hidden() {
    let mut random = Random(19);
    // The last are so far from the origin that single precision says too little of them.
    for (radius, middle) in [(0.06, 0.0), (0.2, 0.0), (0.06, 1e5)] {
        let middle = DVec3::splat(middle);
        let balls: Vec<_> = (0..4000)
            .map(|_| (middle + random.point(), radius))
            .collect();
        let world = world_of(balls, &mut random);
        let visibility = Visibility::new(&world);
        let mut view = view(&mut random);
        view.camera.position = middle + view.camera.world_from_camera * DVec3::NEG_Z * 4.0;
        (view.width, view.height) = (150, 90);
        let few = ViewIndex::new(&visibility, &view, RayPoints::All);
        let hierarchy = visibility.hierarchy.as_deref();
        midpoints_agree(&few, &view, hierarchy);
        let crowd = ViewIndex::with_hierarchy(&visibility, &view, RayPoints::All, hierarchy);
        let once = RayPoints::Midpoints(NonZeroU32::MIN);
        let sampled = ViewIndex::with_hierarchy(&visibility, &view, once, hierarchy);
        let (mut listed, mut left, mut left_once) = (0, 0, 0);
        for tile in tiles_of(&view) {
            (listed, left) = (
                listed + few.balls(tile).count(),
                left + crowd.balls(tile).count(),
            );
            left_once += sampled.balls(tile).count();
            for cell in cells_and_edges(tile) {
                let ray = view.ray(view.cell_center(cell.0, cell.1, FINE));
                let [one, other] = [&few, &crowd].map(|index| index.nearest(tile, &ray));
                assert_eq!(one, other);
            }
        }
        assert!(2 * left < listed && left > 100, "{left} of {listed}");
        assert!(left_once < left && left_once > 100, "{left_once} of {left}");
    }
}

#[test]
fn no_spheres() {
    let mut random = Random(1);
    agrees_with_asking_all(&world_of([], &mut random), &mut random);
}

#[test]
fn all_equal_all_nested_and_all_on_a_line() {
    let mut random = Random(2);
    let center = DVec3::new(0.1, 0.2, 0.3);
    let equal = [(center, 0.5); 20];
    let nested: Vec<_> = (1..20)
        .map(|index| (center, 0.05 * f64::from(index)))
        .collect();
    let line: Vec<_> = (0..60)
        .map(|index| (DVec3::X * (0.1 * f64::from(index) - 3.0), 0.06))
        .collect();
    let column: Vec<_> = (0..60)
        .map(|index| (DVec3::Y * (0.1 * f64::from(index) - 3.0), 0.05))
        .collect();
    for balls in [equal.to_vec(), nested, line, column] {
        agrees_with_asking_all(&world_of(balls, &mut random), &mut random);
    }
}

#[test]
fn huge_among_tiny_and_radii_over_twelve_decades() {
    let mut random = Random(3);
    let mut floor: Vec<_> = (0..60).map(|_| (random.point(), 0.05)).collect();
    floor.push((DVec3::new(0.0, -1e6 - 0.5, 0.0), 1e6));
    let decades: Vec<_> = (0..80)
        .map(|_| {
            let radius = libm::exp10(-6.0 + 12.0 * random.number());
            (random.point() * (1.0 + radius), radius)
        })
        .collect();
    for balls in [floor, decades] {
        agrees_with_asking_all(&world_of(balls, &mut random), &mut random);
    }
}

#[test]
fn far_from_the_origin() {
    let mut random = Random(4);
    for exponent in [-600, -538, -537, -536, -535, -500, -300, 300, 600] {
        let scale = libm::scalbn(1.0, exponent);
        let balls: Vec<_> = (0..40)
            .map(|_| (random.point() * scale, 0.2 * scale))
            .collect();
        let world = world_of(balls, &mut random);
        let visibility = Visibility::new(&world);
        let mut view = view(&mut random);
        view.camera.position *= scale;
        let index = ViewIndex::new(&visibility, &view, RayPoints::All);
        let tile = Tile {
            col: 16,
            row: 8,
            width: SIDE,
            height: SIDE,
        };
        for (col, row) in tile.pixels() {
            let ray = view.ray(view.cell_center(u64::from(col), u64::from(row), 1));
            let found = index.nearest(tile, &ray);
            let expected = nearest(world.spheres(), &ray);
            assert_eq!(
                found.map(|(index, _)| index),
                expected.map(|(index, _)| index)
            );
        }
    }
}
