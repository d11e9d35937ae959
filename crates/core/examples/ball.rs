//! Renders a ball under a light and writes `ball.ppm`.

use std::error::Error;
use std::fs;

use marbles_core::glam::DVec3;
use marbles_core::{Angle, Camera, Lens, Light, Material, Renderer, Settings, Sphere, View, World};

fn main() -> Result<(), Box<dyn Error>> {
    let mut world = World::new();
    let red = world.add_material(Material {
        albedo: DVec3::new(0.9, 0.2, 0.15),
        ..Material::default()
    });
    world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, red);
    let sun = Light::directional(DVec3::new(-1.0, 1.0, -1.0), DVec3::ONE)?;
    world.lights.push(sun);
    let lens = Lens::from_field_of_view(Angle::from_degrees(40.0))?;
    let view = View::new(Camera::default(), lens, 200, 200);
    let image = Renderer::new(&world).render(&view, &Settings::default());

    let mut file = b"P6 200 200 255\n".to_vec();
    file.extend(image.to_srgb8().chunks_exact(4).flat_map(|rgba| &rgba[..3]));
    fs::write("ball.ppm", file)?;
    Ok(())
}
