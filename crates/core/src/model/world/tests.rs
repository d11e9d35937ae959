//! Worlds: their colors and their spheres.

use glam::DVec3;

use super::*;

fn spheres(count: usize, x: f64) -> Vec<Sphere> {
    (0..count)
        .map(|index| Sphere::new(DVec3::new(x, index as f64, 0.0), 1.0).unwrap())
        .collect()
}

#[test]
fn many_spheres_come_behind_those_that_are_there() {
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    for (count, x) in [(2, 0.0), (5, 1.0), (0, 2.0), (3, 3.0), (9, 4.0)] {
        world.add_spheres(spheres(count, x), white, None);
    }
    let found: Vec<(f64, f64)> = world
        .spheres()
        .iter()
        .map(|sphere| (sphere.center().x, sphere.center().y))
        .collect();
    let expected: Vec<(f64, f64)> = [(2, 0.0), (5, 1.0), (3, 3.0), (9, 4.0)]
        .into_iter()
        .flat_map(|(count, x)| (0..count).map(move |y| (x, f64::from(y))))
        .collect();
    assert_eq!(found, expected);
    assert_eq!(*world.material(18), Material::MATTE_WHITE);
}

#[test]
fn albedos_of_their_own_belong_to_their_spheres() {
    let mut world = World::new();
    let grey = world.add_material(Material {
        albedo: Color::splat(0.5),
        ..Material::MATTE_WHITE
    });
    world.add_spheres(spheres(2, 0.0), grey, None);
    let each = Albedos::Each(vec![[0.25, 0.25, 0.25], [0.5, 0.75, 1.0]]);
    world.add_spheres(spheres(2, 0.0), grey, Some(each));
    world.add_spheres(spheres(1, 0.0), grey, None);
    assert!(!world.has_grey_spheres());
    let palette = Albedos::Palette {
        colors: vec![Color::X, Color::Y],
        indices: vec![1, 0, 1],
    };
    world.add_spheres(spheres(3, 0.0), grey, Some(palette));
    let found: Vec<Color> = (0..8).map(|index| world.albedo(index)).collect();
    let half = Color::splat(0.5);
    let colored = Color::new(0.5, 0.75, 1.0);
    let expected = [
        half,
        half,
        0.5 * half,
        colored,
        half,
        Color::Y,
        Color::X,
        Color::Y,
    ];
    assert_eq!(found, expected);
}

#[test]
fn grey_albedos_leave_a_world_grey() {
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    let grey = Albedos::Each(vec![[0.25; 3]; 4]);
    world.add_spheres(spheres(4, 0.0), white, Some(grey));
    // Colors that no sphere has do not count.
    let palette = Albedos::Palette {
        colors: vec![Color::X, Color::ONE],
        indices: vec![1, 1],
    };
    world.add_spheres(spheres(2, 0.0), white, Some(palette));
    assert!(world.is_grey());
}
