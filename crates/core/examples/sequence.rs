//! Renders a camera's way around three balls, and prints the error of each frame. The world is prepared once.

#![expect(clippy::print_stdout, reason = "an example prints its results")]

use std::error::Error;

use marbles_core::glam::DVec3;
use marbles_core::{Angle, Camera, Lens, Light, Material, Renderer, Settings, Sphere, View, World};

const FRAMES: u32 = 8;

fn main() -> Result<(), Box<dyn Error>> {
    let mut world = World::new();
    let white = world.add_material(Material::default());
    for x in [-1.0, 0.0, 1.0] {
        world.add_sphere(Sphere::new(DVec3::new(x, 0.0, 0.0), 0.4)?, white);
    }
    let sun = Light::directional(DVec3::new(-1.0, 1.0, -1.0), DVec3::ONE)?;
    world.lights.push(sun);
    let renderer = Renderer::new(&world);
    let lens = Lens::from_field_of_view(Angle::from_degrees(40.0))?;
    for frame in 1..=FRAMES {
        let azimuth = Angle::from_degrees(360.0 * f64::from(frame - 1) / f64::from(FRAMES));
        let elevation = Angle::from_degrees(20.0);
        let camera = Camera::orbit(DVec3::ZERO, 5.0, azimuth, elevation, Angle::ZERO);
        let view = View {
            frame: i64::from(frame),
            ..View::new(camera, lens, 160, 120)
        };
        let image = renderer.render(&view, &Settings::default());
        println!(
            "frame {frame}: error <= {:.1e}",
            image.summary().largest_error
        );
    }
    Ok(())
}
